#include "src/materials/cosine_power.h"

namespace dapple {

namespace {

/// log(cos^2) of a unit vector: by the sine where the cosine is near one, since large exponents multiply it.
template <typename T>
T LogSquaredCosine(T sin2, T z) {
  return sin2 < T(0.5) ? std::log1p(-sin2) : std::log(std::max(z * z, T(1e-30)));
}

}  // namespace

float CosinePower::D(const Vec3& wm) const {
  const float x2 = wm.x * wm.x, y2 = wm.y * wm.y, sin2 = x2 + y2;
  const float log2 = LogSquaredCosine(sin2, wm.z);
  // log(cos^2) / sin^2 is -1 at the pole.
  const float exponent = sin2 > 0 ? (exponentX_ * x2 + exponentY_ * y2) * (log2 / (2 * sin2)) : 0;
  return std::sqrt((exponentX_ + 2) * (exponentY_ + 2)) * (kInvPi / 2) * std::exp(exponent);
}

Vec3 CosinePower::SampleNormal(const Vec2d& u) const {
  // The azimuth has density proportional to 1 / (e + 2): a circle squeezed along both axes. Of one azimuth, cos^(e + 2)
  // is uniform.
  const double psi = 2 * kPiD * u.y;
  const double x = std::cos(psi) / std::sqrt(static_cast<double>(exponentX_) + 2);
  const double y = std::sin(psi) / std::sqrt(static_cast<double>(exponentY_) + 2);
  const double squeezed = x * x + y * y;              // 1 / (e + 2)
  const double logCosine = std::log(u.x) * squeezed;  // minus infinity at u.x = 0
  const double sine = SafeSqrt(-std::expm1(2 * logCosine)) / std::sqrt(squeezed);
  return ToFloat(Vec3d(x * sine, y * sine, std::exp(logCosine)));
}

Vec2d CosinePower::InvertNormal(const Vec3& wm) const {
  const double a = static_cast<double>(exponentX_) + 2, b = static_cast<double>(exponentY_) + 2;
  const double x = static_cast<double>(wm.x), y = static_cast<double>(wm.y), sin2 = x * x + y * y;
  if (!(sin2 > 0)) return {1, 0};
  const double psi = std::atan2(y * std::sqrt(b), x * std::sqrt(a));
  const double logCosine = LogSquaredCosine(sin2, static_cast<double>(wm.z)) / 2;
  return {std::exp(logCosine * (a * x * x + b * y * y) / sin2), (psi < 0 ? psi + 2 * kPiD : psi) / (2 * kPiD)};
}

}  // namespace dapple
