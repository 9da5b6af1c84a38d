// What materials share: their shading frame, textures within bounds, and the adding up of facts.
#pragma once

#include "src/materials/bump.h"
#include "src/materials/material.h"
#include "src/materials/roughness.h"

namespace dapple {

/// A black BSDF in the shading frame that `detail` makes, or in that of `hit` where `detail` is null.
inline Bsdf BlackBsdf(const SurfaceInteraction& hit, const SurfaceDetailPtr& detail) {
  return {hit, detail ? detail->ShadingFrame(hit) : SmoothShadingFrame(hit)};
}

/// A share of light: the texture's colour times `scale`, in [0, 1]; `otherwise` where there is no texture. NaN becomes
/// 0.
inline Color EvaluateShare(const ColorTexturePtr& texture, const TextureContext& at, const Color& otherwise,
                           float scale = 1) {
  if (!texture) return otherwise;
  return Map(texture->Evaluate(at) * scale, [](float x) { return x > 0 ? std::min(x, 1.f) : 0.f; });
}

/// An index of refraction: the texture's value; 1 where it is not positive.
inline float EvaluateEta(const FloatTexturePtr& texture, const TextureContext& at) {
  const float eta = texture->Evaluate(at);
  return eta > 0 && std::isfinite(eta) ? eta : 1;
}

/// Zero everywhere, as far as a constant texture tells; `otherwise` where there is no texture.
inline bool IsAlwaysBlack(const ColorTexturePtr& texture, bool otherwise = false) {
  if (!texture) return otherwise;
  return texture->IsConstant() && EvaluateShare(texture, TextureContext(), Color()).IsBlack();
}

/// Facts of a material without lobes: black, until `AddFact` says otherwise.
inline MaterialFacts NoFacts() {
  MaterialFacts facts;
  facts.isBlack = true;
  return facts;
}

/// `lobes` lobes of kinds `flags` and, where they are not specular, of roughness `minRoughness`.
inline void AddFact(LobeFlags flags, float minRoughness, MaterialFacts* facts, int lobes = 1) {
  if (flags.IsEmpty()) return;
  facts->isBlack = false;
  facts->hasSpecular |= flags.HasSpecular();
  facts->hasNonSpecular |= flags.HasNonSpecular();
  facts->hasTransmission |= flags.HasTransmission();
  if (flags.HasNonSpecular()) facts->minRoughness = std::min(facts->minRoughness, minRoughness);
  facts->maxLobes += lobes;
}

/// A lobe that is glossy, of kind `glossy`, or specular, of kind `smooth`, as `roughness` tells.
inline void AddFact(const Roughness& roughness, LobeFlags glossy, LobeFlags smooth, MaterialFacts* facts) {
  if (!roughness.IsAlwaysSmooth()) AddFact(glossy, roughness.MinAlpha(), facts, 0);
  if (!roughness.IsAlwaysRough()) AddFact(smooth, 0, facts, 0);
  ++facts->maxLobes;
}

}  // namespace dapple
