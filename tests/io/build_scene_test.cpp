// Whole scenes: where render space lies, instances, and that what is said once is warned of once.
#include "src/base/numerics.h"
#include "tests/io/build_test_support.h"

namespace dapple {
namespace {

/// A small scene of every kind of thing, moved by (d, -d, d / 2) in all of its statements.
std::string Moved(double d) {
  const auto xyz = [&](double x, double y, double z) {
    char text[120];
    std::snprintf(text, sizeof text, "%.6f %.6f %.6f ", x + d, y - d, z + d / 2);
    return std::string(text);
  };
  return "LookAt " + xyz(1, -4, 2) + xyz(0, 0, 0.5) + " 0 0 1\n" + "Camera \"perspective\" \"float fov\" 40\n" +
         "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\nWorldBegin\n" +
         "LightSource \"point\" \"point3 from\" [" + xyz(2, -2, 3) + "]\n" +
         "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" + xyz(-3, -3, 0) + xyz(3, -3, 0) +
         xyz(3, 3, 0) + xyz(-3, 3, 0) + "]\n" + "AttributeBegin Translate " + xyz(0.5, 0, 0.5) +
         " Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n" +
         // An object that is defined where it stands, and one that is placed.
         "ObjectBegin \"a\" Shape \"trianglemesh\" \"point3 P\" [" + xyz(-1.5, 0, 0) + xyz(-0.5, 0, 0) + xyz(-1, 0, 1) +
         "] ObjectEnd\nObjectInstance \"a\"\n" + "ObjectBegin \"b\" Shape \"disk\" \"float radius\" 0.4 ObjectEnd\n" +
         "AttributeBegin Translate " + xyz(-0.5, -1, 0.3) + " Rotate 70 1 0 0 ObjectInstance \"b\" AttributeEnd\n";
}

TEST(BuildScene, ASceneFarAwayIsTheSameScene) {
  const Built near = BuildText(Moved(0), 4), far = BuildText(Moved(1e7), 4);
  EXPECT_TRUE(near.warnings.empty() && far.warnings.empty());
  int found = 0;
  for (int i = 0; i < 32 * 32; ++i) {
    const Vec2 film(static_cast<float>(i % 32) + 0.5f, static_cast<float>(i / 32) + 0.5f);
    const Ray a = near->GetCamera().GenerateRay(film, {0.5, 0.5}, 0).ray;
    const Ray b = far->GetCamera().GenerateRay(film, {0.5, 0.5}, 0).ray;
    EXPECT_LT(Distance(a.o, b.o), 1e-6);
    EXPECT_LT(Distance(a.d, b.d), 1e-6);
    const std::optional<SurfaceInteraction> p = near->Intersect(a), q = far->Intersect(a);
    ASSERT_EQ(p.has_value(), q.has_value());
    if (!p) continue;
    ++found;
    EXPECT_EQ(p->shape, q->shape);
    EXPECT_EQ(p->instance, q->instance);
    // Doubles at 1e7 resolve 2e-9; what is left is the rounding to float.
    EXPECT_LT(Distance(p->p, q->p), 2e-6);
    EXPECT_LT(Distance(p->ng, q->ng), 1e-5);
    EXPECT_LT((p->uv - q->uv).length(), 1e-5);
    EXPECT_LT(q->pError, 1e-5);
    const LiRandom u{0.5, {0.5, 0.5}};
    EXPECT_LT(Distance(near->Lights()[0]->Sample_Li(LightContext(p->p), u)->p,
                       far->Lights()[0]->Sample_Li(LightContext(q->p), u)->p),
              1e-6);
  }
  EXPECT_GT(found, 500);
  EXPECT_LT(Length(far->GetCamera().Position()), 1e-6);
  EXPECT_NEAR(far->RenderToWorld().Point(Vec3d(0)).x, 1e7 + 1, 1e-6);
}

TEST(BuildScene, FarThingsDoNotDragTheCentreAway) {
  const Built built = BuildText(Moved(1e7) + "AttributeBegin Translate 0 0 1e9 Shape \"sphere\" AttributeEnd\n", 4);
  EXPECT_LT(Length(built->GetCamera().Position()), 1e-6);
}

TEST(BuildScene, OrthographicCamerasMayStandFarBack) {
  const Built built = BuildText(
      "LookAt 1e8 0 0  0 0 0  0 0 1\nCamera \"orthographic\"\nWorldBegin\nLightSource \"point\"\n"
      "Translate 3 0 0 Shape \"sphere\"",
      4);
  const Vec3d origin = built->RenderToWorld().Point(Vec3d(0));
  EXPECT_NEAR(origin.x, 3, 1e-6);
}

TEST(BuildScene, InstancesStandWhereTheyArePlaced) {
  const auto scene = CleanWorld(R"(ObjectBegin "ball" Translate 0 0 1 Shape "sphere" "float radius" .25 ObjectEnd
      AttributeBegin Translate 1 0 0 ObjectInstance "ball" AttributeEnd
      AttributeBegin Translate -1 0 0 Scale 2 2 2 ObjectInstance "ball" AttributeEnd)",
                                4);
  EXPECT_EQ(scene->Facts().instances, 2);
  EXPECT_EQ(scene->Facts().shapes, 1);
  EXPECT_FALSE(LookAtXY(*scene, 0, 0));
  const auto depth = [&](double x) { return scene->RenderToWorld().Point(ToDouble(LookAtXY(*scene, x, 0)->p)).z; };
  EXPECT_NEAR(depth(1), 0.75, 1e-5);
  EXPECT_NEAR(depth(-1), 1.5, 1e-5);
}

TEST(BuildScene, EachWarningIsGivenOnce) {
  std::string world;
  for (int i = 0; i < 3; ++i) world += "Shape \"sphere\" ";
  const Built built = BuildWorld("Material \"hair\" AreaLightSource \"diffuse\" \"float bogus\" 1 " + world, 4);
  EXPECT_EQ(built.warnings.size(), 2u);
}

TEST(BuildScene, ScenesOfTheProjectLoadWithoutAWarning) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(DAPPLE_SOURCE_DIR) + "/scenes")) {
    if (entry.path().extension() != ".pbrt") continue;
    ++count;
    WarningList warnings;
    const std::unique_ptr<Scene> scene = LoadScene(entry.path(), {}, warnings.diagnostics);
    for (const std::string& line : warnings.lines) ADD_FAILURE() << line;
    EXPECT_TRUE(scene->Facts().EmitsLight()) << entry.path();
  }
  EXPECT_GE(count, 6);
}

