// What a scene has, and so what its rendering can skip. Computed once; shown by `dapple info`.
#pragma once

#include <cstdint>

#include "src/base/vec.h"

namespace dapple {

/// Counts and bounds, after the lights that emit nothing are dropped.
struct SceneFacts {
  // Geometry.
  int shapes = 0;
  int64_t primitives = 0;  ///< stored ones, each instance's once
  int instances = 0;

  // Light.
  int lights = 0;       ///< that emit anything
  int blackLights = 0;  ///< dropped: they cost nothing
  bool hasDeltaLight = false;
  bool hasInfiniteLight = false;
  bool hasAreaLight = false;
  /// The largest share of the directions at the scene's centre that one non-delta light covers, in [0, 1]; an
  /// environment's share is measured by how evenly its power is spread.
  double largestLightShare = 0;
  /// The smallest such share of a non-delta light that carries at least 1 % of the power; 1 where there is none.
  double smallestLightShare = 1;

  // Surfaces.
  bool hasSpecular = false;     ///< smooth mirrors, metals or glass: caustics may be
  bool hasNonSpecular = false;  ///< something can receive light
  bool hasTransmission = false;
  float minRoughness = 1;  ///< of non-specular surfaces, GGX alpha

  /// False: the image is black.
  bool EmitsLight() const { return lights > 0; }
  /// Light that was scattered before can land on something that scatters it on in more than one direction.
  bool CanUsePhotons() const { return EmitsLight() && hasNonSpecular; }
  /// A specular surface and something that can receive what it throws.
  bool MayHaveCaustics() const { return EmitsLight() && hasSpecular && hasNonSpecular; }
};

class Light;

/// The share of all directions that a light covers as seen from a point, in [0, 1]: (integral of L)^2 / integral of L^2
/// / 4 pi, which is the solid angle for a light of even radiance. From a fixed set of samples; 0 where the light is a
/// delta light or does not shine on the point.
double LightShare(const Light& light, const Vec3& point);

}  // namespace dapple
