#include "src/image/filter.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "src/base/hash.h"
#include "src/base/numerics.h"

namespace dapple {
namespace {

struct Case {
  std::string name;
  Filter filter;
};

std::vector<Case> AllFilters() {
  return {{"box", Filter::Box()},
          {"wide box", Filter::Box({1.5, 0.75})},
          {"triangle", Filter::Triangle({2, 1})},
          {"gaussian v3", Filter::Gaussian()},
          {"gaussian v3, flat", Filter::Gaussian({2, 3}, 1e-9)},
          {"gaussian v4", Filter::GaussianSigma()},
          {"gaussian v4, needle", Filter::GaussianSigma({2, 2}, 1e-3)},
          {"mitchell", Filter::Mitchell()},
          {"mitchell, ringing", Filter::Mitchell({2.5, 2}, 0, 1)},
          {"sinc", Filter::Sinc()},
          {"sinc, cut between its zeros", Filter::Sinc({3.3, 1.7}, 2.2)},
          {"sinc, wide", Filter::Sinc({40, 4}, 0.5)}};
}

// Sum over a regular grid over the support, far finer than any lobe.
template <typename F>
double Integrate(const Filter& filter, F f) {
  constexpr int kSteps = 600;
  const Vec2d radius = filter.Radius();
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j)
      sum += f(radius.x * (2 * (i + 0.5) / kSteps - 1), radius.y * (2 * (j + 0.5) / kSteps - 1));
  return sum * 4 * radius.x * radius.y / (kSteps * kSteps);
}

TEST(Filter, IntegralsInClosedForm) {
  EXPECT_DOUBLE_EQ(Filter::Box({1.5, 0.75}).Integral(), 3 * 1.5);
  EXPECT_DOUBLE_EQ(Filter::Triangle({2, 1}).Integral(), 4);
  // Mitchell's cubics sum to one over the integers for every B and C, so each axis integrates to radius / 2.
  for (const double B : {0., 1. / 3, 1.})
    for (const double C : {0., 0.5, 1.}) EXPECT_NEAR(Filter::Mitchell({2, 3}, B, C).Integral(), 1 * 1.5, 1e-8);
  const auto gaussian = [](double sigma, double r) {
    return std::erf(r / (sigma * std::sqrt(2))) -
           2 * r * std::exp(-r * r / (2 * sigma * sigma)) / (sigma * std::sqrt(2 * kPiD));
  };
  EXPECT_NEAR(Filter::GaussianSigma({1.5, 2}, 0.5).Integral(), gaussian(0.5, 1.5) * gaussian(0.5, 2), 1e-8);
  EXPECT_NEAR(Filter::GaussianSigma({2, 2}, 1e-3).Integral(), 1, 1e-8);
  const double v3 = std::sqrt(kPiD / 2) * std::erf(2 * std::sqrt(2.)) - 4 * std::exp(-8.);
  EXPECT_NEAR(Filter::Gaussian({2, 2}, 2).Integral(), v3 * v3, 1e-8);
  // pbrt-v3's and v4's gaussians are one shape: sigma^2 = 1 / (2 alpha).
  EXPECT_NEAR(Filter::Gaussian({2, 2}, 2).NormalizedX(0.7), Filter::GaussianSigma({2, 2}, 0.5).NormalizedX(0.7), 1e-8);
}

TEST(Filter, ValuesOfTheBook) {
  EXPECT_DOUBLE_EQ(Filter::Triangle({2, 2}).Evaluate(0.5, -1), 1.5);
  EXPECT_NEAR(Filter::Gaussian({2, 2}, 2).Evaluate(1, 0), (std::exp(-2.) - std::exp(-8.)) * (1 - std::exp(-8.)), 1e-15);
  // Mitchell at B = C = 1/3: 8/9 at the centre, 1/18 at half the radius, 0 with slope 0 at the radius.
  EXPECT_NEAR(Filter::Mitchell().Evaluate(0, 0), 64. / 81, 1e-15);
  EXPECT_NEAR(Filter::Mitchell().Evaluate(1, 0), 1. / 18 * 8 / 9, 1e-15);
  EXPECT_NEAR(Filter::Mitchell().Evaluate(1.5, 0) / Filter::Mitchell().Evaluate(0, 0), (-5. / 144) / (8. / 9), 1e-8);
  const double window = std::sin(kPiD * 0.5 / 3) / (kPiD * 0.5 / 3);
  EXPECT_NEAR(Filter::Sinc().Evaluate(0.5, 0), 2 / kPiD * window, 1e-8);
  EXPECT_NEAR(Filter::Sinc().Evaluate(1, 0), 0, 1e-15);
  EXPECT_NEAR(Filter::Sinc().Evaluate(1e-9, 0), 1, 1e-9);
}

// Between its exact values a filter is linear: offsets that fall between them, against the formulas.
TEST(Filter, InterpolationIsWithinItsBound) {
  const Filter sinc = Filter::Sinc({4, 4}, 3), gaussian = Filter::GaussianSigma({2, 2}, 0.05);
  const auto sincOf = [](double x) { return std::sin(kPiD * x) / (kPiD * x); };
  for (int i = 0; i < 10000; ++i) {
    const double x = 3.9999 * (i + 0.5) / 10000;
    EXPECT_NEAR(sinc.Evaluate(x, 0), sincOf(x) * sincOf(x / 3), 3e-6) << x;
    const double peak = gaussian.Evaluate(0, 0);
    EXPECT_NEAR(gaussian.Evaluate(x / 10, 0) / peak, std::exp(-x * x / 100 / (2 * 0.05 * 0.05)), 3e-6) << x;
  }
}

TEST(Filter, IntegralMatchesTheValuesAndDensityIntegratesToOne) {
  for (const auto& named : AllFilters()) {
    // Lambdas of clang 14 capture no structured bindings.
    const auto& name = named.name;
    const auto& filter = named.filter;
    if (name == "gaussian v4, needle") continue;  // the grid is too coarse for it; its closed form is tested above
    EXPECT_NEAR(Integrate(filter, [&](double x, double y) { return filter.Evaluate(x, y); }) / filter.Integral(), 1,
                2e-3)
        << name;
    EXPECT_NEAR(Integrate(filter, [&](double x, double y) { return filter.Pdf({x, y}); }), 1, 2e-3) << name;
    EXPECT_NEAR(Integrate(filter, [&](double x, double y) { return filter.NormalizedX(x) * filter.NormalizedY(y); }), 1,
                2e-3)
        << name;
  }
}

TEST(Filter, EvenAndZeroOutside) {
  for (const auto& [name, filter] : AllFilters()) {
    const Vec2d r = filter.Radius();
    EXPECT_EQ(filter.Evaluate(0.3 * r.x, -0.2 * r.y), filter.Evaluate(-0.3 * r.x, 0.2 * r.y)) << name;
    EXPECT_EQ(filter.Evaluate(r.x * 1.0001, 0), 0) << name;
    EXPECT_EQ(filter.Evaluate(0, -r.y * 1.0001), 0) << name;
    EXPECT_EQ(filter.Pdf({r.x * 1.0001, 0}), 0) << name;
  }
}

TEST(Filter, WeightIsFOverPdfAndOfConstantMagnitude) {
  for (const auto& [name, filter] : AllFilters()) {
    double smallest = 1e30, largest = 0;
    constexpr int kSamples = 128;
    for (int i = 0; i < kSamples; ++i) {
      for (int j = 0; j < kSamples; ++j) {
        const FilterSample sample = filter.Sample({(i + 0.5) / kSamples, (j + 0.37) / kSamples});
        const double f = filter.Evaluate(sample.offset.x, sample.offset.y);
        const double expected = f / (filter.Pdf(sample.offset) * filter.Integral());
        EXPECT_NEAR(sample.weight, expected, 1e-5 * std::abs(expected)) << name;
        smallest = std::min<double>(smallest, std::abs(sample.weight));
        largest = std::max<double>(largest, std::abs(sample.weight));
      }
    }
    // Where f is nowhere negative, each sample counts the same.
    const bool hasLobes = name.starts_with("mitchell") || name.starts_with("sinc");
    EXPECT_LT(largest / smallest, hasLobes ? 1.05 : 1.000001) << name;
    EXPECT_NEAR(hasLobes ? 1 : smallest, 1, 1e-6) << name;
  }
  EXPECT_EQ(Filter::Box().Sample({0.1, 0.9}).weight, 1);
  EXPECT_EQ(Filter::Triangle().Sample({0.1, 0.9}).weight, 1);
}

// The mean of weight * g(x) * h(y) over all random numbers. Weights are a product of both axes, so each is run through
// by itself, far finer than a grid over both could be.
template <typename G, typename H>
double WeightedMean(const Filter& filter, G g, H h) {
  constexpr int kSteps = 20000;
  double sumX = 0, sumY = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double u = (i + 0.5) / kSteps;
    const FilterSample x = filter.Sample({u, 0.5}), y = filter.Sample({0.5, u});
    sumX += x.weight * g(x.offset.x) / kSteps;
    sumY += y.weight * h(y.offset.y) / kSteps;
  }
  return sumX * sumY / filter.Sample({0.5, 0.5}).weight;
}