TEST(BuildScene, AMissingFileIsAnError) {
  WarningList warnings;
  EXPECT_NE(MessageOf([&] { LoadScene("/nowhere/scene.pbrt", {}, warnings.diagnostics); }).find("error"),
            std::string::npos);
}

TEST(BuildScene, ABlackImageIsTold) {
  const auto warnings = [](const std::string& world) {
    std::string lines;
    for (const std::string& line : BuildText("WorldBegin " + world, 4).warnings) lines += line + "\n";
    return lines;
  };
  const std::string light = "LightSource \"point\" ", shape = "Shape \"sphere\" ";
  const std::string noLight = "a.pbrt: warning: the scene has no light; its image is black\n";
  const std::string noShape = "a.pbrt: warning: the scene has no shape to be seen; its image is black\n";
  EXPECT_EQ(warnings(light + shape), "");
  EXPECT_EQ(warnings(shape), noLight);
  EXPECT_EQ(warnings(light), noShape);
  EXPECT_EQ(warnings(""), noLight + noShape);
  EXPECT_EQ(warnings(light + "Material \"interface\" " + shape), noShape);
  EXPECT_EQ(warnings(light + "ObjectBegin \"o\" " + shape + "ObjectEnd"), noShape);
  EXPECT_EQ(warnings(light + "ObjectBegin \"o\" " + shape + "ObjectEnd ObjectInstance \"o\""), "");
  // Such a light is seen by itself.
  EXPECT_EQ(warnings("LightSource \"infinite\""), "");
}

}  // namespace
}  // namespace dapple
