// Holes cut into a surface by an alpha texture.
#pragma once

#include "src/geometry/accelerator.h"
#include "src/materials/texture.h"

namespace dapple {

/// A surface that is there with probability alpha. Values between 0 and 1 are decided by a hash of the ray and the hit
/// (pbrt-v4, section 7.1.1), so that the same ray always finds the same.
class AlphaFilter final : public HitFilter {
 public:
  /// `isBinary`: as in pbrt-v3, there is a hole only where alpha is 0.
  AlphaFilter(FloatTexturePtr alpha, bool isBinary) : alpha_(std::move(alpha)), isBinary_(isBinary) {}
  bool Accepts(const Shape& shape, const PrimitiveHit& hit, const Ray& ray) const override;

 private:
  FloatTexturePtr alpha_;
  bool isBinary_;
};

}  // namespace dapple
