// Chi-square goodness of fit between a sampling routine and the density that it claims, on an interval or on the
// sphere.
//
//   const double level = SidakLevel(0.01, kTests);   // 1 % for the whole family of kTests
//   const ChiSquare fit = ChiSquareOnSphere(sample, pdf, {.seed = 1});
//   EXPECT_GT(fit.pValue, level) << fit.message;
//
// The domain is cut into cells; the density is integrated over each by adaptive quadrature; samples are counted. What
// the density lacks to one is expected to come back as nothing (a rejected sample): that is a cell too. Cells that
// expect fewer than five samples are pooled. A density of total above one fails at once (p = 0).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "src/base/frame.h"
#include "src/base/vec.h"

namespace dapple::testing {

struct ChiSquare {
  double pValue = 0;    ///< probability of a fit as bad as this one, if the density is true
  double total = 0;     ///< the integral of the density
  std::string message;  ///< what was found, for the failing test
};

/// The level of each of `tests` independent tests, so that one of them fails by chance with probability `family`.
inline double SidakLevel(double family, int tests) { return -std::expm1(std::log1p(-family) / tests); }

/// The upper regularised incomplete gamma function Q(a, x), by series or continued fraction (Numerical Recipes, 6.2).
inline double UpperGamma(double a, double x) {
  if (x <= 0) return 1;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; std::abs(term) > 1e-16 * sum; n += 1) sum += term *= x / n;
    return std::max(0.0, 1 - front * sum);
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int i = 1; i < 10000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return front * h;
}

/// P(X >= statistic) for a chi-square variable.
inline double ChiSquareTail(double statistic, int degreesOfFreedom) {
  return UpperGamma(degreesOfFreedom / 2.0, statistic / 2);
}

/// Compares counts with expectations (both of the same total).
inline ChiSquare CompareCounts(const std::vector<double>& expected, const std::vector<double>& observed) {
  constexpr double kSmallest = 5;
  std::vector<size_t> order(expected.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
  ChiSquare result;
  double statistic = 0, pooledExpected = 0, pooledObserved = 0;
  int cells = 0;
  for (const size_t i : order) {
    pooledExpected += expected[i];
    pooledObserved += observed[i];
    if (pooledExpected < kSmallest) continue;
    const double difference = pooledObserved - pooledExpected;
    statistic += difference * difference / pooledExpected;
    pooledExpected = pooledObserved = 0;
    ++cells;
  }
  result.message = std::to_string(cells) + " cells, chi-square " + std::to_string(statistic);
  if (pooledObserved > 10 * (pooledExpected + 1)) {
    result.message += ", samples where the density is zero: " + std::to_string(pooledObserved);
    return result;
  }
  result.pValue = cells > 1 ? ChiSquareTail(statistic, cells - 1) : 1;
  result.message += ", p = " + std::to_string(result.pValue);
  return result;
}

struct ChiSquareOptions {
  int samples = 200'000;
  int rows = 24;     ///< cells along cos theta, or along the interval
  int columns = 48;  ///< cells along phi
  uint64_t seed = 1;
  Frame frame = {};  ///< of the sphere's grid: its cells are slivers at the poles, so keep detail away
};

namespace internal {

/// The integral of f over a rectangle: 3 x 3 Gauss points, halved both ways until it stands still.
template <typename F>
double IntegrateRectangle(const F& f, double x0, double x1, double y0, double y1, double tolerance, int depth) {
  static constexpr std::array<double, 3> kAt = {-0.774596669241483377, 0, 0.774596669241483377};
  static constexpr std::array<double, 3> kWeight = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  const auto gauss = [&](double a, double b, double c, double d) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        sum += kWeight[i] * kWeight[j] * f((a + b) / 2 + kAt[i] * (b - a) / 2, (c + d) / 2 + kAt[j] * (d - c) / 2);
      }
    }
    return sum * (b - a) * (d - c);
  };
  const double xm = (x0 + x1) / 2, ym = (y0 + y1) / 2;
  const double coarse = gauss(x0, x1, y0, y1);
  const double fine = gauss(x0, xm, y0, ym) + gauss(xm, x1, y0, ym) + gauss(x0, xm, ym, y1) + gauss(xm, x1, ym, y1);
  if (depth == 0 || std::abs(fine - coarse) < tolerance) return fine;
  const auto part = [&](double a, double b, double c, double d) {
    return IntegrateRectangle(f, a, b, c, d, tolerance / 2, depth - 1);
  };
  return part(x0, xm, y0, ym) + part(xm, x1, y0, ym) + part(x0, xm, ym, y1) + part(xm, x1, ym, y1);
}

