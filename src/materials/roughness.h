// The roughness of a material as its textures give it, and the microfacet distribution that follows.
#pragma once

#include <optional>

#include "src/materials/microfacet_kind.h"
#include "src/materials/texture.h"

namespace dapple {

/// How a roughness parameter becomes a GGX alpha: as it is, or by the map of pbrt-v3 or pbrt-v4.
enum class RoughnessRemap { None, V3, V4 };

/// Roughness along the tangents u and v.
class Roughness {
 public:
  /// Smooth.
  Roughness() = default;
  /// The same both ways; null: smooth.
  Roughness(FloatTexturePtr roughness, RoughnessRemap remap) : Roughness(std::move(roughness), nullptr, remap) {}
  /// `v` null: as `u`; both null: smooth.
  Roughness(FloatTexturePtr u, FloatTexturePtr v, RoughnessRemap remap);

  /// The distribution that is to have this roughness; GGX unless set.
  MicrofacetKind Kind() const { return kind_; }
  void SetKind(MicrofacetKind kind) { kind_ = kind; }

  /// The roughness at a point, as GGX has it (see `WithMicrofacets` for the others); nothing where the surface is
  /// effectively smooth (`Ggx::EffectivelySmooth`).
  std::optional<Ggx> Evaluate(const TextureContext& at) const;

  /// Smooth at every point, as far as constant textures tell.
  bool IsAlwaysSmooth() const;
  /// Rough at every point, as far as constant textures tell.
  bool IsAlwaysRough() const;
  /// The same where it is one everywhere, and rough.
  std::optional<Ggx> Constant() const;
  /// A lower bound of the alphas: exact for constant textures.
  float MinAlpha() const;

 private:
  bool IsConstant() const;

  FloatTexturePtr u_, v_;
  RoughnessRemap remap_ = RoughnessRemap::None;
  MicrofacetKind kind_ = MicrofacetKind::Ggx;
};

}  // namespace dapple
