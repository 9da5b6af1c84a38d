// pbrt-v4's layered materials in closed form: a clear dielectric coat over a diffuse or a metal base.
//
// Between coat and base there is no medium: pbrt's `albedo` and `g` have no counterpart, and with them `thickness` has
// no effect. Depth and sample limits are not needed: all interreflections are in the formula.
#pragma once

#include "src/materials/bump.h"
#include "src/materials/material.h"
#include "src/materials/roughness.h"

namespace dapple {

/// pbrt-v4 "coateddiffuse". What its random walk converges to; under an anisotropic coat the base sees the mean
/// roughness.
class CoatedDiffuseMaterial final : public Material {
 public:
  /// `reflectance`: of the base, clamped to [0, 1]; `roughness` and `eta` > 0: the coat's.
  CoatedDiffuseMaterial(ColorTexturePtr reflectance, Roughness roughness, float eta = 1.5f,
                        SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

 private:
  ColorTexturePtr reflectance_;
  Roughness roughness_;
  float eta_, diffuseReflectance_;
  std::optional<CoatTransmittance> roughCoat_;  ///< where the coat may be rough
  SurfaceDetailPtr detail_;
};

/// pbrt-v4 "coatedconductor". Exact where both are smooth; otherwise see `CoatedRoughConductor`.
class CoatedConductorMaterial final : public Material {
 public:
  struct Parameters {
    Roughness coatRoughness = {};
    float coatEta = 1.5f;  ///< index of the coat over that outside, >= 1
    Roughness conductorRoughness = {};
    ColorTexturePtr eta = {}, k = {};  ///< of the metal in vacuum; null where `reflectance` is given
    ColorTexturePtr reflectance = {};  ///< of the bare metal at normal incidence; null where `eta` and `k` are given
  };
  explicit CoatedConductorMaterial(Parameters parameters, SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

 private:
  Parameters parameters_;
  SurfaceDetailPtr detail_;
};

}  // namespace dapple
