#include "lights/projection_light.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lights/goniometric_light.h"
#include "src/base/error.h"
#include "src/base/numerics.h"
#include "src/sampling/warps.h"
#include "tests/lights/light_cases.h"
#include "tests/support/chi_square.h"

namespace dapple {
namespace {

Image White(int width, int height) {
  Image image = Image::Rgb(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.SetColor(x, y, Color(1));
  return image;
}

// The solid angle of a pyramid of half-angles whose tangents are a and b: 4 atan(a b / sqrt(1 + a^2 + b^2)).
TEST(ProjectionMap, AWhiteImageHasTheSolidAngleOfItsPyramid) {
  for (const Vec2i& size : {Vec2i(1, 1), Vec2i(4, 3), Vec2i(3, 4), Vec2i(200, 7)}) {
    for (const double fov : {1e-4, 0.01, 1.0, 45.0, 90.0, 150.0, 179.0}) {
      const double shorter = std::tan(Radians(fov) / 2), aspect = static_cast<double>(size.x) / size.y;
      const double a = shorter * std::max(1.0, aspect), b = shorter * std::max(1.0, 1 / aspect);
      const double solidAngle = 4 * std::atan(a * b / std::sqrt(1 + a * a + b * b));
      const ProjectionMap map(White(size.x, size.y), fov, Color(1));
      EXPECT_NEAR(static_cast<double>(map.Integral().g) / solidAngle, 1, 1e-6) << size << " at " << fov;
    }
  }
}

// The integral by a grid of directions over the square of the tangents: dw = dx dy / (1 + x^2 + y^2)^(3/2).
TEST(ProjectionMap, IntegralIsTheQuadratureOfTheLookup) {
  const Image image = RandomEnvironment(5, 4, 1);
  const ProjectionMap map(image, 100, Color(1, 2, 3));
  const double b = std::tan(Radians(50)), a = b * 5 / 4;
  constexpr int kSide = 1200;
  Vec3d sum(0);
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const double x = a * ((2 * i + 1.0) / kSide - 1), y = b * ((2 * j + 1.0) / kSide - 1);
      const Color c = map.Radiance({x, y, 1});
      sum += Vec3d(c.r, c.g, c.b) * std::pow(1 + x * x + y * y, -1.5);
    }
  }
  sum *= 4 * a * b / (kSide * kSide);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(static_cast<double>(map.Integral()[i]) / sum[i], 1, 1e-5) << i;
}

TEST(ProjectionMap, ShowsEachPixelAtItsPlace) {
  const Image image = RandomEnvironment(6, 4, 2);
  const ProjectionMap map(image, 70, Color(1));
  const double b = std::tan(Radians(35)), a = b * 6 / 4;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) {
      // Left at -x, top at +y.
      const Color c = map.Radiance({a * ((2 * x + 1) / 6.0 - 1), -b * ((2 * y + 1) / 4.0 - 1), 1});
      for (int i = 0; i < 3; ++i) ASSERT_NEAR(c[i], image.ColorAt(x, y)[i], 1e-4f);
    }
  }
  EXPECT_TRUE(map.Radiance({a * 1.001, 0, 1}).IsBlack());
  EXPECT_TRUE(map.Radiance({0, -b * 1.001, 1}).IsBlack());
  EXPECT_TRUE(map.Radiance({0, 0, -1}).IsBlack());
  EXPECT_TRUE(map.Radiance({1, 0, 0}).IsBlack());
}

// In the square of the image, where dw = dx dy / (1 + x^2 + y^2)^(3/2) on the plane.
TEST(ProjectionMap, DirectionsFollowTheirDensity) {
  struct Case {
    int width, height;
    double fov;
  };
  const Case cases[] = {{5, 4, 100}, {1, 1, 160}, {2, 3, 30}};
  for (const Case& c : cases) {
    const ProjectionMap map(RandomEnvironment(c.width, c.height, 3), c.fov, Color(1));
    const double shorter = std::tan(Radians(c.fov) / 2), aspect = static_cast<double>(c.width) / c.height;
    const Vec2d extent = Vec2d(std::max(1.0, aspect), std::max(1.0, 1 / aspect)) * shorter;
    const auto sample = [&](testing::UniformNumbers& random) -> std::optional<testing::Coordinates<2>> {
      const double u = random.Get1D(), v = random.Get1D();
      const Vec3d w = map.Sample({u, v});
      return testing::Coordinates<2>{(w.x / w.z / extent.x + 1) / 2, (w.y / w.z / extent.y + 1) / 2};
    };
    const auto density = [&](const testing::Coordinates<2>& p) {
      const double x = extent.x * (2 * p[0] - 1), y = extent.y * (2 * p[1] - 1);
      return map.Evaluate({x, y, 1}).pdf * std::pow(1 + x * x + y * y, -1.5) * 4 * extent.x * extent.y;
    };
    const testing::ChiSquare fit = testing::ChiSquareOnCube<2>(sample, density, {20, 30}, 50000, 9);
    EXPECT_TRUE(fit.Passes()) << c.fov << ": " << fit.message;
    EXPECT_NEAR(testing::Integrate<2>(density, {{0, 0}, {1, 1}}, 1e-5, 20), 1, 1e-5) << c.fov;
  }
}

