// Chi-square goodness of fit between a sampling routine and the density that it claims: on the interval, the disk, the
// sphere, the hemisphere, a cone, or any domain with coordinates of equal measure (area x direction, for one).
//
//   const ChiSquare fit = ChiSquareOnSphere(sample, pdf, {.seed = 1});
//   EXPECT_TRUE(fit.Passes()) << fit.message;
//
// Each test states in chi_square_family.h how many fits it makes; all of the project are judged at one level.
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
#include <string>
#include <vector>

#include "src/base/frame.h"
#include "src/base/vec.h"
#include "tests/support/chi_square_family.h"
#include "tests/support/quadrature.h"
#include "tests/support/random_numbers.h"

namespace dapple::testing {

struct ChiSquare {
  double pValue = 0;    ///< probability of a fit as bad as this one, if the density is true
  double total = 0;     ///< the integral of the density
  std::string message;  ///< what was found, for the failing test

  /// At the level of the whole project.
  bool Passes() const { return pValue > FitLevel(); }
};

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
  CountFit();
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
  int rows = 24;     ///< cells along cos theta, the disk's radius, or the interval
  int columns = 48;  ///< cells along phi
  uint64_t seed = 1;
  Frame frame = {};  ///< of the sphere's grid: its cells are slivers at the poles, so keep detail away
};

namespace internal {

/// The cell of the unit cube that holds `x`; `count`, the number of all cells, where none does.
template <int D>
size_t CellOf(const Coordinates<D>& x, const std::array<int, D>& cells, size_t count) {
  constexpr double kRounding = 1e-9;
  size_t cell = 0, stride = 1;
  for (size_t axis = 0; axis < D; ++axis) {
    if (!(x[axis] >= -kRounding && x[axis] <= 1 + kRounding)) return count;
    const int at = std::clamp(static_cast<int>(x[axis] * cells[axis]), 0, cells[axis] - 1);
    cell += stride * static_cast<size_t>(at);
    stride *= static_cast<size_t>(cells[axis]);
  }
  return cell;
}

/// Of the cells' probabilities and counts; `observed` has a cell of nothing at its end.
inline ChiSquare Finish(std::vector<double> probability, const std::vector<double>& observed, int samples) {
  ChiSquare result;
  result.total = std::accumulate(probability.begin(), probability.end(), 0.0);
  const std::string total = "the density integrates to " + std::to_string(result.total);
  if (!(result.total < 1.0005)) {
    result.message = total;
    return result;
  }
  probability.push_back(std::max(0.0, 1 - result.total));  // of nothing
  for (double& p : probability) p *= samples;
  const ChiSquare fit = CompareCounts(probability, observed);
  return {fit.pValue, result.total, fit.message + ", " + total};
}

}  // namespace internal

/// `sample(random)` gives a point of the unit cube, or nothing; `density(x)` is per unit volume of the cube, where a
/// domain was mapped to it so that equal volumes are equal measures of the domain. `cells` along each axis.
template <int D, typename Sample, typename Density>
ChiSquare ChiSquareOnCube(const Sample& sample, const Density& density, const std::array<int, D>& cells, int samples,
                          uint64_t seed) {
  constexpr int kDepth = 10;
  constexpr double kCountError = 0.5;
  size_t count = 1;
  for (const int n : cells) count *= static_cast<size_t>(n);
  std::vector<double> probability(count), observed(count + 1);
  for (size_t i = 0; i < count; ++i) {
    Box<D> cell;
    for (size_t axis = 0, rest = i; axis < D; ++axis) {
      const size_t n = static_cast<size_t>(cells[axis]);
      cell.low[axis] = static_cast<double>(rest % n) / cells[axis];
      cell.high[axis] = static_cast<double>(rest % n + 1) / cells[axis];
      rest /= n;
    }
    probability[i] = Integrate<D>(density, cell, kCountError / samples, kDepth);
  }
  UniformNumbers random(seed);
  for (int i = 0; i < samples; ++i) {
    const std::optional<Coordinates<D>> x = sample(random);
    observed[x ? internal::CellOf<D>(*x, cells, count) : count] += 1;
  }
  return internal::Finish(std::move(probability), observed, samples);
}

