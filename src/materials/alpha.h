// Alpha textures: how much of a surface is there. One rule for rays that meet the surface (src/scene/alpha_filter.h)
// and for light that leaves it (lights/area_light.h), so that both see the same holes.
#pragma once

#include <algorithm>

#include "src/materials/texture.h"

namespace dapple {

/// The probability with which the surface is there, in [0, 1]: alpha, cut to that range (pbrt-v4, section 7.1.1); 0 for
/// NaN.
inline float Coverage(const FloatTexture& alpha, const TextureContext& at) {
  const float value = alpha.Evaluate(at);
  return value > 0 ? std::min(value, 1.f) : 0;
}

/// pbrt-v3's alpha as coverage: there is a hole only where it is 0.
class BinaryAlpha final : public FloatTexture {
 public:
  explicit BinaryAlpha(FloatTexturePtr alpha) : alpha_(std::move(alpha)) {}
  float Evaluate(const TextureContext& at) const override { return alpha_->Evaluate(at) != 0 ? 1.f : 0.f; }
  bool IsConstant() const override { return alpha_->IsConstant(); }

 private:
  FloatTexturePtr alpha_;
};

}  // namespace dapple
