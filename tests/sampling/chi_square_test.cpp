// The harness itself: quadrature and tail are right, true densities pass at the rate that they should, false ones fail.
#include "tests/support/chi_square.h"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

namespace dapple::testing {
namespace {

TEST(Quadrature, IntegratesSmoothAndBrokenFunctions) {
  const auto smooth = [](const Coordinates<2>& x) { return std::exp(x[0]) * std::cos(x[1]); };
  EXPECT_NEAR((Integrate<2>(smooth, {{0, 0}, {1, 1}}, 1e-9, 20)), (std::exp(1) - 1) * std::sin(1), 1e-8);
  const auto step = [](const Coordinates<1>& x) { return x[0] < 0.3 ? 1.0 : 0.0; };
  EXPECT_NEAR((Integrate<1>(step, {{0}, {1}}, 1e-7, 30)), 0.3, 1e-6);
  const auto ball = [](const Coordinates<4>& x) {
    return x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3] < 1 ? 1.0 : 0.0;
  };
  EXPECT_NEAR((Integrate<4>(ball, {{0, 0, 0, 0}, {1, 1, 1, 1}}, 1e-5, 18)), std::pow(std::numbers::pi, 2) / 32, 5e-3);
}

TEST(ChiSquareHarness, TailIsThatOfTables) {
  EXPECT_NEAR(ChiSquareTail(3.841458820694124, 1), 0.05, 1e-9);
  EXPECT_NEAR(ChiSquareTail(18.307038053275146, 10), 0.05, 1e-9);
  EXPECT_NEAR(ChiSquareTail(149.4492527790, 100), 0.001, 1e-9);
  EXPECT_NEAR(SidakLevel(0.01, 1), 0.01, 1e-15);
  EXPECT_NEAR(1 - std::pow(1 - SidakLevel(0.01, 50), 50), 0.01, 1e-12);
}

// Of 400 true hypotheses a tenth has p below 0.1: 40 of them, with a standard deviation of 6.
TEST(ChiSquareHarness, TrueDensitiesFailAsOftenAsTheLevelSays) {
  int below = 0;
  for (uint64_t seed = 1; seed <= 400; ++seed) {
    const ChiSquareOptions options{.samples = 2000, .rows = 4, .columns = 8, .seed = seed};
    below += ChiSquareOnInterval([](double u) { return std::sqrt(u); }, [](double x) { return 2 * x; }, 0, 1, options)
                 .pValue < 0.1;
  }
  EXPECT_NEAR(below, 40, 4 * 6);
}

TEST(ChiSquareHarness, MoreFitsThanTheShareFail) {
  CountFit();
  EXPECT_NONFATAL_FAILURE(CountFit(), "more fits than the share");
}

TEST(ChiSquareHarness, FitsWithoutAShareFail) { EXPECT_NONFATAL_FAILURE(CountFit(), "needs its share"); }

TEST(ChiSquareHarness, RejectsWhatIsFalse) {
  const ChiSquareOptions options{.samples = 50'000, .rows = 8, .columns = 16, .seed = 2};
  const auto disk = [&](const auto& radius, double pdf) {
    const auto sample = [&](const Vec2d& u) { return DiskDomain::Point(radius(u.x), u.y); };
    return ChiSquareOnDisk(
        sample, [&](const Vec2d&) { return pdf; }, options);
  };
  constexpr double kTrue = 1 / std::numbers::pi;
  EXPECT_GT(disk([](double u) { return u; }, kTrue).pValue, 1e-3);
  EXPECT_LT(disk([](double u) { return u * u; }, kTrue).pValue, 1e-9);       // not uniform
  EXPECT_LT(disk([](double u) { return 1.02 * u; }, kTrue).pValue, 1e-9);    // beyond the rim
  EXPECT_LT(disk([](double u) { return u; }, 0.98 * kTrue).pValue, 1e-9);    // a total below one
  EXPECT_EQ(disk([](double u) { return u; }, 1.001 * kTrue).pValue, 0);      // a total above one
  EXPECT_LT(disk([](double) { return std::nan(""); }, kTrue).pValue, 1e-9);  // no point at all
}

}  // namespace
}  // namespace dapple::testing
