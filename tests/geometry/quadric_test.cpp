#include <gtest/gtest.h>

#include "src/base/error.h"
#include "src/geometry/cylinder.h"
#include "src/geometry/disk.h"
#include "src/geometry/sphere.h"
#include "tests/geometry/shape_checks.h"

namespace dapple {
namespace {

/// Turned, scaled alike along all axes and moved.
Transform Similarity() {
  return Transform::Translate({0.3, -0.7, 1.1}) * Transform::Rotate(40, {1, 2, 3}) * Transform::Scale(Vec3d(1.7));
}

/// Scaled differently along axes and sheared by rotations.
Transform Affine() {
  return Transform::Translate({0.3, -0.7, 1.1}) * Transform::Rotate(40, {1, 2, 3}) * Transform::Scale({0.7, 1.9, 1.2}) *
         Transform::Rotate(25, {1, 0, 1});
}

std::vector<std::unique_ptr<Shape>> ManyQuadrics() {
  std::vector<std::unique_ptr<Shape>> shapes;
  for (const Transform& transform : {Transform(), Similarity(), Affine()}) {
    for (const bool reverse : {false, true}) {
      shapes.push_back(std::make_unique<Sphere>(transform, reverse, 1.5));
      shapes.push_back(std::make_unique<Sphere>(transform, reverse, 1.5, -0.6, 1.1, 220));
      shapes.push_back(std::make_unique<Disk>(transform, reverse, 0.4, 1.3, 0, 360));
      shapes.push_back(std::make_unique<Disk>(transform, reverse, -0.2, 1.3, 0.5, 200));
      shapes.push_back(std::make_unique<Cylinder>(transform, reverse, 0.9, -1, 1.4, 360));
      shapes.push_back(std::make_unique<Cylinder>(transform, reverse, 0.9, -1, 1.4, 130));
    }
  }
  return shapes;
}

TEST(Quadric, AreaSamplesInvertAndIntegrate) {
  uint64_t seed = 1;
  for (const auto& shape : ManyQuadrics()) {
    CheckAreaInverse(*shape, 0, seed, 1e-5);
    CheckAreaDensity(*shape, 0, seed++);
  }
}

TEST(Quadric, AreasAreTheClosedForms) {
  const double s2 = 1.7 * 1.7;
  EXPECT_NEAR(Sphere(Similarity(), false, 1.5).PrimitiveArea(0), 4 * kPiD * 2.25 * s2, 1e-9);
  EXPECT_NEAR(Sphere(Similarity(), false, 1.5, -0.5, 1, 90).PrimitiveArea(0), kPiD / 2 * 1.5 * 1.5 * s2, 1e-9);
  EXPECT_NEAR(Disk(Similarity(), false, 0, 2, 1, 180).PrimitiveArea(0), kPiD / 2 * 3 * s2, 1e-9);
  EXPECT_NEAR(Cylinder(Similarity(), false, 2, -1, 2, 180).PrimitiveArea(0), kPiD * 2 * 3 * s2, 1e-9);
  // Spheroids: 2 pi a^2 (1 + (1 - e^2) / e atanh e) and 2 pi a^2 (1 + c / (a e) asin e).
  const double oblate = std::sqrt(1 - 0.25), prolate = std::sqrt(1 - 1 / 9.0);
  EXPECT_NEAR(Sphere(Transform::Scale({2, 2, 1}), false, 1).PrimitiveArea(0),
              2 * kPiD * 4 * (1 + (1 - oblate * oblate) / oblate * std::atanh(oblate)), 1e-9);
  EXPECT_NEAR(Sphere(Transform::Scale({1, 1, 3}), false, 1).PrimitiveArea(0),
              2 * kPiD * (1 + 3 / prolate * std::asin(prolate)), 1e-9);
}

TEST(Quadric, RaysToSampledPointsMeetTheSurfaceThere) {
  TestRandom random(7);
  for (const auto& shape : ManyQuadrics()) {
    for (int i = 0; i < 300; ++i) {
      const ShapeSample sample = shape->SampleArea(0, random.Square());
      const Vec3 o = ToFloat(random.Direction() * 6.0);
      const Ray ray{o, sample.p - o, kInfinity, {}};
      if (AbsDot(Normalize(ray.d), sample.n) < 0.05f) continue;  // seen edge-on a hit says little
      const PrimitiveHits hits = shape->IntersectAll(ray, 0);
      bool isFound = false;
      for (int h = 0; h < hits.count; ++h) {
        const SurfaceInteraction at = shape->Interact(ray, hits.hits[h]);
        EXPECT_LE(Distance(at.p, ray(hits.hits[h].t)), 1e-4);
        EXPECT_LE(Distance(Vec3(at.uv.x, at.uv.y, 0), Vec3(shape->Uv(hits.hits[h]).x, shape->Uv(hits.hits[h]).y, 0)),
                  1e-6);
        if (std::abs(hits.hits[h].t - 1) > 1e-3) continue;
        isFound = true;
        ExpectNear(at.p, sample.p, 1e-4, "p");
        ExpectNear(at.ng, sample.n, 1e-3, "normal");
      }
      // At the very edge of a partial shape the ray may pass by.
      EXPECT_TRUE(isFound || sample.uv.x < 1e-3 || sample.uv.x > 0.999 || sample.uv.y < 1e-3 || sample.uv.y > 0.999);
    }
  }
}

TEST(Quadric, DerivativesPredictNeighbours) {
  TestRandom random(9);
  for (const auto& shape : ManyQuadrics()) {
    for (int i = 0; i < 10; ++i) {
      const ShapeSample sample = shape->SampleArea(0, {random.Uniform(0.1, 0.9), random.Uniform(0.1, 0.9)});
      const Ray ray{sample.p + sample.n * 2.0f, -sample.n, kInfinity, {}};
      const auto hit = shape->Intersect(ray, 0);
      if (!hit || std::abs(hit->t - 2) > 0.01f) continue;
      CheckDerivatives(*shape, 0, ray, 3e-3, 1e-2);
    }
  }
}

TEST(Quadric, SolidAngleDensitiesAreExact) {
  uint64_t seed = 40;
  for (const auto& shape : ManyQuadrics()) {
    if (++seed % 2 == 0) continue;  // every kind comes with one orientation or the other
    CheckSolidAngleDensity(*shape, 0, {2.5f, -3, 2}, seed);
    CheckSolidAngleInverse(*shape, 0, {2.5f, -3, 2}, seed, 1e-4);
  }
}

TEST(Quadric, SphereFromInsideIsSampledWhole) {
  for (const Transform& transform : {Transform(), Affine()}) {
    const Sphere sphere(transform, false, 1.5);
    const Vec3 inside = ToFloat(transform.Point({0.2, -0.5, 0.6}));
    CheckSolidAngleDensity(sphere, 0, inside, 77);
    CheckSolidAngleInverse(sphere, 0, inside, 78, 1e-4);
  }
}

TEST(Quadric, NormalsPointOutwardUnlessReversed) {
  const Transform mirror = Transform::Scale({-1, 1, 1});
  for (const Transform& transform : {Similarity(), Affine(), mirror}) {
    for (const bool reverse : {false, true}) {
      const double sign = reverse ? -1 : 1;
      const ShapeSample sphere = Sphere(transform, reverse, 1).SampleArea(0, {0.3, 0.6});
      const Vec3d centre = transform.Point(Vec3d(0));
      EXPECT_GT(sign * Dot(ToDouble(sphere.n), ToDouble(sphere.p) - centre), 0);
      const ShapeSample disk = Disk(transform, reverse, 0, 1, 0, 360).SampleArea(0, {0.3, 0.6});
      EXPECT_GT(sign * Dot(ToDouble(disk.n), transform.Normal({0, 0, 1})), 0);
      const ShapeSample cylinder = Cylinder(transform, reverse, 1, -1, 1, 360).SampleArea(0, {0.3, 0.6});
      EXPECT_GT(sign * Dot(ToDouble(cylinder.n), ToDouble(cylinder.p) - centre), 0);
    }
  }
}

TEST(Quadric, UvsArePbrts) {
  const Sphere sphere(Transform(), false, 2);
  const auto uvAt = [](const Shape& shape, const Vec3& o, const Vec3& d) {
    return shape.Uv(shape.Intersect({o, d, kInfinity, {}}, 0).value());
  };
  const Vec2 south = uvAt(sphere, {0, 0, -9}, {0, 0, 1}), north = uvAt(sphere, {0, 0, 9}, {0, 0, -1});
  EXPECT_NEAR(south.y, 0, 1e-6);
  EXPECT_NEAR(north.y, 1, 1e-6);
  const Vec2 y = uvAt(sphere, {0, 9, 0}, {0, -1, 0});
  EXPECT_NEAR(y.x, 0.25, 1e-6);
  EXPECT_NEAR(y.y, 0.5, 1e-6);
  const Vec2 disk = uvAt(Disk(Transform(), false, 1, 2, 0.5, 180), {0, 1, 5}, {0, 0, -1});
  EXPECT_NEAR(disk.x, 0.5, 1e-6);
  EXPECT_NEAR(disk.y, 1 / 1.5, 1e-6);
  const Vec2 cylinder = uvAt(Cylinder(Transform(), false, 1, -1, 3, 360), {-5, 0, 2}, {1, 0, 0});
  EXPECT_NEAR(cylinder.x, 0.5, 1e-6);
  EXPECT_NEAR(cylinder.y, 0.75, 1e-6);
}

TEST(Quadric, BoundsHoldThePointsTightly) {
  TestRandom random(21);
  for (const auto& shape : ManyQuadrics()) {
    const Bounds3 bounds = shape->PrimitiveBounds(0);
    for (int i = 0; i < 2000; ++i) ASSERT_TRUE(bounds.intersects(shape->SampleArea(0, random.Square()).p));
  }
  const Bounds3 ball = Sphere(Similarity(), false, 1.5).PrimitiveBounds(0);
  EXPECT_NEAR(ball.size().x, 2 * 1.5 * 1.7, 1e-5);
}

TEST(Quadric, RefusesWhatIsNoShape) {
  EXPECT_THROW(Sphere(Transform(), false, 0), Error);
  EXPECT_THROW(Sphere(Transform(), false, -1), Error);
  EXPECT_THROW(Sphere(Transform::Scale({1, 0, 1}), false, 1), Error);
  EXPECT_THROW(Disk(Transform(), false, 0, 1, 1, 360), Error);
  EXPECT_THROW(Cylinder(Transform(), false, 0, 0, 1, 360), Error);
}

}  // namespace
}  // namespace dapple
