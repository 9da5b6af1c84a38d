// What several lights compute alike.
#pragma once

#include "lights/light.h"

namespace dapple {

/// `c` times `scale`; components that leave the range of float become its largest number.
Color FiniteColor(const Color& c, double scale);

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
