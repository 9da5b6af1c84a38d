#include "src/geometry/bilinear_mesh.h"

#include <gtest/gtest.h>

#include "src/base/error.h"
#include "tests/geometry/shape_checks.h"

namespace dapple {
namespace {

const std::vector<Vec3> kRectangle = {{-1, -2, 0.5f}, {1, -2, 0.5f}, {-1, 2, 0.5f}, {1, 2, 0.5f}};
const std::vector<Vec3> kTrapezoid = {{-1, -2, 0.5f}, {1, -2, 0.5f}, {-0.2f, 2, 0.5f}, {0.5f, 2, 0.5f}};
const std::vector<Vec3> kTwisted = {{-1, -1, 0}, {1, -1, 0.7f}, {-1, 1, 0.9f}, {1.2f, 1.1f, -0.4f}};

BilinearMesh Patch(const std::vector<Vec3>& p) { return {p, {}, {}, {0, 1, 2, 3}}; }

TEST(BilinearMesh, AreasOfPlanarPatchesAreTheClosedForms) {
  EXPECT_DOUBLE_EQ(Patch(kRectangle).PrimitiveArea(0), 8);
  EXPECT_NEAR(Patch(kTrapezoid).PrimitiveArea(0), 4 * (2 + 0.7) / 2, 1e-6);
  EXPECT_EQ(Patch(std::vector<Vec3>(4, Vec3(1))).PrimitiveArea(0), 0);
}

TEST(BilinearMesh, AreaOfATwistedPatchIsThatOfAFineMesh) {
  const BilinearMesh mesh = Patch(kTwisted);
  constexpr int kSteps = 400;
  const auto at = [&](int i, int j) {
    const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
    return ToDouble(kTwisted[0]) * ((1 - u) * (1 - v)) + ToDouble(kTwisted[1]) * (u * (1 - v)) +
           ToDouble(kTwisted[2]) * ((1 - u) * v) + ToDouble(kTwisted[3]) * (u * v);
  };
  double area = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j)
      area += Length(Cross(at(i + 1, j + 1) - at(i, j), at(i, j + 1) - at(i + 1, j))) / 2;
  EXPECT_NEAR(mesh.PrimitiveArea(0), area, 1e-5 * area);
}

TEST(BilinearMesh, SamplesInvertAndIntegrate) {
  uint64_t seed = 1;
  for (const auto& p : {kRectangle, kTrapezoid, kTwisted}) {
    const BilinearMesh mesh = Patch(p);
    CheckAreaInverse(mesh, 0, seed, 1e-5);
    CheckAreaDensity(mesh, 0, seed);
    for (const Vec3& reference : {Vec3(0.3f, 0.2f, 2), Vec3(1.5f, -2, -0.5f)}) {
      CheckSolidAngleInverse(mesh, 0, reference, seed, 1e-5);
      CheckSolidAngleDensity(mesh, 0, reference, ++seed);
    }
  }
  // Planar convex patches are sampled uniformly.
  const BilinearMesh trapezoid = Patch(kTrapezoid);
  EXPECT_NEAR(trapezoid.SampleArea(0, {0.9, 0.9}).pdf * trapezoid.PrimitiveArea(0), 1, 1e-6);
}

TEST(BilinearMesh, FarRectanglesHaveTheDensityOfTheirSolidAngle) {
  for (const float distance : {1e3f, 1e6f}) {
    const auto sample = Patch(kRectangle).SampleSolidAngle(0, {0, 0, distance}, {0.3, 0.6});
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->pdf * 8 / Sqr(static_cast<double>(distance) - 0.5), 1, 1e-5);
  }
}

TEST(BilinearMesh, RaysToPointsOfThePatchHitThem) {
  TestRandom random(4);
  for (const auto& p : {kRectangle, kTrapezoid, kTwisted}) {
    const BilinearMesh mesh = Patch(p);
    for (int i = 0; i < 2000; ++i) {
      const ShapeSample sample = mesh.SampleArea(0, {random.Uniform(1e-3, 0.999), random.Uniform(1e-3, 0.999)});
      const Vec3 o = ToFloat(random.Direction() * 5.0);
      const Ray ray{o, sample.p - o, kInfinity, {}};
      if (AbsDot(Normalize(ray.d), sample.n) < 0.02f) continue;
      const PrimitiveHits hits = mesh.IntersectAll(ray, 0);
      bool isFound = false;
      for (int h = 0; h < hits.count; ++h) {
        if (std::abs(hits.hits[h].t - 1) > 1e-3) continue;
        isFound = true;
        const SurfaceInteraction at = mesh.Interact(ray, hits.hits[h]);
        ExpectNear(at.p, sample.p, 1e-4, "p");
        ExpectNear(at.ng, sample.n, 1e-3, "normal");
      }
      EXPECT_TRUE(isFound);
    }
  }
}

TEST(BilinearMesh, DerivativesPredictNeighbours) {
  const std::vector<Vec3> n = {{-0.5f, -0.3f, 1}, {0.4f, -0.4f, 1}, {-0.3f, 0.5f, 1}, {0.4f, 0.3f, 1}};
  const std::vector<Vec2> uv = {{0.1f, 0.9f}, {0.2f, 0.3f}, {0.8f, 0.8f}, {0.7f, 0.1f}};  // turned by 90 degrees
  const Ray ray{{0.3f, -0.2f, 5}, {0.02f, 0.05f, -1}, kInfinity, {}};
  for (const auto& p : {kRectangle, kTrapezoid, kTwisted}) {
    CheckDerivatives(BilinearMesh(p, {}, {}, {0, 1, 2, 3}), 0, ray, 3e-3, 1e-2);
    CheckDerivatives(BilinearMesh(p, {}, uv, {0, 1, 2, 3}, true, false), 0, ray, 3e-3, 1e-2);
    CheckDerivatives(BilinearMesh(p, n, uv, {0, 1, 2, 3}, false, true), 0, ray, 3e-3, 1e-2);
  }
}

TEST(BilinearMesh, OutsideFollowsOrientationAndVertexNormals) {
  const std::vector<Vec3> down(4, Vec3(0, 0, -1));
  for (const bool reverse : {false, true}) {
    for (const bool swaps : {false, true}) {
      const BilinearMesh bare(kRectangle, {}, {}, {0, 1, 2, 3}, reverse, swaps);
      EXPECT_EQ(bare.SampleArea(0, {0.5, 0.5}).n.z, reverse != swaps ? -1 : 1);
      const BilinearMesh withNormals(kRectangle, down, {}, {0, 1, 2, 3}, reverse, swaps);
      EXPECT_EQ(withNormals.SampleArea(0, {0.5, 0.5}).n.z, reverse ? 1 : -1);
    }
  }
}

TEST(BilinearMesh, RefusesWhatDoesNotFit) {
  EXPECT_THROW(BilinearMesh(kRectangle, {}, {}, {0, 1, 2}), Error);
  EXPECT_THROW(BilinearMesh(kRectangle, {}, {}, {0, 1, 2, 4}), Error);
  EXPECT_THROW(BilinearMesh(kRectangle, {{0, 0, 1}}, {}, {0, 1, 2, 3}), Error);
}

}  // namespace
}  // namespace dapple
