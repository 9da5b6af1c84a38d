#include "src/base/octahedral.h"

#include <random>

#include <gtest/gtest.h>

namespace dapple {
namespace {

TEST(OctahedralVector, KeepsDirectionsWithinItsBound) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3 v = Normalize(Vec3(normal(random), normal(random), normal(random)));
    const Vec3 decoded = OctahedralVector(v).Decode();
    EXPECT_NEAR(Length(decoded), 1, 1e-6);
    worst = std::max<double>(worst, Length(decoded - v));
  }
  EXPECT_LT(worst, 6.5e-5);
  EXPECT_GT(worst, 6e-5);
}

TEST(OctahedralVector, KeepsAxesExactly) {
  for (const Vec3& v : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)})
    EXPECT_EQ(OctahedralVector(v).Decode(), v);
}

}  // namespace
}  // namespace dapple
