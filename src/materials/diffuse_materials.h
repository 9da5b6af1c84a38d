// Materials without gloss: matte surfaces and diffusing sheets; and v3's translucent, a diffusing sheet with a gloss.
#pragma once

#include "src/materials/bump.h"
#include "src/materials/material.h"
#include "src/materials/roughness.h"

namespace dapple {

/// pbrt-v3 "matte" and pbrt-v4 "diffuse": Lambertian, or Oren-Nayar where `sigma` is not zero.
class MatteMaterial final : public Material {
 public:
  /// `reflectance` is clamped to [0, 1]; `sigma` in degrees, clamped to [0, 90], null: 0.
  explicit MatteMaterial(ColorTexturePtr reflectance, FloatTexturePtr sigma = nullptr,
                         SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

 private:
  ColorTexturePtr reflectance_;
  FloatTexturePtr sigma_;
  SurfaceDetailPtr detail_;
};

/// pbrt-v4 "diffusetransmission": Lambertian reflection and transmission.
class DiffuseTransmissionMaterial final : public Material {
 public:
  /// Both are multiplied by `scale`, then clamped to [0, 1].
  DiffuseTransmissionMaterial(ColorTexturePtr reflectance, ColorTexturePtr transmittance, float scale = 1,
                              SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

 private:
  ColorTexturePtr reflectance_, transmittance_;
  float scale_;
  SurfaceDetailPtr detail_;
};

/// pbrt-v3 "translucent": diffuse `kd` and rough dielectric `ks` (eta 1.5), each shared out by `reflect` and
/// `transmit`.
class TranslucentMaterial final : public Material {
 public:
  /// Colours are clamped to [0, 1], null: black. Fresnel's equations share `ks` out further; where the roughness is
  /// zero the dielectric is smooth.
  TranslucentMaterial(ColorTexturePtr kd, ColorTexturePtr ks, Roughness roughness, ColorTexturePtr reflect,
                      ColorTexturePtr transmit, SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

 private:
  ColorTexturePtr kd_, ks_, reflect_, transmit_;
  Roughness roughness_;
  SurfaceDetailPtr detail_;
};

}  // namespace dapple
