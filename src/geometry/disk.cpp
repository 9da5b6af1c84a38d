#include "src/geometry/disk.h"

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/geometry/surface_math.h"

namespace dapple {

Disk::Disk(const Transform& objectToRender, bool reverseOrientation, double height, double radius, double innerRadius,
           double phiMaxDegrees)
    : Quadric(objectToRender, reverseOrientation, {2 * radius, 2 * radius, 0}),
      height_(height),
      radius_(radius),
      innerRadius_(innerRadius),
      phiMax_(Radians(std::clamp(phiMaxDegrees, 0.0, 360.0))) {
  if (!(radius > 0) || !std::isfinite(radius) || !(innerRadius >= 0 && innerRadius < radius))
    throw Error(
        fmt::format("disk: radius {}, innerradius {}: expected 0 <= innerradius < radius", radius, innerRadius));
}

double Disk::LocalArea() const { return phiMax_ / 2 * (radius_ - innerRadius_) * (radius_ + innerRadius_); }

double Disk::PrimitiveArea(int primitive) const { return primitive == 0 ? LocalArea() * AreaStretch({0, 0, 1}) : 0; }

Bounds3 Disk::PrimitiveBounds(int) const {
  return BoundsOf({-radius_, -radius_, height_}, {radius_, radius_, height_});
}

void Disk::AppendHull(std::vector<HullBall>* hull) const {
  const Vec2d profile[] = {{radius_, height_}, {innerRadius_, height_}};
  AppendRevolved(profile, phiMax_, hull);
}

Quadric::LocalHits Disk::IntersectLocal(const LocalRay& ray) const {
  LocalHits hits;
  const double t = (height_ - ray.o.z) / ray.d.z;
  if (!(t > 0 && t < ray.tMax) || !std::isfinite(t)) return hits;
  const Vec3d p(ray.o.x + t * ray.d.x, ray.o.y + t * ray.d.y, height_);
  const double distanceSquared = p.x * p.x + p.y * p.y;
  if (distanceSquared > radius_ * radius_ || distanceSquared < innerRadius_ * innerRadius_) return hits;
  if (phiMax_ < 2 * kPiD && Azimuth(p.x, p.y) > phiMax_) return hits;
  hits.Add(t, p);
  return hits;
}

Vec2 Disk::Encode(const Vec3d& p) const { return ToFloat(Vec2d(p.x / radius_, p.y / radius_)); }
Vec3d Disk::Decode(const Vec2& code) const { return {code.x * radius_, code.y * radius_, height_}; }
Vec3d Disk::Project(const Vec3d& p) const { return {p.x, p.y, height_}; }

Vec2d Disk::UvAt(const Vec3d& p) const {
  const double u = phiMax_ > 0 ? std::min(1.0, Azimuth(p.x, p.y) / phiMax_) : 0;
  return {u, std::clamp((radius_ - std::sqrt(p.x * p.x + p.y * p.y)) / (radius_ - innerRadius_), 0.0, 1.0)};
}

Vec2 Disk::Uv(const PrimitiveHit& hit) const { return ToFloat(UvAt(Decode({hit.b1, hit.b2}))); }

Vec3d Disk::NormalAt(const Vec3d&) const { return {0, 0, 1}; }

Quadric::LocalDerivatives Disk::DerivativesAt(const Vec3d& p) const {
  LocalDerivatives local;
  const double across = std::sqrt(p.x * p.x + p.y * p.y);
  const double cosPhi = across > 0 ? p.x / across : 1, sinPhi = across > 0 ? p.y / across : 0;
  // At the centre dpdu would vanish; a tiny one keeps its direction.
  constexpr double kCentre = 1e-5;
  local.dpdu = Vec3d(-sinPhi, cosPhi, 0) * (std::max(across, kCentre * radius_) * phiMax_);
  local.dpdv = Vec3d(cosPhi, sinPhi, 0) * (innerRadius_ - radius_);
  return local;
}

Vec3d Disk::SampleLocal(const Vec2d& u) const {
  const double inner = innerRadius_ * innerRadius_;
  const double across = std::sqrt(inner + u.x * (radius_ * radius_ - inner));
  const double phi = u.y * phiMax_;
  return {across * std::cos(phi), across * std::sin(phi), height_};
}

Vec2d Disk::InvertLocal(const Vec3d& p) const {
  const double inner = innerRadius_ * innerRadius_;
  return {std::clamp((p.x * p.x + p.y * p.y - inner) / (radius_ * radius_ - inner), 0.0, 1.0),
          phiMax_ > 0 ? std::min(1.0, Azimuth(p.x, p.y) / phiMax_) : 0};
}

}  // namespace dapple
