#include "src/photons/photon_map.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "src/base/hash.h"
#include "src/photons/kernel.h"
#include "src/photons/radius_schedule.h"

namespace dapple {
namespace {

std::vector<Vec3> UniformCloud(size_t count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = {uniform(random), uniform(random), uniform(random)};
  return points;
}

std::vector<int> Numbers(size_t count) {
  std::vector<int> numbers(count);
  for (size_t i = 0; i < count; ++i) numbers[i] = static_cast<int>(i);
  return numbers;
}

std::vector<int> Within(const PhotonMap<int>& map, const Vec3& p, float radius) {
  std::vector<int> found;
  map.ForEachWithin(p, radius, [&](const Vec3&, int photon, float) { found.push_back(photon); });
  std::sort(found.begin(), found.end());
  return found;
}

TEST(PhotonForest, FindsTheNearestPoints) {
  constexpr size_t kPoints = 20000;  // several buckets
  std::vector<Vec3> points;
  for (uint64_t i = 0; i < kPoints; ++i) {
    const auto coordinate = [&](uint64_t axis) { return static_cast<float>(Hash(i, axis) >> 40) * 0x1p-24f; };
    points.emplace_back(coordinate(0), coordinate(1), coordinate(2));
  }
  const PhotonForest forest{std::vector<Vec3>(points)};
  std::vector<float> found;
  for (const float radius : {0.02f, 0.1f, 2.f})
    for (size_t query = 0; query < kPoints; query += 500) {
      const Vec3 p = points[query] + Vec3(0.003f, 0, 0);
      std::vector<float> expected;
      for (const Vec3& point : points) {
        const float squared = DistanceSquared(p, point);
        if (squared < radius * radius) expected.push_back(squared);
      }
      std::sort(expected.begin(), expected.end());
      constexpr size_t kMost = 17;
      if (expected.size() > kMost) expected.resize(kMost);
      forest.FindNearest(p, radius, kMost, &found);
      ASSERT_EQ(found.size(), expected.size());
      if (!found.empty()) {
        ASSERT_FLOAT_EQ(found.front(), expected.back());
      }
      std::sort(found.begin(), found.end());
      for (size_t i = 0; i < found.size(); ++i) ASSERT_FLOAT_EQ(found[i], expected[i]);
    }
}

TEST(PhotonMap, FindsJustThePhotonsWithinTheRadius) {
  const std::vector<Vec3> points = UniformCloud(50000, 1);
  const PhotonMap<int> map(points, Numbers(points.size()));
  ASSERT_EQ(map.Size(), points.size());
  for (const Vec3& p : UniformCloud(40, 2))
    for (float radius : {0.01f, 0.1f, 0.4f, 4.f}) {
      std::vector<int> expected;
      for (size_t i = 0; i < points.size(); ++i)
        if (DistanceSquared(points[i], p) < radius * radius) expected.push_back(static_cast<int>(i));
      EXPECT_EQ(Within(map, p, radius), expected);
    }
}

TEST(PhotonMap, VisitsPayloadsWithTheirOwnPositionsAndDistances) {
  const std::vector<Vec3> points = UniformCloud(30000, 3);
  const PhotonMap<int> map(points, Numbers(points.size()));
  const Vec3 center(0.1f, -0.2f, 0.3f);
  int visited = 0;
  map.ForEachWithin(center, 0.5f, [&](const Vec3& p, int photon, float distanceSquared) {
    ++visited;
    EXPECT_EQ(p, points[static_cast<size_t>(photon)]);
    EXPECT_FLOAT_EQ(distanceSquared, DistanceSquared(p, center));
  });
  EXPECT_GT(visited, 1000);
}

TEST(PhotonMap, EmptyMapFindsNothing) {
  const PhotonMap<int> map({}, {});
  EXPECT_TRUE(Within(map, Vec3(0), 1e10f).empty());
  EXPECT_TRUE(Within(PhotonMap<int>(), Vec3(0), 1e10f).empty());
}

// A build that cannot part them would take time with their square: hours.
TEST(PhotonMap, AMillionPhotonsAtOnePointOrOnALineAreFound) {
  constexpr size_t kCount = 1000000;
  const PhotonMap<int> point(std::vector<Vec3>(kCount, Vec3(1, 2, 3)), Numbers(kCount));
  EXPECT_EQ(Within(point, Vec3(1, 2, 3), 1e-3f).size(), kCount);
  EXPECT_TRUE(Within(point, Vec3(1, 2, 3.01f), 1e-3f).empty());

  std::vector<Vec3> positions(kCount);
  for (size_t i = 0; i < kCount; ++i) positions[i] = Vec3(static_cast<float>(i) * 0x1p-20f, 0, 0);
  const PhotonMap<int> line(positions, Numbers(kCount));
  EXPECT_EQ(Within(line, Vec3(0.5f, 0, 0), 0x1.8p-20f).size(), 3u);
}

TEST(PhotonMap, OrderDoesNotDependOnThreads) {
  const std::vector<Vec3> points = UniformCloud(200000, 4);
  std::vector<int> order[2];
  for (int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    const PhotonMap<int> map(points, Numbers(points.size()));
    map.ForEachWithin(Vec3(0), 10, [&](const Vec3&, int photon, float) { order[threads / 2].push_back(photon); });
  }
  EXPECT_EQ(order[0].size(), points.size());
  EXPECT_EQ(order[0], order[1]);
}

class Kernels : public ::testing::TestWithParam<KernelShape> {
 protected:
  /// The integral of f(K(d)) over the disk of radius `until`.
  template <typename F>
  static double Integrate(const Kernel& kernel, double until, F&& f) {
    constexpr int kSteps = 100000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double d = until * (i + 0.5) / kSteps;
      sum += f(static_cast<double>(kernel(static_cast<float>(d * d)))) * 2 * kPiD * d * until / kSteps;
    }
    return sum;
  }

  static constexpr float kRadius = 0.37f;
};

TEST_P(Kernels, IntegrateToOneOverTheirDisk) {
  const Kernel kernel(GetParam(), kRadius);
  EXPECT_NEAR(Integrate(kernel, kRadius, [](double k) { return k; }), 1, 1e-5);
  EXPECT_NEAR(kernel(kRadius * kRadius), 0, 1e-5);
  EXPECT_NEAR(1 / Integrate(kernel, kRadius, [](double k) { return k * k; }),
              Kernel::EffectiveArea(GetParam(), kRadius), 1e-5);
}

TEST_P(Kernels, DrawPointsByTheirDensity) {
  const Kernel kernel(GetParam(), kRadius);
  for (double u : {0.0, 0.1, 0.3, 0.5, 0.8, 0.99, 1.0}) {
    // The share u of the kernel lies nearer to the middle than the point drawn with u.
    const double distance = static_cast<double>(kernel.Sample({u, 0.3}).length());
    EXPECT_NEAR(Integrate(kernel, distance, [](double k) { return k; }), u, 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Kernels, ::testing::Values(KernelShape::Epanechnikov, KernelShape::Cone));

TEST(RadiusSchedule, FollowsTheRecurrenceAndPairsPasses) {
  constexpr double kAlpha = 0.7;
  double radiusSquared = 1;
  for (int i = 1; i < 200; ++i) {
    const int pass = 2 * (i - 1);
    EXPECT_NEAR(Sqr(RadiusFactor(pass, kAlpha)), radiusSquared, 1e-5 * radiusSquared);
    EXPECT_EQ(RadiusFactor(pass, kAlpha), RadiusFactor(pass + 1, kAlpha));
    radiusSquared *= (i + kAlpha) / (i + 1);
  }
}

}  // namespace
}  // namespace dapple
