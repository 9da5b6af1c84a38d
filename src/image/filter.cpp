#include "src/image/filter.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "src/base/numerics.h"

namespace dapple {

namespace {

constexpr double kMaxRadius = 64;
constexpr double kMinTau = 0.05;
// Linear interpolation over a step h of a function whose second derivative is at most k times its peak errs by
// h^2 k / 8 of the peak. Of a Gaussian, nothing above 3e-11 of its peak is left out.
constexpr int kMinSteps = 2048;
constexpr int kStepsPerZero = 512;
constexpr double kGaussianExtent = 7;  // deviations

double Sinc(double x) {
  const double t = kPiD * x;
  return std::abs(t) < 1e-4 ? 1 - t * t / 6 : std::sin(t) / t;
}

// exp(-a x^2) - exp(-a r^2), without the cancellation at the rim.
double TruncatedGaussian(double a, double x, double r) {
  return -std::exp(-a * x * x) * std::expm1(-a * (r - x) * (r + x));
}

// Mitchell and Netravali 1988, equation 8, for 0 <= x <= 2.
double MitchellPolynomial(double x, double B, double C) {
  if (x < 1) return ((12 - 9 * B - 6 * C) * x * x * x + (-18 + 12 * B + 6 * C) * x * x + (6 - 2 * B)) / 6;
  return ((-B - 6 * C) * x * x * x + (6 * B + 30 * C) * x * x + (-12 * B - 48 * C) * x + (8 * B + 24 * C)) / 6;
}

void CheckPositive(double value, const char* name, const FileLocation& location) {
  if (!(value > 0) || !std::isfinite(value))
    throw Error(location, fmt::format("filter: {} is {}, expected a positive number", name, value));
}

}  // namespace

Filter::Filter(Kind kind, const Vec2d& radius, double p, double q, const FileLocation& location)
    : kind_(kind), p_(p), q_(q) {
  x_.radius = radius.x;
  y_.radius = radius.y;
  Check(location);
  x_ = MakeAxis(radius.x);
  y_ = radius.x == radius.y ? x_ : MakeAxis(radius.y);
}

Filter Filter::Box(Vec2d radius, const FileLocation& location) { return {Kind::kBox, radius, 0, 0, location}; }

Filter Filter::Triangle(Vec2d radius, const FileLocation& location) {
  return {Kind::kTriangle, radius, 0, 0, location};
}

Filter Filter::Gaussian(Vec2d radius, double alpha, const FileLocation& location) {
  return {Kind::kGaussian, radius, alpha, 0, location};
}

Filter Filter::GaussianSigma(Vec2d radius, double sigma, const FileLocation& location) {
  return {Kind::kGaussianSigma, radius, sigma, 0, location};
}

Filter Filter::Mitchell(Vec2d radius, double B, double C, const FileLocation& location) {
  return {Kind::kMitchell, radius, B, C, location};
}

Filter Filter::Sinc(Vec2d radius, double tau, const FileLocation& location) {
  return {Kind::kSinc, radius, tau, 0, location};
}

Filter Filter::FromDescription(const Description& d, const FileLocation& location) {
  if (d.kind < static_cast<int>(Kind::kBox) || d.kind > static_cast<int>(Kind::kSinc))
    throw Error(location, fmt::format("filter of unknown kind {}", d.kind));
  return {static_cast<Kind>(d.kind), {d.radiusX, d.radiusY}, d.p, d.q, location};
}

void Filter::Check(const FileLocation& location) const {
  for (const double radius : {x_.radius, y_.radius})
    if (!(radius > 0 && radius <= kMaxRadius))
      throw Error(location,
                  fmt::format("filter: radius is {}, expected more than 0 and at most {}", radius, kMaxRadius));
  if (kind_ == Kind::kGaussian) CheckPositive(p_, "alpha", location);
  if (kind_ == Kind::kGaussianSigma) CheckPositive(p_, "sigma", location);
  if (kind_ == Kind::kMitchell && !(std::abs(p_) <= 100 && std::abs(q_) <= 100))
    throw Error(location, fmt::format("filter: B and C are {} and {}, expected numbers from 0 to 1", p_, q_));
  if (kind_ == Kind::kSinc && !(p_ >= kMinTau && std::isfinite(p_)))
    throw Error(location, fmt::format("filter: tau is {}, expected at least {}", p_, kMinTau));
}

double Filter::Exact(double x, double r) const {
  switch (kind_) {
    case Kind::kBox:
      return 1;
    case Kind::kTriangle:
      return r - x;
    case Kind::kGaussian:
      return TruncatedGaussian(p_, x, r);
    case Kind::kGaussianSigma:
      return TruncatedGaussian(1 / (2 * p_ * p_), x, r) / (p_ * std::sqrt(2 * kPiD));
    case Kind::kMitchell:
      return MitchellPolynomial(2 * x / r, p_, q_);
    case Kind::kSinc:
      return dapple::Sinc(x) * dapple::Sinc(x / p_);
  }
  return 0;
}

// A narrow Gaussian is cut where nothing is left of it, so that the steps go where its mass is.
double Filter::Extent(double radius) const {
  if (kind_ == Kind::kGaussian) return std::min(radius, kGaussianExtent * std::sqrt(0.5 / p_));
  if (kind_ == Kind::kGaussianSigma) return std::min(radius, kGaussianExtent * p_);
  return radius;
}

// Even, so that Mitchell's seam lies between two steps. A box or triangle is linear as it is.
int Filter::Steps(double radius) const {
  if (kind_ == Kind::kBox || kind_ == Kind::kTriangle) return 1;
  if (kind_ != Kind::kSinc) return kMinSteps;
  const double zeros = radius * std::max(1., 1 / p_);
  return std::max(kMinSteps, 2 * static_cast<int>(std::ceil(kStepsPerZero * zeros / 2)));
}

Filter::Axis Filter::MakeAxis(double radius) const {
  Axis axis;
  axis.radius = radius;
  axis.extent = Extent(radius);
  const int steps = Steps(radius);
  const double step = axis.extent / steps;
  axis.invStep = steps / axis.extent;
  for (int i = 0; i <= steps; ++i) axis.values.push_back(Exact(i == steps ? axis.extent : i * step, radius));
  double half = 0, halfMagnitude = 0;
  axis.cumulative.push_back(0);
  for (size_t i = 0; i + 1 < axis.values.size(); ++i) {
    const double left = axis.values[i], right = axis.values[i + 1];
    half += step / 2 * (left + right);
    halfMagnitude += step / 2 * (std::abs(left) + std::abs(right));
    axis.cumulative.push_back(halfMagnitude);
  }
  axis.integral = 2 * half;
  axis.invIntegral = 1 / axis.integral;
  return axis;
}

double Filter::Axis::Pdf(double x) const {
  x = std::abs(x);
  if (!(x <= extent)) return 0;
  double t;
  const size_t i = Locate(x, &t);
  return Lerp(t, std::abs(values[i]), std::abs(values[i + 1])) / (2 * cumulative.back());
}

// The step that holds this much of the magnitude, then the inverse of its linear density (pbrt-v4, section A.4.1).
double Filter::Axis::Sample(double u, double* weight) const {
  const double v = 2 * u - 1;
  const double mass = std::abs(v) * cumulative.back();
  const auto above = std::upper_bound(cumulative.begin() + 1, cumulative.end() - 1, mass);
  const auto i = static_cast<size_t>(above - cumulative.begin()) - 1;
  const double a = std::abs(values[i]), b = std::abs(values[i + 1]);
  const double stepMass = cumulative[i + 1] - cumulative[i];
  const double s = stepMass > 0 ? std::clamp((mass - cumulative[i]) / stepMass, 0., 1.) : 0;
  const double denominator = a + std::sqrt(Lerp(s, a * a, b * b));
  const double t = denominator > 0 ? std::min(1., s * (a + b) / denominator) : 0;
  // f / |f| is 1 or -1 but where f changes its sign within the step.
  const double magnitude = Lerp(t, a, b);
  const double sign = magnitude > 0 ? Lerp(t, values[i], values[i + 1]) / magnitude : 0;
  *weight = sign * 2 * cumulative.back() * invIntegral;
  return std::copysign(std::min(extent, (static_cast<double>(i) + t) / invStep), v);
}

FilterSample Filter::Sample(const Vec2d& u) const {
  if (kind_ == Kind::kBox) return {{(2 * u.x - 1) * x_.radius, (2 * u.y - 1) * y_.radius}, 1};
  double weightX, weightY;
  const double x = x_.Sample(u.x, &weightX);
  const double y = y_.Sample(u.y, &weightY);
  return {{x, y}, static_cast<float>(weightX * weightY)};
}

}  // namespace dapple