/// The same for a product of two domains of two dimensions each (area x direction): `density` is smooth in the first
/// two coordinates within a cell, where two Gauss points each way take its integral, and the other two are integrated
/// adaptively at each of them.
template <typename Sample, typename Density>
ChiSquare ChiSquareOnProduct(const Sample& sample, const Density& density, const std::array<int, 4>& cells, int samples,
                             uint64_t seed) {
  constexpr double kNode = 0.577350269189625765 / 2, kCountError = 0.5;
  const auto [na, nb, nc, nd] = cells;
  std::vector<double> probability;
  // In the order of CellOf: the first coordinate runs fastest.
  for (int i = 0; i < na * nb * nc * nd; ++i) {
    const int a = i % na, b = i / na % nb, c = i / (na * nb) % nc, d = i / (na * nb * nc);
    const Box<2> cell = {{static_cast<double>(c) / nc, static_cast<double>(d) / nd},
                         {static_cast<double>(c + 1) / nc, static_cast<double>(d + 1) / nd}};
    double sum = 0;
    for (const double atA : {0.5 - kNode, 0.5 + kNode}) {
      for (const double atB : {0.5 - kNode, 0.5 + kNode}) {
        const auto f = [&](const Coordinates<2>& x) {
          return density(Coordinates<4>{(a + atA) / na, (b + atB) / nb, x[0], x[1]});
        };
        sum += Integrate<2>(f, cell, kCountError * na * nb / samples, 10) / (4 * na * nb);
      }
    }
    probability.push_back(sum);
  }
  std::vector<double> observed(probability.size() + 1);
  UniformNumbers random(seed);
  for (int i = 0; i < samples; ++i) {
    const std::optional<Coordinates<4>> x = sample(random);
    observed[x ? internal::CellOf<4>(*x, cells, probability.size()) : probability.size()] += 1;
  }
  return internal::Finish(std::move(probability), observed, samples);
}

/// Coordinates of equal measure for the cone around the frame's n with 1 - cos thetaMax in (0, 2]: share of 1 - cos
/// theta, turn. 1 is the hemisphere and 2 the sphere.
class ConeDomain {
 public:
  explicit ConeDomain(double oneMinusCosMax, const Frame& frame = {})
      : oneMinusCosMax_(oneMinusCosMax), s_(ToDouble(frame.s)), t_(ToDouble(frame.t)), n_(ToDouble(frame.n)) {}

  double SolidAngle() const { return 2 * std::numbers::pi * oneMinusCosMax_; }
  Vec3d Point(double share, double turn) const {
    const double oneMinusCos = share * oneMinusCosMax_, phi = 2 * std::numbers::pi * turn;
    const double sinTheta = std::sqrt(oneMinusCos * (2 - oneMinusCos));
    return s_ * (sinTheta * std::cos(phi)) + t_ * (sinTheta * std::sin(phi)) + n_ * (1 - oneMinusCos);
  }
  /// Nothing outside the cone, but for rounding.
  std::optional<Coordinates<2>> CoordinatesOf(const Vec3d& w) const {
    const double x = Dot(w, s_), y = Dot(w, t_), turn = std::atan2(y, x) / (2 * std::numbers::pi);
    const double half = std::sin(std::atan2(std::hypot(x, y), Dot(w, n_)) / 2);
    const double share = 2 * half * half / oneMinusCosMax_;
    if (share > 1.0001) return std::nullopt;
    return Coordinates<2>{std::min(share, 1.0), turn < 0 ? turn + 1 : turn};
  }

 private:
  double oneMinusCosMax_;
  Vec3d s_, t_, n_;
};

