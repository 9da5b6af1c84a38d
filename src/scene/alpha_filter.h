// Holes cut into a surface by an alpha texture.
#pragma once

#include "src/geometry/accelerator.h"
#include "src/materials/alpha.h"

namespace dapple {

/// A surface that is there with the probability `Coverage` (src/materials/alpha.h). Values between 0 and 1 are decided
/// by a hash of the ray and the hit (pbrt-v4, section 7.1.1), so that the same ray always finds the same.
class AlphaFilter final : public HitFilter {
 public:
  /// `alpha` is not null; pbrt-v3's comes as a `BinaryAlpha`.
  explicit AlphaFilter(FloatTexturePtr alpha) : alpha_(std::move(alpha)) {}
  /// False where the ray goes through a hole.
  bool Accepts(const Shape& shape, const PrimitiveHit& hit, const Ray& ray) const override;

 private:
  FloatTexturePtr alpha_;
};

}  // namespace dapple
