#include "lights/environment_map.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lights/environment_light.h"
#include "lights/equal_area_mapping.h"
#include "src/base/error.h"
#include "src/base/numerics.h"
#include "src/sampling/warps.h"
#include "tests/lights/light_cases.h"

namespace dapple {
namespace {

using Mapping = EnvironmentMapping;

Vec3d LatLongDirection(double u, double v) {
  const double theta = kPiD * v, phi = 2 * kPiD * u;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

Image OneBrightTexel(int width, int height, int x, int y) {
  Image image = Image::Rgb(width, height);
  image.SetColor(x, y, Color(1, 2, 3));
  return image;
}

// Small maps that are hard in some way.
std::vector<std::pair<Image, Mapping>> Maps() {
  std::vector<std::pair<Image, Mapping>> maps;
  for (const Vec2i& size : {Vec2i(1, 1), Vec2i(2, 1), Vec2i(1, 2), Vec2i(2, 2), Vec2i(16, 8), Vec2i(7, 5)}) {
    maps.emplace_back(RandomEnvironment(size.x, size.y, 1), Mapping::LatLong);
  }
  for (const int size : {1, 2, 3, 8}) maps.emplace_back(RandomEnvironment(size, size, 2), Mapping::EqualArea);
  for (const Vec2i& texel : {Vec2i(0, 0), Vec2i(7, 0), Vec2i(3, 7), Vec2i(4, 3), Vec2i(0, 4)}) {
    maps.emplace_back(OneBrightTexel(8, 8, texel.x, texel.y), Mapping::LatLong);
    maps.emplace_back(OneBrightTexel(8, 8, texel.x, texel.y), Mapping::EqualArea);
  }
  return maps;
}

TEST(EqualAreaMapping, KeepsAreaAndInverts) {
  RandomNumbers random(1);
  for (int i = 0; i < 10000; ++i) {
    const Vec2d p = random.Get2D();
    const Vec3d w = EqualAreaSquareToSphere(p);
    ASSERT_NEAR(Length(w), 1, 1e-14);
    const Vec2d back = EqualAreaSphereToSquare(w);
    ASSERT_NEAR(back.x, p.x, 1e-12);
    ASSERT_NEAR(back.y, p.y, 1e-12);
    constexpr double h = 1e-6;
    const double a = std::abs(2 * p.x - 1), b = std::abs(2 * p.y - 1);
    if (std::min({a, b, 1 - a, 1 - b, std::abs(1 - a - b)}) < 0.01) continue;  // creases of the map
    const Vec3d du = EqualAreaSquareToSphere(p + Vec2d(h, 0)) - EqualAreaSquareToSphere(p - Vec2d(h, 0));
    const Vec3d dv = EqualAreaSquareToSphere(p + Vec2d(0, h)) - EqualAreaSquareToSphere(p - Vec2d(0, h));
    ASSERT_NEAR(Length(Cross(du, dv)) / (4 * h * h), 4 * kPiD, 1e-4);
  }
}

TEST(EqualAreaMapping, LiesAsInPbrt) {
  const auto expectAt = [](const Vec2d& p, const Vec3d& w) {
    EXPECT_LT(Length(EqualAreaSquareToSphere(p) - w), 1e-12) << p;
  };
  expectAt({0.5, 0.5}, {0, 0, 1});
  expectAt({1, 0.5}, {1, 0, 0});
  expectAt({0.5, 1}, {0, 1, 0});
  expectAt({0.5, 0}, {0, -1, 0});
  for (const Vec2d& corner : {Vec2d(0, 0), Vec2d(1, 0), Vec2d(0, 1), Vec2d(1, 1)}) expectAt(corner, {0, 0, -1});
}

TEST(EnvironmentMap, LookupIsBilinearBetweenTexelCentres) {
  const Image image = RandomEnvironment(8, 4, 3);
  const EnvironmentMap map(image, Mapping::LatLong, Color(2));
  const auto expect = [&](double u, double v, const Color& expected) {
    const Color value = map.Radiance(LatLongDirection(u, v));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(value[i], 2 * expected[i], 1e-4) << u << ", " << v;
  };
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      const double u = (x + 0.5) / 8, v = (y + 0.5) / 4;
      const Color here = image.ColorAt(x, y), right = image.ColorAt((x + 1) % 8, y);
      expect(u, v, here);
      expect(u + 0.5 / 8, v, (here + right) / 2);
      expect(u + 0.25 / 8, v, here * 0.75f + right * 0.25f);
      if (y < 3) expect(u, v + 0.5 / 4, (here + image.ColorAt(x, y + 1)) / 2);
    }
  }
  // The first and last rows reach up to the poles; nothing of the other end leaks in.
  expect(2.5 / 8, 0.01, image.ColorAt(2, 0));
  expect(5.5 / 8, 0.999, image.ColorAt(5, 3));
}

TEST(EnvironmentMap, EqualAreaLookupIsContinuousAcrossEdges) {
  const Image image = RandomEnvironment(6, 6, 4);
  const EnvironmentMap map(image, Mapping::EqualArea, Color(1));
  for (int i = 0; i < 100; ++i) {
    const double s = (i + 0.5) / 100, edge = 1e-7;
    // A point of an edge and its mirror image are the same direction.
    const std::pair<Vec2d, Vec2d> pairs[] = {
        {{edge, s}, {edge, 1 - s}}, {{1 - edge, s}, {1 - edge, 1 - s}}, {{s, edge}, {1 - s, edge}}};
    for (const auto& [a, b] : pairs) {
      const Color first = map.Radiance(EqualAreaSquareToSphere(a)), second = map.Radiance(EqualAreaSquareToSphere(b));
      ASSERT_NEAR(first.g, second.g, 1e-3) << a;
    }
  }
  const Color centre = map.Radiance(EqualAreaSquareToSphere({2.5 / 6, 4.5 / 6}));
  EXPECT_NEAR(centre.g, image.ColorAt(2, 4).g, 1e-4);
}

TEST(EnvironmentMap, DensityIsPositiveExactlyWhereRadianceIs) {
  RandomNumbers random(5);
  for (const auto& [image, mapping] : Maps()) {
    const EnvironmentMap map(image, mapping, Color(1));
    for (int i = 0; i < 20000; ++i) {
      const RadianceWithPdf value = map.Evaluate(SampleSphere(random.Get2D()));
      ASSERT_EQ(value.pdf > 0, !value.L.IsBlack());
      ASSERT_TRUE(std::isfinite(value.pdf));
    }
  }
}

// The lookup of one bright texel is a tent of two texels' width around its centre: v3 shifted it by half a texel.
TEST(EnvironmentMap, OneBrightTexelShinesFromItsPlace) {
  const EnvironmentMap map(OneBrightTexel(32, 16, 9, 6), Mapping::LatLong, Color(1));
  RandomNumbers random(6);
  for (int i = 0; i < 20000; ++i) {
    const Vec3d w = map.Sample(random.Get2D());
    const double x = TurnOf(w.x, w.y) * 32, y = std::acos(w.z) / kPiD * 16;
    ASSERT_LT(std::abs(x - 9.5), 1 + 1e-9);
    ASSERT_LT(std::abs(y - 6.5), 1 + 1e-9);
  }
}

TEST(EnvironmentMap, RadianceOverDensityHardlyVaries) {
  Image gray = RandomEnvironment(32, 16, 7);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) gray.SetColor(x, y, Color(gray.ColorAt(x, y).g));
  }
  for (const Mapping mapping : {Mapping::LatLong, Mapping::EqualArea}) {
    if (mapping == Mapping::EqualArea) gray = RandomEnvironment(1, 1, 1);
    const EnvironmentMap map(gray, mapping, Color(1));
    RandomNumbers random(8);
    for (int i = 0; i < 20000; ++i) {
      const RadianceWithPdf value = map.Evaluate(map.Sample(random.Get2D()));
      const double ratio = static_cast<double>(value.L.g) / value.pdf / static_cast<double>(map.Integral().g);
      // Exactly one, but for the sine within a cell, which is noticeable next to the poles only.
      ASSERT_TRUE(ratio > 0.45 && ratio < 2.2) << ratio;
    }
  }
}

