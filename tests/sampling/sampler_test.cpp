#include "src/sampling/sampler.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace dapple {
namespace {

// Every elementary interval of a (0, m, 2)-net in base 2 holds exactly one point.
void ExpectNet(const std::vector<Vec2d>& points) {
  const int m = static_cast<int>(std::lround(std::log2(points.size())));
  for (int xBits = 0; xBits <= m; ++xBits) {
    const int columns = 1 << xBits, rows = 1 << (m - xBits);
    std::vector<int> count(points.size());
    for (const Vec2d& p : points)
      ++count[static_cast<size_t>(static_cast<int>(p.y * rows) * columns + static_cast<int>(p.x * columns))];
    for (int c : count) ASSERT_EQ(c, 1) << columns << " x " << rows;
  }
}

TEST(Sampler, FirstTwoDimensionsOfEveryBlockAreNets) {
  for (int block : {0, 1, 7})
    for (int pass : {0, 1}) {
      std::vector<Vec2d> points;
      for (int i = 0; i < 256; ++i) {
        Sampler sampler = Sampler::ForPixel(3, {5, 9}, pass + 2 * i);
        sampler.StartBlock(block);
        points.push_back(sampler.Get2D());
      }
      ExpectNet(points);
    }
}

// The samples that one path branches into are stratified, and so are those of many paths together; the branches of two
// vertices are independent of each other and of the path's own numbers.
TEST(Sampler, BranchesAreNetsOfTheirOwn) {
  constexpr int kBranches = 16;
  double own = 0, other = 0;
  std::vector<Vec2d> points;
  for (int i = 0; i < 64; ++i) {
    Sampler sampler = Sampler::ForPixel(3, {5, 9}, 2 * i), next = sampler;
    sampler.StartBlock(2);
    next.StartBlock(3);
    std::vector<Vec2d> branches;
    for (int j = 0; j < kBranches; ++j) {
      branches.push_back(sampler.Branch(j, kBranches).Get2D());
      other += (branches.back().x - 0.5) * (next.Branch(j, kBranches).Get1D() - 0.5);
    }
    own += (branches[0].x - 0.5) * (sampler.Get1D() - 0.5);
    ExpectNet(branches);
    points.insert(points.end(), branches.begin(), branches.end());
  }
  ExpectNet(points);
  EXPECT_LT(std::abs(own / 64 * 12) * std::sqrt(64), 4.5);
  EXPECT_LT(std::abs(other / 1024 * 12) * std::sqrt(1024), 4.5);
}

// A path that parts from another is as well stratified, and independent of it in each block.
TEST(Sampler, ForksAreNetsIndependentOfTheirPath) {
  constexpr int kCount = 4096;
  double sums[3] = {0, 0, 0};
  std::vector<Vec2d> points;
  for (int i = 0; i < kCount; ++i) {
    Sampler path = Sampler::ForPixel(3, {5, 9}, 2 * i);
    path.StartBlock(2);
    Sampler fork = path.Fork(), again = fork;
    fork.StartBlock(3);
    path.StartBlock(3);
    again.StartBlock(2);
    points.push_back(fork.Get2D());
    Sampler second = again.Fork();
    second.StartBlock(3);
    sums[0] += (points.back().x - 0.5) * (path.Get1D() - 0.5);
    sums[1] += (points.back().x - 0.5) * (second.Get1D() - 0.5);
    // Path stands at block 3 by now: another fork than the one at block 2.
    Sampler sibling = path.Fork();
    sibling.StartBlock(3);
    sums[2] += (points.back().x - 0.5) * (sibling.Get1D() - 0.5);
  }
  ExpectNet(points);
  for (const double sum : sums) EXPECT_LT(std::abs(sum / kCount * 12) * std::sqrt(kCount), 4.5);
}

TEST(Sampler, LightPathsOfSuccessivePassesContinueOneSequence) {
  std::vector<Vec2d> points;
  for (int pass : {0, 2, 4, 6})
    for (int i = 0; i < 64; ++i) points.push_back(Sampler::ForLightPath(1, i, pass, 64).Get2D());
  ExpectNet(points);
}

TEST(Sampler, EachDimensionIsStratified) {
  constexpr int kCount = 1024;
  for (int dimension = 0; dimension < Sampler::kBlockDimensions; ++dimension) {
    std::vector<int> count(kCount);
    for (int i = 0; i < kCount; ++i) {
      Sampler sampler = Sampler::ForLightPath(11, i, 0, kCount);
      double u = 0;
      for (int d = 0; d <= dimension; ++d) u = sampler.Get1D();
      ASSERT_GE(u, 0);
      ASSERT_LT(u, 1);
      ++count[static_cast<size_t>(u * kCount)];
    }
    for (int c : count) ASSERT_EQ(c, 1) << "dimension " << dimension;
  }
}

// Errors of estimates that should know nothing of each other: their correlation over n seeds has a standard deviation
// of 1 / sqrt(n), and 4.5 of them reject by chance once in 150,000.
TEST(Sampler, ErrorsOfPixelsReplicatesAndBlocksAreUncorrelated) {
  constexpr int kSeeds = 4096, kPoints = 24;
  struct Stream {
    Vec2i pixel;
    int replicate, block;
  };
  const auto error = [](uint64_t seed, const Stream& stream) {
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) {
      Sampler sampler = Sampler::ForPixel(seed, stream.pixel, stream.replicate + 2 * i);
      sampler.StartBlock(stream.block);
      const double u = sampler.Get1D();
      sum += u * u - 1.0 / 3;
    }
    return sum;
  };
  const auto correlation = [&](const Stream& first, const Stream& second) {
    double xy = 0, xx = 0, yy = 0;
    for (uint64_t seed = 0; seed < kSeeds; ++seed) {
      const double x = error(seed, first), y = error(seed, second);
      xy += x * y;
      xx += x * x;
      yy += y * y;
    }
    return std::abs(xy) / std::sqrt(xx * yy) * std::sqrt(kSeeds);
  };
  EXPECT_LT(correlation({{0, 0}, 0, 0}, {{1, 0}, 0, 0}), 4.5);
  EXPECT_LT(correlation({{0, 0}, 0, 0}, {{0, 1}, 0, 0}), 4.5);
  EXPECT_LT(correlation({{0, 0}, 0, 0}, {{0, 0}, 1, 0}), 4.5);
  EXPECT_LT(correlation({{0, 0}, 0, 0}, {{0, 0}, 0, 1}), 4.5);
  EXPECT_LT(correlation({{0, 0}, 0, 1}, {{0, 0}, 0, 2}), 4.5);
}

