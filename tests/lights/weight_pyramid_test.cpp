#include "lights/weight_pyramid.h"

#include <gtest/gtest.h>

#include "tests/lights/light_cases.h"

namespace dapple {
namespace {

std::vector<double> RandomWeights(int count, unsigned seed) {
  RandomNumbers random(seed);
  std::vector<double> weights;
  for (int i = 0; i < count; ++i) weights.push_back(std::max(0.0, random.Get1D() - 0.4));
  weights[static_cast<size_t>(count / 2)] = 50;
  return weights;
}

TEST(WeightPyramid, ProbabilitiesAreTheSharesOfTheWeights) {
  for (const Vec2i& size : {Vec2i(1, 1), Vec2i(2, 1), Vec2i(1, 5), Vec2i(17, 9), Vec2i(8, 8)}) {
    const std::vector<double> weights = RandomWeights(size.x * size.y, 1);
    const WeightPyramid pyramid(weights, size.x, size.y);
    double sum = 0, all = 0;
    for (const double w : weights) all += w;
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const double p = pyramid.Probability(pyramid.Root().level, {x, y});
        EXPECT_NEAR(p, weights[static_cast<size_t>(y * size.x + x)] / all, 1e-6);
        sum += p;
      }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(WeightPyramid, DrawProbabilityAndInverseAgree) {
  const std::vector<double> weights = RandomWeights(17 * 9, 2);
  const WeightPyramid pyramid(weights, 17, 9);
  RandomNumbers random(3);
  std::vector<double> expected, observed(weights.size());
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 17; ++x) expected.push_back(pyramid.Probability(pyramid.Root().level, {x, y}));
  for (int i = 0; i < 20000; ++i) {
    const Vec2d u = random.Get2D();
    Vec2d rest = u;
    const PyramidSample drawn = pyramid.Sample(pyramid.Root(), &rest);
    ASSERT_GT(weights[static_cast<size_t>(drawn.cell.y * 17 + drawn.cell.x)], 0);
    ASSERT_EQ(drawn.probability, pyramid.Probability(pyramid.Root().level, drawn.cell));
    ASSERT_TRUE(rest.x >= 0 && rest.x < 1 && rest.y >= 0 && rest.y < 1);
    const Vec2d back = pyramid.Invert(pyramid.Root().level, drawn.cell, rest);
    ASSERT_NEAR(back.x, u.x, 1e-14);
    ASSERT_NEAR(back.y, u.y, 1e-14);
    observed[static_cast<size_t>(drawn.cell.y * 17 + drawn.cell.x)] += 1;
  }
  double statistic = 0;
  int cells = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    if (expected[i] == 0) continue;
    const double e = expected[i] * 20000;
    statistic += (observed[i] - e) * (observed[i] - e) / e;
    ++cells;
  }
  // The 99.99 % quantile of chi-square with n degrees of freedom is below n + 4 sqrt(2 n) + 10.
  EXPECT_LT(statistic, cells + 4 * std::sqrt(2. * cells) + 10);
}

// A weight far below what float resolves beside the others is still drawn from its parent alone, and keeps its density.
TEST(WeightPyramid, TinyWeightsStayPositive) {
  const WeightPyramid pyramid(std::vector<double>{1e200, 0, 0, 0, 1e100, 1e-90, 0, 0}, 4, 2);
  EXPECT_GT(pyramid.Weight({0, {0, 1}}), 0);
  EXPECT_GT(pyramid.Weight({0, {1, 1}}), 0);
  EXPECT_EQ(pyramid.Weight({0, {1, 0}}), 0);
  EXPECT_EQ(pyramid.Weight({1, {1, 0}}), 0);
}

}  // namespace
}  // namespace dapple
