#include "src/geometry/cylinder.h"

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/geometry/surface_math.h"

namespace dapple {

Cylinder::Cylinder(const Transform& objectToRender, bool reverseOrientation, double radius, double zMin, double zMax,
                   double phiMaxDegrees)
    : Quadric(objectToRender, reverseOrientation, {0, 0, std::abs(zMax - zMin)}),
      radius_(radius),
      zMin_(std::min(zMin, zMax)),
      zMax_(std::max(zMin, zMax)),
      phiMax_(Radians(std::clamp(phiMaxDegrees, 0.0, 360.0))) {
  if (!(radius > 0) || !std::isfinite(radius) || !std::isfinite(zMax_ - zMin_))
    throw Error(fmt::format("cylinder: radius {}, z from {} to {}: expected a radius above zero", radius, zMin, zMax));
  constexpr int kPanels = 32;
  const auto stretch = [&](double phi) { return AreaStretch({std::cos(phi), std::sin(phi), 0}); };
  area_ = radius_ * (zMax_ - zMin_) * (IsSimilarity() ? phiMax_ * stretch(0) : Integrate(0, phiMax_, kPanels, stretch));
}

double Cylinder::LocalArea() const { return phiMax_ * radius_ * (zMax_ - zMin_); }

Bounds3 Cylinder::PrimitiveBounds(int) const {
  return BoundsOf({-radius_, -radius_, zMin_}, {radius_, radius_, zMax_});
}

void Cylinder::AppendHull(std::vector<HullBall>* hull) const {
  const Vec2d profile[] = {{radius_, zMin_}, {radius_, zMax_}};
  AppendRevolved(profile, phiMax_, hull);
}

Quadric::LocalHits Cylinder::IntersectLocal(const LocalRay& ray) const {
  LocalHits hits;
  const double a = ray.d.x * ray.d.x + ray.d.y * ray.d.y;
  if (!(a > 0)) return hits;
  const double b = ray.o.x * ray.d.x + ray.o.y * ray.d.y;
  const double nearestX = ray.o.x - ray.d.x * (b / a), nearestY = ray.o.y - ray.d.y * (b / a);
  const double discriminant = radius_ * radius_ - (nearestX * nearestX + nearestY * nearestY);
  if (!(discriminant > 0)) return hits;
  const double c = ray.o.x * ray.o.x + ray.o.y * ray.o.y - radius_ * radius_;
  const double q = -(b + std::copysign(std::sqrt(a * discriminant), b));
  const double t0 = q / a, t1 = c / q;

  for (const double t : {std::min(t0, t1), std::max(t0, t1)}) {
    if (!(t > 0 && t < ray.tMax) || !std::isfinite(t)) continue;
    const Vec3d p = ray.o + ray.d * t;
    if (p.z < zMin_ || p.z > zMax_) continue;
    if (phiMax_ < 2 * kPiD && Azimuth(p.x, p.y) > phiMax_) continue;
    hits.Add(t, p);
  }
  return hits;
}

Vec2 Cylinder::Encode(const Vec3d& p) const { return ToFloat(UvAt(p)); }
Vec3d Cylinder::Decode(const Vec2& code) const { return SampleLocal(Vec2d(code)); }
Vec3d Cylinder::Project(const Vec3d& p) const {
  const double across = std::sqrt(p.x * p.x + p.y * p.y);
  return across > 0 ? Vec3d(p.x * (radius_ / across), p.y * (radius_ / across), p.z) : Vec3d(radius_, 0, p.z);
}

Vec2d Cylinder::UvAt(const Vec3d& p) const { return InvertLocal(p); }
Vec2 Cylinder::Uv(const PrimitiveHit& hit) const { return {hit.b1, hit.b2}; }

Vec3d Cylinder::NormalAt(const Vec3d& p) const { return {p.x / radius_, p.y / radius_, 0}; }

Quadric::LocalDerivatives Cylinder::DerivativesAt(const Vec3d& p) const {
  LocalDerivatives local;
  local.dpdu = {-p.y * phiMax_, p.x * phiMax_, 0};
  local.dpdv = {0, 0, zMax_ - zMin_};
  local.dndu = local.dpdu / radius_;
  return local;
}

Vec3d Cylinder::SampleLocal(const Vec2d& u) const {
  const double phi = u.x * phiMax_;
  return {radius_ * std::cos(phi), radius_ * std::sin(phi), zMin_ + u.y * (zMax_ - zMin_)};
}

Vec2d Cylinder::InvertLocal(const Vec3d& p) const {
  return {phiMax_ > 0 ? std::min(1.0, Azimuth(p.x, p.y) / phiMax_) : 0,
          zMax_ > zMin_ ? std::clamp((p.z - zMin_) / (zMax_ - zMin_), 0.0, 1.0) : 0};
}

}  // namespace dapple
