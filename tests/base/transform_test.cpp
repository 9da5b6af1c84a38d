#include "src/base/transform.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "src/base/hash.h"
#include "src/base/numerics.h"

namespace dapple {
namespace {

double Uniform(uint64_t i, uint64_t dimension) { return static_cast<double>(Hash(i, dimension) >> 11) * 0x1p-53; }
Vec3d Point(uint64_t i) { return {4 * Uniform(i, 0) - 2, 4 * Uniform(i, 1) - 2, 4 * Uniform(i, 2) - 2}; }

void ExpectNear(const Vec3d& a, const Vec3d& b, double tolerance) {
  EXPECT_LE(MaxAbsComponent(a - b), tolerance) << a << " and " << b;
}

std::vector<Transform> SomeTransforms() {
  const double shear[16] = {1, 0.3, 0, 2, 0, 1, -0.7, 0, 0.1, 0, 2, -5, 0, 0, 0, 1};
  return {Transform(),
          Transform::Translate({1, -2, 3}),
          Transform::Scale({2, -0.5, 3}),
          Transform::Rotate(37, {1, 2, -0.5}),
          Transform::CameraToWorldLookAt({1, 2, 3}, {-4, 0, 2}, {0, 1, 0.2}),
          Transform::FromRows(shear)};
}

TEST(Transform, RowsActOnColumnVectors) {
  const double rows[16] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13, 0, 0, 0, 1};
  const Transform t = Transform::FromRows(rows);
  EXPECT_EQ(t.Point({1, 10, 100}), Vec3d(1 + 20 + 300 + 4, 5 + 60 + 700 + 8, 9 + 100 + 1100 + 13));
  EXPECT_EQ(t.Vector({1, 10, 100}), Vec3d(321, 765, 1209));
  EXPECT_EQ(t.At(0, 3), 4);
  EXPECT_EQ(t.At(2, 0), 9);
}

TEST(Transform, ProductAppliesTheRightOneFirst) {
  const Transform product = Transform::Translate({1, 0, 0}) * Transform::Scale({2, 2, 2});
  EXPECT_EQ(product.Point({1, 1, 1}), Vec3d(3, 2, 2));
  for (const Transform& a : SomeTransforms())
    for (const Transform& b : SomeTransforms())
      for (uint64_t i = 0; i < 4; ++i) {
        ExpectNear((a * b).Point(Point(i)), a.Point(b.Point(Point(i))), 1e-13 * 100);
        ExpectNear((a * b).Inverse().Point((a * b).Point(Point(i))), Point(i), 1e-12);
      }
}

TEST(Transform, InverseUndoes) {
  for (const Transform& t : SomeTransforms()) {
    EXPECT_FALSE(t.IsSingular());
    EXPECT_EQ(t.Inverse().Inverse(), t);
    for (uint64_t i = 0; i < 10; ++i) {
      ExpectNear(t.Inverse().Point(t.Point(Point(i))), Point(i), 1e-13 * 100);
      ExpectNear(t.Vector(t.Inverse().Vector(Point(i))), Point(i), 1e-13 * 100);
    }
  }
}

TEST(Transform, NormalsStayPerpendicularToTheirSurface) {
  for (const Transform& t : SomeTransforms()) {
    for (uint64_t i = 0; i < 10; ++i) {
      const Vec3d tangent = Point(i), normal = Cross(tangent, Point(i + 100));
      EXPECT_NEAR(Dot(t.Vector(tangent), t.Normal(normal)), 0, 1e-12);
    }
  }
}

TEST(Transform, RotationIsCounterClockwiseSeenFromTheTipOfTheAxis) {
  ExpectNear(Transform::Rotate(90, {0, 0, 5}).Point({1, 0, 0}), {0, 1, 0}, 1e-15);
  ExpectNear(Transform::Rotate(90, {1, 0, 0}).Point({0, 1, 0}), {0, 0, 1}, 1e-15);
  ExpectNear(Transform::Rotate(90, {0, 1, 0}).Point({0, 0, 1}), {1, 0, 0}, 1e-15);
  // A third of a turn around the diagonal carries each axis to the next.
  ExpectNear(Transform::Rotate(120, {1, 1, 1}).Point({1, 0, 0}), {0, 1, 0}, 1e-15);
  for (uint64_t i = 0; i < 10; ++i) {
    const Vec3d turned = Transform::Rotate(360 * Uniform(i, 7), Point(i)).Point(Point(i + 50));
    EXPECT_NEAR(Length(turned), Length(Point(i + 50)), 1e-14 * 10);
    EXPECT_NEAR(Dot(turned, Point(i)), Dot(Point(i + 50), Point(i)), 1e-13);
  }
}

TEST(Transform, LookAtPutsTheTargetStraightAhead) {
  const Vec3d eye(1, 2, 3), target(-4, 0, 2);
  const Transform t = Transform::CameraToWorldLookAt(eye, target, {0, 1, 0});
  ExpectNear(t.Point({0, 0, 0}), eye, 1e-15);
  ExpectNear(t.Point({0, 0, Distance(eye, target)}), target, 1e-14);
  EXPECT_NEAR(t.Vector({1, 0, 0}).y, 0, 1e-15);
  EXPECT_GT(t.Vector({0, 1, 0}).y, 0);
  // pbrt's own example: looking along +z with y up leaves the axes as they are (left-handed on both sides).
  EXPECT_EQ(Transform::CameraToWorldLookAt({0, 0, 0}, {0, 0, 1}, {0, 1, 0}), Transform());
  EXPECT_FALSE(t.SwapsHandedness());
}

TEST(Transform, LookAtAlongUpIsSingular) {
  EXPECT_TRUE(Transform::CameraToWorldLookAt({0, 0, 0}, {0, 5, 0}, {0, 1, 0}).IsSingular());
  EXPECT_TRUE(Transform::CameraToWorldLookAt({1, 1, 1}, {1, 1, 1}, {0, 1, 0}).IsSingular());
}

TEST(Transform, SingularAndHandedness) {
  EXPECT_TRUE(Transform::Scale({1, 0, 1}).IsSingular());
  EXPECT_TRUE(Transform::Scale({1, std::numeric_limits<double>::infinity(), 1}).IsSingular());
  EXPECT_FALSE(Transform::Scale({1e-6, 1e-6, 1e-6}).IsSingular());
  EXPECT_TRUE(Transform::Scale({1, 1, -1}).SwapsHandedness());
  EXPECT_FALSE(Transform::Scale({-1, 1, -1}).SwapsHandedness());
  EXPECT_FALSE(Transform::Rotate(180, {3, 1, 2}).SwapsHandedness());
  EXPECT_TRUE(Transform().IsIdentity());
  EXPECT_FALSE(Transform::Translate({0, 0, 1e-30}).IsIdentity());
}

// A chain as scene files make them: far away, tiny, and back.
TEST(Transform, FarAwayAndBackKeepsPrecision) {
  const Transform chain = Transform::Translate({1e7, -1e7, 1e7}) * Transform::Scale({1e-6, 1e-6, 1e-6}) *
                          Transform::Rotate(33, {1, 1, 0}) * Transform::Translate({1e3, 0, 0});
  for (uint64_t i = 0; i < 10; ++i) {
    // Coordinates near 1e7 have a spacing of 2e-9, which the inverse scale makes 2e-3.
    ExpectNear(chain.Inverse().Point(chain.Point(Point(i))), Point(i), 1e-2);
    ExpectNear((chain.Inverse() * chain).Vector(Point(i)), Point(i), 1e-12);
  }
}

}  // namespace
}  // namespace dapple
