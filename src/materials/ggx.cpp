#include "src/materials/ggx.h"

namespace dapple {

namespace {

/// The frame of the hemisphere of alpha 1 into which the ellipsoid of normals is stretched: v is the direction in it.
struct Hemisphere {
  Vec3 v, t1, t2;

  Hemisphere(float alphaX, float alphaY, const Vec3& w, float side)
      : v(Normalize(Vec3(alphaX * w.x, alphaY * w.y, w.z) * side)) {
    const float sin2 = v.x * v.x + v.y * v.y;
    t1 = sin2 > 0 ? Vec3(-v.y, v.x, 0) * (1 / std::sqrt(sin2)) : Vec3(1, 0, 0);
    t2 = Cross(v, t1);
  }
};

}  // namespace

Vec3 Ggx::SampleVisible(const Vec3& w, const Vec2d& u, double*) const {
  const float side = w.z < 0 ? -1.f : 1.f;
  const auto [v, t1, t2] = Hemisphere(alphaX_, alphaY_, w, side);

  // A point on the disk, with the half that is foreshortened squeezed (Heitz 2018, section 3.2).
  const double r = std::sqrt(u.x), phi = 2 * kPiD * u.y;
  const double p1 = r * std::cos(phi);
  const double edge = SafeSqrt(1 - p1 * p1), s = (1 + static_cast<double>(v.z)) / 2;
  const double p2 = (1 - s) * edge + s * r * std::sin(phi);
  const double p3 = SafeSqrt(1 - p1 * p1 - p2 * p2);

  const Vec3 n = t1 * static_cast<float>(p1) + t2 * static_cast<float>(p2) + v * static_cast<float>(p3);
  return Normalize(Vec3(alphaX_ * n.x, alphaY_ * n.y, std::max(0.f, n.z))) * side;
}

FacetNumbers Ggx::InvertVisible(const Vec3& w, const Vec3& wm) const {
  const float side = w.z < 0 ? -1.f : 1.f;
  const auto [v, t1, t2] = Hemisphere(alphaX_, alphaY_, w, side);
  const Vec3 n = Normalize(Vec3(wm.x / alphaX_, wm.y / alphaY_, wm.z) * side);
  const double p1 = static_cast<double>(Dot(n, t1)), p2 = static_cast<double>(Dot(n, t2));
  const double edge = SafeSqrt(1 - p1 * p1), s = (1 + static_cast<double>(v.z)) / 2;
  const double q = (p2 - (1 - s) * edge) / s;
  const double phi = Atan2(q, p1);
  return {{std::min(1.0, p1 * p1 + q * q), (phi < 0 ? phi + 2 * kPiD : phi) / (2 * kPiD)}};
}

}  // namespace dapple