/// Coordinates of equal measure for the unit disk: squared radius, turn.
struct DiskDomain {
  static constexpr double kArea = std::numbers::pi;
  static Vec2d Point(double share, double turn) {
    const double r = std::sqrt(share), phi = 2 * std::numbers::pi * turn;
    return {r * std::cos(phi), r * std::sin(phi)};
  }
  /// Nothing outside the disk, but for rounding.
  static std::optional<Coordinates<2>> CoordinatesOf(const Vec2d& p) {
    const double share = p.x * p.x + p.y * p.y, turn = std::atan2(p.y, p.x) / (2 * std::numbers::pi);
    if (share > 1.0001) return std::nullopt;
    return Coordinates<2>{std::min(share, 1.0), turn < 0 ? turn + 1 : turn};
  }
};

/// `sample(random)` gives a unit direction or nothing; `pdf(w)` is per solid angle. Both speak of Vec3d.
template <typename Sample, typename Pdf>
ChiSquare ChiSquareOnCone(const Sample& sample, const Pdf& pdf, const ConeDomain& cone,
                          const ChiSquareOptions& options = {}) {
  return ChiSquareOnCube<2>(
      [&](UniformNumbers& random) -> std::optional<Coordinates<2>> {
        const std::optional<Vec3d> w = sample(random);
        return w ? cone.CoordinatesOf(*w) : std::nullopt;
      },
      [&](const Coordinates<2>& x) { return pdf(cone.Point(x[0], x[1])) * cone.SolidAngle(); },
      {options.rows, options.columns}, options.samples, options.seed);
}

/// `sample(uc, u)` gives a unit direction or nothing from random numbers in [0, 1); `pdf(w)` is per solid angle.
inline ChiSquare ChiSquareOnSphere(const std::function<std::optional<Vec3>(double uc, const Vec2d& u)>& sample,
                                   const std::function<double(const Vec3& w)>& pdf,
                                   const ChiSquareOptions& options = {}) {
  const auto draw = [&](UniformNumbers& random) -> std::optional<Vec3d> {
    const double uc = random.Get1D();
    const std::optional<Vec3> w = sample(uc, random.Get2D());
    return w ? std::optional(ToDouble(*w)) : std::nullopt;
  };
  return ChiSquareOnCone(
      draw, [&](const Vec3d& w) { return pdf(ToFloat(w)); }, ConeDomain(2, options.frame), options);
}

/// `sample(u)` gives a point of the unit disk or nothing; `pdf(p)` is per unit area.
inline ChiSquare ChiSquareOnDisk(const std::function<std::optional<Vec2d>(const Vec2d& u)>& sample,
                                 const std::function<double(const Vec2d& p)>& pdf,
                                 const ChiSquareOptions& options = {}) {
  return ChiSquareOnCube<2>(
      [&](UniformNumbers& random) -> std::optional<Coordinates<2>> {
        const std::optional<Vec2d> p = sample(random.Get2D());
        return p ? DiskDomain::CoordinatesOf(*p) : std::nullopt;
      },
      [&](const Coordinates<2>& x) { return pdf(DiskDomain::Point(x[0], x[1])) * DiskDomain::kArea; },
      {options.rows, options.columns}, options.samples, options.seed);
}

/// `sample(u)` gives a point of [low, high] or nothing; `pdf(x)` is per unit length. Cells: rows x columns of them.
inline ChiSquare ChiSquareOnInterval(const std::function<std::optional<double>(double u)>& sample,
                                     const std::function<double(double x)>& pdf, double low, double high,
                                     const ChiSquareOptions& options = {}) {
  return ChiSquareOnCube<1>(
      [&](UniformNumbers& random) -> std::optional<Coordinates<1>> {
        const std::optional<double> x = sample(random.Get1D());
        return x ? std::optional(Coordinates<1>{(*x - low) / (high - low)}) : std::nullopt;
      },
      [&](const Coordinates<1>& x) { return pdf(low + (high - low) * x[0]) * (high - low); },
      {options.rows * options.columns}, options.samples, options.seed);
}

}  // namespace dapple::testing
