// Sphere lights from one ulp away to a million radii, against long double.
#include <gtest/gtest.h>

#include "src/geometry/sphere.h"
#include "tests/geometry/shape_checks.h"

namespace dapple {
namespace {

/// The solid angle of a sphere of radius 1 at the distance 1 + height, in long double.
long double SolidAngle(long double height) {
  const long double distance = 1 + height;
  // 1 - cos = 1 - sqrt(d^2 - 1) / d, rewritten for large d.
  const long double tangent = sqrtl(height * (2 + height));
  return 2 * 3.14159265358979323846264338327950288L / (distance * (distance + tangent));
}

TEST(SphereLight, SolidAngleIsExactAtAllDistances) {
  const Sphere sphere(Transform(), false, 1);
  for (const double height : {1e-6, 1e-4, 1e-2, 1.0, 10.0, 1e3, 1e6}) {
    const auto reference = static_cast<float>(1 + height);
    const long double expected = SolidAngle(static_cast<long double>(reference) - 1);
    const auto sample = sphere.SampleSolidAngle(0, {0, 0, reference}, {0.4, 0.2});
    ASSERT_TRUE(sample);
    EXPECT_NEAR(static_cast<double>(sample->pdf * expected), 1, 1e-12) << height;
  }
}

TEST(SphereLight, OneUlpOutsideItFillsTheHemisphere) {
  const Sphere sphere(Transform(), false, 1);
  const Vec3 reference(0, 0, NextFloatUp(1));
  const auto sample = sphere.SampleSolidAngle(0, reference, {0.7, 0.2});
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->pdf * 2 * kPiD, 1, 1e-3);
  EXPECT_NEAR(Length(sample->p), 1, 1e-6);
}

TEST(SphereLight, DrawnDirectionsAreUniformInTheCone) {
  // The first number is the share of 1 - cos(theta) of the direction, measured in long double on the point drawn.
  const Sphere sphere(Transform(), false, 1);
  TestRandom random(3);
  for (const double height : {0.01, 1.0, 30.0}) {
    const auto z = static_cast<float>(1 + height);
    const long double whole = SolidAngle(static_cast<long double>(z) - 1) / (2 * 3.14159265358979323846L);
    for (int i = 0; i < 200; ++i) {
      const Vec2d u = random.Square();
      const auto sample = sphere.SampleSolidAngle(0, {0, 0, z}, u);
      ASSERT_TRUE(sample);
      const long double across = hypotl(sample->p.x, sample->p.y), along = static_cast<long double>(z) - sample->p.z;
      const long double half = sinl(atan2l(across, along) / 2);
      EXPECT_NEAR(static_cast<double>(2 * half * half / whole), u.x, 2e-5 / std::min(1.0, std::sqrt(height)));
    }
  }
}

TEST(SphereLight, InverseHoldsAtAllDistances) {
  const Sphere sphere(Transform(), false, 1);
  for (const double height : {1e-4, 1e-2, 1.0, 10.0, 1e3, 1e6}) {
    const Vec3 reference(0, static_cast<float>(1 + height), 0);
    CheckSolidAngleInverse(sphere, 0, reference, 12, height < 1e-3 ? 1e-3 : 1e-4);
  }
}

TEST(SphereLight, PointsLieOnTheVisibleSide) {
  const Sphere sphere(Transform(), false, 1);
  TestRandom random(5);
  for (const double distance : {1.001, 2.0, 1e3, 1e6}) {
    const Vec3 reference = ToFloat(random.Direction() * distance);
    for (int i = 0; i < 500; ++i) {
      const auto sample = sphere.SampleSolidAngle(0, reference, random.Square());
      ASSERT_TRUE(sample);
      ASSERT_GE(Dot(ToDouble(sample->n), Normalize(ToDouble(reference) - ToDouble(sample->p))), -1e-5);
      ASSERT_NEAR(Length(ToDouble(sample->p)), 1, 1e-6);
    }
    EXPECT_EQ(sphere.PdfSolidAngle(0, reference, ToFloat(Normalize(ToDouble(-reference))), {0, 0, 1}), 0);
  }
}

TEST(SphereLight, GrazingAndFarRaysHitAsLongDoubleSays) {
  const Sphere sphere(Transform(), false, 1);
  TestRandom random(6);
  for (const double distance : {2.0, 1e3, 1e6}) {
    for (int i = 0; i < 2000; ++i) {
      const Vec3d axis = random.Direction();
      Vec3d x, y;
      CoordinateSystem(axis, &x, &y);
      const double offset = 1 + random.Uniform(-1, 1) * std::pow(10, random.Uniform(-6, 0));
      const Vec3 o = ToFloat(axis * distance + x * offset), d = ToFloat(-axis);
      const long double dd = static_cast<long double>(d.x) * d.x + static_cast<long double>(d.y) * d.y +
                             static_cast<long double>(d.z) * d.z;
      const long double od = static_cast<long double>(o.x) * d.x + static_cast<long double>(o.y) * d.y +
                             static_cast<long double>(o.z) * d.z;
      const long double oo = static_cast<long double>(o.x) * o.x + static_cast<long double>(o.y) * o.y +
                             static_cast<long double>(o.z) * o.z;
      const long double discriminant = od * od - dd * (oo - 1);
      const auto hit = sphere.Intersect({o, d, kInfinity, {}}, 0);
      if (std::abs(static_cast<double>(discriminant)) < 1e-9) continue;  // tangent to what rounding can tell
      ASSERT_EQ(hit.has_value(), discriminant > 0) << distance << " " << static_cast<double>(discriminant);
      if (!hit) continue;
      const long double t = (-od - sqrtl(discriminant)) / dd;
      ASSERT_NEAR(hit->t / static_cast<double>(t), 1, 2e-7);
    }
  }
}

}  // namespace
}  // namespace dapple
