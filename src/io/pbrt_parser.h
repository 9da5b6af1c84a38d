// Reads pbrt scene text, versions 3 and 4, into a SceneDescription.
//
// One reader serves both: which version a file is follows from the words it uses (WorldEnd, point or point3, the names
// of materials and films, ...) and is told in SceneDescription::version and versionReason.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "src/base/error.h"
#include "src/io/scene_description.h"

namespace dapple {

struct ParseOptions {
  int pbrtVersion = 0;  ///< 3 or 4; 0: found from the text.
};

/// Reads a scene file (.pbrt or .pbrt.gz) and what it includes. Throws Error with the place of a syntax error, a
/// statement out of order, a missing file or a wrong value; what is not supported warns.
SceneDescription ParsePbrtFile(const std::filesystem::path& path, const ParseOptions& options,
                               Diagnostics& diagnostics);

/// Reads text in memory; `name` stands in messages, `folder` is where included files are searched.
SceneDescription ParsePbrtString(std::string_view text, const std::string& name, const std::filesystem::path& folder,
                                 const ParseOptions& options, Diagnostics& diagnostics);

}  // namespace dapple
