// pbrt-v3's materials of a diffuse base and a gloss: plastic, substrate and uber.
#pragma once

#include "src/materials/blend_energy.h"
#include "src/materials/bump.h"
#include "src/materials/material.h"
#include "src/materials/roughness.h"

namespace dapple {

/// pbrt-v3 "plastic": Lambertian `kd` plus a gloss `ks`. As in pbrt-v3, Fresnel is taken from inside (index 1.5 to
/// 1).
class PlasticMaterial final : public Material {
 public:
  /// Colours are clamped to [0, 1].
  PlasticMaterial(ColorTexturePtr kd, ColorTexturePtr ks, Roughness roughness, SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

 private:
  ColorTexturePtr kd_, ks_;
  Roughness roughness_;
  SurfaceDetailPtr detail_;
};

/// pbrt-v3 "substrate": Ashikhmin and Shirley's blend of a diffuse base and an anisotropic gloss. Where that would
/// reflect more than arrives, which takes alphas above one, all of it is scaled down (`BlendEnergy`).
class SubstrateMaterial final : public Material {
 public:
  /// Colours are clamped to [0, 1].
  SubstrateMaterial(ColorTexturePtr kd, ColorTexturePtr ks, Roughness roughness, SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

  /// The largest share of light, in any channel and from any direction, that would be reflected without that scale; of
  /// varying `ks` where it is 1. One or less where nothing is scaled; nothing where the roughness varies.
  std::optional<float> LargestUnscaledReflectance() const;

 private:
  ColorTexturePtr kd_, ks_;
  Roughness roughness_;
  std::optional<BlendEnergy> energy_;  ///< of constant roughness
  SurfaceDetailPtr detail_;
};

/// pbrt-v3 "uber": diffuse, gloss, mirror reflection, refraction and opacity.
class UberMaterial final : public Material {
 public:
  struct Parameters {
    ColorTexturePtr kd = {}, ks = {}, kr = {}, kt = {};  ///< clamped to [0, 1]; null: black
    ColorTexturePtr opacity = {};                        ///< clamped to [0, 1]; null: 1. The rest goes straight on
    FloatTexturePtr eta = {};                            ///< index inside over outside; null: 1.5
    Roughness roughness = {};                            ///< of the gloss
  };
  explicit UberMaterial(Parameters parameters, SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

 private:
  Parameters parameters_;
  SurfaceDetailPtr detail_;
};

}  // namespace dapple
