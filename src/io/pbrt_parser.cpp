#include "src/io/pbrt_parser.h"

#include <fmt/format.h>

#include "src/io/pbrt_reader.h"
#include "src/io/text_file.h"

namespace dapple {

namespace {

/// Reads with `read(reader)`, which gives the reader its text. What TransformBegin means depends on the version, which
/// is known at the end: where a file has it and the guess was wrong, it is read again.
template <typename Read>
SceneDescription ReadAndDetect(const ParseOptions& options, Diagnostics& diagnostics, const Read& read) {
  const int guess = options.pbrtVersion != 0 ? options.pbrtVersion : 3;
  PbrtReader first = read(guess);
  const bool isDetected = options.pbrtVersion == 0;
  const int version = isDetected ? first.Votes().Version() : guess;
  const std::string reason = isDetected ? first.Votes().Reason(version) : "asked for";
  if (isDetected) first.Votes().WarnOfContradiction(version, diagnostics);
  SceneDescription scene =
      version == guess || !first.DependsOnVersion() ? first.Finish(version) : read(version).Finish(version);
  scene.versionReason = reason;
  return scene;
}

}  // namespace

SceneDescription ParsePbrtFile(const std::filesystem::path& path, const ParseOptions& options,
                               Diagnostics& diagnostics) {
  SceneDescription scene = ReadAndDetect(options, diagnostics, [&](int version) {
    PbrtReader reader(version, path.parent_path(), diagnostics);
    reader.ReadFile(path);
    return reader;
  });
  scene.file = path;
  return scene;
}

SceneDescription ParsePbrtString(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                                 const ParseOptions& options, Diagnostics& diagnostics) {
  SceneDescription scene = ReadAndDetect(options, diagnostics, [&](int version) {
    PbrtReader reader(version, folder, diagnostics);
    reader.ReadText(text, name);
    return reader;
  });
  scene.file = name;
  return scene;
}

}  // namespace dapple
