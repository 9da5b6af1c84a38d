// What all the builders of a scene's parts share.
#pragma once

#include <string>
#include <vector>

#include "src/io/build_scene.h"
#include "src/io/scene_description.h"

namespace dapple {

/// What the parts are built from; all that it refers to must live as long.
struct BuildContext {
  const SceneDescription& description;
  const BuildOptions& options;
  Diagnostics& diagnostics;
  /// The world, moved so that what the camera sees is near the origin.
  Transform renderFromWorld;

  /// The file is in version 3 of the format; else 4.
  bool IsV3() const { return description.version == 3; }
};

/// Warns that a parameter has no effect, where it is there; it then counts as known.
void WarnUnsupported(const BuildContext& context, const ParameterList& params, std::string_view name);

/// Throws 'unknown <what> "<name>", expected one of ...; did you mean ...?'.
[[noreturn]] void FailUnknownName(const FileLocation& location, std::string_view what, std::string_view name,
                                  const std::vector<std::string>& known);

/// Runs `make`; an Error without a place gets `location`.
template <typename F>
auto AtLocation(const FileLocation& location, F make) {
  try {
    return make();
  } catch (const Error& error) {
    if (error.Location().file) throw;
    const std::string_view line = error.what();
    constexpr std::string_view kPrefix = "error: ";
    throw Error(location, std::string(line.starts_with(kPrefix) ? line.substr(kPrefix.size()) : line));
  }
}

}  // namespace dapple
