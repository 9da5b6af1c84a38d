// Camera statements of both versions, seen from the rays they make.
#include "tests/io/build_test_support.h"

namespace dapple {
namespace {

/// The ray through a share of the film, with the world's coordinates.
struct WorldRay {
  Vec3d o, d;
};

WorldRay RayOf(const Scene& scene, double x, double y) {
  const Vec2i& resolution = scene.Settings().resolution;
  const Vec2 film(static_cast<float>(x * resolution.x), static_cast<float>(y * resolution.y));
  const Ray ray = scene.GetCamera().GenerateRay(film, {0.5, 0.5}, 0).ray;
  return {scene.RenderToWorld().Point(ToDouble(ray.o)), ToDouble(ray.d)};
}

Built CameraScene(const std::string& statements, int version) {
  return BuildText(
      statements + "\nWorldBegin\nLightSource \"point\" Shape \"sphere\"\n" + (version == 3 ? "WorldEnd" : ""),
      version);
}

const char* const kWide = R"(Film "rgb" "integer xresolution" 200 "integer yresolution" 100
)";

void ExpectDirection(const Vec3d& d, const Vec3d& expected) { EXPECT_LT(Distance(d, Normalize(expected)), 1e-6); }

TEST(BuildCamera, FieldOfViewIsThatOfTheShorterSide) {
  const Built built = CameraScene(std::string(kWide) + R"(Camera "perspective" "float fov" 90)", 4);
  ExpectDirection(RayOf(*built.scene, 0.5, 0).d, {0, 1, 1});
  ExpectDirection(RayOf(*built.scene, 1, 0.5).d, {2, 0, 1});
  EXPECT_TRUE(built.warnings.empty());
}

TEST(BuildCamera, DefaultIsNinetyDegreesAlongZ) {
  const Built built = CameraScene(kWide, 4);
  ExpectDirection(RayOf(*built.scene, 0.5, 0).d, {0, 1, 1});
}

TEST(BuildCamera, WindowsAndAspects) {
  const Built aspect =
      CameraScene(std::string(kWide) + R"(Camera "perspective" "float fov" 90 "float frameaspectratio" 1)", 4);
  ExpectDirection(RayOf(*aspect.scene, 1, 0.5).d, {1, 0, 1});
  const Built window =
      CameraScene(std::string(kWide) + R"(Camera "perspective" "float fov" 90 "float screenwindow" [-1 3 -2 0.5])", 4);
  ExpectDirection(RayOf(*window.scene, 1, 0).d, {3, 0.5, 1});
  ExpectDirection(RayOf(*window.scene, 0, 1).d, {-1, -2, 1});
}

TEST(BuildCamera, HalfFovIsOfVersion3) {
  const Built built = CameraScene(R"(Film "image" "integer xresolution" [100] "integer yresolution" [100]
      Camera "perspective" "float halffov" [45])",
                                  3);
  EXPECT_TRUE(built.warnings.empty());
  ExpectDirection(RayOf(*built.scene, 0.5, 0).d, {0, 1, 1});
}

TEST(BuildCamera, LookAtPlacesTheEyeAndAScaleMirrors) {
  const Built built = CameraScene(R"(LookAt 1 2 3  1 2 9  0 1 0
      Camera "perspective" "float fov" 90)",
                                  4);
  EXPECT_LT(Distance(RayOf(*built.scene, 0.5, 0.5).o, {1, 2, 3}), 1e-9);
  EXPECT_GT(RayOf(*built.scene, 0.9, 0.5).d.x, 0);
  const Built mirrored = CameraScene("Scale -1 1 1\nLookAt 1 2 3  1 2 9  0 1 0\nCamera \"perspective\"", 4);
  EXPECT_LT(RayOf(*mirrored.scene, 0.9, 0.5).d.x, 0);
}

TEST(BuildCamera, LensFocusesAtItsDistance) {
  const Built built = CameraScene(R"(Camera "perspective" "float lensradius" 0.5 "float focaldistance" 4)", 4);
  const Ray a = built->GetCamera().GenerateRay({300, 200}, {0.1, 0.2}, 0).ray;
  const Ray b = built->GetCamera().GenerateRay({300, 200}, {0.8, 0.9}, 0).ray;
  EXPECT_GT(Distance(a.o, b.o), 0.1);
  EXPECT_LT(Distance(a((4 - a.o.z) / a.d.z), b((4 - b.o.z) / b.d.z)), 1e-4);
}

TEST(BuildCamera, OtherKinds) {
  const Built parallel = CameraScene(R"(Camera "orthographic" "float screenwindow" [-3 3 -3 3])", 4);
  EXPECT_NEAR(RayOf(*parallel.scene, 0, 0).o.x, -3, 1e-6);
  ExpectDirection(RayOf(*parallel.scene, 0, 0).d, {0, 0, 1});
  const Built v3 = CameraScene(R"(Camera "environment")", 3);
  ExpectDirection(RayOf(*v3.scene, 0.5, 0.5).d, {-1, 0, 0});
  const Built v4 = CameraScene(R"(Camera "spherical" "string mapping" "equirectangular")", 4);
  ExpectDirection(RayOf(*v4.scene, 0.25, 0.5).d, {0, 0, 1});
  const Built equalArea = CameraScene(R"(Camera "spherical")", 4);
  ExpectDirection(RayOf(*equalArea.scene, 0.5, 0.5).d, {0, 1, 0});
  const Built realistic = CameraScene(R"(Camera "realistic" "string lensfile" "x.dat")", 4);
  EXPECT_EQ(realistic.warnings.size(), 1u);
}

TEST(BuildCamera, ErrorsHaveAPlace) {
  const auto message = [](const std::string& statements) { return MessageOf([&] { CameraScene(statements, 4); }); };
  EXPECT_EQ(message(R"(Camera "perspectiv")"),
            "a.pbrt:1:1: error: unknown camera \"perspectiv\", expected one of perspective, orthographic, spherical, "
            "environment; did you mean \"perspective\"?");
  EXPECT_EQ(message(R"(Camera "perspective" "float fov" 180)").substr(0, 17), "a.pbrt:1:1: error");
  EXPECT_EQ(message(R"(Camera "perspective" "float screenwindow" [0 0 1 2])").substr(0, 18), "a.pbrt:1:22: error");
  EXPECT_EQ(message(R"(Camera "perspective" "float screenwindow" [0 1])").substr(0, 18), "a.pbrt:1:22: error");
  EXPECT_EQ(message(R"(Camera "perspective" "string fov" "wide")").substr(0, 18), "a.pbrt:1:22: error");
  EXPECT_EQ(message(R"(Scale 1 0 1
Camera "perspective")")
                .substr(0, 12),
            "a.pbrt:2:1: ");
}

}  // namespace
}  // namespace dapple
