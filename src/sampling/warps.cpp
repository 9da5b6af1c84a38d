#include "src/sampling/warps.h"

#include "src/base/numerics.h"

namespace dapple {

namespace {

Vec3d OnSphere(double z, double sinTheta, double turn) {
  const double phi = 2 * kPiD * turn;
  return {sinTheta * std::cos(phi), sinTheta * std::sin(phi), z};
}

}  // namespace

double TurnOf(double x, double y) {
  const double turn = Atan2(y, x) / (2 * kPiD);
  return turn < 0 ? turn + 1 : turn;
}

Vec2d SampleDiskPolar(const Vec2d& u) {
  const double r = std::sqrt(u.x), phi = 2 * kPiD * u.y;
  return {r * std::cos(phi), r * std::sin(phi)};
}

Vec2d InvertDiskPolar(const Vec2d& p) { return {std::min(1.0, p.x * p.x + p.y * p.y), TurnOf(p.x, p.y)}; }

Vec2d SampleDiskConcentric(const Vec2d& u) {
  const double x = 2 * u.x - 1, y = 2 * u.y - 1;
  if (x == 0 && y == 0) return {0, 0};
  if (std::abs(x) > std::abs(y)) {
    const double phi = (kPiD / 4) * (y / x);
    return {x * std::cos(phi), x * std::sin(phi)};
  }
  const double phi = kPiD / 2 - (kPiD / 4) * (x / y);
  return {y * std::cos(phi), y * std::sin(phi)};
}

Vec2d InvertDiskConcentric(const Vec2d& p) {
  const double r = std::sqrt(p.x * p.x + p.y * p.y);
  if (r == 0) return {0.5, 0.5};
  double x, y;
  if (std::abs(p.x) > std::abs(p.y)) {
    x = std::copysign(r, p.x);
    y = x * std::atan(p.y / p.x) * (4 / kPiD);
  } else {
    y = std::copysign(r, p.y);
    x = y * std::atan(p.x / p.y) * (4 / kPiD);
  }
  return {std::clamp((x + 1) / 2, 0.0, 1.0), std::clamp((y + 1) / 2, 0.0, 1.0)};
}

Vec3d SampleHemisphere(const Vec2d& u) { return OnSphere(u.x, SafeSqrt(1 - u.x * u.x), u.y); }

Vec2d InvertHemisphere(const Vec3d& w) { return {std::clamp(w.z, 0.0, 1.0), TurnOf(w.x, w.y)}; }

Vec3d SampleCosineHemisphere(const Vec2d& u) {
  const Vec2d d = SampleDiskConcentric(u);
  // The radius on the disk is the larger of |2 u - 1|; 1 - r^2 from it has no cancellation at the horizon.
  const double r = std::max(std::abs(2 * u.x - 1), std::abs(2 * u.y - 1));
  return {d.x, d.y, SafeSqrt((1 - r) * (1 + r))};
}

double CosineHemispherePdf(double cosTheta) { return std::max(0.0, cosTheta) * kDiskPdf; }

Vec2d InvertCosineHemisphere(const Vec3d& w) { return InvertDiskConcentric({w.x, w.y}); }

Vec3d SampleSphere(const Vec2d& u) {
  // sin^2 = 1 - z^2 = 4 u (1 - u), without cancellation at the poles.
  return OnSphere(1 - 2 * u.x, 2 * SafeSqrt(u.x * (1 - u.x)), u.y);
}

Vec2d InvertSphere(const Vec3d& w) {
  // (1 - z) / 2, from the sine where z is near one.
  const double sin2 = w.x * w.x + w.y * w.y;
  const double u = w.z > 0 ? sin2 / (2 * (1 + w.z)) : (1 - w.z) / 2;
  return {std::clamp(u, 0.0, 1.0), TurnOf(w.x, w.y)};
}

Vec3d SampleCone(const Vec2d& u, double oneMinusCosMax) {
  const double oneMinusCos = u.x * oneMinusCosMax;
  return OnSphere(1 - oneMinusCos, SafeSqrt(oneMinusCos * (2 - oneMinusCos)), u.y);
}

double ConePdf(double oneMinusCosMax) { return 1 / (2 * kPiD * oneMinusCosMax); }

Vec2d InvertCone(const Vec3d& w, double oneMinusCosMax) {
  const double sin2 = w.x * w.x + w.y * w.y;
  const double oneMinusCos = w.z > 0 ? sin2 / (1 + w.z) : 1 - w.z;
  return {std::clamp(oneMinusCos / oneMinusCosMax, 0.0, 1.0), TurnOf(w.x, w.y)};
}

Vec2d SampleTriangle(const Vec2d& u) {
  if (u.x < u.y) {
    const double b1 = u.x / 2;
    return {b1, u.y - b1};
  }
  const double b2 = u.y / 2;
  return {u.x - b2, b2};
}

Vec2d InvertTriangle(const Vec2d& b) { return b.x < b.y ? Vec2d(2 * b.x, b.y + b.x) : Vec2d(b.x + b.y, 2 * b.y); }

double SampleLinear(double u, double a, double b) {
  if (u == 0 && a == 0) return 0;
  return std::min(u * (a + b) / (a + std::sqrt(Lerp(u, a * a, b * b))), 1.0);
}

double LinearPdf(double x, double a, double b) { return x < 0 || x > 1 ? 0 : 2 * Lerp(x, a, b) / (a + b); }

double InvertLinear(double x, double a, double b) { return x * (a * (2 - x) + b * x) / (a + b); }

Vec2d SampleBilinear(const Vec2d& u, const double (&w)[4]) {
  const double y = SampleLinear(u.y, w[0] + w[1], w[2] + w[3]);
  const double left = Lerp(y, w[0], w[2]), right = Lerp(y, w[1], w[3]);
  // On a border where the function is zero all x are alike.
  return {left + right > 0 ? SampleLinear(u.x, left, right) : u.x, y};
}

double BilinearPdf(const Vec2d& p, const double (&w)[4]) {
  if (p.x < 0 || p.x > 1 || p.y < 0 || p.y > 1) return 0;
  return 4 * Lerp(p.y, Lerp(p.x, w[0], w[1]), Lerp(p.x, w[2], w[3])) / (w[0] + w[1] + w[2] + w[3]);
}

Vec2d InvertBilinear(const Vec2d& p, const double (&w)[4]) {
  const double left = Lerp(p.y, w[0], w[2]), right = Lerp(p.y, w[1], w[3]);
  return {left + right > 0 ? InvertLinear(p.x, left, right) : p.x, InvertLinear(p.y, w[0] + w[1], w[2] + w[3])};
}

}  // namespace dapple
