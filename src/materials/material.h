// What a surface is made of: a recipe that gives the BSDF at each of its points.
#pragma once

#include "src/geometry/interaction.h"
#include "src/materials/bsdf.h"

namespace dapple {

/// What can be said of a material without looking at a point; unions over textures.
struct MaterialFacts {
  bool hasSpecular = false;      ///< some lobe is a delta distribution
  bool hasNonSpecular = false;   ///< some lobe is not
  bool hasTransmission = false;  ///< light may pass through
  bool isBlack = false;          ///< nothing is ever scattered
  float minRoughness = 1;        ///< of the non-specular lobes, GGX alpha; 1 for diffuse ones
  int maxLobes = 0;              ///< the most lobes that the BSDF at one point may have
};

class Material {
 public:
  virtual ~Material() = default;
  /// The scattering at a point; applies bump and normal maps. Index of refraction follows `hit.state.wavelength`.
  virtual Bsdf GetBsdf(const SurfaceInteraction& hit) const = 0;
  virtual MaterialFacts Facts() const = 0;
};

}  // namespace dapple
