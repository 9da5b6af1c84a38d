#include "src/materials/roughness.h"

namespace dapple {

namespace {

float ToAlpha(float roughness, RoughnessRemap remap) {
  if (!(roughness > 0)) roughness = 0;
  switch (remap) {
    case RoughnessRemap::V3:
      return RoughnessToAlphaV3(roughness);
    case RoughnessRemap::V4:
      return RoughnessToAlphaV4(roughness);
    case RoughnessRemap::None:
      break;
  }
  return roughness;
}

}  // namespace

Roughness::Roughness(FloatTexturePtr u, FloatTexturePtr v, RoughnessRemap remap)
    : u_(std::move(u)), v_(std::move(v)), remap_(remap) {
  if (!u_) std::swap(u_, v_);
}

std::optional<Ggx> Roughness::Evaluate(const TextureContext& at) const {
  if (!u_) return std::nullopt;
  const float alphaU = ToAlpha(u_->Evaluate(at), remap_);
  const float alphaV = v_ ? ToAlpha(v_->Evaluate(at), remap_) : alphaU;
  if (Ggx::EffectivelySmooth(alphaU, alphaV)) return std::nullopt;
  return Ggx(alphaU, alphaV);
}

bool Roughness::IsConstant() const { return !u_ || (u_->IsConstant() && (!v_ || v_->IsConstant())); }

std::optional<Ggx> Roughness::Constant() const { return IsConstant() ? Evaluate(TextureContext()) : std::nullopt; }

bool Roughness::IsAlwaysSmooth() const { return IsConstant() && !Constant(); }

bool Roughness::IsAlwaysRough() const {
  // pbrt-v3's map never comes near zero.
  return u_ && (remap_ == RoughnessRemap::V3 || Constant());
}

float Roughness::MinAlpha() const {
  if (const std::optional<Ggx> ggx = Constant()) return ggx->MinAlpha();
  return u_ && remap_ == RoughnessRemap::V3 ? RoughnessToAlphaV3(0) : 0;
}

}  // namespace dapple