// Camera samples and splats must reconstruct the same image: moments of f by sampling and by integration agree.
TEST(Filter, WeightedMomentsAreThoseOfTheFilter) {
  for (const auto& named : AllFilters()) {
    // Lambdas of clang 14 capture no structured bindings.
    const auto& name = named.name;
    const auto& filter = named.filter;
    EXPECT_NEAR(WeightedMean(
                    filter, [](double) { return 1.; }, [](double) { return 1.; }),
                1, 2e-3)
        << name;
    if (name == "gaussian v4, needle") continue;
    const auto g = [](double x) { return std::cos(0.7 * x); };
    const auto h = [](double y) { return std::cos(0.4 * y); };
    const double integral = Integrate(
        filter, [&](double x, double y) { return filter.NormalizedX(x) * filter.NormalizedY(y) * g(x) * h(y); });
    EXPECT_NEAR(WeightedMean(filter, g, h), integral, 3e-3) << name;
  }
}

// Chi-square of 100,000 samples in 20 x 20 cells against the integrated density. Twelve filters, each at a significance
// of 0.001 / 12: the quantile of chi-square with 399 degrees of freedom is 511 (Wilson-Hilferty).
TEST(Filter, SamplesFollowTheDensity) {
  constexpr int kCells = 20, kFine = 40, kSamples = 100000;
  for (const auto& [name, filter] : AllFilters()) {
    const Vec2d r = filter.Radius();
    std::vector<double> expected(kCells * kCells), found(kCells * kCells);
    // The needle's mass is all within 0.005.
    const Vec2d extent = name == "gaussian v4, needle" ? Vec2d(0.005) : r;
    const auto cellOf = [&](double x, double e) {
      return std::clamp(static_cast<int>((x / e + 1) / 2 * kCells), 0, kCells - 1);
    };
    for (int i = 0; i < kCells * kFine; ++i) {
      for (int j = 0; j < kCells * kFine; ++j) {
        const Vec2d p(extent.x * (2 * (i + 0.5) / (kCells * kFine) - 1),
                      extent.y * (2 * (j + 0.5) / (kCells * kFine) - 1));
        expected[static_cast<size_t>(i / kFine * kCells + j / kFine)] +=
            filter.Pdf(p) * 4 * extent.x * extent.y / Sqr(double{kCells * kFine});
      }
    }
    for (uint64_t i = 0; i < kSamples; ++i) {
      const auto uniform = [&](uint64_t dimension) { return static_cast<double>(Hash(i, dimension) >> 11) * 0x1p-53; };
      const FilterSample sample = filter.Sample({uniform(0), uniform(1)});
      EXPECT_LE(std::abs(sample.offset.x), r.x);
      EXPECT_LE(std::abs(sample.offset.y), r.y);
      found[static_cast<size_t>(cellOf(sample.offset.x, extent.x) * kCells + cellOf(sample.offset.y, extent.y))] += 1;
    }
    double chiSquare = 0, pooledExpected = 0, pooledFound = 0;
    for (size_t i = 0; i < found.size(); ++i) {
      const double e = expected[i] * kSamples;
      if (e < 5) {
        pooledExpected += e;
        pooledFound += found[i];
      } else {
        chiSquare += Sqr(found[i] - e) / e;
      }
    }
    chiSquare += Sqr(pooledFound - pooledExpected) / std::max(5., pooledExpected);
    EXPECT_LT(chiSquare, 511) << name;
  }
}

