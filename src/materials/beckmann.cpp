#include "src/materials/beckmann.h"

namespace dapple {

namespace {

constexpr double kInvSqrtPi = std::numbers::inv_sqrtpi;

/// The visible slopes along a direction of elevation (cosTheta, sinTheta), alpha = 1: their density at t is
/// proportional to (cosTheta + t sinTheta) exp(-t^2), t above -cot(theta). With sinTheta = 0 it is a normal
/// distribution.
struct VisibleSlopes {
  double cosTheta, sinTheta;

  double Lowest() const { return -cosTheta / sinTheta; }  // may be minus infinity
  /// The integral of (cosTheta + x sinTheta) exp(-x^2) / sqrt(pi) over x > t: a sum of what is positive.
  double Above(double t) const { return cosTheta * std::erfc(t) / 2 + sinTheta * kInvSqrtPi * std::exp(-t * t) / 2; }

  /// The share of slopes above t.
  double ShareAbove(double t) const { return Above(t) / Above(Lowest()); }
  /// The slope above which the share `u` lies.
  double SlopeOf(double u) const;
};

double VisibleSlopes::SlopeOf(double u) const {
  constexpr double kFarthest = 6.2;  // beyond it there is less than 2^-55
  double low = std::max(Lowest(), -kFarthest), high = kFarthest;
  const double wanted = u * Above(Lowest());
  double t = std::clamp(0.0, low, high);
  for (int i = 0; i < 64 && high - low > 1e-9; ++i) {
    const double gauss = kInvSqrtPi * std::exp(-t * t);
    const double excess = (cosTheta * std::erfc(t) + sinTheta * gauss) / 2 - wanted;
    (excess > 0 ? low : high) = t;
    // Newton's step, and half the bracket where it leads out.
    const double next = t + excess / ((cosTheta + t * sinTheta) * gauss), before = t;
    t = next > low && next < high ? next : (low + high) / 2;
    if (std::abs(t - before) < 1e-8) break;  // convergence is quadratic but at the lowest slope, where it is linear
  }
  return t;
}

/// The space where alpha is one, as seen from the direction `w` there.
struct UnitSpace {
  VisibleSlopes along;
  double cosPhi = 1, sinPhi = 0;

  UnitSpace(float alphaX, float alphaY, const Vec3& w) {
    const double x = static_cast<double>(alphaX * w.x), y = static_cast<double>(alphaY * w.y);
    const double across = std::hypot(x, y), up = std::abs(static_cast<double>(w.z)), length = std::hypot(across, up);
    along = {up / length, across / length};
    if (across > 0) cosPhi = x / across, sinPhi = y / across;
  }
};

constexpr VisibleSlopes kAcross = {1, 0};

}  // namespace

float Beckmann::D(const Vec3& wm) const {
  const float z2 = wm.z * wm.z;
  const float tangent2 = (Sqr(wm.x / alphaX_) + Sqr(wm.y / alphaY_)) / z2;
  if (!(tangent2 < 100)) return 0;  // less than 1e-43 of its peak
  return std::exp(-tangent2) / (kPi * alphaX_ * alphaY_ * z2 * z2);
}

float Beckmann::Stretch(const Vec3& w) const {
  // With a = 1 / (alpha tan theta), Lambda = (erf(a) - 1) / 2 + exp(-a^2) / (2 a sqrt(pi)).
  const float across = std::sqrt(Sqr(alphaX_ * w.x) + Sqr(alphaY_ * w.y)), up = AbsCosTheta(w);
  const float a = up / across;
  return up * std::erf(a) + across * static_cast<float>(kInvSqrtPi) * std::exp(-a * a);
}

Vec3 Beckmann::SampleVisible(const Vec3& w, const Vec2d& u, double*) const {
  const UnitSpace space(alphaX_, alphaY_, w.z < 0 ? -w : w);
  const double t = space.along.SlopeOf(u.x), s = kAcross.SlopeOf(u.y);
  const double x = t * space.cosPhi - s * space.sinPhi, y = t * space.sinPhi + s * space.cosPhi;
  const Vec3d wm(x * static_cast<double>(alphaX_), y * static_cast<double>(alphaY_), 1);
  return ToFloat(Normalize(wm)) * (w.z < 0 ? -1.f : 1.f);
}

FacetNumbers Beckmann::InvertVisible(const Vec3& w, const Vec3& wm) const {
  const UnitSpace space(alphaX_, alphaY_, w.z < 0 ? -w : w);
  const double x = static_cast<double>(wm.x / (wm.z * alphaX_)), y = static_cast<double>(wm.y / (wm.z * alphaY_));
  const double t = x * space.cosPhi + y * space.sinPhi, s = y * space.cosPhi - x * space.sinPhi;
  return {{std::min(1.0, space.along.ShareAbove(std::max(t, space.along.Lowest()))), kAcross.ShareAbove(s)}};
}

}  // namespace dapple
