// A disk, ring or sector, as pbrt's `disk`: in the plane z = height of object space.
#pragma once

#include "src/geometry/quadric.h"

namespace dapple {

class Disk final : public Quadric {
 public:
  /// 0 <= `innerRadius` < `radius`; `phiMaxDegrees` clamped to [0, 360]. Throws `Error` where the radii do not fit, or
  /// the transform is singular.
  Disk(const Transform& objectToRender, bool reverseOrientation, double height, double radius, double innerRadius,
       double phiMaxDegrees);

  Bounds3 PrimitiveBounds(int primitive) const override;
  void AppendHull(std::vector<HullBall>* hull) const override;
  Vec2 Uv(const PrimitiveHit& hit) const override;
  double PrimitiveArea(int primitive) const override;

 protected:
  LocalHits IntersectLocal(const LocalRay& ray) const override;
  Vec2 Encode(const Vec3d& p) const override;
  Vec3d Decode(const Vec2& code) const override;
  Vec3d NormalAt(const Vec3d& p) const override;
  Vec2d UvAt(const Vec3d& p) const override;
  LocalDerivatives DerivativesAt(const Vec3d& p) const override;
  Vec3d Project(const Vec3d& p) const override;
  Vec3d SampleLocal(const Vec2d& u) const override;
  Vec2d InvertLocal(const Vec3d& p) const override;
  double LocalArea() const override;

 private:
  double height_, radius_, innerRadius_, phiMax_;
};

}  // namespace dapple
