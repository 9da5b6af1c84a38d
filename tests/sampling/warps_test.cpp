#include "src/sampling/warps.h"

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "src/base/numerics.h"
#include "tests/support/chi_square.h"

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

constexpr testing::ChiSquareOptions kOptions{.samples = 50'000, .rows = 16, .columns = 32, .seed = 9};

/// Warps that have no parameters are counted in cells of three shapes: as many along both axes, and few along one.
constexpr testing::ChiSquareOptions kGrids[] = {kOptions,
                                                {.samples = 50'000, .rows = 100, .columns = 5, .seed = 10},
                                                {.samples = 50'000, .rows = 3, .columns = 200, .seed = 11}};

TEST(WarpsChiSquare, Disks) {
  for (const auto& warp : {SampleDiskPolar, SampleDiskConcentric}) {
    for (const testing::ChiSquareOptions& grid : kGrids) {
      const testing::ChiSquare fit = testing::ChiSquareOnDisk(
          warp, [](const Vec2d&) { return kDiskPdf; }, grid);
      EXPECT_TRUE(fit.Passes()) << fit.message;
    }
  }
}

// Of a warp that is given as functions of Vec2d and Vec3d, over the cone in which it may lie.
void ExpectFit(const std::function<Vec3d(const Vec2d&)>& sample, const std::function<double(const Vec3d&)>& pdf,
               double oneMinusCosMax) {
  const auto draw = [&](testing::UniformNumbers& random) { return std::optional(sample(random.Get2D())); };
  // Seen in a frame that leans, and in the warp's own.
  for (const Vec3& axis : {Vec3(0, 0, 1), Normalize(Vec3(1, 2, 3)), Normalize(Vec3(-2, 1, 0))}) {
    const double size = axis.z == 1 ? oneMinusCosMax : 2;
    if (size == 2 && oneMinusCosMax < 0.1) continue;  // too small for the cells of the sphere
    const testing::ChiSquare fit =
        testing::ChiSquareOnCone(draw, pdf, testing::ConeDomain(size, Frame::FromZ(axis)), kOptions);
    EXPECT_TRUE(fit.Passes()) << fit.message << ", 1 - cos " << oneMinusCosMax;
  }
}

TEST(WarpsChiSquare, Sphere) {
  ExpectFit(
      SampleSphere, [](auto&) { return kSpherePdf; }, 2);
}

TEST(WarpsChiSquare, Hemisphere) {
  ExpectFit(
      SampleHemisphere, [](auto& w) { return w.z >= 0 ? kHemispherePdf : 0; }, 1);
}

TEST(WarpsChiSquare, CosineHemisphere) {
  ExpectFit(
      SampleCosineHemisphere, [](auto& w) { return CosineHemispherePdf(w.z); }, 1);
}

TEST(WarpsChiSquare, Cone) {
  for (const double size : {1e-12, 1e-3, 0.5, 1.9}) {
    ExpectFit([&](auto& u) { return SampleCone(u, size); },
              // 1 - cos theta, without cancellation.
              [&](auto& w) {
                const double sin2 = w.x * w.x + w.y * w.y;
                return (w.z > 0 ? sin2 / (1 + w.z) : 1 - w.z) <= size * (1 + 1e-9) ? ConePdf(size) : 0;
              },
              size);
  }
}

// On the unit square: the triangle fills half of it.
void ExpectFitOnSquare(const std::function<Vec2d(const Vec2d&)>& sample, const std::function<double(const Vec2d&)>& pdf,
                       const testing::ChiSquareOptions& grid = {
                           .samples = 50'000, .rows = 20, .columns = 20, .seed = 9}) {
  const testing::ChiSquare fit = testing::ChiSquareOnCube<2>(
      [&](testing::UniformNumbers& random) {
        const Vec2d p = sample(random.Get2D());
        return std::optional(testing::Coordinates<2>{p.x, p.y});
      },
      [&](const testing::Coordinates<2>& x) {
        return pdf({x[0], x[1]});
      },
      {grid.rows, grid.columns}, grid.samples, grid.seed);
  EXPECT_TRUE(fit.Passes()) << fit.message;
}

TEST(WarpsChiSquare, Triangle) {
  for (const testing::ChiSquareOptions& grid : kGrids)
    ExpectFitOnSquare(
        SampleTriangle, [](auto& b) { return b.x + b.y <= 1 ? 2.0 : 0.0; }, grid);
}

TEST(WarpsChiSquare, Linear) {
  for (const auto& [a, b] : {std::pair(1.0, 3.0), {2.0, 2.0}, {0.0, 1.0}, {1.0, 0.0}}) {
    const testing::ChiSquare fit = testing::ChiSquareOnInterval(
        [&](double u) { return SampleLinear(u, a, b); }, [&](double x) { return LinearPdf(x, a, b); }, 0, 1, kOptions);
    EXPECT_TRUE(fit.Passes()) << fit.message;
  }
}

TEST(WarpsChiSquare, Bilinear) {
  const double cases[][4] = {{1, 2, 3, 4}, {0, 0, 1, 1}, {0, 1, 0, 0}, {5, 0, 0, 5}};
  for (const auto& w : cases) {
    ExpectFitOnSquare([&](auto& u) { return SampleBilinear(u, w); }, [&](auto& p) { return BilinearPdf(p, w); });
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
