#include "lights/spot_light.h"

#include <cmath>

#include <gtest/gtest.h>

#include "src/base/numerics.h"

namespace dapple {
namespace {

struct Cone {
  double total, start;
};

const Cone kCones[] = {{180, 180}, {180, 0},  {180, 90}, {120, 80}, {90, 90},      {45, 40},
                       {30, 0},    {30, -25}, {10, 30},  {1, 0.5},  {0.01, 0.009}, {1e-4, 0}};

// pbrt's own words: the falloff as a function of the cosine.
double FalloffOfCosine(double cosTheta, const Cone& cone, SpotFalloff falloff) {
  const double cosTotal = std::cos(Radians(cone.total)), cosStart = std::cos(Radians(cone.start));
  if (cosTheta <= cosTotal) return 0;
  if (cosTheta >= cosStart) return 1;
  const double t = (cosTheta - cosTotal) / (cosStart - cosTotal);
  return falloff == SpotFalloff::PbrtV3 ? t * t * t * t : t * t * (3 - 2 * t);
}

template <typename F>
void ForEachProfile(F f) {
  for (const SpotFalloff falloff : {SpotFalloff::PbrtV3, SpotFalloff::PbrtV4}) {
    for (const Cone& cone : kCones) {
      SCOPED_TRACE(std::to_string(cone.total) + " " + std::to_string(cone.start));
      f(SpotProfile(cone.total, cone.start, falloff), cone, falloff);
    }
  }
}

TEST(SpotProfile, IsPbrtsFalloff) {
  ForEachProfile([](const SpotProfile& profile, const Cone& cone, SpotFalloff falloff) {
    if (cone.total < 1) return;  // there the cosine itself has no precision left
    for (int i = 0; i < 1000; ++i) {
      const double theta = kPiD * (i + 0.5) / 1000, x = 2 * Sqr(std::sin(theta / 2));
      ASSERT_NEAR(profile.Evaluate(x), FalloffOfCosine(std::cos(theta), cone, falloff), 1e-9) << theta;
    }
  });
}

TEST(SpotProfile, IntegralIsTheQuadrature) {
  ForEachProfile([](const SpotProfile& profile, const Cone& cone, SpotFalloff) {
    const double widest = 2 * Sqr(std::sin(Radians(cone.total) / 2));
    constexpr int kSteps = 100000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += profile.Evaluate(widest * (i + 0.5) / kSteps);
    EXPECT_NEAR(profile.Integral() / (sum * widest / kSteps), 1, 1e-5);
  });
}

TEST(SpotProfile, IsSampledInExactProportion) {
  ForEachProfile([](const SpotProfile& profile, const Cone&, SpotFalloff) {
    for (int i = 1; i < 1000; ++i) {
      const double u = i / 1000.0, h = 1e-6;
      const double x = profile.Sample(u);
      ASSERT_NEAR(profile.Invert(x), u, 1e-10);
      // The density of x is one over the slope of the map from u.
      const double below = profile.Sample(u - h), above = profile.Sample(u + h);
      const double share = profile.Evaluate(x);
      const bool isSmooth = std::abs(profile.Evaluate(above) - profile.Evaluate(below)) < 1e-3 * share;
      if (isSmooth) {
        ASSERT_NEAR((above - below) / (2 * h) * share / profile.Integral(), 1, 1e-3) << u;
      }
    }
    EXPECT_EQ(profile.Sample(0), 0);
    EXPECT_GT(profile.Evaluate(profile.Sample(1 - 0x1p-40)), 0);
  });
}

TEST(SpotProfile, ConesWithoutWidthEmitNothing) {
  for (const double total : {0.0, -10.0, 1e-5, std::nan("")}) {
    const SpotProfile profile(total, 0, SpotFalloff::PbrtV4);
    EXPECT_EQ(profile.Integral(), 0);
    EXPECT_EQ(profile.Evaluate(0), 0);
  }
  SpotLight light(Vec3(0), Vec3(0, 0, 1), Color(1), 0, 0, SpotFalloff::PbrtV3);
  EXPECT_TRUE(light.Power().IsBlack());
  EXPECT_FALSE(light.Sample_Le({}));
  EXPECT_FALSE(light.Sample_Li(LightContext(Vec3(0, 0, 1)), {}));
}

TEST(SpotLight, PowerIsTheClosedForm) {
  const double cosStart = std::cos(Radians(20)), cosTotal = std::cos(Radians(50));
  const double inner = 2 * kPiD * (1 - cosStart), rim = 2 * kPiD * (cosStart - cosTotal);
  const SpotLight v3(Vec3(0), Vec3(0, 0, 3), Color(1, 2, 4), 50, 20, SpotFalloff::PbrtV3);
  EXPECT_NEAR(v3.Power().g, 2 * (inner + rim / 5), 1e-5);
  const SpotLight v4(Vec3(0), Vec3(0, 0, 3), Color(1, 2, 4), 50, 20, SpotFalloff::PbrtV4);
  EXPECT_NEAR(v4.Power().b, 4 * (inner + rim / 2), 1e-5);
  const SpotLight all(Vec3(0), Vec3(0, 0, 3), Color(1), 180, 180, SpotFalloff::PbrtV4);
  EXPECT_NEAR(all.Power().r, 4 * kPiD, 1e-5);
}

TEST(SpotLight, EveryRayCarriesTheSameFlux) {
  for (const SpotFalloff falloff : {SpotFalloff::PbrtV3, SpotFalloff::PbrtV4}) {
    for (const Cone& cone : kCones) {
      const SpotLight light(Vec3(1, 2, 3), Vec3(0.3f, -0.5f, 0.2f), Color(5), cone.total, cone.start, falloff);
      for (int i = 0; i < 1000; ++i) {
        LeRandom u;
        u.direction = Vec2d(std::fmod(i * 0.7548776662466927, 1), std::fmod(i * 0.5698402909980532, 1));
        const std::optional<LeSample> sample = light.Sample_Le(u);
        ASSERT_TRUE(sample) << cone.total;
        ASSERT_NEAR(sample->Flux().r / light.Power().r, 1, 1e-5) << cone.total;
      }
    }
  }
}

TEST(SpotLight, IlluminatesByIntensityOverSquaredDistance) {
  const SpotLight light(Vec3(0, 0, 0), Vec3(0, 0, 1), Color(8), 60, 30, SpotFalloff::PbrtV3);
  EXPECT_NEAR(light.Sample_Li(LightContext(Vec3(0, 0, 2)), {})->L.r, 2, 1e-6);
  EXPECT_FALSE(light.Sample_Li(LightContext(Vec3(0, 0, -2)), {}));
  EXPECT_FALSE(light.Sample_Li(LightContext(Vec3(0, 0, 0)), {}));
  const double t = (std::cos(Radians(45)) - 0.5) / (std::cos(Radians(30)) - 0.5);
  EXPECT_NEAR(light.Sample_Li(LightContext(Vec3(1, 0, 1)), {})->L.r, 8 * t * t * t * t / 2, 1e-5);
}

}  // namespace
}  // namespace dapple
