// Beckmann's distribution of microfacet normals, anisotropic, with Smith's masking. See microfacet.h.
//
// Slopes are normally distributed, of standard deviation alpha / sqrt(2) (Beckmann and Spizzichino 1963; Heitz 2014,
// section 5.4). Lambda is the exact one, by the error function, not a rational fit.
#pragma once

#include "src/materials/microfacet.h"

namespace dapple {

class Beckmann : public SmithMasking<Beckmann> {
 public:
  Beckmann() = default;
  /// `alphaX`, `alphaY` in (0, 1] and above; smaller ones than 1e-4 are raised to it.
  Beckmann(float alphaX, float alphaY) : alphaX_(std::max(alphaX, 1e-4f)), alphaY_(std::max(alphaY, 1e-4f)) {}

  float MinAlpha() const { return std::min(alphaX_, alphaY_); }

  float D(const Vec3& wm) const;
  float Stretch(const Vec3& w) const;

  /// Heitz and d'Eon 2014: in the space where alpha is one, the slope across `w` is normally distributed, and the one
  /// along it has a distribution function in closed form, which is inverted by iteration, to 1e-8.
  Vec3 SampleVisible(const Vec3& w, const Vec2d& u, double* uc = nullptr) const;
  FacetNumbers InvertVisible(const Vec3& w, const Vec3& wm) const;

 private:
  float alphaX_ = 1, alphaY_ = 1;
};

}  // namespace dapple
