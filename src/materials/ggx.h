// The Trowbridge-Reitz (GGX) distribution of microfacet normals, anisotropic, with Smith's masking. See microfacet.h.
//
// Pharr, Jakob and Humphreys 2023, section 9.6; visible normals: Heitz 2018, "Sampling the GGX distribution of visible
// normals".
#pragma once

#include "src/materials/microfacet.h"

namespace dapple {

class Ggx : public SmithMasking<Ggx> {
 public:
  Ggx() = default;
  /// `alphaX`, `alphaY` in (0, 1] and above; smaller ones than 1e-4 are raised to it.
  Ggx(float alphaX, float alphaY) : alphaX_(std::max(alphaX, 1e-4f)), alphaY_(std::max(alphaY, 1e-4f)) {}

  /// Both alphas under 1e-3: what floats cannot tell from a smooth surface (pbrt-v4, section 9.6.1).
  static bool EffectivelySmooth(float alphaX, float alphaY) { return std::max(alphaX, alphaY) < 1e-3f; }

  float AlphaX() const { return alphaX_; }
  float AlphaY() const { return alphaY_; }
  float MinAlpha() const { return std::min(alphaX_, alphaY_); }

  float D(const Vec3& wm) const {
    const float x = wm.x / alphaX_, y = wm.y / alphaY_;
    return 1 / (kPi * alphaX_ * alphaY_ * Sqr(x * x + y * y + wm.z * wm.z));
  }
  float Stretch(const Vec3& w) const { return std::sqrt(Sqr(alphaX_ * w.x) + Sqr(alphaY_ * w.y) + w.z * w.z); }

  Vec3 SampleVisible(const Vec3& w, const Vec2d& u, double* uc = nullptr) const;
  FacetNumbers InvertVisible(const Vec3& w, const Vec3& wm) const;

 private:
  float alphaX_ = 1, alphaY_ = 1;
};

}  // namespace dapple