TEST(EnvironmentMap, DrawDensityAndInverseAgree) {
  for (const auto& [image, mapping] : Maps()) {
    const EnvironmentMap map(image, mapping, Color(1));
    RandomNumbers random(9);
    for (int i = 0; i < 3000; ++i) {
      const Vec2d u = random.Get2D();
      const Vec3d w = map.Sample(u);
      ASSERT_NEAR(Length(w), 1, 1e-12);
      const Vec2d back = map.Invert(w);
      ASSERT_NEAR(back.x, u.x, 1e-6);
      ASSERT_NEAR(back.y, u.y, 1e-6);
      // The density is one over the factor by which the map from random numbers stretches area, where that is smooth.
      const auto stretch = [&](double h) {
        const Vec3d du = map.Sample(u + Vec2d(h, 0)) - map.Sample(u - Vec2d(h, 0));
        const Vec3d dv = map.Sample(u + Vec2d(0, h)) - map.Sample(u - Vec2d(0, h));
        return Length(Cross(du, dv)) / (4 * h * h);
      };
      const double h = 1e-5, margin = 2 * h;
      if (std::min(u.x, u.y) < margin || std::max(u.x, u.y) > 1 - margin) continue;
      const double fine = stretch(h), coarse = stretch(2 * h);
      if (std::abs(fine - coarse) < 1e-4 * fine) {
        ASSERT_NEAR(fine * map.Evaluate(w).pdf, 1, 2e-3) << u;
      }
    }
  }
}

