#include "lights/spot_light.h"

#include <cmath>

#include "lights/light_math.h"
#include "src/base/frame.h"
#include "src/sampling/warps.h"

namespace dapple {

namespace {

/// 1 - cos of an angle in degrees, without cancellation.
double OneMinusCosOf(double degrees) { return 2 * Sqr(std::sin(Radians(degrees) / 2)); }

}  // namespace

SpotProfile::SpotProfile(double totalWidth, double falloffStart, SpotFalloff falloff) : falloff_(falloff) {
  constexpr double kNarrowest = 1e-4;
  const double total = std::clamp(totalWidth, 0.0, 180.0);
  if (!(total >= kNarrowest)) return;
  xTotal_ = OneMinusCosOf(total);
  xStart_ = OneMinusCosOf(std::min(std::abs(falloffStart), total));
  rimIntegral_ = (xTotal_ - xStart_) * (falloff == SpotFalloff::PbrtV3 ? 1.0 / 5 : 1.0 / 2);
}

double SpotProfile::Evaluate(double x) const {
  if (x >= xTotal_) return x == xTotal_ && xStart_ == xTotal_ && xTotal_ > 0 ? 1 : 0;
  if (x <= xStart_) return 1;
  const double t = (xTotal_ - x) / (xTotal_ - xStart_);
  return falloff_ == SpotFalloff::PbrtV3 ? Sqr(Sqr(t)) : t * t * (3 - 2 * t);
}

double SpotProfile::Sample(double u) const {
  const double flux = u * Integral();
  if (flux < xStart_ || rimIntegral_ == 0) return std::min(flux, xStart_);
  const double t = InvertRimCdf(1 - std::min((flux - xStart_) / rimIntegral_, 1.0));
  return xStart_ + (1 - t) * (xTotal_ - xStart_);
}

double SpotProfile::Invert(double x) const {
  if (x <= xStart_ || rimIntegral_ == 0) return std::min(x, xStart_) / Integral();
  const double t = std::max(0.0, xTotal_ - x) / (xTotal_ - xStart_);
  return (xStart_ + rimIntegral_ * (1 - RimCdf(t))) / Integral();
}

double SpotProfile::RimCdf(double t) const {
  return falloff_ == SpotFalloff::PbrtV3 ? t * Sqr(Sqr(t)) : t * t * t * (2 - t);
}

double SpotProfile::InvertRimCdf(double share) const {
  if (falloff_ == SpotFalloff::PbrtV3) return std::pow(share, 0.2);
  // t^3 (2 - t) = share: Newton's method, which falls back to bisection where it would leave the bracket.
  double low = 0, high = 1;
  double t = std::cbrt(share / 2);
  for (int iteration = 0; iteration < 64; ++iteration) {
    const double error = RimCdf(t) - share;
    if (error == 0) break;
    (error < 0 ? low : high) = t;
    const double newton = t - error / (t * t * (6 - 4 * t));
    const double next = newton > low && newton < high ? newton : (low + high) / 2;
    if (std::abs(next - t) <= 1e-16) break;
    t = next;
  }
  return t;
}

SpotLight::SpotLight(const Vec3& position, const Vec3& axis, const Color& intensity, double totalWidthDegrees,
                     double falloffStartDegrees, SpotFalloff falloff)
    : position_(position),
      axis_(Normalize(ToDouble(axis))),
      intensity_(intensity),
      profile_(totalWidthDegrees, falloffStartDegrees, falloff) {
  CoordinateSystem(axis_, &s_, &t_);
}

Color SpotLight::Power() const { return FiniteColor(intensity_, 2 * kPiD * profile_.Integral()); }

double SpotLight::OneMinusCos(const Vec3& w) const {
  const Vec3d unit = Normalize(ToDouble(w));
  const double cosTheta = Dot(unit, axis_);
  return cosTheta > 0 ? LengthSquared(Cross(unit, axis_)) / (1 + cosTheta) : std::min(1 - cosTheta, 2.0);
}

Color SpotLight::Intensity(const Vec3& w) const {
  return intensity_ * static_cast<float>(profile_.Evaluate(OneMinusCos(w)));
}

double SpotLight::ImportanceAt(const LightContext& at) const {
  const Vec3 w = Normalize(at.p - position_);
  return PointImportance(at, position_, static_cast<double>(Intensity(w).MaxComponent()));
}

std::optional<LiSample> SpotLight::Sample_Li(const LightContext& at, const LiRandom&) const {
  std::optional<LiSample> sample = SamplePointLi(at, position_, intensity_);
  if (!sample) return std::nullopt;
  sample->L *= static_cast<float>(profile_.Evaluate(OneMinusCos(-sample->wi)));
  if (sample->L.IsBlack()) return std::nullopt;
  return sample;
}

std::optional<LeSample> SpotLight::Sample_Le(const LeRandom& u) const {
  if (intensity_.IsBlack() || profile_.Integral() == 0) return std::nullopt;
  const double phi = 2 * kPiD * u.direction.y;
  double x = profile_.Sample(u.direction.x);
  LeSample sample;
  double share = 0;
  // In a narrow cone the rounding of the direction to float may carry it over the edge: then it is drawn in again.
  for (int attempt = 0; share == 0 && attempt < 64; ++attempt, x *= 0.9) {
    const double sinTheta = SafeSqrt(x * (2 - x));
    const Vec3d w = s_ * (sinTheta * std::cos(phi)) + t_ * (sinTheta * std::sin(phi)) + axis_ * (1 - x);
    sample.ray = Ray{position_, ToFloat(w)};
    share = profile_.Evaluate(OneMinusCos(sample.ray.d));
  }
  sample.Le = intensity_ * static_cast<float>(share);
  sample.pdfPos = 1;
  sample.pdfDir = share / (2 * kPiD * profile_.Integral());
  sample.deltaPos = true;
  if (sample.Le.IsBlack()) return std::nullopt;
  return sample;
}

LePdf SpotLight::Pdf_Le(const Ray& ray, const LightPoint&) const {
  const double share = profile_.Evaluate(OneMinusCos(ray.d));
  return {1, share > 0 ? share / (2 * kPiD * profile_.Integral()) : 0};
}

LeRandom SpotLight::Invert_Le(const Ray& ray, const LightPoint&) const {
  const Vec3d w = ToDouble(ray.d);
  LeRandom u;
  u.direction = Vec2d(profile_.Invert(OneMinusCos(ray.d)), TurnOf(Dot(w, s_), Dot(w, t_)));
  return u;
}

}  // namespace dapple
