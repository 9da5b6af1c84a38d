// Shape statements: what a ray finds of them, and what is wrong with bad ones.
#include "src/base/numerics.h"
#include "tests/io/build_test_support.h"

namespace dapple {
namespace {

/// Where the ray along +z through world position (x, y) meets the scene, in the world.
std::optional<Vec3d> HitAt(const Scene& scene, double x, double y) {
  const std::optional<SurfaceInteraction> hit = LookAtXY(scene, x, y);
  if (!hit) return std::nullopt;
  return scene.RenderToWorld().Point(ToDouble(hit->p));
}

void ExpectDepth(const Scene& scene, double x, double y, double z) {
  const std::optional<Vec3d> p = HitAt(scene, x, y);
  ASSERT_TRUE(p) << x << " " << y;
  EXPECT_NEAR(p->z, z, 1e-5) << x << " " << y;
}

TEST(BuildShapes, QuadricsHaveTheirDefaults) {
  for (int version : {3, 4}) {
    const auto sphere = CleanWorld("Shape \"sphere\"", version);
    ExpectDepth(*sphere, 0.6, 0, -0.8);
    EXPECT_FALSE(HitAt(*sphere, 1.01, 0));
    const auto disk = CleanWorld("Shape \"disk\"", version);
    ExpectDepth(*disk, 0.99, 0, 0);
    EXPECT_FALSE(HitAt(*disk, 1.01, 0));
    const auto cylinder = CleanWorld("Rotate 90 1 0 0 Shape \"cylinder\"", version);
    ExpectDepth(*cylinder, 0.6, 0.99, -0.8);
    EXPECT_FALSE(HitAt(*cylinder, 0, 1.01));
  }
}

TEST(BuildShapes, QuadricsArePartialAsAsked) {
  const auto sphere =
      CleanWorld(R"(Shape "sphere" "float radius" 2 "float zmin" 0 "float zmax" 1 "float phimax" 180)", 4);
  EXPECT_FALSE(HitAt(*sphere, 0, 0.5)) << "the cap above zmax is open";
  ExpectDepth(*sphere, 0, 1.9, std::sqrt(4 - 1.9 * 1.9));
  EXPECT_FALSE(HitAt(*sphere, 0, -1.9)) << "phi above phimax";
  const auto disk = CleanWorld(R"(Shape "disk" "float radius" 2 "float innerradius" 1 "float height" 0.5)", 4);
  EXPECT_FALSE(HitAt(*disk, 0.5, 0));
  ExpectDepth(*disk, 1.5, 0, 0.5);
}

TEST(BuildShapes, MeshesOfBothSpellings) {
  for (int version : {3, 4}) {
    const auto scene = CleanWorld("Translate 0 0 1 " + Square(version), version);
    ExpectDepth(*scene, 0.5, -0.25, 1);
    const std::optional<SurfaceInteraction> hit = LookAtXY(*scene, 0.5, -0.25);
    EXPECT_NEAR(hit->uv.x, 0.75, 1e-6);
    EXPECT_NEAR(hit->uv.y, 0.375, 1e-6);
  }
  // One triangle needs no indices in pbrt-v4.
  const auto one = CleanWorld(R"(Shape "trianglemesh" "point3 P" [-1 -1 0  1 -1 0  0 1 0])", 4);
  ExpectDepth(*one, 0, 0, 0);
  const auto patch = CleanWorld(R"(Shape "bilinearmesh" "point3 P" [-1 -1 0  1 -1 0  -1 1 0  1 1 1])", 4);
  ExpectDepth(*patch, 0, 0, 0.25);
}

TEST(BuildShapes, OrientationFollowsWindingHandednessAndReversal) {
  const auto normal = [](const std::string& before) {
    return LookAtXY(*CleanWorld(before + R"(
        Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [-1 -1 0  1 -1 0  0 1 0])",
                                4))
        ->ng.z;
  };
  EXPECT_NEAR(normal(""), 1, 1e-6);
  EXPECT_NEAR(normal("ReverseOrientation"), -1, 1e-6);
  // A mirrored copy looks the same from outside: the mirror in x keeps z.
  EXPECT_NEAR(normal("Scale -1 1 1"), 1, 1e-6);
  EXPECT_NEAR(normal("Scale -1 1 1 ReverseOrientation"), -1, 1e-6);
  const auto sphere = [](const std::string& before) {
    return LookAtXY(*CleanWorld(before + " Shape \"sphere\"", 4))->ng.z;
  };
  EXPECT_NEAR(sphere(""), -1, 1e-6);
  EXPECT_NEAR(sphere("Scale 1 -1 1"), -1, 1e-6);
  EXPECT_NEAR(sphere("ReverseOrientation"), 1, 1e-6);
}

TEST(BuildShapes, NormalsAreTransformedAsNormals) {
  const auto scene = CleanWorld(R"(Scale 1 1 3 Shape "trianglemesh" "integer indices" [0 1 2]
      "point3 P" [-1 -1 0  1 -1 0  0 1 0] "normal N" [1 0 3  1 0 3  1 0 3])",
                                4);
  const Vec3 expected = Normalize(Vec3(1, 0, 1));
  EXPECT_LT(Distance(LookAtXY(*scene)->ns, expected), 1e-6);
}