// Within one estimate, blocks must be independent point by point: they are different decisions of the same path.
TEST(Sampler, BlocksOfOneSampleAreUncorrelated) {
  constexpr int kCount = 4096;
  double sum = 0;
  for (int i = 0; i < kCount; ++i) {
    Sampler sampler = Sampler::ForPixel(1, {0, 0}, 2 * i);
    const double first = sampler.Get1D();
    sampler.StartBlock(1);
    sum += (first - 0.5) * (sampler.Get1D() - 0.5);
  }
  EXPECT_LT(std::abs(sum / kCount * 12) * std::sqrt(kCount), 4.5);
}

// A smooth integrand in five dimensions: scrambled Sobol' points beat the 1/n of independent ones by far.
TEST(Sampler, VarianceFallsFasterThanOfIndependentPoints) {
  const auto meanSquaredError = [](int count) {
    double error = 0;
    constexpr int kSeeds = 32;
    for (uint64_t seed = 0; seed < kSeeds; ++seed) {
      double sum = 0;
      for (int i = 0; i < count; ++i) {
        Sampler sampler = Sampler::ForLightPath(seed, i, 0, count);
        double f = 1;
        for (int d = 0; d < 5; ++d) f *= 0.5 + sampler.Get1D();
        sum += f;
      }
      error += (sum / count - 1) * (sum / count - 1) / kSeeds;
    }
    return error;
  };
  const double independent = (std::pow(1 + 1.0 / 12, 5) - 1) / 1024;
  EXPECT_LT(meanSquaredError(1024), independent / 20);
  EXPECT_GT(meanSquaredError(1024), 0);
}

}  // namespace
}  // namespace dapple
