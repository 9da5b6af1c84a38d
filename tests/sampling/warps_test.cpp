#include "src/sampling/warps.h"

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "src/base/numerics.h"

namespace dapple {
namespace {

constexpr int kPoints = 2000;

std::vector<Vec2d> RandomPoints(unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.001, 0.999);
  std::vector<Vec2d> points;
  for (int i = 0; i < kPoints; ++i) points.emplace_back(uniform(random), uniform(random));
  return points;
}

// The factor by which a map from the square stretches area around u, by central differences.
double Stretch(const std::function<Vec3d(const Vec2d&)>& map, const Vec2d& u) {
  constexpr double h = 1e-5;
  const Vec3d du = (map(u + Vec2d(h, 0)) - map(u - Vec2d(h, 0))) / (2 * h);
  const Vec3d dv = (map(u + Vec2d(0, h)) - map(u - Vec2d(0, h))) / (2 * h);
  return Length(Cross(du, dv));
}

// A map that is one to one (its inverse leads back) and whose density is one over its stretch has that density.
void ExpectWarp(
    const std::function<Vec3d(const Vec2d&)>& sample, const std::function<double(const Vec3d&)>& pdf,
    const std::function<Vec2d(const Vec3d&)>& invert,
    const std::function<bool(const Vec2d&)>& isSmooth = [](const Vec2d&) { return true; }) {
  for (const Vec2d& u : RandomPoints(1)) {
    const Vec3d p = sample(u);
    const Vec2d back = invert(p);
    ASSERT_NEAR(back.x, u.x, 1e-9);
    ASSERT_NEAR(back.y, u.y, 1e-9);
    if (isSmooth(u)) {
      ASSERT_NEAR(Stretch(sample, u) * pdf(p), 1, 1e-5) << u.x << ", " << u.y;
    }
  }
  for (double x : {0.0, 0.5, 1 - 0x1p-53}) {
    for (double y : {0.0, 0.5, 1 - 0x1p-53}) {
      const Vec2d back = invert(sample({x, y}));
      EXPECT_TRUE(back.x >= 0 && back.x <= 1 && back.y >= 0 && back.y <= 1) << x << ", " << y;
    }
  }
}

Vec3d Flat(const Vec2d& p) { return {p.x, p.y, 0}; }
Vec2d Flat(const Vec3d& p) { return {p.x, p.y}; }
// The concentric and the triangle map have a crease along the diagonals.
bool OffDiagonals(const Vec2d& u) { return std::abs(u.x - u.y) > 1e-3 && std::abs(u.x + u.y - 1) > 1e-3; }

TEST(Warps, DiskPolar) {
  ExpectWarp([](auto& u) { return Flat(SampleDiskPolar(u)); }, [](auto&) { return kDiskPdf; },
             [](auto& p) { return InvertDiskPolar(Flat(p)); });
}

TEST(Warps, DiskConcentric) {
  ExpectWarp([](auto& u) { return Flat(SampleDiskConcentric(u)); }, [](auto&) { return kDiskPdf; },
             [](auto& p) { return InvertDiskConcentric(Flat(p)); }, OffDiagonals);
}

TEST(Warps, Hemisphere) {
  ExpectWarp(
      SampleHemisphere, [](auto&) { return kHemispherePdf; }, InvertHemisphere);
}

TEST(Warps, CosineHemisphere) {
  ExpectWarp(
      SampleCosineHemisphere, [](auto& w) { return CosineHemispherePdf(w.z); }, InvertCosineHemisphere,
      [](auto& u) { return OffDiagonals(u) && std::abs(u.x - 0.5) < 0.49 && std::abs(u.y - 0.5) < 0.49; });
}

TEST(Warps, Sphere) {
  ExpectWarp(
      SampleSphere, [](auto&) { return kSpherePdf; }, InvertSphere);
}

TEST(Warps, Cone) {
  for (double oneMinusCos : {1e-3, 0.5, 1.0, 1.7, 2.0}) {
    ExpectWarp([&](auto& u) { return SampleCone(u, oneMinusCos); }, [&](auto&) { return ConePdf(oneMinusCos); },
               [&](auto& w) { return InvertCone(w, oneMinusCos); });
  }
}

TEST(Warps, NarrowConesKeepTheirPrecision) {
  for (double oneMinusCos : {1e-8, 1e-14, 1e-20}) {
    for (const Vec2d& u : RandomPoints(2)) {
      const Vec3d w = SampleCone(u, oneMinusCos);
      const double sin2 = oneMinusCos * u.x * (2 - oneMinusCos * u.x);
      EXPECT_NEAR((w.x * w.x + w.y * w.y) / sin2, 1, 1e-12);
      EXPECT_NEAR(InvertCone(w, oneMinusCos).x, u.x, 1e-9);
    }
  }
}

TEST(Warps, Triangle) {
  ExpectWarp([](auto& u) { return Flat(SampleTriangle(u)); }, [](auto&) { return 2.0; },
             [](auto& p) { return InvertTriangle(Flat(p)); }, OffDiagonals);
  for (const Vec2d& u : RandomPoints(3)) {
    const Vec2d b = SampleTriangle(u);
    EXPECT_TRUE(b.x >= 0 && b.y >= 0 && b.x + b.y <= 1);
  }
}

TEST(Warps, DirectionsAreOfUnitLength) {
  for (const Vec2d& u : RandomPoints(4)) {
    EXPECT_NEAR(Length(SampleSphere(u)), 1, 1e-15);
    EXPECT_NEAR(Length(SampleHemisphere(u)), 1, 1e-15);
    EXPECT_NEAR(Length(SampleCosineHemisphere(u)), 1, 1e-15);
    EXPECT_NEAR(Length(SampleCone(u, 1.9)), 1, 1e-15);
  }
}

TEST(Warps, Linear) {
  for (const auto& [a, b] : {std::pair(1.0, 3.0), {3.0, 1.0}, {2.0, 2.0}, {0.0, 1.0}, {1.0, 0.0}, {1e-30, 1e-30}}) {
    ExpectWarp([a = a, b = b](auto& u) { return Vec3d(SampleLinear(u.x, a, b), u.y, 0); },
               [a = a, b = b](auto& p) { return LinearPdf(p.x, a, b); },
               [a = a, b = b](auto& p) { return Vec2d(InvertLinear(p.x, a, b), p.y); });
  }
  EXPECT_EQ(LinearPdf(-0.1, 1, 2), 0);
  EXPECT_EQ(LinearPdf(1.1, 1, 2), 0);
}

TEST(Warps, Bilinear) {
  const double cases[][4] = {{1, 2, 3, 4}, {0, 0, 1, 1}, {0, 1, 0, 0}, {5, 0, 0, 5}, {1, 1, 1, 1}, {0, 0, 0, 1e-30}};
  for (const auto& w : cases) {
    ExpectWarp([&](auto& u) { return Flat(SampleBilinear(u, w)); }, [&](auto& p) { return BilinearPdf(Flat(p), w); },
               [&](auto& p) { return InvertBilinear(Flat(p), w); },
               // Central differences cannot follow the square roots at a corner of weight zero.
               [](auto& u) { return u.x > 0.02 && u.y > 0.02 && u.x < 0.98 && u.y < 0.98; });
  }
}

TEST(Warps, TurnIsTheAngleAsAShareOfTheCircle) {
  EXPECT_EQ(TurnOf(1, 0), 0);
  EXPECT_EQ(TurnOf(0, 1), 0.25);
  EXPECT_EQ(TurnOf(-1, 0), 0.5);
  EXPECT_EQ(TurnOf(0, -1), 0.75);
  EXPECT_LE(TurnOf(1, -1e-300), 1);
}

}  // namespace
}  // namespace dapple
