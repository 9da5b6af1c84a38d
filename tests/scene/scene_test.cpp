// Facts of scenes made by hand: lights that are kept, what shadows and interfaces do, what the scene knows of itself.
#include "src/scene/scene.h"

#include <limits>

#include <gtest/gtest.h>

#include "lights/area_light.h"
#include "lights/distant_light.h"
#include "lights/environment_light.h"
#include "lights/point_light.h"
#include "src/geometry/disk.h"
#include "src/geometry/sphere.h"
#include "src/materials/conductor_materials.h"
#include "src/materials/diffuse_materials.h"
#include "src/materials/procedural_textures.h"
#include "src/scene/alpha_filter.h"
#include "src/scene/perspective_camera.h"

namespace dapple {
namespace {

/// Parts of a scene, put together one after the other.
struct Builder {
  SceneParts parts;

  Builder() {
    parts.camera = std::make_unique<PerspectiveCamera>(Transform::CameraToWorldLookAt({0, -5, 0}, Vec3d(0), {0, 0, 1}),
                                                       Vec2i(8, 8), ScreenWindow(), 40);
  }

  int Matte(float reflectance) {
    parts.materials.push_back(std::make_unique<MatteMaterial>(MakeConstant(Color(reflectance))));
    return static_cast<int>(parts.materials.size()) - 1;
  }
  int Mirror() {
    parts.materials.push_back(std::make_unique<MirrorMaterial>(MakeConstant(Color(1))));
    return static_cast<int>(parts.materials.size()) - 1;
  }
  void Ball(const Vec3d& center, double radius, int material, float radiance = -1) {
    ScenePrimitive primitive;
    primitive.shape = std::make_unique<Sphere>(Transform::Translate(center), false, radius);
    primitive.material = material;
    if (radiance >= 0) {
      primitive.light = static_cast<int>(parts.lights.size());
      parts.lights.push_back(std::make_unique<AreaLight>(primitive.shape.get(), Color(radiance), false));
    }
    parts.primitives.push_back(std::move(primitive));
  }
  Scene Make() { return Scene(std::move(parts)); }
};

std::optional<SurfaceInteraction> HitAlongX(const Scene& scene, float y) {
  return scene.Intersect({Vec3(-100, y, 0), Vec3(1, 0, 0), kInfinity, {}});
}

// A reader refuses such numbers where they stand; a program may make them.
TEST(Scene, ALightWhosePowerIsNoNumberIsAnErrorAtItsPlace) {
  Builder b;
  b.parts.lights.push_back(std::make_unique<PointLight>(Vec3(0), Color(1)));
  b.parts.lights.push_back(std::make_unique<PointLight>(Vec3(0), Color(1, std::numeric_limits<float>::quiet_NaN(), 1)));
  const auto file = std::make_shared<const std::string>("a.pbrt");
  b.parts.lightLocations = {{file, 1, 1}, {file, 7, 3}};
  try {
    b.Make();
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("a.pbrt:7:3: error: light \"point\" has the power ("))
        << error.what();
  }
}

TEST(Scene, BlackLightsCostNothingAndTheOthersKeepTheirShapes) {
  Builder b;
  const int matte = b.Matte(0.5f);
  b.parts.lights.push_back(std::make_unique<PointLight>(Vec3(0), Color(0)));
  b.Ball({0, 0, 0}, 1, matte, 0);
  b.Ball({0, 5, 0}, 1, matte, 3);
  const Scene scene = b.Make();
  ASSERT_EQ(scene.Lights().size(), 1u);
  EXPECT_EQ(scene.Facts().lights, 1);
  EXPECT_EQ(scene.Facts().blackLights, 2);
  EXPECT_EQ(scene.AreaLightAt(*HitAlongX(scene, 0)), -1);
  const SurfaceInteraction hit = *HitAlongX(scene, 5);
  ASSERT_EQ(scene.AreaLightAt(hit), 0);
  EXPECT_EQ(scene.Lights()[0]->L(hit, hit.ng), Color(3));
  EXPECT_EQ(scene.Picker().PickByPower(0.7).index, 0);
}

TEST(Scene, ExtentHoldsAllThatCanBeHit) {
  Builder b;
  const int matte = b.Matte(0.5f);
  b.Ball({10, 0, 0}, 1, matte);
  b.Ball({-4, 3, 2}, 0.5, matte);
  const Scene scene = b.Make();
  const SceneExtent& extent = scene.Extent();
  EXPECT_GE(extent.radius + 1e-5f, Distance(extent.center, Vec3(10, 0, 0)) + 1);
  EXPECT_GE(extent.radius + 1e-5f, Distance(extent.center, Vec3(-4, 3, 2)) + 0.5f);
  EXPECT_LT(extent.radius, 10);
}

TEST(Scene, DistantLightsShineFromADiskAroundShapesAndInstances) {
  Builder b;
  const int matte = b.Matte(0.5f);
  b.Ball({0, 0, 0}, 1, matte);
  b.Ball({0, 0, 0}, 1, matte);
  b.parts.groups = {{{1}}};
  b.parts.instances = {{0, Transform::Translate({10, 0, 3})}};
  b.parts.lights.push_back(std::make_unique<DistantLight>(Vec3(0, 0, -1), Color(2)));
  const Scene scene = b.Make();
  EXPECT_NEAR(scene.Lights()[0]->Power().g / (2 * kPi * 36), 1, 2e-5);
  EXPECT_EQ(scene.Extent().outline, nullptr);
}

TEST(Scene, AnEmptySceneIsAScene) {
  Builder b;
  b.parts.lights.push_back(std::make_unique<UniformEnvironmentLight>(Color(1)));
  const Scene scene = b.Make();
  EXPECT_FALSE(HitAlongX(scene, 0));
  EXPECT_GT(scene.Extent().radius, 0);
  EXPECT_EQ(scene.InfiniteLights().size(), 1u);
  EXPECT_GT(scene.Lights()[0]->Power().r, 0);
}

TEST(Scene, LightPassesInterfacesUnchanged) {
  Builder b;
  b.Matte(0.5f);
  b.Ball({0, 0, 0}, 1, -1, 2);
  const Scene scene = b.Make();
  const SurfaceInteraction hit = *HitAlongX(scene, 0);
  EXPECT_EQ(scene.MaterialAt(hit), nullptr);
  EXPECT_EQ(scene.AreaLightAt(hit), 0);
  EXPECT_TRUE(scene.Unoccluded({Vec3(-100, 0, 0), Vec3(1, 0, 0), kInfinity, {}}));
}

TEST(Scene, ShadowRaysReachTheirLightAndNoFarther) {
  Builder b;
  const int matte = b.Matte(0.5f);
  b.Ball({0, 0, 0}, 1, matte);
  b.Ball({10, 0, 0}, 1, matte, 1);
  b.Ball({5, 4, 0}, 0.5, matte);
  const Scene scene = b.Make();
  // Straight at the light, and past its edge at a grazing angle: the light itself is never in the way.
  const SurfaceInteraction near = *scene.Intersect({Vec3(5, 0, 0), Vec3(-1, 0, 0), kInfinity, {}});
  int count = 0;
  for (int i = 0; i < 256; ++i) {
    const LiRandom u{0.5, {(i % 16 + 0.5) / 16, (i / 16 + 0.5) / 16}};
    const std::optional<LiSample> sample = scene.Lights()[0]->Sample_Li(LightContext(near.p), u);
    if (!sample) continue;
    ++count;
    EXPECT_TRUE(scene.Unoccluded(scene.ShadowRay(near, *sample)));
  }
  EXPECT_EQ(count, 256);
  // From the far side the ball is in its own way.
  const SurfaceInteraction far = *HitAlongX(scene, 0);
  const std::optional<LiSample> sample = scene.Lights()[0]->Sample_Li(LightContext(far.p), {0.5, {0.5, 0.5}});
  ASSERT_TRUE(sample);
  EXPECT_FALSE(scene.Unoccluded(scene.ShadowRay(far, *sample)));
}

TEST(SceneFacts, SurfacesCountOnlyWhereTheyAreUsed) {
  Builder b;
  const int matte = b.Matte(0.5f);
  b.Mirror();
  b.Ball({0, 0, 0}, 1, matte, 1);
  const Scene without = b.Make();
  EXPECT_FALSE(without.Facts().hasSpecular);
  EXPECT_TRUE(without.Facts().hasNonSpecular);
  EXPECT_FALSE(without.Facts().MayHaveCaustics());

  Builder c;
  const int diffuse = c.Matte(0.5f), mirror = c.Mirror();
  c.Ball({0, 0, 0}, 1, diffuse, 1);
  c.Ball({3, 0, 0}, 1, mirror);
  const Scene with = c.Make();
  EXPECT_TRUE(with.Facts().hasSpecular);
  EXPECT_TRUE(with.Facts().MayHaveCaustics());
  EXPECT_EQ(with.Facts().shapes, 2);
  EXPECT_EQ(with.Facts().primitives, 2);
}

TEST(SceneFacts, KindsOfLight) {
  Builder b;
  b.Ball({0, 0, 0}, 1, b.Matte(0.5f), 1);
  const Scene area = b.Make();
  EXPECT_TRUE(area.Facts().hasAreaLight);
  EXPECT_FALSE(area.Facts().hasDeltaLight || area.Facts().hasInfiniteLight);

  Builder c;
  c.Ball({0, 0, 0}, 1, c.Matte(0.5f));
  c.parts.lights.push_back(std::make_unique<DistantLight>(Vec3(0, 0, -1), Color(1)));
  c.parts.lights.push_back(std::make_unique<UniformEnvironmentLight>(Color(1)));
  const Scene sky = c.Make();
  EXPECT_TRUE(sky.Facts().hasDeltaLight && sky.Facts().hasInfiniteLight);
  EXPECT_FALSE(sky.Facts().hasAreaLight);
  EXPECT_EQ(sky.Facts().lights, 2);
}

TEST(SceneFacts, ShareOfASphereIsItsSolidAngle) {
  const Sphere shape(Transform::Translate({10, 0, 0}), false, 2);
  const AreaLight light(&shape, Color(5), false);
  const double exact = (1 - std::sqrt(1 - Sqr(2. / 10))) / 2;  // of the whole sphere of directions
  EXPECT_NEAR(LightShare(light, Vec3(0)) / exact, 1, 0.01);
}

TEST(SceneFacts, ShareOfAnEnvironmentIsHowEvenlyItShines) {
  UniformEnvironmentLight even(Color(2));
  even.Prepare({Vec3(0), 1});
  EXPECT_NEAR(LightShare(even, Vec3(0)), 1, 1e-6);

  Image image = Image::Rgb(64, 32);
  for (int c = 0; c < 3; ++c) image.At(20, 10, c) = 1000;
  EnvironmentLight sun(image, Transform(), Color(1), EnvironmentMapping::LatLong);
  sun.Prepare({Vec3(0), 1});
  EXPECT_LT(LightShare(sun, Vec3(0)), 0.005);
  EXPECT_GT(LightShare(sun, Vec3(0)), 1e-5);
}

TEST(SceneFacts, ALightThatFacesAwayHasNoShare) {
  const Disk disk(Transform::Translate({0, 0, 3}), false, 0, 1, 0, 360);
  EXPECT_EQ(LightShare(AreaLight(&disk, Color(1), false), Vec3(0)), 0);
  EXPECT_GT(LightShare(AreaLight(&disk, Color(1), true), Vec3(0)), 0);
}

TEST(SceneFacts, DimLightsDoNotCountAsTheSmallest) {
  Builder b;
  const int matte = b.Matte(0.5f);
  b.Ball({0, 0, 0}, 3, matte);
  b.Ball({20, 0, 0}, 5, matte, 1);
  b.Ball({-20, 0, 0}, 0.01, matte, 10);  // a hundred-thousandth of the other's power
  const Scene scene = b.Make();
  EXPECT_EQ(scene.Facts().lights, 2);
  EXPECT_EQ(scene.Facts().smallestLightShare, scene.Facts().largestLightShare);
}

TEST(AlphaFilter, CutsHolesWithTheTexturesProbability) {
  const Sphere shape(Transform(), false, 1);
  const AlphaFilter half(MakeConstant(0.3f)), v3(std::make_shared<BinaryAlpha>(MakeConstant(0.3f)));
  const AlphaFilter none(std::make_shared<BinaryAlpha>(MakeConstant(0.f)));
  constexpr int kCount = 20'000;
  int accepted = 0;
  for (int i = 0; i < kCount; ++i) {
    const Ray ray{Vec3(-3, static_cast<float>(i) * 1e-5f, 0), Vec3(1, 0, 0), kInfinity, {}};
    const std::optional<PrimitiveHit> hit = shape.Intersect(ray, 0);
    ASSERT_TRUE(hit);
    accepted += half.Accepts(shape, *hit, ray) ? 1 : 0;
    EXPECT_EQ(half.Accepts(shape, *hit, ray), half.Accepts(shape, *hit, ray));
    EXPECT_TRUE(v3.Accepts(shape, *hit, ray)) << "pbrt-v3 has a hole only at 0";
    EXPECT_FALSE(none.Accepts(shape, *hit, ray));
  }
  // Binomial, five standard deviations: two-sided significance 6e-7.
  EXPECT_NEAR(accepted, 0.3 * kCount, 5 * std::sqrt(kCount * 0.3 * 0.7));
}

TEST(AlphaFilter, LightIsAsBrightSeenAsSampled) {
  for (const bool isV3 : {false, true}) {
    FloatTexturePtr alpha = MakeConstant(0.3f);
    if (isV3) alpha = std::make_shared<BinaryAlpha>(alpha);
    Builder b;
    b.Ball({0, 0, 3}, 1, b.Matte(0.5f), 2);
    b.parts.primitives[0].alpha = std::make_shared<AlphaFilter>(alpha);
    b.parts.lights[0] =
        std::make_unique<AreaLight>(b.parts.primitives[0].shape.get(), MakeConstant(Color(2)), false, alpha);
    const Scene scene = b.Make();
    const Light& light = *scene.Lights()[0];
    double seen = 0, sampled = 0;
    constexpr int kSide = 128, kCount = kSide * kSide;
    for (int i = 0; i < kCount; ++i) {
      const LiRandom u{0.5, {(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide}};
      const std::optional<LiSample> sample = light.Sample_Li(LightContext(Vec3(0)), u);
      ASSERT_TRUE(sample);
      sampled += static_cast<double>(sample->L.g);
      const Ray ray{Vec3(0), sample->wi, kInfinity, {}};
      if (const auto hit = scene.Intersect(ray)) seen += static_cast<double>(light.L(*hit, -ray.d).g);
    }
    // Binomial, five standard deviations.
    EXPECT_NEAR(seen / sampled, 1, 5 * std::sqrt(0.7 / 0.3 / kCount));
    EXPECT_NEAR(sampled / kCount, isV3 ? 2 : 0.6, 1e-4);
  }
}

}  // namespace
}  // namespace dapple
