#include "src/geometry/spherical_triangle.h"

#include <gtest/gtest.h>

#include "src/base/numerics.h"
#include "tests/geometry/shape_checks.h"

namespace dapple {
namespace {

using Corners = std::array<Vec3d, 3>;

SphericalTriangle Seen(const Corners& corners, const Vec3d& from) {
  return {corners[0], corners[1] - corners[0], corners[2] - corners[0], from};
}

Vec3d At(const Corners& corners, const Vec3d& b) { return corners[0] * b.x + corners[1] * b.y + corners[2] * b.z; }

TEST(SphericalTriangle, AnOctantIsAnEighthOfTheSphere) {
  const Corners octant = {Vec3d(1, 0, 0), Vec3d(0, 2, 0), Vec3d(0, 0, 3)};
  EXPECT_NEAR(Seen(octant, Vec3d(0)).SolidAngle(), kPiD / 2, 1e-15);
}

TEST(SphericalTriangle, FacesOfATetrahedronFillTheSphereFromAnyPointInside) {
  const Vec3d p[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  TestRandom random(1);
  for (int i = 0; i < 100; ++i) {
    Vec3d inside(0);
    double weights = 0;
    for (const Vec3d& corner : p) {
      const double weight = random.Uniform();
      inside += corner * weight;
      weights += weight;
    }
    inside /= weights;
    double sum = 0;
    for (int skip = 0; skip < 4; ++skip)
      sum += Seen({p[skip == 0], p[1 + (skip <= 1)], p[2 + (skip <= 2)]}, inside).SolidAngle();
    EXPECT_NEAR(sum, 4 * kPiD, 1e-12);
  }
}

TEST(SphericalTriangle, FarTrianglesHaveTheSolidAngleOfTheirArea) {
  for (const double distance : {1e3, 1e5, 1e7}) {
    const Corners corners = {Vec3d(0, 0, distance), Vec3d(1, 0, distance), Vec3d(0, 1, distance)};
    const double expected = 0.5 / (distance * distance);
    // To second order in 1 / distance: the centre's distance and the cosine there differ.
    EXPECT_NEAR(Seen(corners, Vec3d(0)).SolidAngle() / expected, 1, 1 / (distance * distance) + 1e-9);
  }
}

TEST(SphericalTriangle, HasNoSolidAngleEdgeOnOrFromItsCorner) {
  const Corners corners = {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)};
  EXPECT_EQ(Seen(corners, Vec3d(3, 3, 0)).SolidAngle(), 0);
  EXPECT_EQ(Seen(corners, Vec3d(0, 0, 0)).SolidAngle(), 0);
  EXPECT_EQ(Seen({Vec3d(0, 0, 1), Vec3d(1, 0, 1), Vec3d(2, 0, 1)}, Vec3d(0)).SolidAngle(), 0);
}

TEST(SphericalTriangle, FillsHalfTheSphereFromJustAbove) {
  const Corners corners = {Vec3d(-1, -1, 0), Vec3d(1, -1, 0), Vec3d(0, 1, 0)};
  EXPECT_NEAR(Seen(corners, Vec3d(0, 0, 1e-6)).SolidAngle(), 2 * kPiD, 2e-5);
}

TEST(SphericalTriangle, InvertUndoesSample) {
  TestRandom random(2);
  for (int i = 0; i < 300; ++i) {
    const double size = std::pow(10, random.Uniform(-4, 1));
    const Vec3d centre = random.Box(-1, 1);
    const Corners corners = {centre + random.Box(-1, 1) * size, centre + random.Box(-1, 1) * size,
                             centre + random.Box(-1, 1) * size};
    const SphericalTriangle seen = Seen(corners, Vec3d(0));
    if (!seen.IsWellConditioned()) continue;
    for (int j = 0; j < 20; ++j) {
      const Vec2d u = random.Square();
      const Vec3d b = seen.Sample(u);
      ASSERT_NEAR(b.x + b.y + b.z, 1, 1e-14);
      ASSERT_GE(std::min({b.x, b.y, b.z}), -1e-14);
      const Vec2d inverse = seen.Invert(b);
      ASSERT_NEAR(inverse.x, u.x, 1e-6) << seen.SolidAngle();
      ASSERT_NEAR(inverse.y, u.y, 1e-6) << seen.SolidAngle();
    }
  }
}

TEST(SphericalTriangle, DirectionsAreUniform) {
  // The share of the square up to u.x is the share of the solid angle on the near side of the edge from b to c': the
  // part triangle's own solid angle, by the closed form. Along the arc, u.y is the share of 1 - cos.
  TestRandom random(3);
  for (int i = 0; i < 300; ++i) {
    const Corners corners = {random.Box(-1, 1), random.Box(-1, 1), random.Box(-1, 1)};
    const SphericalTriangle seen = Seen(corners, Vec3d(0));
    if (!seen.IsWellConditioned()) continue;
    const Vec2d u = random.Square();
    const Vec3d onEdge = At(corners, seen.Sample({u.x, 1}));
    const double part = Seen({corners[0], corners[1], onEdge}, Vec3d(0)).SolidAngle();
    ASSERT_NEAR(part, u.x * seen.SolidAngle(), 1e-9);
    const Vec3d b = Normalize(corners[1]), w = Normalize(At(corners, seen.Sample(u)));
    ASSERT_NEAR(1 - Dot(b, w), u.y * (1 - Dot(b, Normalize(onEdge))), 1e-9);
  }
}

}  // namespace
}  // namespace dapple