inline ChiSquare Finish(std::vector<double> probability, std::vector<double> observed, int samples) {
  const double total = std::accumulate(probability.begin(), probability.end(), 0.0);
  if (!(total < 1.0005)) {
    ChiSquare result;
    result.total = total;
    result.message = "the density integrates to " + std::to_string(total);
    return result;
  }
  probability.push_back(std::max(0.0, 1 - total));  // observed has its cell of nothing at the end already
  for (double& p : probability) p *= samples;
  ChiSquare result = CompareCounts(probability, observed);
  result.total = total;
  result.message += ", the density integrates to " + std::to_string(total);
  return result;
}

}  // namespace internal

/// `sample(uc, u)` gives a unit direction or nothing from random numbers in [0, 1); `pdf(w)` is per solid angle.
inline ChiSquare ChiSquareOnSphere(const std::function<std::optional<Vec3>(double uc, const Vec2d& u)>& sample,
                                   const std::function<double(const Vec3& w)>& pdf,
                                   const ChiSquareOptions& options = {}) {
  const int rows = options.rows, columns = options.columns;
  const double twoPi = 2 * std::numbers::pi;
  const auto density = [&](double cosTheta, double phi) {
    const double sinTheta = std::sqrt(std::max(0.0, 1 - cosTheta * cosTheta));
    const Vec3d local(sinTheta * std::cos(phi), sinTheta * std::sin(phi), cosTheta);
    return pdf(options.frame.ToWorld(ToFloat(local)));
  };
  std::vector<double> probability, observed(static_cast<size_t>(rows * columns + 1));
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      probability.push_back(internal::IntegrateRectangle(density, -1 + 2.0 * row / rows, -1 + 2.0 * (row + 1) / rows,
                                                         twoPi * column / columns, twoPi * (column + 1) / columns,
                                                         0.05 / options.samples, 6));
    }
  }
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < options.samples; ++i) {
    const double uc = uniform(random), u0 = uniform(random), u1 = uniform(random);
    const std::optional<Vec3> w = sample(uc, Vec2d(u0, u1));
    size_t cell = static_cast<size_t>(rows * columns);
    if (w) {
      const Vec3 local = options.frame.ToLocal(*w);
      const double phi = std::atan2(static_cast<double>(local.y), static_cast<double>(local.x));
      const int row = std::clamp(static_cast<int>((static_cast<double>(local.z) + 1) / 2 * rows), 0, rows - 1);
      const int column = std::clamp(static_cast<int>((phi < 0 ? phi + twoPi : phi) / twoPi * columns), 0, columns - 1);
      cell = static_cast<size_t>(row * columns + column);
    }
    observed[cell] += 1;
  }
  return internal::Finish(std::move(probability), std::move(observed), options.samples);
}

/// `sample(u)` gives a point of [low, high] or nothing; `pdf(x)` is per unit length. Cells: rows x columns of them.
inline ChiSquare ChiSquareOnInterval(const std::function<std::optional<double>(double u)>& sample,
                                     const std::function<double(double x)>& pdf, double low, double high,
                                     const ChiSquareOptions& options = {}) {
  const int cells = options.rows * options.columns;
  const auto edge = [&](int i) { return low + (high - low) * i / cells; };
  std::vector<double> probability, observed(static_cast<size_t>(cells + 1));
  for (int i = 0; i < cells; ++i) {
    probability.push_back(internal::IntegrateRectangle([&](double x, double) { return pdf(x); }, edge(i), edge(i + 1),
                                                       0, 1, 0.01 / options.samples, 6));
  }
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < options.samples; ++i) {
    const std::optional<double> x = sample(uniform(random));
    const int cell = x ? std::clamp(static_cast<int>((*x - low) / (high - low) * cells), 0, cells - 1) : cells;
    observed[static_cast<size_t>(cell)] += 1;
  }
  return internal::Finish(std::move(probability), std::move(observed), options.samples);
}

/// The integral of `f` over the sphere (not only of densities), to about 1e-5 for functions without needles.
inline double IntegrateSphere(const std::function<double(const Vec3& w)>& f, const Frame& frame = {}) {
  double sum = 0;
  constexpr int kRows = 16, kColumns = 16;
  const double twoPi = 2 * std::numbers::pi;
  const auto density = [&](double cosTheta, double phi) {
    const double sinTheta = std::sqrt(std::max(0.0, 1 - cosTheta * cosTheta));
    return f(frame.ToWorld(ToFloat(Vec3d(sinTheta * std::cos(phi), sinTheta * std::sin(phi), cosTheta))));
  };
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      sum += internal::IntegrateRectangle(density, -1 + 2.0 * row / kRows, -1 + 2.0 * (row + 1) / kRows,
                                          twoPi * column / kColumns, twoPi * (column + 1) / kColumns, 1e-7, 7);
    }
  }
  return sum;
}

}  // namespace dapple::testing