TEST(BuildShapes, LoopSubdivisionRoundsAnOctahedron) {
  const std::string mesh = R"("integer indices" [0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5]
      "point3 P" [1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1])";
  for (const std::string before : {"", "Scale -1 1 1 "}) {
    const auto scene = CleanWorld(before + "Shape \"loopsubdiv\" \"integer levels\" 4 " + mesh, 4);
    const std::optional<SurfaceInteraction> hit = LookAtXY(*scene, 0.1, 0.05);
    ASSERT_TRUE(hit);
    const Vec3d p = scene->RenderToWorld().Point(ToDouble(hit->p));
    EXPECT_GT(Length(p), 0.4);
    EXPECT_LT(Length(p), 0.8);
    // pbrt's side of a mesh that is wound counter-clockwise from outside is the inside; a mirror does not change that.
    EXPECT_LT(Dot(Normalize(p), ToDouble(hit->ns)), -0.9);
  }
  EXPECT_EQ(CleanWorld("Shape \"loopsubdiv\" \"integer nlevels\" [0] " +
                           std::string(mesh).replace(mesh.find("point3"), 6, "point"),
                       3)
                ->Facts()
                .primitives,
            8);
}

std::string PlySquare() {
  return "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
         "-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n0 2 0\n4 0 1 2 3\n3 3 2 4\n";
}

TEST(BuildShapes, PlyFacesOfFourArePatchesInVersion4) {
  const TestFolder folder;
  folder.Write("mesh.ply", PlySquare());
  const std::string shape = R"(Shape "plymesh" "string filename" "mesh.ply")";
  const auto v3 = CleanWorld(shape, 3, folder.Path()), v4 = CleanWorld(shape, 4, folder.Path());
  EXPECT_EQ(v3->Facts().shapes, 1);
  EXPECT_EQ(v3->Facts().primitives, 3);
  EXPECT_EQ(v4->Facts().shapes, 2);
  EXPECT_EQ(v4->Facts().primitives, 2);
  for (const Scene* scene : {v3.get(), v4.get()}) {
    ExpectDepth(*scene, 0.9, 0.9, 0);
    ExpectDepth(*scene, -0.9, 0.9, 0);
    ExpectDepth(*scene, 0, 1.5, 0);
    EXPECT_FALSE(HitAt(*scene, 0.9, 1.5));
  }
}

TEST(BuildShapes, AlphaCutsHoles) {
  const std::string checks = R"(Texture "holes" "float" "checkerboard" "float uscale" [2] "float vscale" [2]
      "float tex1" [1] "float tex2" [0]
  )";
  for (int version : {3, 4}) {
    std::string square = Square(version);
    square.insert(square.size() - 1, " \"texture alpha\" \"holes\"");
    const auto scene = CleanWorld(checks + square, version);
    ExpectDepth(*scene, -0.5, -0.5, 0);
    EXPECT_FALSE(HitAt(*scene, 0.5, -0.5));
    ExpectDepth(*scene, 0.5, 0.5, 0);
  }
}

TEST(BuildShapes, InterfacesAreLeftOut) {
  for (const std::string material : {"Material \"interface\"", "Material \"none\"", "Material \"\""})
    EXPECT_EQ(CleanWorld(material + "\nShape \"sphere\" Material \"diffuse\" Shape \"disk\"", 4)->Facts().shapes, 1);
  // In pbrt-v3 they may glow; then they are seen, and cast no shadow.
  const auto glow = CleanWorld("Material \"none\" AreaLightSource \"diffuse\" Shape \"sphere\"", 3);
  const std::optional<SurfaceInteraction> hit = LookAtXY(*glow);
  ASSERT_TRUE(hit);
  EXPECT_GE(glow->AreaLightAt(*hit), 0);
  EXPECT_EQ(glow->MaterialAt(*hit), nullptr);
  const Built v4 = BuildWorld(
      "AttributeBegin Material \"interface\" AreaLightSource \"diffuse\" Shape \"sphere\" AttributeEnd Shape \"disk\"",
      4);
  EXPECT_EQ(v4->Facts().shapes, 1);
  EXPECT_EQ(v4.warnings.size(), 1u);
}

