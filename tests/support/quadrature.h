// Adaptive quadrature over boxes of any dimension, and over the sphere: the independent answer that sampling is held
// against.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "src/base/frame.h"
#include "src/base/vec.h"

namespace dapple::testing {

template <int D>
using Coordinates = std::array<double, D>;

template <int D>
struct Box {
  Coordinates<D> low, high;
};

/// The integral of `f` over a box: Gauss product rules, the box cut in two along the axis where `f` varies most, until
/// D cuts, one inside the other, change nothing beyond `tolerance` (of which each half has half), or `depth`
/// cuts were made. Three points along each axis up to two dimensions, else two.
template <int D, typename F>
class AdaptiveQuadrature {
 public:
  explicit AdaptiveQuadrature(const F& f) : f_(f) {}

  double Integrate(const Box<D>& box, double tolerance, int depth) const {
    return Refine(box, Apply(box, {}), {}, 0, tolerance, depth);
  }

 private:
  static constexpr int kNodes = D <= 2 ? 3 : 2;
  static constexpr std::array<double, 3> kAt = D <= 2 ? std::array{-0.774596669241483377, 0.0, 0.774596669241483377}
                                                      : std::array{-0.577350269189625765, 0.577350269189625765, 0.0};
  static constexpr std::array<double, 3> kWeight =
      D <= 2 ? std::array{5.0 / 18, 8.0 / 18, 5.0 / 18} : std::array{0.5, 0.5, 0.0};
  // Cuts in a row that must change nothing: one may by chance, and says nothing of what hides along another axis.
  static constexpr int kAgreements = D <= 2 ? 2 * D : D + 1;
  static constexpr size_t Power(size_t base, int exponent) {
    return exponent == 0 ? 1 : base * Power(base, exponent - 1);
  }
  static constexpr size_t kPoints = Power(kNodes, D);
  using Splits = std::array<int, D>;  // how often the box was cut along each axis

  struct Result {
    double integral = 0;
    size_t axis = 0;       // to cut next
    double atCorners = 0;  // what may hide in the corners, beyond the rule's points
  };

  Result Apply(const Box<D>& box, const Splits& splits) const {
    double volume = 1;
    for (size_t axis = 0; axis < D; ++axis) volume *= box.high[axis] - box.low[axis];
    std::array<double, kPoints> values;
    Result result;
    for (size_t i = 0; i < kPoints; ++i) {
      Coordinates<D> x;
      double weight = volume;
      for (size_t axis = 0, rest = i; axis < D; ++axis, rest /= kNodes) {
        const size_t node = rest % kNodes;
        x[axis] = (box.low[axis] + box.high[axis]) / 2 + kAt[node] * (box.high[axis] - box.low[axis]) / 2;
        weight *= kWeight[node];
      }
      values[i] = f_(x);
      result.integral += weight * values[i];
    }
    result.axis = AxisToCut(values, splits);
    result.atCorners = JumpsToCorners(box, values) * volume;
    return result;
  }

  // Where a border of the function cuts a corner off, no point of the rule need see it: the difference of the values
  // there, where it is a jump, times the share of the box that such a corner may be.
  double JumpsToCorners(const Box<D>& box, const std::array<double, kPoints>& values) const {
    constexpr double kShareOfCorner = 0.02, kNearCorner = 0.98;
    double jumps = 0;
    for (size_t corner = 0; corner < size_t{1} << D; ++corner) {
      Coordinates<D> x;
      size_t nearest = 0;
      for (size_t axis = 0, stride = 1; axis < D; ++axis, stride *= kNodes) {
        const bool isHigh = (corner >> axis & 1) != 0;
        const double half = (box.high[axis] - box.low[axis]) / 2;
        x[axis] = box.low[axis] + half * (1 + (isHigh ? kNearCorner : -kNearCorner));
        nearest += isHigh ? stride * (kNodes - 1) : 0;
      }
      const double there = f_(x), here = values[nearest], jump = std::abs(there - here);
      if (jump > std::max(std::abs(there), std::abs(here)) / 2) jumps += kShareOfCorner * jump;
    }
    return jumps;
  }

  // Where the function varies most; of equals, the one that was cut least.
  static size_t AxisToCut(const std::array<double, kPoints>& values, const Splits& splits) {
    size_t best = 0;
    double most = -1;
    for (size_t axis = 0, stride = 1; axis < D; ++axis, stride *= kNodes) {
      double variation = 0;
      for (size_t i = 0; i < kPoints; ++i) {
        if ((i / stride) % kNodes + 1 < kNodes) variation += std::abs(values[i + stride] - values[i]);
      }
      if (variation > most || (variation == most && splits[axis] < splits[best])) best = axis;
      most = std::max(most, variation);
    }
    return best;
  }

  // `agreed`: how many cuts before this one changed nothing.
  double Refine(const Box<D>& box, const Result& whole, Splits splits, int agreed, double tolerance, int depth) const {
    const size_t axis = agreed > 0 ? LeastCut(splits) : whole.axis;
    Box<D> first = box, second = box;
    first.high[axis] = second.low[axis] = (box.low[axis] + box.high[axis]) / 2;
    ++splits[axis];
    const Result a = Apply(first, splits), b = Apply(second, splits);
    const double sum = a.integral + b.integral;
    agreed = std::abs(sum - whole.integral) + whole.atCorners < tolerance ? agreed + 1 : 0;
    if (depth <= 1 || agreed == kAgreements) return sum;
    return Refine(first, a, splits, agreed, tolerance / 2, depth - 1) +
           Refine(second, b, splits, agreed, tolerance / 2, depth - 1);
  }

  static size_t LeastCut(const Splits& splits) {
    return static_cast<size_t>(std::min_element(splits.begin(), splits.end()) - splits.begin());
  }

  const F& f_;
};

template <int D, typename F>
double Integrate(const F& f, const Box<D>& box, double tolerance, int depth) {
  return AdaptiveQuadrature<D, F>(f).Integrate(box, tolerance, depth);
}

/// The integral of `f` over the sphere (not only of densities), to about 1e-5 for functions without needles. `frame`:
/// of the grid, whose cells are slivers at the poles.
inline double IntegrateSphere(const std::function<double(const Vec3& w)>& f, const Frame& frame = {}) {
  constexpr int kRows = 16, kColumns = 16;
  constexpr double kTwoPi = 2 * std::numbers::pi;
  // Horizons through the grid's poles would lie along the cells' borders, where slivers between the points are missed.
  constexpr double kTurned = 0.1;
  const auto density = [&](const Coordinates<2>& x) {
    const double sinTheta = std::sqrt(std::max(0.0, 1 - x[0] * x[0]));
    return f(frame.ToWorld(ToFloat(Vec3d(sinTheta * std::cos(x[1]), sinTheta * std::sin(x[1]), x[0]))));
  };
  double sum = 0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const Box<2> cell = {{-1 + 2.0 * row / kRows, kTurned + kTwoPi * column / kColumns},
                           {-1 + 2.0 * (row + 1) / kRows, kTurned + kTwoPi * (column + 1) / kColumns}};
      sum += Integrate<2>(density, cell, 1e-7, 16);
    }
  }
  return sum;
}

}  // namespace dapple::testing
