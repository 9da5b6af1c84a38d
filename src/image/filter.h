// Pixel reconstruction filters: the weight of a point of the image plane in the pixel around it (pbrt-v3 and v4, ch.
// 8).
//
// All are separable products f(dx) f(dy) on [-radius, radius]. A camera sample draws its offset with `Sample` and
// counts with the weight that comes with it (mean 1); a splat uses `Normalized`. Both give the same expected image.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "src/base/error.h"
#include "src/base/vec.h"

namespace dapple {

/// An offset from a pixel's centre, in pixels, and its weight f / (pdf * integral): 1 for filters that are nowhere
/// negative; otherwise a constant of either sign, but for the narrow steps in which f passes zero.
struct FilterSample {
  Vec2d offset;
  float weight;
};

class Filter {
 public:
  /// Radii are in pixels, in (0, 64]. Bad parameters throw `Error` at `location`.
  static Filter Box(Vec2d radius = Vec2d(0.5), const FileLocation& location = {});
  static Filter Triangle(Vec2d radius = Vec2d(2), const FileLocation& location = {});
  /// pbrt-v3: exp(-alpha x^2) - exp(-alpha radius^2), alpha > 0.
  static Filter Gaussian(Vec2d radius = Vec2d(2), double alpha = 2, const FileLocation& location = {});
  /// pbrt-v4: normal density of deviation sigma > 0 at x, less that at the radius.
  static Filter GaussianSigma(Vec2d radius = Vec2d(1.5), double sigma = 0.5, const FileLocation& location = {});
  /// Mitchell and Netravali 1988, stretched to the radius; pbrt's default is B = C = 1/3.
  static Filter Mitchell(Vec2d radius = Vec2d(2), double B = 1. / 3, double C = 1. / 3,
                         const FileLocation& location = {});
  /// sinc(x) sinc(x / tau), cut at the radius (Lanczos; pbrt calls it sinc); tau >= 0.05.
  static Filter Sinc(Vec2d radius = Vec2d(4), double tau = 3, const FileLocation& location = {});

  Vec2d Radius() const { return {x_.radius, y_.radius}; }
  /// f at that offset; 0 outside the radius.
  double Evaluate(double dx, double dy) const { return x_.Evaluate(dx) * y_.Evaluate(dy); }
  /// The integral of f (signed: negative lobes count negative); positive.
  double Integral() const { return x_.integral * y_.integral; }
  /// f / its integral along one axis; the product over both axes is the filter's normalised weight.
  double NormalizedX(double dx) const { return x_.Evaluate(dx) * x_.invIntegral; }
  double NormalizedY(double dy) const { return y_.Evaluate(dy) * y_.invIntegral; }

  /// Draws an offset for u in [0, 1)^2; monotone in each coordinate, so that stratification is kept.
  FilterSample Sample(const Vec2d& u) const;
  /// The density of `Sample` per square pixel: |f| over its integral (between the values around a zero of f, the
  /// interpolation of |f|).
  double Pdf(const Vec2d& offset) const { return x_.Pdf(offset.x) * y_.Pdf(offset.y); }

  /// True where each sample has weight 1 and each splat touches exactly one pixel: a box of radius 1/2.
  bool IsUnitBox() const { return kind_ == Kind::kBox && x_.radius == 0.5 && y_.radius == 0.5; }

  friend bool operator==(const Filter& a, const Filter& b) {
    return a.kind_ == b.kind_ && a.p_ == b.p_ && a.q_ == b.q_ && a.Radius() == b.Radius();
  }

  /// Kind, radii and parameters as plain numbers and back, for files.
  struct Description {
    int kind;
    double radiusX, radiusY, p, q;
  };
  Description Describe() const { return {static_cast<int>(kind_), x_.radius, y_.radius, p_, q_}; }
  static Filter FromDescription(const Description& description, const FileLocation& location = {});

 private:
  enum class Kind { kBox, kTriangle, kGaussian, kGaussianSigma, kMitchell, kSinc };

  /// One axis: values of f at equal steps over [0, extent], linear between them and zero beyond, and the running
  /// integral of |f| between them. f is even.
  struct Axis {
    double radius = 0, extent = 0, invStep = 0;
    double integral = 0, invIntegral = 0;  // over both sides, negative lobes negative
    std::vector<double> values, cumulative;

    double Evaluate(double x) const;
    double Pdf(double x) const;
    double Sample(double u, double* weight) const;
    /// The step that x in [0, extent] falls into, and how far into it.
    size_t Locate(double x, double* fraction) const;
  };

  Filter(Kind kind, const Vec2d& radius, double p, double q, const FileLocation& location);
  void Check(const FileLocation& location) const;
  double Exact(double x, double radius) const;
  double Extent(double radius) const;
  int Steps(double radius) const;
  Axis MakeAxis(double radius) const;

  Kind kind_;
  double p_, q_;  // alpha; sigma; B and C; tau
  Axis x_, y_;
};

inline size_t Filter::Axis::Locate(double x, double* fraction) const {
  const double position = x * invStep;
  const size_t i = std::min(static_cast<size_t>(position), values.size() - 2);
  *fraction = std::min(1., position - static_cast<double>(i));
  return i;
}

inline double Filter::Axis::Evaluate(double x) const {
  x = std::abs(x);
  if (!(x <= extent)) return 0;
  double t;
  const size_t i = Locate(x, &t);
  return values[i] * (1 - t) + values[i + 1] * t;
}

}  // namespace dapple