TEST(BuildShapes, WarnsOfWhatItLacks) {
  const Built built = BuildWorld("Shape \"curve\" \"point3 P\" [0 0 0 1 1 1 2 2 2 3 3 3]\nShape \"sphere\"", 4);
  EXPECT_EQ(built.warnings,
            std::vector<std::string>{"a.pbrt:5:1: warning: shape \"curve\" is not supported and left out"});
  EXPECT_EQ(built->Facts().shapes, 1);
  EXPECT_EQ(BuildWorld("Shape \"sphere\" \"float raduis\" 2", 4).warnings,
            std::vector<std::string>{"a.pbrt:5:16: warning: unknown parameter \"raduis\"; did you mean \"radius\"?"});
}

TEST(BuildShapes, ErrorsSayWhatIsWrongAndWhere) {
  const auto mesh = [](const std::string& rest) { return WorldError("Shape \"trianglemesh\" " + rest, 4); };
  const std::string P = R"("point3 P" [0 0 0  1 0 0  0 1 0  1 1 0] )";
  EXPECT_EQ(mesh(""), "a.pbrt:5:1: error: \"trianglemesh\" has no vertices, expected a parameter \"point3 P\"");
  EXPECT_EQ(mesh(P), "a.pbrt:5:1: error: \"trianglemesh\" has no faces, expected a parameter \"integer indices\"");
  EXPECT_EQ(mesh(R"("integer indices" [0 1 2 3] )" + P),
            "a.pbrt:5:22: error: parameter \"indices\" has 4 values, expected a multiple of 3");
  EXPECT_EQ(mesh(R"("integer indices" [0 1 4] )" + P),
            "a.pbrt:5:22: error: index 4 (number 2 of \"indices\") is out of range, expected 0 to 3");
  EXPECT_EQ(mesh(R"("integer indices" [0 -1 2] )" + P),
            "a.pbrt:5:22: error: index -1 (number 1 of \"indices\") is out of range, expected 0 to 3");
  EXPECT_EQ(mesh(R"("normal N" [0 0 1] "integer indices" [0 1 2] )" + P),
            "a.pbrt:5:22: error: parameter \"N\" has 1 values, expected one for each of the 4 vertices");
  EXPECT_EQ(mesh(R"("point2 uv" [0 0 1 1] "integer indices" [0 1 2] )" + P),
            "a.pbrt:5:22: error: parameter \"uv\" has 2 values, expected one for each of the 4 vertices");
  EXPECT_EQ(WorldError(R"(Shape "bilinearmesh" "integer indices" [0 1 2] "point3 P" [0 0 0 1 0 0 0 1 0 1 1 0])", 4),
            "a.pbrt:5:22: error: parameter \"indices\" has 3 values, expected a multiple of 4");
  EXPECT_EQ(WorldError(R"(Shape "sphere" "float radius" -1)", 4),
            "a.pbrt:5:16: error: parameter \"radius\" is -1, expected more than 0");
  EXPECT_EQ(WorldError(R"(Shape "disk" "float innerradius" 2)", 4).substr(0, 18), "a.pbrt:5:14: error");
  EXPECT_EQ(WorldError(R"(Shape "spere")", 4),
            "a.pbrt:5:1: error: unknown shape \"spere\", expected one of trianglemesh, plymesh, bilinearmesh, "
            "loopsubdiv, sphere, disk, cylinder; did you mean \"sphere\"?");
  EXPECT_EQ(WorldError(R"(Shape "plymesh")", 4).substr(0, 17), "a.pbrt:5:1: error");
  EXPECT_EQ(WorldError(R"(Shape "plymesh" "string filename" "nowhere.ply")", 4).substr(0, 18), "a.pbrt:5:17: error");
  EXPECT_EQ(WorldError(
                R"(Shape "loopsubdiv" "integer levels" 99 "integer indices" [0 1 2] "point3 P" [0 0 0 1 0 0 0 1 0])", 4)
                .substr(0, 18),
            "a.pbrt:5:20: error");
  EXPECT_EQ(
      WorldError(R"(Scale 1e30 1e30 1e30 Shape "trianglemesh" "point3 P" [0 0 0  1e30 0 0  0 1 0])", 4).substr(0, 18),
      "a.pbrt:5:22: error");
}

}  // namespace
}  // namespace dapple
