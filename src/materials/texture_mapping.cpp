#include "src/materials/texture_mapping.h"

#include <cmath>

#include "src/base/numerics.h"

namespace dapple {
namespace {

Vec2 ToFloat(double s, double t) { return {static_cast<float>(s), static_cast<float>(t)}; }

}  // namespace

PlanarMapping::PlanarMapping(const Transform& textureFromRender, const Vec3d& v1, const Vec3d& v2, const Vec2d& delta) {
  const Vec3d origin = textureFromRender.Point(Vec3d(0));
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d unit(0);
    unit[axis] = 1;
    const Vec3d column = textureFromRender.Vector(unit);
    s_[axis] = Dot(column, v1);
    t_[axis] = Dot(column, v2);
  }
  offset_ = Vec2d(Dot(origin, v1), Dot(origin, v2)) + delta;
}

Vec2 PlanarMapping::Map(const TextureContext& at) const {
  const Vec3d p = ToDouble(at.p);
  return ToFloat(Dot(s_, p) + offset_.x, Dot(t_, p) + offset_.y);
}

Vec2 SphericalMapping::Map(const TextureContext& at) const {
  const Vec3d p = textureFromRender_.Point(ToDouble(at.p));
  const double theta = std::atan2(std::hypot(p.x, p.y), p.z), phi = std::atan2(p.y, p.x);
  return ToFloat(theta / kPiD, (phi < 0 ? phi + 2 * kPiD : phi) / (2 * kPiD));
}

Vec2 CylindricalMapping::Map(const TextureContext& at) const {
  const Vec3d p = textureFromRender_.Point(ToDouble(at.p));
  const double z = height_ == Height::kDirection ? Normalize(p).z : p.z;
  return ToFloat((kPiD + std::atan2(p.y, p.x)) / (2 * kPiD), z);
}

}  // namespace dapple
