// Mirrors and metals.
#pragma once

#include "src/materials/bump.h"
#include "src/materials/material.h"
#include "src/materials/roughness.h"

namespace dapple {

/// pbrt-v3 "mirror": reflects `reflectance`, clamped to [0, 1], at every angle.
class MirrorMaterial final : public Material {
 public:
  explicit MirrorMaterial(ColorTexturePtr reflectance, SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

 private:
  ColorTexturePtr reflectance_;
  SurfaceDetailPtr detail_;
};

/// pbrt-v3 "metal" and pbrt-v4 "conductor": Fresnel's reflection, smooth or rough.
class ConductorMaterial final : public Material {
 public:
  /// Of index `eta` + i `k`.
  ConductorMaterial(ColorTexturePtr eta, ColorTexturePtr k, Roughness roughness, SurfaceDetailPtr detail = nullptr);
  /// Of the reflectance at normal incidence (see `ConductorKFromReflectance`).
  ConductorMaterial(ColorTexturePtr reflectance, Roughness roughness, SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

 private:
  ColorTexturePtr eta_, k_;      ///< null where `reflectance_` is given
  ColorTexturePtr reflectance_;  ///< null where `eta_` and `k_` are
  Roughness roughness_;
  SurfaceDetailPtr detail_;
};

}  // namespace dapple
