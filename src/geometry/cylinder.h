// An open cylinder or a part of one, as pbrt's `cylinder`: around the z axis of object space.
#pragma once

#include "src/geometry/quadric.h"

namespace dapple {

class Cylinder final : public Quadric {
 public:
  /// `radius` > 0; `zMin` and `zMax` in any order; `phiMaxDegrees` clamped to [0, 360]. Throws `Error` where the radius
  /// is not positive, or the transform is singular.
  Cylinder(const Transform& objectToRender, bool reverseOrientation, double radius, double zMin, double zMax,
           double phiMaxDegrees);

  Bounds3 PrimitiveBounds(int primitive) const override;
  void AppendHull(std::vector<HullBall>* hull) const override;
  Vec2 Uv(const PrimitiveHit& hit) const override;
  double PrimitiveArea(int primitive) const override { return primitive == 0 ? area_ : 0; }

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
  double radius_, zMin_, zMax_, phiMax_;
  double area_;
};

}  // namespace dapple