TEST(Filter, SamplingIsMonotoneSoThatStrataStayTogether) {
  for (const auto& [name, filter] : AllFilters()) {
    double previous = -1e9;
    for (int i = 0; i < 5000; ++i) {
      const double x = filter.Sample({i / 5000., 0.5}).offset.x;
      EXPECT_GE(x, previous) << name;
      previous = x;
    }
    EXPECT_TRUE(std::isfinite(filter.Sample({0, 0}).weight)) << name;
    EXPECT_TRUE(std::isfinite(filter.Sample({1 - 0x1p-53, 0.5}).weight)) << name;
  }
}

TEST(Filter, DescriptionsComeBack) {
  for (const auto& [name, filter] : AllFilters()) EXPECT_EQ(Filter::FromDescription(filter.Describe()), filter) << name;
  EXPECT_FALSE(Filter::Gaussian({2, 2}, 2) == Filter::Gaussian({2, 2}, 3));
  EXPECT_THROW(Filter::FromDescription({99, 1, 1, 0, 0}), Error);
}

TEST(Filter, BadParametersAreErrors) {
  EXPECT_THROW(Filter::Box({0, 1}), Error);
  EXPECT_THROW(Filter::Box({1, -1}), Error);
  EXPECT_THROW(Filter::Triangle({1e9, 1}), Error);
  EXPECT_THROW(Filter::Gaussian({std::nan(""), 1}), Error);
  EXPECT_THROW(Filter::Gaussian({2, 2}, 0), Error);
  EXPECT_THROW(Filter::GaussianSigma({2, 2}, -1), Error);
  EXPECT_THROW(Filter::Mitchell({2, 2}, INFINITY, 0), Error);
  EXPECT_THROW(Filter::Sinc({4, 4}, 0), Error);
}

}  // namespace
}  // namespace dapple
