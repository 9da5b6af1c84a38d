// A blend of two materials.
#pragma once

#include <memory>

#include "src/materials/material.h"
#include "src/materials/texture.h"

namespace dapple {

/// `amount` of the first and 1 - `amount` of the second (pbrt-v3's "mix"). pbrt-v4's, which draws one of the two by
/// chance, has the same mean: give its materials in the other order, since there `amount` is the second one's. The
/// blend lies in one frame: that of the material which has the larger share.
class MixMaterial final : public Material {
 public:
  /// Either may be null: no surface, light goes straight on. `amount` is clamped to [0, 1].
  /// Throws `Error` where both together could have more lobes than `Bsdf::kMaxLobes` (deeply nested mixes).
  MixMaterial(std::shared_ptr<const Material> first, std::shared_ptr<const Material> second, ColorTexturePtr amount);
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override;
  MaterialFacts Facts() const override { return facts_; }

 private:
  MaterialFacts FindFacts() const;

  std::shared_ptr<const Material> first_, second_;
  ColorTexturePtr amount_;
  MaterialFacts facts_;
};

}  // namespace dapple
