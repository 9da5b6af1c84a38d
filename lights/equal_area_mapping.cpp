#include "lights/equal_area_mapping.h"

#include "src/base/numerics.h"

namespace dapple {

Vec3d EqualAreaSquareToSphere(const Vec2d& p) {
  // The square of side 2 around the origin; its inner diamond |u| + |v| <= 1 is the upper hemisphere.
  const double u = 2 * p.x - 1, v = 2 * p.y - 1;
  const double up = std::abs(u), vp = std::abs(v);
  const double signedDistance = 1 - (up + vp);
  const double distance = std::abs(signedDistance);
  const double r = 1 - distance;
  const double phi = (r == 0 ? 1 : (vp - up) / r + 1) * (kPiD / 4);
  const double z = std::copysign(1 - r * r, signedDistance);
  // r sqrt(2 - r^2) is the sine: 1 - (1 - r^2)^2 = r^2 (2 - r^2).
  const double sinTheta = r * SafeSqrt(2 - r * r);
  return {std::copysign(std::cos(phi), u) * sinTheta, std::copysign(std::sin(phi), v) * sinTheta, z};
}

Vec2d EqualAreaSphereToSquare(const Vec3d& w) {
  const double x = std::abs(w.x), y = std::abs(w.y), z = std::abs(w.z);
  // sqrt(1 - z), from the sine.
  const double r = std::sqrt((x * x + y * y) / (1 + z));
  const double phi = Atan2(y, x) * (2 / kPiD);
  double v = phi * r;
  double u = r - v;
  if (w.z < 0) {
    const double mirrored = 1 - u;
    u = 1 - v;
    v = mirrored;
  }
  return {std::clamp((std::copysign(u, w.x) + 1) / 2, 0.0, 1.0), std::clamp((std::copysign(v, w.y) + 1) / 2, 0.0, 1.0)};
}

}  // namespace dapple
