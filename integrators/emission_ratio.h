// How a light path begins, as the techniques of multiple importance sampling compare it with a camera path's end.
#pragma once

#include "lights/light.h"

namespace dapple {

/// The density of an emitted ray over area at its first surface, divided by the cosine there, in units of the density
/// per solid angle with which that surface would look for the light (discrete where the light is). `pdf` is that of
/// `EmissionSampler`; `cosAtLight` is 1 without a surface.
inline double EmissionRatio(double pdf, double cosAtLight, bool isPoint, double distanceSquared) {
  return isPoint ? pdf / distanceSquared : pdf / cosAtLight;
}

/// The point of an area light from which a ray was emitted, as far as `Light::Pdf_Li` asks for it.
inline SurfaceInteraction OriginOf(const LeSample& le) {
  SurfaceInteraction origin;
  origin.p = le.ray.o;
  origin.ng = le.n;
  origin.primitive = le.primitive;
  return origin;
}

}  // namespace dapple