TEST(EnvironmentMap, IntegralsAreThoseOfTheLookup) {
  for (const auto& [image, mapping] : Maps()) {
    const EnvironmentMap map(image, mapping, Color(1, 0.5f, 2));
    // The midpoint rule over the map's own parameters: the texels of all maps divide the grid.
    const bool isLatLong = mapping == Mapping::LatLong;
    const int rows = isLatLong ? 700 : 240, columns = isLatLong ? 224 : 240;
    double radiance = 0, density = 0;
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        const double u = (x + 0.5) / columns, v = (y + 0.5) / rows;
        const RadianceWithPdf value = map.Evaluate(isLatLong ? SampleSphere({v, u}) : EqualAreaSquareToSphere({u, v}));
        radiance += static_cast<double>(value.L.b) * (4 * kPiD / (rows * columns));
        density += value.pdf * (4 * kPiD / (rows * columns));
      }
    }
    EXPECT_NEAR(radiance / static_cast<double>(map.Integral().b), 1, 2e-3);
    EXPECT_NEAR(density, 1, 2e-3);
  }
}

TEST(EnvironmentMap, SurvivesThePoles) {
  const EnvironmentMap map(OneBrightTexel(8, 4, 0, 0), Mapping::LatLong, Color(1));
  for (const Vec3d& pole : {Vec3d(0, 0, 1), Vec3d(0, 0, -1), Vec3d(1e-30, 0, 1), Vec3d(0, -1e-12, -1)}) {
    const RadianceWithPdf value = map.Evaluate(pole);
    EXPECT_TRUE(value.L.IsFinite() && std::isfinite(value.pdf));
    const Vec2d u = map.Invert(pole);
    EXPECT_TRUE(std::isfinite(u.x) && std::isfinite(u.y));
  }
  EXPECT_GT(map.Evaluate({1e-9, 1e-9, 1}).pdf, 0);
  EXPECT_EQ(map.Evaluate({1e-9, 1e-9, -1}).pdf, 0);
  for (const double u : {0.0, 0.5, 1 - 0x1p-53}) EXPECT_GE(map.Evaluate(map.Sample({u, 0})).pdf, 0);
}

