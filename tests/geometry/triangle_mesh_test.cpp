#include "src/geometry/triangle_mesh.h"

#include <gtest/gtest.h>

#include "src/base/error.h"
#include "tests/geometry/shape_checks.h"

namespace dapple {
namespace {

TriangleMesh One(const Vec3& a, const Vec3& b, const Vec3& c) { return {{a, b, c}, {}, {}, {0, 1, 2}}; }

TriangleMesh RandomTriangle(TestRandom* random, double size) {
  return One(ToFloat(random->Box(-size, size)), ToFloat(random->Box(-size, size)), ToFloat(random->Box(-size, size)));
}

SurfaceInteraction HitFromAbove(const TriangleMesh& mesh, float x, float y) {
  const Ray ray{{x, y, 5}, {0, 0, -1}, kInfinity, {}};
  const auto hit = mesh.Intersect(ray, 0);
  EXPECT_TRUE(hit);
  return mesh.Interact(ray, hit.value_or(PrimitiveHit{}));
}

TEST(TriangleMesh, RayMeetsThePlaneWhereAlgebraSays) {
  const TriangleMesh mesh = One({0, 0, 1}, {4, 0, 1}, {0, 4, 1});
  const SurfaceInteraction at = HitFromAbove(mesh, 1, 2);
  EXPECT_FLOAT_EQ(at.t, 4);
  ExpectNear(at.p, {1, 2, 1}, 1e-6, "p");
  ExpectNear(at.wo, {0, 0, 1}, 0, "wo");
  EXPECT_FALSE(mesh.Intersect({{3, 3, 5}, {0, 0, -1}, kInfinity, {}}, 0));
  EXPECT_FALSE(mesh.Intersect({{1, 1, 5}, {0, 0, -1}, 3.9f, {}}, 0));
  EXPECT_FALSE(mesh.Intersect({{1, 1, 5}, {0, 0, 1}, kInfinity, {}}, 0));
}

TEST(TriangleMesh, OutsideFollowsWindingOrientationAndVertexNormals) {
  const std::vector<Vec3> p = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};  // counter-clockwise from +z
  const std::vector<Vec3> up(3, Vec3(0, 0, 1)), down(3, Vec3(0, 0, -1));
  for (const bool reverse : {false, true}) {
    for (const bool swaps : {false, true}) {
      const float plain = reverse != swaps ? -1 : 1;
      const TriangleMesh bare(p, {}, {}, {0, 1, 2}, {}, reverse, swaps);
      EXPECT_EQ(HitFromAbove(bare, 1, 1).ng.z, plain);
      EXPECT_EQ(HitFromAbove(bare, 1, 1).ns.z, plain);
      EXPECT_EQ(bare.SampleArea(0, {0.3, 0.3}).n.z, plain);
      // Vertex normals decide; ReverseOrientation turns them around, a mirroring transform does not.
      const float withNormals = reverse ? -1 : 1;
      const TriangleMesh upward(p, up, {}, {0, 1, 2}, {}, reverse, swaps);
      const TriangleMesh downward(p, down, {}, {0, 1, 2}, {}, reverse, swaps);
      EXPECT_EQ(HitFromAbove(upward, 1, 1).ng.z, withNormals);
      EXPECT_EQ(HitFromAbove(upward, 1, 1).ns.z, withNormals);
      EXPECT_EQ(HitFromAbove(downward, 1, 1).ng.z, -withNormals);
      EXPECT_EQ(upward.SampleArea(0, {0.3, 0.3}).n.z, withNormals);
      EXPECT_EQ(downward.SampleArea(0, {0.3, 0.3}).n.z, -withNormals);
    }
  }
}

TEST(TriangleMesh, DerivativesPredictNeighbours) {
  const std::vector<Vec3> p = {{0, 0, 0.3f}, {4, 0, 1}, {1, 4, -0.5f}};
  const std::vector<Vec3> n = {{-1, -0.3f, 2}, {0.8f, -0.2f, 1}, {0.1f, 0.9f, 1.5f}};
  const std::vector<Vec2> uv = {{0.1f, 0.2f}, {0.9f, 0.4f}, {0.2f, 0.7f}};
  const Ray ray{{1.5f, 1.2f, 5}, {0.05f, -0.02f, -1}, kInfinity, {}};
  CheckDerivatives(TriangleMesh(p, {}, uv, {0, 1, 2}), 0, ray, 1e-2, 1e-4);
  CheckDerivatives(TriangleMesh(p, n, uv, {0, 1, 2}), 0, ray, 1e-2, 1e-3);
  CheckDerivatives(TriangleMesh(p, n, uv, {0, 1, 2}, {}, true, false), 0, ray, 1e-2, 1e-3);
  CheckDerivatives(TriangleMesh(p, n, {}, {0, 1, 2}), 0, ray, 1e-2, 1e-3);
}

TEST(TriangleMesh, TinyUvStepsKeepTheirDerivatives) {
  const std::vector<Vec2> uv = {{0, 0}, {1e-6f, 0}, {0, 1e-6f}};
  const TriangleMesh mesh({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {}, uv, {0, 1, 2});
  const SurfaceInteraction at = HitFromAbove(mesh, 1, 1);
  ExpectNear(at.dpdu, {4e6f, 0, 0}, 1, "dpdu");
  ExpectNear(at.dpdv, {0, 4e6f, 0}, 1, "dpdv");
}

TEST(TriangleMesh, WithoutUsableUvsTangentsAreAFrameAndNormalsStillTurn) {
  const std::vector<Vec3> n = {{-0.5f, 0, 1}, {0.5f, 0, 1}, {-0.5f, 0, 1}};
  const TriangleMesh mesh({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, n, std::vector<Vec2>(3, Vec2(0.5f)), {0, 1, 2});
  const SurfaceInteraction at = HitFromAbove(mesh, 2, 1);  // where the normal is (0, 0, 1)
  EXPECT_NEAR(Length(at.dpdu), 1, 1e-6);
  EXPECT_NEAR(Length(at.dpdv), 1, 1e-6);
  EXPECT_NEAR(Dot(at.dpdu, at.dpdv), 0, 1e-6);
  // dn/dx = (0.25, 0, 0) there.
  ExpectNear(at.dndu, Vec3(0.25f, 0, 0) * at.dpdu.x, 1e-6, "dndu");
  ExpectNear(at.dndv, Vec3(0.25f, 0, 0) * at.dpdv.x, 1e-6, "dndv");
}

TEST(TriangleMesh, TangentsOfTheFileSetTheShadingFrame) {
  const std::vector<Vec3> s(3, Vec3(0, 3, 0));
  const TriangleMesh mesh({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {}, {}, {0, 1, 2}, s);
  const SurfaceInteraction at = HitFromAbove(mesh, 1, 1);
  ExpectNear(at.dpdus, {0, 1, 0}, 1e-6, "dpdus");
  ExpectNear(Cross(at.dpdus, at.dpdvs), at.ns, 1e-6, "frame");
}

TEST(TriangleMesh, AreaAndItsSamplesAreUniform) {
  TestRandom random(1);
  for (int i = 0; i < 10; ++i) {
    const TriangleMesh mesh = RandomTriangle(&random, 2);
    CheckAreaInverse(mesh, 0, 100 + i, 1e-4);
    CheckAreaDensity(mesh, 0, 200 + i);
  }
  const TriangleMesh right = One({0, 0, 7}, {3, 0, 7}, {0, 4, 7});
  EXPECT_DOUBLE_EQ(right.PrimitiveArea(0), 6);
  // The centroid of uniform points.
  Vec3d sum(0);
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) sum += ToDouble(right.SampleArea(0, {(i + 0.5) / 64, (j + 0.5) / 64}).p);
  EXPECT_NEAR(sum.x / 4096, 1, 1e-3);
  EXPECT_NEAR(sum.y / 4096, 4.0 / 3, 1e-3);
}

TEST(TriangleMesh, SolidAngleDensityIsExact) {
  TestRandom random(4);
  for (int i = 0; i < 3; ++i) {
    const TriangleMesh mesh = RandomTriangle(&random, 2);
    CheckSolidAngleDensity(mesh, 0, ToFloat(random.Box(-1, 1)), 300 + i);
  }
}

TEST(TriangleMesh, SolidAngleInverseHoldsNearFarAndForNeedles) {
  TestRandom random(5);
  for (const double distance : {0.01, 1.0, 100.0, 1e4, 1e6}) {
    for (int i = 0; i < 5; ++i) {
      const TriangleMesh mesh = RandomTriangle(&random, 1);
      const Vec3 reference = ToFloat(random.Direction() * distance);
      CheckSolidAngleInverse(mesh, 0, reference, 400 + i, 2e-4);
    }
  }
  const TriangleMesh needle = One({-1, 0, 1}, {1, 1e-3f, 1}, {-1, 1e-3f, 1});
  CheckSolidAngleInverse(needle, 0, {0, 0, 0}, 500, 1e-3);
}

TEST(TriangleMesh, FarLightsHaveTheDensityOfTheirSolidAngle) {
  for (const float distance : {1e2f, 1e4f, 1e6f, 1e9f}) {
    const TriangleMesh mesh = One({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const auto sample = mesh.SampleSolidAngle(0, {0, 0, distance}, {0.3, 0.6});
    ASSERT_TRUE(sample);
    const double expected = 2.0 * distance * distance;
    EXPECT_NEAR(sample->pdf / expected, 1, 2e-4) << distance;
  }
}

TEST(TriangleMesh, DegenerateTrianglesAreHarmless) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<TriangleMesh> meshes = {One({0, 0, 0}, {0, 0, 0}, {0, 0, 0}), One({0, 0, 0}, {1, 1, 1}, {2, 2, 2}),
                                            One({0, 0, 0}, {1, 0, 0}, {0, nan, 0}),
                                            One({0, 0, 0}, {1, 0, 0}, {0, kInfinity, 0})};
  for (const TriangleMesh& mesh : meshes) {
    EXPECT_EQ(mesh.PrimitiveArea(0), 0);
    EXPECT_EQ(mesh.SampleArea(0, {0.2, 0.7}).pdf, 0);
    EXPECT_FALSE(mesh.SampleSolidAngle(0, {0, 1, 5}, {0.2, 0.7}));
    EXPECT_EQ(mesh.PdfSolidAngle(0, {0, 1, 5}, {0, 0, 0}, {0, 0, 1}), 0);
    EXPECT_FALSE(mesh.Intersect({{0, 0, 5}, {0, 0, -1}, kInfinity, {}}, 0));
    EXPECT_NEAR(Length(mesh.SampleArea(0, {0.2, 0.7}).n), 1, 1e-6);
    const Vec2d u = mesh.InvertArea(0, {0.1f, 0.1f, 0});
    EXPECT_TRUE(u.x >= 0 && u.x <= 1 && u.y >= 0 && u.y <= 1) << u;
  }
}

TEST(TriangleMesh, RefusesWhatDoesNotFit) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THROW(TriangleMesh(p, {}, {}, {0, 1, 3}), Error);
  EXPECT_THROW(TriangleMesh(p, {}, {}, {0, 1, -1}), Error);
  EXPECT_THROW(TriangleMesh(p, {}, {}, {0, 1}), Error);
  EXPECT_THROW(TriangleMesh(p, {{0, 0, 1}}, {}, {0, 1, 2}), Error);
  EXPECT_THROW(TriangleMesh(p, {}, {{0, 0}}, {0, 1, 2}), Error);
}

}  // namespace
}  // namespace dapple
