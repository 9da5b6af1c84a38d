#include "src/base/frame.h"

#include <cmath>

#include <gtest/gtest.h>

#include "src/base/hash.h"

namespace dapple {
namespace {

float Uniform(uint64_t i, uint64_t dimension) { return static_cast<float>(Hash(i, dimension) >> 40) * 0x1p-24f; }

// Directions all over the sphere, the poles and their neighbours among them.
std::vector<Vec3> SomeNormals() {
  std::vector<Vec3> normals = {{0, 0, 1},
                               {0, 0, -1},
                               {1, 0, 0},
                               {0, -1, 0},
                               Normalize(Vec3(1e-4f, 0, -1)),
                               Normalize(Vec3(1e-20f, -1e-20f, -1)),
                               Normalize(Vec3(1e-7f, 1e-7f, 1)),
                               {1, 0, -0.f}};
  for (uint64_t i = 0; i < 1000; ++i)
    normals.push_back(Normalize(Vec3(2 * Uniform(i, 0) - 1, 2 * Uniform(i, 1) - 1, 2 * Uniform(i, 2) - 1)));
  return normals;
}

void ExpectOrthonormal(const Frame& frame) {
  EXPECT_NEAR(Length(frame.s), 1, 1e-6);
  EXPECT_NEAR(Length(frame.t), 1, 1e-6);
  EXPECT_NEAR(Dot(frame.s, frame.t), 0, 1e-6);
  EXPECT_NEAR(Dot(frame.s, frame.n), 0, 1e-6);
  EXPECT_NEAR(Dot(frame.t, frame.n), 0, 1e-6);
  EXPECT_LT(Length(Cross(frame.s, frame.t) - frame.n), 2e-6f);
}

TEST(Frame, OrthonormalAndRightHandedAroundEveryNormal) {
  for (const Vec3& n : SomeNormals()) {
    ExpectOrthonormal(Frame::FromZ(n));
    EXPECT_EQ(Frame::FromZ(n).n, n);
    ExpectOrthonormal(Frame::FromZX(n, {0.3f, -2, 0.1f}));
  }
}

TEST(Frame, LocalAndWorldUndoEachOther) {
  for (const Vec3& n : SomeNormals()) {
    const Frame frame = Frame::FromZ(n);
    const Vec3 v(0.3f, -0.8f, 2);
    EXPECT_LT(Length(frame.ToLocal(frame.ToWorld(v)) - v), 3e-6f);
    EXPECT_LT(Length(frame.ToLocal(n) - Vec3(0, 0, 1)), 1e-6f);
    EXPECT_NEAR(CosTheta(frame.ToLocal(v)), Dot(v, n), 1e-6);
  }
}

TEST(Frame, KeepsTheTangentWhereItCan) {
  const Frame frame = Frame::FromZX({0, 0, 1}, {3, 0, 7});
  EXPECT_EQ(frame.s, Vec3(1, 0, 0));
  EXPECT_EQ(frame.t, Vec3(0, 1, 0));
  for (const Vec3& n : SomeNormals()) {
    const Vec3 tangent(1, 2, -1);
    EXPECT_GE(Dot(Frame::FromZX(n, tangent).s, tangent), 0);
    EXPECT_NEAR(Dot(Frame::FromZX(n, tangent).t, tangent), 0, 1e-5);
  }
}

TEST(Frame, TangentsThatGiveNoDirection) {
  for (const Vec3& n : SomeNormals())
    for (const Vec3& tangent : {Vec3(0), n, -n, n * 1e10f, n * 1e-10f, Vec3(NAN, 0, 0)})
      ExpectOrthonormal(Frame::FromZX(n, tangent));
}

TEST(Frame, TangentsNearTheNormal) {
  for (const Vec3& n : SomeNormals())
    for (const float distance : {1e-2f, 1e-4f, 1e-5f, 2e-6f, 1e-7f})
      ExpectOrthonormal(Frame::FromZX(n, n + Frame::FromZ(n).t * distance));
}

TEST(Frame, TangentsOfAnyLength) {
  for (const float length : {1e-12f, 1e-6f, 1e6f, 1e12f}) {
    const Frame frame = Frame::FromZX({0, 0, 1}, Vec3(length, length, 0));
    ExpectOrthonormal(frame);
    EXPECT_NEAR(frame.s.x, std::sqrt(0.5f), 1e-6) << length;
  }
}

TEST(Frame, TrigonometryOfLocalDirections) {
  for (const Vec3& w : SomeNormals()) {
    EXPECT_NEAR(Sin2Theta(w) + Cos2Theta(w), 1, 1e-6);
    EXPECT_NEAR(SinTheta(w), std::sin(std::acos(std::clamp(w.z, -1.f, 1.f))), 5e-4);
    EXPECT_EQ(AbsCosTheta(w), std::abs(w.z));
  }
  EXPECT_TRUE(SameHemisphere({1, 0, 0.1f}, {-1, 0, 0.2f}));
  EXPECT_FALSE(SameHemisphere({1, 0, 0.1f}, {1, 0, -0.1f}));
  // A degree off the pole, sin from 1 - cos^2 in float would be wrong in the fourth digit.
  EXPECT_NEAR(SinTheta(Vec3(1e-4f, 0, 1)), 1e-4, 1e-10);
}

TEST(Vec, NormalizeKeepsPrecisionOverItsRange) {
  for (const float length : {1e-18f, 1e-10f, 1.f, 1e10f, 1e18f})
    EXPECT_NEAR(Length(Normalize(Vec3(length, -2 * length, 3 * length))), 1, 3e-7) << length;
  EXPECT_EQ(Normalize(Vec3(0)), Vec3(0));
}

TEST(Vec, FaceForwardAndFinite) {
  EXPECT_EQ(FaceForward({0, 0, 1}, {1, 0, -1}), Vec3(0, 0, -1));
  EXPECT_EQ(FaceForward({0, 0, 1}, {1, 0, 1}), Vec3(0, 0, 1));
  EXPECT_TRUE(IsFinite(Vec3(1, 2, 3)));
  EXPECT_FALSE(IsFinite(Vec3(1, NAN, 3)));
  EXPECT_FALSE(IsFinite(Vec3(1, 2, -INFINITY)));
}

}  // namespace
}  // namespace dapple
