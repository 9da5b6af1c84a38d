// What spheres, disks and cylinders share: one primitive, described in object space, seen through an affine transform.
//
// Intersection and sampling run in object space and in double, so the transform may scale by any factors. A derived
// class describes its surface there; this one makes interactions, samples and densities in render space of it.
#pragma once

#include <span>

#include "src/geometry/affine.h"
#include "src/geometry/shape.h"

namespace dapple {

class Quadric : public Shape {
 public:
  int PrimitiveCount() const override { return 1; }
  int64_t MemoryBytes() const override { return sizeof(Quadric); }

  PrimitiveHits IntersectAll(const Ray& ray, int primitive) const override;
  SurfaceInteraction Interact(const Ray& ray, const PrimitiveHit& hit) const override;

  ShapeSample SampleArea(int primitive, const Vec2d& u) const override;
  double PdfArea(int primitive, const Vec3& p) const override;
  Vec2d InvertArea(int primitive, const Vec3& p) const override;
  std::optional<ShapeSample> SampleSolidAngle(int primitive, const Vec3& reference, const Vec2d& u) const override;
  double PdfSolidAngle(int primitive, const Vec3& reference, const Vec3& p, const Vec3& n) const override;
  Vec2d InvertSolidAngle(int primitive, const Vec3& reference, const Vec3& p) const override;

 protected:
  /// Of a point of the surface, in object space.
  struct LocalDerivatives {
    Vec3d dpdu{0}, dpdv{0}, dndu{0}, dndv{0};
  };
  struct LocalRay {
    Vec3d o, d;
    double tMax;
  };
  struct LocalHits {
    int count = 0;
    double t[2] = {};
    Vec3d p[2] = {Vec3d(0), Vec3d(0)};
    void Add(double distance, const Vec3d& point) { t[count] = distance, p[count] = point, ++count; }
  };

  /// `flatExtent`: how far, along each axis of object space, straight lines lie on the surface (a sphere has none).
  /// Throws `Error` where the transform is singular.
  Quadric(const Transform& objectToRender, bool reverseOrientation, const Vec3d& flatExtent);

  /// All hits with 0 < t < tMax, nearest first, with their object-space points (near the surface but for rounding).
  virtual LocalHits IntersectLocal(const LocalRay& ray) const = 0;
  /// Two floats that say where on the surface `p` is (`PrimitiveHit::b1`, `b2`), and back.
  virtual Vec2 Encode(const Vec3d& p) const = 0;
  virtual Vec3d Decode(const Vec2& code) const = 0;
  /// Unit normal at `p`, a point of the surface, on pbrt's outside without ReverseOrientation.
  virtual Vec3d NormalAt(const Vec3d& p) const = 0;
  virtual Vec2d UvAt(const Vec3d& p) const = 0;
  /// The derivatives there, as pbrt defines them.
  virtual LocalDerivatives DerivativesAt(const Vec3d& p) const = 0;
  /// The point of the surface nearest to `p`, which is on it but for rounding.
  virtual Vec3d Project(const Vec3d& p) const = 0;
  /// A point uniform over the object-space area, and the inverse.
  virtual Vec3d SampleLocal(const Vec2d& u) const = 0;
  virtual Vec2d InvertLocal(const Vec3d& p) const = 0;
  virtual double LocalArea() const = 0;

  Vec3d ToObject(const Vec3& p) const { return renderToObject_.Point(ToDouble(p)); }
  Vec3d ToRender(const Vec3d& p) const { return objectToRender_.Point(p); }
  Vec3d ToRenderVector(const Vec3d& w) const { return objectToRender_.Vector(w); }
  /// Render-space area per object-space area where the object-space unit normal is `n`.
  double AreaStretch(const Vec3d& n) const;
  ShapeSample SampleAt(const Vec3d& p, double pdf) const;
  /// Object-space solid angle per render-space solid angle around the object-space direction `w`, of any length.
  double SolidAngleShrink(const Vec3d& w) const;
  /// True where the transform keeps shapes and so stretches all areas alike.
  bool IsSimilarity() const { return isSimilarity_; }
  /// The box around the transformed box of object space.
  Bounds3 BoundsOf(const Vec3d& low, const Vec3d& high) const;
  /// The box around the transformed sphere of that radius around the origin.
  Bounds3 EllipsoidBounds(double radius) const;
  /// Adds points whose convex hull holds what `profile`, points (r, z) joined by lines, sweeps over as it turns around
  /// the z axis from 0 to `phiMax`. The points are at most 0.2 % farther from the axis than the surface.
  void AppendRevolved(std::span<const Vec2d> profile, double phiMax, std::vector<HullBall>* hull) const;

 private:
  /// The unit normal in render space, on the outside, of an object-space normal.
  Vec3d RenderNormal(const Vec3d& n) const;
  /// Bound on the distance of a render-space point from the surface, along its normal `n`.
  float PointError(const Vec3d& p, const Vec3d& n) const;

  Affine objectToRender_, renderToObject_;
  bool reverseOrientation_;
  bool isSimilarity_;
  double absDeterminant_;
  double doubleError_;  ///< relative error of points that went through the transforms in double
  Vec3d flatExtent_;
};

}  // namespace dapple
