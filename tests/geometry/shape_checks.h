// Facts that hold for every shape, as checks that the tests of each shape run.
#pragma once

#include <random>

#include <gtest/gtest.h>

#include "src/base/frame.h"
#include "src/geometry/shape.h"
#include "src/sampling/warps.h"

namespace dapple {

/// Random numbers of a test; the seed is fixed.
class TestRandom {
 public:
  explicit TestRandom(uint64_t seed) : engine_(seed) {}
  double Uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }
  Vec2d Square() {
    const double x = Uniform();
    return {x, Uniform()};
  }
  Vec3d Box(double low, double high) {
    const double x = Uniform(low, high), y = Uniform(low, high);
    return {x, y, Uniform(low, high)};
  }
  Vec3d Direction() { return SampleSphere(Square()); }

 private:
  std::mt19937_64 engine_;
};

/// A mean with the standard error of it.
struct Estimate {
  void Add(double x) { ++count, sum += x, sumOfSquares += x * x; }
  double Mean() const { return sum / count; }
  double Error() const { return std::sqrt(std::max(0.0, sumOfSquares / count - Mean() * Mean()) / (count - 1)); }

  double count = 0;
  double sum = 0, sumOfSquares = 0;
};

/// Two-sided at 5 standard errors: a false alarm in two million.
inline void ExpectEqualMeans(const Estimate& a, const Estimate& b, double rounding, const char* what) {
  EXPECT_NEAR(a.Mean(), b.Mean(), 5 * std::hypot(a.Error(), b.Error()) + rounding) << what;
}

inline void ExpectNear(const Vec3& a, const Vec3& b, double tolerance, const char* what) {
  EXPECT_LE(Length(ToDouble(a) - ToDouble(b)), tolerance) << what << ": " << a << " and " << b;
}

/// `InvertArea` undoes `SampleArea`, and both densities agree. `tolerance`: what rounding of the point leaves.
inline void CheckAreaInverse(const Shape& shape, int primitive, uint64_t seed, double tolerance) {
  TestRandom random(seed);
  for (int i = 0; i < 1000; ++i) {
    const Vec2d u = random.Square();
    const ShapeSample sample = shape.SampleArea(primitive, u);
    const Vec2d inverse = shape.InvertArea(primitive, sample.p);
    ASSERT_NEAR(inverse.x, u.x, tolerance) << u;
    ASSERT_NEAR(inverse.y, u.y, tolerance) << u;
    ASSERT_NEAR(shape.PdfArea(primitive, sample.p) / sample.pdf, 1, 10 * tolerance) << u;
  }
}

/// `InvertSolidAngle` undoes `SampleSolidAngle`, and both densities agree.
inline void CheckSolidAngleInverse(const Shape& shape, int primitive, const Vec3& reference, uint64_t seed,
                                   double tolerance) {
  TestRandom random(seed);
  for (int i = 0; i < 1000; ++i) {
    const Vec2d u = random.Square();
    const auto sample = shape.SampleSolidAngle(primitive, reference, u);
    if (!sample) continue;
    const Vec2d inverse = shape.InvertSolidAngle(primitive, reference, sample->p);
    ASSERT_NEAR(inverse.x, u.x, tolerance) << u;
    ASSERT_NEAR(inverse.y, u.y, tolerance) << u;
    ASSERT_NEAR(shape.PdfSolidAngle(primitive, reference, sample->p, sample->n) / sample->pdf, 1, 10 * tolerance) << u;
  }
}

/// The mean of 1 / pdf over points drawn per area is the area.
inline void CheckAreaDensity(const Shape& shape, int primitive, uint64_t seed) {
  TestRandom random(seed);
  Estimate inverse;
  for (int i = 0; i < 40000; ++i) inverse.Add(1 / shape.SampleArea(primitive, random.Square()).pdf);
  const double area = shape.PrimitiveArea(primitive);
  EXPECT_NEAR(inverse.Mean(), area, 5 * inverse.Error() + 1e-5 * area);
}

