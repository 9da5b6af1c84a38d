#include "src/render/slope_fit.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random_numbers.h"

namespace dapple {
namespace {

TEST(SlopeFit, PowersHaveTheirExponent) {
  std::vector<double> x, y;
  for (int i = 0; i < 9; ++i) {
    x.push_back(std::exp2(0.5 * i));
    y.push_back(3.5 * std::pow(x.back(), -0.8));
  }
  EXPECT_NEAR(*LogLogSlope(x, y), -0.8, 1e-12);
  EXPECT_FALSE(LogLogSlope(std::vector<double>{2, 2}, std::vector<double>{1, 3}));
  EXPECT_FALSE(LogLogSlope({}, {}));
}

// Quantiles of tables (one side): of one degree of freedom it is tan(pi (p - 1/2)), of two (2p - 1) / sqrt(2 p (1 -
// p)).
TEST(SlopeFit, StudentsQuantiles) {
  for (const double p : {0.6, 0.9, 0.975, 0.999}) {
    EXPECT_NEAR(StudentTQuantile(p, 1), std::tan(M_PI * (p - 0.5)), 1e-9 * std::tan(M_PI * (p - 0.5)));
    EXPECT_NEAR(StudentTQuantile(p, 2), (2 * p - 1) / std::sqrt(2 * p * (1 - p)), 1e-9);
    EXPECT_NEAR(StudentTQuantile(1 - p, 5), -StudentTQuantile(p, 5), 1e-9);
  }
  EXPECT_NEAR(StudentTQuantile(0.975, 4), 2.776445, 1e-6);
  EXPECT_NEAR(StudentTQuantile(0.975, 9), 2.262157, 1e-6);
  EXPECT_NEAR(StudentTQuantile(0.995, 30), 2.749996, 1e-6);
  EXPECT_NEAR(StudentTQuantile(0.5, 7), 0, 1e-12);
}

TEST(SlopeFit, OneSeedHasNoInterval) {
  EXPECT_FALSE(EstimateSlope({}));
  const auto one = EstimateSlope(std::vector<double>{-1.5});
  EXPECT_EQ(one->slope, -1.5);
  EXPECT_FALSE(one->halfWidth);
  const auto two = EstimateSlope(std::vector<double>{-1, -2});
  EXPECT_NEAR(*two->halfWidth, 12.7062 * std::sqrt(0.5) / std::sqrt(2.), 1e-3);
}

// The error of a run of N passes: E(n) = |sum of n normal numbers / n|^2 over 40 pixels. Runs are independent, their
// snapshots are not. The interval must hold the true slope, -1, in 95 % of the experiments: of 400 with the
// probability 0.95 fewer than 361 or more than 397 succeed with a probability below 1e-3 together (binomial).
TEST(SlopeFit, IntervalsHoldTheTruthAsOftenAsTheySay) {
  testing::UniformNumbers random(17);
  const auto normal = [&] {
    const Vec2d u = random.Get2D();
    return std::sqrt(-2 * std::log(1 - u.x)) * std::cos(2 * M_PI * u.y);
  };
  constexpr int kExperiments = 400, kSeeds = 5, kPasses = 128, kPixels = 40;
  int held = 0;
  for (int experiment = 0; experiment < kExperiments; ++experiment) {
    std::vector<double> slopes;
    for (int seed = 0; seed < kSeeds; ++seed) {
      std::vector<double> sums(kPixels), passes, errors;
      for (int pass = 1; pass <= kPasses; ++pass) {
        for (double& sum : sums) sum += normal();
        if ((pass & (pass - 1)) != 0) continue;
        double error = 0;
        for (const double sum : sums) error += sum * sum / (double{kPixels} * pass * pass);
        passes.push_back(pass);
        errors.push_back(error);
      }
      slopes.push_back(*LogLogSlope(passes, errors));
    }
    const auto estimate = EstimateSlope(slopes);
    if (std::abs(estimate->slope + 1) < *estimate->halfWidth) ++held;
  }
  EXPECT_GE(held, 361);
  EXPECT_LE(held, 397);
}

TEST(TimeToReach, BetweenBeforeAndBeyondThePoints) {
  const std::vector<double> seconds{1, 2, 4}, errors{1, 0.25, 0.0625};  // 1 / t^2
  using Kind = ReachTime::Kind;
  const ReachTime between = TimeToReach(seconds, errors, 1. / 9, -2);
  EXPECT_EQ(between.kind, Kind::Measured);
  EXPECT_NEAR(between.seconds, 3, 1e-12);
  EXPECT_EQ(TimeToReach(seconds, errors, 0.0625, -2).seconds, 4);
  EXPECT_EQ(TimeToReach(seconds, errors, 2, -2).kind, Kind::AtMost);
  const ReachTime beyond = TimeToReach(seconds, errors, 0.01, -2);
  EXPECT_EQ(beyond.kind, Kind::Extrapolated);
  EXPECT_NEAR(beyond.seconds, 10, 1e-9);
  EXPECT_EQ(TimeToReach(seconds, errors, 0.01, std::nullopt).kind, Kind::Never);
  EXPECT_EQ(TimeToReach(seconds, errors, 0.01, 0.1).kind, Kind::Never);
}

}  // namespace
}  // namespace dapple