// What the interpolated density leaves of it, at any field of view and for images of one pixel and of many.
TEST(ProjectionLight, RaysOfAGrayImageCarryTheSameFluxWithinOnePercent) {
  Image ramp(7, 5, {"Y"});
  for (int i = 0; i < 35; ++i) ramp.Values()[static_cast<size_t>(i)] = static_cast<float>(1 + i % 7 + i / 7);
  for (const Image& image : {ramp, White(1, 1)}) {
    for (const double fov : {0.001, 10.0, 90.0, 170.0, 179.0}) {
      const ProjectionLight light(Vec3(1, 2, 3), Transform::Rotate(30, {3, 2, 1}), image, fov, Color(5));
      RandomNumbers random(4);
      for (int i = 0; i < 1000; ++i) {
        const std::optional<LeSample> sample = light.Sample_Le(random.Le());
        ASSERT_TRUE(sample) << fov;
        ASSERT_NEAR(sample->Flux().g / light.Power().g, 1, 0.01) << fov;
      }
    }
  }
}

// A wall at distance h across the axis: E = I cos / r^2 = (I / h^2) cos^3.
TEST(ProjectionLight, AWallIsDarkerTowardTheCornersByTheCubeOfTheCosine) {
  const ProjectionLight light(Vec3(0), Transform(), White(8, 8), 100, Color(3));
  for (const double x : {0.0, 0.5, 1.1}) {
    const Vec3 p(static_cast<float>(2 * x), 0.4f, 2);
    const std::optional<LiSample> sample = light.Sample_Li(LightContext(p), {});
    ASSERT_TRUE(sample);
    const double cosTheta = 1 / std::sqrt(1 + x * x + 0.04);
    EXPECT_NEAR(static_cast<double>(-sample->wi.z) * static_cast<double>(sample->L.g),
                3.0 / 4 * cosTheta * cosTheta * cosTheta, 1e-6);
  }
  EXPECT_FALSE(light.Sample_Li(LightContext(Vec3(2.5f, 0, 2)), {}));
  EXPECT_FALSE(light.Sample_Li(LightContext(Vec3(0, 0, -2)), {}));
  EXPECT_FALSE(light.Sample_Li(LightContext(Vec3(0)), {}));
}

TEST(ProjectionLight, FieldsOfViewThatMakeNoPyramidAreErrors) {
  for (const double fov : {0.0, -10.0, 1e-5, 180.0, 300.0, std::nan("")}) {
    EXPECT_THROW(ProjectionMap(White(1, 1), fov, Color(1)), Error) << fov;
  }
  EXPECT_THROW(ProjectionMap(Image::Rgb(0, 0), 30, Color(1)), Error);
}

TEST(ImagePointLights, BlackImagesEmitNothing) {
  const ProjectionLight projection(Vec3(0), Transform(), Image::Rgb(3, 2), 50, Color(1));
  const GoniometricLight goniometric(Vec3(0), Transform(), Image::Rgb(4, 2), EnvironmentMapping::LatLong, Color(1));
  for (const Light* light : {static_cast<const Light*>(&projection), static_cast<const Light*>(&goniometric)}) {
    EXPECT_TRUE(light->Power().IsBlack());
    EXPECT_FALSE(light->Sample_Le({}));
    EXPECT_FALSE(light->Sample_Li(LightContext(Vec3(0, 0, 1)), {}));
    EXPECT_EQ(light->Pdf_Le(Ray{Vec3(0), Vec3(0, 0, 1)}, {}).direction, 0);
    EXPECT_EQ(light->ImportanceAt(LightContext(Vec3(0, 0, 1))), 0);
  }
}

// A goniometric light of one intensity is a point light; of equal-area images the power is the mean times 4 pi.
TEST(GoniometricLight, PowerIsTheMeanIntensityTimesTheSphere) {
  for (const EnvironmentMapping mapping : {EnvironmentMapping::LatLong, EnvironmentMapping::EqualArea}) {
    const GoniometricLight even(Vec3(0), Transform(), White(6, 6), mapping, Color(1, 2, 3));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(static_cast<double>(even.Power()[i]) / (4 * kPiD * (i + 1)), 1, 1e-6);
  }
  const Image image = RandomEnvironment(8, 8, 5);
  double mean = 0;
  for (int i = 0; i < 64; ++i) mean += static_cast<double>(image.ColorAt(i % 8, i / 8).g) / 64;
  const GoniometricLight light(Vec3(0), Transform(), image, EnvironmentMapping::EqualArea, Color(1));
  EXPECT_NEAR(static_cast<double>(light.Power().g) / (4 * kPiD * mean), 1, 1e-6);
}

}  // namespace
}  // namespace dapple