/// The density per solid angle is the right one: over all directions it integrates to one, and means of functions of
/// the direction are the same by drawn points as by uniform directions that hit.
inline void CheckSolidAngleDensity(const Shape& shape, int primitive, const Vec3& reference, uint64_t seed) {
  TestRandom random(seed);
  const Vec3d a = random.Direction(), b = random.Direction();
  const auto first = [&](const Vec3d& w) { return Sqr(Dot(w, a)) + 0.1; };
  const auto second = [&](const Vec3d& w) { return std::exp(2 * Dot(w, b)); };
  Estimate total, first1, first2, second1, second2;
  for (int i = 0; i < 60000; ++i) {
    const Vec3d w = random.Direction();
    const Ray ray{reference, ToFloat(w), kInfinity, {}};
    const PrimitiveHits hits = shape.IntersectAll(ray, primitive);
    double density = 0, reached = 0;
    for (int h = 0; h < hits.count; ++h) {
      const SurfaceInteraction at = shape.Interact(ray, hits.hits[h]);
      const double pdf = shape.PdfSolidAngle(primitive, reference, at.p, at.ng);
      density += pdf;
      reached += pdf > 0 ? 1 : 0;
    }
    total.Add(density * 4 * kPiD);
    first1.Add(reached * 4 * kPiD * first(w));
    second1.Add(reached * 4 * kPiD * second(w));

    const auto sample = shape.SampleSolidAngle(primitive, reference, random.Square());
    const Vec3d toward = sample ? Normalize(ToDouble(sample->p) - ToDouble(reference)) : Vec3d(0);
    first2.Add(sample ? first(toward) / sample->pdf : 0);
    second2.Add(sample ? second(toward) / sample->pdf : 0);
  }
  EXPECT_NEAR(total.Mean(), 1, 5 * total.Error() + 1e-5);
  ExpectEqualMeans(first1, first2, 1e-5, "mean of a square");
  ExpectEqualMeans(second1, second2, 1e-5, "mean of an exponential");
}

/// The hit nearest to `uv` near the hit of `ray`: used to differentiate numerically. Rays around `ray` hit near points,
/// whose p, uv and normals must change as the derivatives at the middle say.
inline void CheckDerivatives(const Shape& shape, int primitive, const Ray& ray, double step, double tolerance) {
  const auto middle = shape.Intersect(ray, primitive);
  ASSERT_TRUE(middle);
  const SurfaceInteraction at = shape.Interact(ray, *middle);
  EXPECT_NEAR(Length(at.ng), 1, 1e-6);
  EXPECT_NEAR(Length(at.ns), 1, 1e-6);
  EXPECT_GT(Dot(at.ng, at.ns), 0);
  EXPECT_NEAR(Dot(Normalize(at.dpdu), at.ng), 0, 1e-5);
  EXPECT_NEAR(Dot(Normalize(at.dpdv), at.ng), 0, 1e-5);
  EXPECT_NEAR(AbsDot(Normalize(Cross(at.dpdus, at.dpdvs)), at.ns), 1, 1e-5);
  Vec3d x, y;
  CoordinateSystem(ToDouble(Normalize(ray.d)), &x, &y);
  for (const Vec3d& shift : {x, y}) {
    const auto shifted = [&](double sign) {
      const Ray moved{ToFloat(ToDouble(ray.o) + shift * (step * sign)), ray.d, kInfinity, {}};
      const auto hit = shape.Intersect(moved, primitive);
      EXPECT_TRUE(hit);
      return shape.Interact(moved, hit.value_or(*middle));
    };
    const SurfaceInteraction after = shifted(1), before = shifted(-1);
    const Vec2d duv = Vec2d(after.uv) - Vec2d(before.uv);
    const Vec3d moved = ToDouble(after.p) - ToDouble(before.p);
    const Vec3d predicted = ToDouble(at.dpdu) * duv.x + ToDouble(at.dpdv) * duv.y;
    EXPECT_LE(Length(moved - predicted), tolerance * Length(moved)) << moved << " and " << predicted;
    const Vec3d turned = ToDouble(after.ns) - ToDouble(before.ns);
    const Vec3d predictedTurn = ToDouble(at.dndu) * duv.x + ToDouble(at.dndv) * duv.y;
    EXPECT_LE(Length(turned - predictedTurn), tolerance * (Length(turned) + 1e-3))
        << turned << " and " << predictedTurn;
  }
}

}  // namespace dapple
