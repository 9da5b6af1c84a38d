// What several lights compute alike.
#pragma once

#include "lights/light.h"

namespace dapple {

/// `c` times `scale`; components that leave the range of float become its largest number.
Color FiniteColor(const Color& c, double scale);

/// Sums in double as a colour; what leaves the range of float becomes its largest number.
Color FiniteColor(const Vec3d& sums);

/// The colour at `t` in the unit square, bilinear between those of its corners (0,0), (1,0), (0,1), (1,1).
Color Bilinear(const Color (&c)[4], const Vec2d& t);

/// What light of that colour counts as where it is drawn: its largest component.
inline double Importance(const Color& c) { return static_cast<double>(c.MaxComponent()); }

/// The point of `origin` as a delta light that sends `intensity` (W / sr) toward `at.p`; nothing where that is black or
/// where the two points are one.
std::optional<LiSample> SamplePointLi(const LightContext& at, const Vec3& origin, const Color& intensity);

/// Irradiance at `at` from `origin` of that intensity; 0 where it comes from behind an opaque surface.
double PointImportance(const LightContext& at, const Vec3& origin, double intensity);

/// |cos| between the surface at `at` and the unit vector `wi`; 0 from behind an opaque surface, 1 without a surface.
double ReceiverCosine(const LightContext& at, const Vec3& wi);

/// True where the surface at `at` is opaque, so that light from behind `n` does not count.
inline bool HasHorizon(const LightContext& at) { return !at.transmissive && LengthSquared(at.n) > 0; }

/// A point along `wi` from `p` that lies outside the scene.
Vec3 PointOutside(const SceneExtent& extent, const Vec3& p, const Vec3& wi);

}  // namespace dapple
