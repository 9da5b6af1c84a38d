#include "src/materials/microfacet.h"

namespace dapple {

Vec3 Ggx::SampleVisible(const Vec3& w, const Vec2d& u) const {
  const float side = w.z < 0 ? -1.f : 1.f;
  // The ellipsoid becomes a hemisphere of alpha 1.
  const Vec3 v = Normalize(Vec3(alphaX_ * w.x, alphaY_ * w.y, w.z) * side);
  const float sin2 = v.x * v.x + v.y * v.y;
  const Vec3 t1 = sin2 > 0 ? Vec3(-v.y, v.x, 0) * (1 / std::sqrt(sin2)) : Vec3(1, 0, 0);
  const Vec3 t2 = Cross(v, t1);

  // A point on the disk, with the half that is foreshortened squeezed (Heitz 2018, section 3.2).
  const double r = std::sqrt(u.x), phi = 2 * kPiD * u.y;
  const double p1 = r * std::cos(phi);
  const double edge = SafeSqrt(1 - p1 * p1), s = (1 + static_cast<double>(v.z)) / 2;
  const double p2 = (1 - s) * edge + s * r * std::sin(phi);
  const double p3 = SafeSqrt(1 - p1 * p1 - p2 * p2);

  const Vec3 n = t1 * static_cast<float>(p1) + t2 * static_cast<float>(p2) + v * static_cast<float>(p3);
  return Normalize(Vec3(alphaX_ * n.x, alphaY_ * n.y, std::max(0.f, n.z))) * side;
}

float RoughnessToAlphaV3(float roughness) {
  const float x = std::log(std::max(roughness, 1e-3f));
  return 1.62142f + x * (0.819955f + x * (0.1734f + x * (0.0171201f + x * 0.000640711f)));
}

float RoughnessToAlphaV4(float roughness) { return std::sqrt(std::max(0.f, roughness)); }

}  // namespace dapple
