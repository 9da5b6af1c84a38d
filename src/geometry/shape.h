// The interface of shapes: what the tracer, the lights and the photon tracer ask of a surface.
//
// A shape is a list of primitives (the triangles of a mesh; one for a sphere). Each is sampled in two measures: per
// area, for photons that leave it, and per solid angle as seen from a point, for next-event estimation. Either comes as
// three: draw, density and inverse. Shapes that may be instanced live in their instance's space; lights are never
// instanced.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "src/base/transform.h"
#include "src/base/vec.h"
#include "src/geometry/interaction.h"
#include "src/geometry/ray.h"

namespace dapple {

/// A point drawn on a shape. `pdf` is per area or per solid angle, as the function that drew it says.
struct ShapeSample {
  Vec3 p{0};
  float pError = 0;  ///< as in SurfaceInteraction
  Vec3 n{0};         ///< unit geometric normal on the outside, as SurfaceInteraction::ng
  Vec2 uv{0};
  double pdf = 0;
  /// From the reference to the point, before that was rounded to float: very near a shape, rounding would turn the
  /// direction. Zero: `p` knows no better.
  Vec3d toPoint{0, 0, 0};
};

/// Where a ray meets a primitive, before shading needs more of it.
struct PrimitiveHit {
  float t = kInfinity;   ///< in units of |d|
  float b1 = 0, b2 = 0;  ///< triangles: weights of the second and third vertex; others: surface parameters of their own
  int primitive = 0;
};

/// All hits of one primitive along a ray, nearest first; no primitive here has more than two.
struct PrimitiveHits {
  int count = 0;
  PrimitiveHit hits[2];
};

/// A ball in render space.
struct Ball {
  Vec3d center{0, 0, 0};
  double radius = 0;
};

/// A ball of a convex hull; a point where the radius is 0.
struct HullBall {
  Vec3 center{0, 0, 0};
  float radius = 0;
};

class Shape {
 public:
  virtual ~Shape() = default;

  /// The ball whose whole surface this shape is, its normals pointing away from the centre; nothing for other shapes.
  virtual std::optional<Ball> AsBall() const { return std::nullopt; }

  virtual int PrimitiveCount() const = 0;
  /// Of its vertices and indices, or whatever it keeps.
  virtual int64_t MemoryBytes() const = 0;
  virtual Bounds3 PrimitiveBounds(int primitive) const = 0;
  /// Adds balls whose convex hull holds the shape: its vertices where it has them.
  virtual void AppendHull(std::vector<HullBall>* hull) const = 0;

  /// All hits with 0 < t < ray.tMax, for shapes that Embree does not trace itself.
  virtual PrimitiveHits IntersectAll(const Ray& ray, int primitive) const = 0;
  /// The nearest of them.
  std::optional<PrimitiveHit> Intersect(const Ray& ray, int primitive) const {
    const PrimitiveHits all = IntersectAll(ray, primitive);
    return all.count > 0 ? std::optional(all.hits[0]) : std::nullopt;
  }

  /// The surface at a hit. Fills all but `shape`, `instance` and `state`.
  virtual SurfaceInteraction Interact(const Ray& ray, const PrimitiveHit& hit) const = 0;

  /// Surface coordinates at a hit, as alpha textures ask for them.
  virtual Vec2 Uv(const PrimitiveHit& hit) const = 0;

  /// Area of one side; 0 for degenerate primitives.
  virtual double PrimitiveArea(int primitive) const = 0;

  /// A point on the primitive; density per area in `pdf`: 1 / PrimitiveArea except on ellipsoids, elliptic cylinders
  /// and bilinear patches that are no parallelograms. Density 0 (and no more to expect) where the primitive has no
  /// area.
  virtual ShapeSample SampleArea(int primitive, const Vec2d& u) const = 0;
  /// The density of `SampleArea` at the point `p` of the primitive, per area.
  virtual double PdfArea(int primitive, const Vec3& p) const = 0;
  /// The random numbers with which `SampleArea` gives the point `p` of the primitive.
  virtual Vec2d InvertArea(int primitive, const Vec3& p) const = 0;

  /// A point visible from `reference` if nothing else stands between; density per solid angle at `reference`.
  /// Nothing where the primitive covers no solid angle.
  virtual std::optional<ShapeSample> SampleSolidAngle(int primitive, const Vec3& reference, const Vec2d& u) const = 0;
  /// The density of `SampleSolidAngle` at `p`, a point of the primitive with unit normal `n`, from `reference`;
  /// 0 where it cannot be drawn.
  virtual double PdfSolidAngle(int primitive, const Vec3& reference, const Vec3& p, const Vec3& n) const = 0;
  /// The random numbers with which `SampleSolidAngle` gives the point `p`.
  virtual Vec2d InvertSolidAngle(int primitive, const Vec3& reference, const Vec3& p) const = 0;
};

}  // namespace dapple
