// Distributions of microfacet normals by a power of their cosine, with the masking of V-cavities. See microfacet.h.
//
//   D(wm) = sqrt((ex + 2) (ey + 2)) / (2 pi) cos^e(wm),   e = ex cos^2 phi + ey sin^2 phi
// Blinn's half-vector distribution (Blinn 1977; pbrt, first edition, section 9.4.3) where ex = ey, else the anisotropic
// one of Ashikhmin and Shirley (2000), "An anisotropic Phong BRDF model", here normalised as area of facets. Smith's
// Lambda has no closed form for them; V-cavities need none.
#pragma once

#include "src/materials/microfacet.h"

namespace dapple {

class CosinePower : public VCavities<CosinePower> {
 public:
  CosinePower() = default;
  /// Exponents along x and y, from 0 to 2e8; others are moved there.
  CosinePower(float exponentX, float exponentY)
      : exponentX_(std::clamp(exponentX, 0.f, kLargestExponent)),
        exponentY_(std::clamp(exponentY, 0.f, kLargestExponent)) {}

  /// The exponent that makes a highlight as wide as GGX's or Beckmann's alpha, in (0, 1]: 2 / alpha^2 - 2 (Walter et
  /// al. 2007, section 5.2); 0 for alphas above one.
  static float ExponentOfAlpha(float alpha) { return std::max(0.f, 2 / Sqr(alpha) - 2); }

  float ExponentX() const { return exponentX_; }
  float ExponentY() const { return exponentY_; }
  float MinAlpha() const { return std::sqrt(2 / (std::max(exponentX_, exponentY_) + 2)); }

  float D(const Vec3& wm) const;
  /// A normal with z > 0, of density D(wm) cos(wm) per solid angle.
  Vec3 SampleNormal(const Vec2d& u) const;
  /// The random numbers that give `wm`, z > 0.
  Vec2d InvertNormal(const Vec3& wm) const;

 private:
  static constexpr float kLargestExponent = 2e8f;  ///< of alpha = 1e-4

  float exponentX_ = 1, exponentY_ = 1;
};

}  // namespace dapple
