// Gather radii where the density of photons is known: inside a closed sphere of albedo one half that glows evenly.
//
// Each light path leaves a photon after its first scattering with probability 1/2, after its second with 1/4, and so
// on: one in the mean, anywhere on the sphere. So a disk of radius r holds r^2 / 4 of the photons of a pass.
#include "src/photons/gather_radius.h"

#include <cmath>

#include <gtest/gtest.h>

#include "src/base/numerics.h"
#include "src/sampling/warps.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

constexpr const char* kGlowingSphere =
    "LookAt 0 0 0  0 0 -1  0 1 0 Camera \"perspective\" \"float fov\" [40] "
    "Film \"image\" \"integer xresolution\" [40] \"integer yresolution\" [40] WorldBegin "
    "ReverseOrientation Material \"matte\" \"rgb Kd\" [.5 .5 .5] "
    "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Shape \"sphere\" \"float radius\" [1] WorldEnd";

constexpr int64_t kPaths = 100000;

struct Means {
  double radius = 0, photons = 0;
};

/// Over points spread evenly on the sphere.
Means MeansOver(const GatherRadius& radius) {
  constexpr int kSide = 32;
  Means means;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec3d p = SampleSphere({(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide});
    const GatherForecast forecast = radius.At(ToFloat(p));
    means.radius += static_cast<double>(forecast.radius) / (kSide * kSide);
    means.photons += static_cast<double>(forecast.photons) / (kSide * kSide);
  }
  return means;
}

class GatherRadii : public ::testing::Test {
 protected:
  GatherRadius Learn(int64_t paths, const GatherRadius::Options& options = {}) const {
    return {*scene_, EmissionSampler(*scene_), paths, options};
  }

  std::unique_ptr<Scene> scene_ = testing_support::SceneFromText(kGlowingSphere);
};

TEST_F(GatherRadii, HoldTheWantedNumberOfPhotons) {
  const Means means = MeansOver(Learn(kPaths));
  // A density from 16 photons is off by a quarter, and the mean of its inverse root by 3/8 of the square of that; a few
  // places reach the bounds of radii.
  EXPECT_NEAR(means.radius, std::sqrt(4 * GatherRadius::kPhotons / kPaths), 0.05 * means.radius);
  EXPECT_NEAR(means.photons, GatherRadius::kPhotons, 0.05 * GatherRadius::kPhotons);
}

TEST_F(GatherRadii, ScaleAndFixedRadiusChangeWhatIsExpected) {
  const Means half = MeansOver(Learn(kPaths, {.scale = 0.5, .fixed = {}}));
  EXPECT_NEAR(half.radius, std::sqrt(GatherRadius::kPhotons / kPaths), 0.05 * half.radius);
  EXPECT_NEAR(half.photons, GatherRadius::kPhotons / 4, 0.05 * GatherRadius::kPhotons);
  constexpr double kRadius = 0.05;
  const Means fixed = MeansOver(Learn(kPaths, {.fixed = kRadius}));
  EXPECT_FLOAT_EQ(static_cast<float>(fixed.radius), static_cast<float>(kRadius));
  EXPECT_NEAR(fixed.photons, Sqr(kRadius) / 4 * kPaths, 0.1 * fixed.photons);
}

TEST_F(GatherRadii, AreNoWiderThanSoManyPixels) {
  // So few light paths that no radius would do. A pixel covers (2 tan 20 / 40)^2 of solid angle in the middle.
  const Means means = MeansOver(Learn(100));
  const double pixel = 2 * std::tan(Radians(20)) / 40;
  EXPECT_NEAR(means.radius, GatherRadius::kMaxPixels * pixel, 0.01 * means.radius);
  EXPECT_LT(means.photons, GatherRadius::kPhotons);
}

TEST_F(GatherRadii, AreWidestWhereNoPhotonEverLands) {
  const GatherForecast outside = Learn(kPaths).At({0, 0, 50});
  EXPECT_EQ(outside.photons, 0);
  EXPECT_GT(outside.radius, 1);
}

// A mirror throws the light of two spots on a floor of next to no albedo: a dim one everywhere, and a bright one on a
// disk around the origin. In the dim light 24 photons lie within a radius of 0.088; nearer than that to the disk the
// radius would reach into it, and gather what belongs there.
TEST(GatherRadiiBesideACaustic, DoNotReachIt) {
  const std::string spot =
      "LightSource \"spot\" \"point from\" [0 0 0.001] \"point to\" [0 0 1] \"float conedeltaangle\" [0] ";
  const auto scene = testing_support::SceneFromText(
      "LookAt 0 0 0.95  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" [56] "
      "Film \"image\" \"integer xresolution\" [40] \"integer yresolution\" [40] WorldBegin " +
      spot + "\"float coneangle\" [10] \"rgb I\" [1 1 1] " + spot +
      "\"float coneangle\" [40] \"rgb I\" [.02 .02 .02] "
      "Material \"mirror\" Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
      "\"point P\" [-2 -2 1 2 -2 1 2 2 1 -2 2 1] "
      "Material \"matte\" \"rgb Kd\" [.02 .02 .02] Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
      "\"point P\" [-2 -2 0 2 -2 0 2 2 0 -2 2 0] WorldEnd");
  const GatherRadius radius(*scene, EmissionSampler(*scene), 1 << 15, {});
  const auto toRender = scene->RenderToWorld().Inverse();
  const double rim = 2 * std::tan(Radians(10.0));
  /// So far from the disk, all around it.
  const auto meanAt = [&](double distance) {
    constexpr int kPoints = 720;
    Means mean;
    for (int i = 0; i < kPoints; ++i) {
      const double phi = 2 * kPiD * i / kPoints, r = rim + distance;
      const GatherForecast forecast =
          radius.At(toRender.Point(ToFloat(Vec3d(r * std::cos(phi), r * std::sin(phi), 0))));
      mean.radius += static_cast<double>(forecast.radius) / kPoints;
      mean.photons += static_cast<double>(forecast.photons) / kPoints;
    }
    return mean;
  };
  const Means away = meanAt(0.2);
  EXPECT_NEAR(away.radius, 0.088, 0.004);
  EXPECT_NEAR(away.photons, GatherRadius::kPhotons, 0.1 * GatherRadius::kPhotons);
  // Nearer, radii are means over cubes 0.05 wide, of which those at the rim count in the disk's.
  for (const double distance : {0.05, 0.06, 0.07, 0.08}) EXPECT_LT(meanAt(distance).radius, 0.9 * distance) << distance;
}

}  // namespace
}  // namespace dapple
