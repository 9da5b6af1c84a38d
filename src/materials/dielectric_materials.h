// Glass, water and other clear bodies, smooth or rough; and thin sheets of them.
#pragma once

#include "src/materials/bump.h"
#include "src/materials/material.h"
#include "src/materials/roughness.h"

namespace dapple {

/// pbrt-v3 "glass" and pbrt-v4 "dielectric": reflects and refracts; the inside is where `ng` does not point.
class DielectricMaterial final : public Material {
 public:
  /// `eta`: index inside over outside, > 0. `kr`, `kt`: factors of what is reflected and transmitted, clamped to [0,
  /// 1]; null: 1.
  explicit DielectricMaterial(FloatTexturePtr eta, Roughness roughness = {}, ColorTexturePtr kr = nullptr,
                              ColorTexturePtr kt = nullptr, SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

 private:
  FloatTexturePtr eta_;
  Roughness roughness_;
  ColorTexturePtr kr_, kt_;
  SurfaceDetailPtr detail_;
};

/// pbrt-v4 "thindielectric": a sheet that reflects and lets light go straight on.
class ThinDielectricMaterial final : public Material {
 public:
  explicit ThinDielectricMaterial(FloatTexturePtr eta, SurfaceDetailPtr detail = nullptr);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override;

 private:
  FloatTexturePtr eta_;
  SurfaceDetailPtr detail_;
};

}  // namespace dapple