TEST(EnvironmentMap, BlackMapsEmitNothing) {
  EnvironmentLight light(Image::Rgb(4, 2), Transform(), Color(1), Mapping::LatLong);
  light.Prepare(kTestExtent);
  EXPECT_TRUE(light.Power().IsBlack());
  EXPECT_FALSE(light.Sample_Le({}));
  EXPECT_FALSE(light.Sample_Li(LightContext(Vec3(0)), {}));
  EXPECT_EQ(light.Pdf_Li(LightContext(Vec3(0)), Vec3(0, 0, 1), nullptr), 0);
}

TEST(EnvironmentMap, RepairsWhatIsNoRadiance) {
  Image image = Image::Rgb(2, 2);
  image.SetColor(0, 0, Color(1, std::nanf(""), -3));
  image.SetColor(1, 0, Color(kInfinity, 7, -kInfinity));
  image.SetColor(0, 1, Color(1, 2, 3));
  int64_t repaired = 0;
  const Image result = EnvironmentMap::Repair(image, &repaired);
  EXPECT_EQ(repaired, 2);
  EXPECT_EQ(result.ColorAt(0, 0), Color(1, 0, 0));
  EXPECT_EQ(result.ColorAt(1, 0), Color(7, 7, 0));
  EXPECT_EQ(result.ColorAt(0, 1), Color(1, 2, 3));
}

TEST(EnvironmentMap, HugeRadiancesStayFinite) {
  const EnvironmentMap map(OneBrightTexel(4, 4, 1, 1), Mapping::EqualArea, Color(3e38f));
  EXPECT_TRUE(map.Integral().IsFinite());
  EXPECT_TRUE(map.Radiance(EqualAreaSquareToSphere({1.5 / 4, 1.5 / 4})).IsFinite());
  EXPECT_GT(map.Evaluate(map.Sample({0.5, 0.5})).pdf, 0);
}

TEST(EnvironmentMap, RefusesImagesOfTheWrongShape) {
  EXPECT_THROW(EnvironmentMap(Image::Rgb(4, 2), Mapping::EqualArea, Color(1)), Error);
  EXPECT_THROW(EnvironmentMap(Image(), Mapping::LatLong, Color(1)), Error);
}

TEST(EnvironmentLight, TurnsWithItsTransformAndIgnoresItsScale) {
  const Image image = RandomEnvironment(8, 4, 3);
  const Transform turn = Transform::Rotate(30, {1, 2, 3});
  const EnvironmentLight still(image, Transform(), Color(1), Mapping::LatLong);
  const EnvironmentLight turned(image, Transform::Translate({5, 6, 7}) * turn * Transform::Scale(Vec3d(100)), Color(1),
                                Mapping::LatLong);
  RandomNumbers random(10);
  for (int i = 0; i < 100; ++i) {
    const Vec3d w = SampleSphere(random.Get2D());
    const Color expected = still.Le(Ray{Vec3(0), ToFloat(w)});
    const Color actual = turned.Le(Ray{Vec3(0), ToFloat(turn.Vector(w))});
    ASSERT_NEAR(actual.g, expected.g, 1e-4 * (1 + expected.g));
  }
  // What is not a rotation at all leaves a light of the same power.
  EnvironmentLight sheared(image, turn * Transform::Scale({1, 3, -0.1}), Color(1), Mapping::LatLong);
  sheared.Prepare({Vec3(0), 1});
  EXPECT_NEAR(sheared.Power().g / (still.Map().Integral().g * kPi), 1, 1e-5);
  EXPECT_THROW(EnvironmentLight(image, Transform::Scale({1, 1, 0}), Color(1), Mapping::LatLong), Error);
}

}  // namespace
}  // namespace dapple
