// From what a scene file says to a scene that can be traced.
//
//   auto scene = LoadScene("scene.pbrt", {}, diagnostics);
//
// Defaults and meanings are those of the version of pbrt that the file is in. What is not supported gets a warning at
// its place and a stand-in; what cannot be right is an Error at its place.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>

#include "src/io/scene_description.h"
#include "src/scene/scene.h"

namespace dapple {

/// The longest paths that a file or the command line may ask for, in scattering events: where nothing absorbs, only
/// this ends them. After so many, a surface that absorbs 1 % an event has left 3e-5 of the light.
inline constexpr int kMostDepth = 1024;
/// The most next-event samples at a vertex that either may ask for.
inline constexpr int kMostLightSamples = 65'536;

/// What the command line says; absent: the file's own.
struct BuildOptions {
  int pbrtVersion = 0;  ///< 3 or 4; 0: found from the text (`LoadScene`)
  std::optional<Vec2i> resolution;
  /// xMin, xMax, yMin, yMax as shares of the image, in [0, 1].
  std::optional<std::array<double, 4>> cropWindow;
  /// Directions will be drawn toward lights (`Light::Sample_Li`): where not, no table is built for that alone, and
  /// environments answer by the table that they emit from.
  bool drawsTowardLights = true;
  /// How many at a vertex, in place of the lights' own counts.
  std::optional<int> lightSamples;
};

/// The parts of the scene, as `Scene` takes them. Throws `Error`.
SceneParts BuildSceneParts(const SceneDescription& description, const BuildOptions& options, Diagnostics& diagnostics);

/// The scene, ready to trace. Throws `Error`.
std::unique_ptr<Scene> BuildScene(const SceneDescription& description, const BuildOptions& options,
                                  Diagnostics& diagnostics);

/// Reads and builds the scene file at `path`. Throws `Error`.
std::unique_ptr<Scene> LoadScene(const std::filesystem::path& path, const BuildOptions& options,
                                 Diagnostics& diagnostics);

}  // namespace dapple
