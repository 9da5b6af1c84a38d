// A sphere or a part of one, as pbrt's `sphere`: around the origin of object space, cut by z and phi.
#pragma once

#include "src/geometry/quadric.h"

namespace dapple {

class Sphere final : public Quadric {
 public:
  /// `radius` > 0; `zMin` and `zMax` in any order, clamped to [-radius, radius]; `phiMaxDegrees` clamped to [0, 360].
  /// Throws `Error` where the radius is not positive, or the transform is singular.
  Sphere(const Transform& objectToRender, bool reverseOrientation, double radius, double zMin, double zMax,
         double phiMaxDegrees);
  /// The whole sphere.
  Sphere(const Transform& objectToRender, bool reverseOrientation, double radius)
      : Sphere(objectToRender, reverseOrientation, radius, -radius, radius, 360) {}

  std::optional<Ball> AsBall() const override;
  Bounds3 PrimitiveBounds(int primitive) const override;
  void AppendHull(std::vector<HullBall>* hull) const override;
  Vec2 Uv(const PrimitiveHit& hit) const override;
  double PrimitiveArea(int primitive) const override { return primitive == 0 ? area_ : 0; }
  /// Of a whole sphere (or ellipsoid) from outside: uniform over the cone that touches it, in object space
  /// (pbrt-v4, 6.2.4), from inside over all directions there; of a part of one by area.
  std::optional<ShapeSample> SampleSolidAngle(int primitive, const Vec3& reference, const Vec2d& u) const override;
  double PdfSolidAngle(int primitive, const Vec3& reference, const Vec3& p, const Vec3& n) const override;
  Vec2d InvertSolidAngle(int primitive, const Vec3& reference, const Vec3& p) const override;

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
  bool Contains(const Vec3d& p) const;
  std::optional<ShapeSample> SampleFromInside(const Vec3& reference, const Vec2d& u) const;
  double IntegrateArea() const;

  double radius_, zMin_, zMax_, phiMax_;
  double thetaZMin_, thetaZMax_;
  bool isWhole_;
  double area_;
};

}  // namespace dapple
