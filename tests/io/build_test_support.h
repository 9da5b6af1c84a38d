// Shared by the tests of the scene builder: scenes from text, with their warnings, and what a ray through the middle
// finds.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "src/io/build_scene.h"
#include "src/io/pbrt_parser.h"
#include "tests/io/reader_test_support.h"

namespace dapple {

/// A scene from text in memory, with the warnings on the way.
struct Built {
  std::unique_ptr<Scene> scene;
  std::vector<std::string> warnings;

  const Scene* operator->() const { return scene.get(); }
};

inline Built BuildText(const std::string& text, int version, const BuildOptions& options = {},
                       const std::filesystem::path& folder = "") {
  WarningList warnings;
  const SceneDescription description = ParsePbrtString(text, "a.pbrt", folder, {version}, warnings.diagnostics);
  Built built;
  built.scene = BuildScene(description, options, warnings.diagnostics);
  built.warnings = warnings.lines;
  return built;
}

/// A camera at (0, 0, -5) that looks along +z, a point light, and what `world` says. Any warning fails the test.
inline std::string WorldText(const std::string& world, int version) {
  return std::string("LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\nWorldBegin\n") +
         "LightSource \"point\"\n" + world + (version == 3 ? "\nWorldEnd\n" : "\n");
}

inline Built BuildWorld(const std::string& world, int version, const std::filesystem::path& folder = "") {
  return BuildText(WorldText(world, version), version, {}, folder);
}

/// The same without warnings.
inline std::unique_ptr<Scene> CleanWorld(const std::string& world, int version,
                                         const std::filesystem::path& folder = "") {
  Built built = BuildWorld(world, version, folder);
  for (const std::string& line : built.warnings) ADD_FAILURE() << line;
  return std::move(built.scene);
}

/// The message of the Error in a world, whose first line is line 5 of the text.
inline std::string WorldError(const std::string& world, int version) {
  return MessageOf([&] { BuildWorld(world, version); });
}

/// What the ray along +z through world position (x, y) finds first.
inline std::optional<SurfaceInteraction> LookAtXY(const Scene& scene, double x = 0, double y = 0) {
  const Vec3d o = scene.RenderToWorld().Inverse().Point({x, y, -5});
  return scene.Intersect({ToFloat(o), Vec3(0, 0, 1), kInfinity, {}});
}

/// The BSDF there.
inline Bsdf BsdfAtXY(const Scene& scene, double x = 0, double y = 0) {
  const std::optional<SurfaceInteraction> hit = LookAtXY(scene, x, y);
  if (!hit || !scene.MaterialAt(*hit)) throw Error("no surface there");
  return scene.MaterialAt(*hit)->GetBsdf(*hit);
}

/// A unit square in the plane z = 0 that faces the camera, with (u, v) from (0, 0) at (-1, -1) to (1, 1) at (1, 1).
inline std::string Square(int version) {
  const std::string point = version == 3 ? "point" : "point3";
  return "Shape \"trianglemesh\" \"" + point +
         " P\" [-1 -1 0 -1 1 0 1 1 0 1 -1 0] \"integer indices\" [0 1 2 0 2 3] \"" +
         (version == 3 ? "float" : "point2") + " uv\" [0 0 0 1 1 1 1 0]\n";
}

inline void ExpectColor(const Color& color, const Color& expected, double relative = 1e-4) {
  for (int c = 0; c < Color::kComponents; ++c)
    EXPECT_NEAR(color[c], expected[c], relative * std::max(1e-3f, std::abs(expected[c]))) << "component " << c;
}

}  // namespace dapple
