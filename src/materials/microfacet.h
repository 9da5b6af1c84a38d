// The Trowbridge-Reitz (GGX) distribution of microfacet normals, anisotropic, with Smith's height-correlated masking.
//
// Pharr, Jakob and Humphreys 2023, section 9.6; visible normals: Heitz 2018, "Sampling the GGX distribution of visible
// normals". Directions are local, and either side of the surface counts as outside (the sign of z is taken from `w`).
#pragma once

#include "src/base/frame.h"
#include "src/base/numerics.h"
#include "src/base/vec.h"

namespace dapple {

class Ggx {
 public:
  Ggx() = default;
  /// `alphaX`, `alphaY` in (0, 1] and above; smaller ones than 1e-4 are raised to it.
  Ggx(float alphaX, float alphaY) : alphaX_(std::max(alphaX, 1e-4f)), alphaY_(std::max(alphaY, 1e-4f)) {}

  /// Both alphas under 1e-3: what floats cannot tell from a smooth surface (pbrt-v4, section 9.6.1).
  static bool EffectivelySmooth(float alphaX, float alphaY) { return std::max(alphaX, alphaY) < 1e-3f; }

  float AlphaX() const { return alphaX_; }
  float AlphaY() const { return alphaY_; }
  float MinAlpha() const { return std::min(alphaX_, alphaY_); }

  /// Area of microfacets per solid angle of normal `wm`; the integral of D(wm) |cos(wm)| over a hemisphere is one.
  float D(const Vec3& wm) const {
    const float x = wm.x / alphaX_, y = wm.y / alphaY_;
    return 1 / (kPi * alphaX_ * alphaY_ * Sqr(x * x + y * y + wm.z * wm.z));
  }

  /// |z| (1 + 2 Lambda(w)): Smith's terms without a division by the cosine, so that grazing directions stay exact.
  float Stretch(const Vec3& w) const { return std::sqrt(Sqr(alphaX_ * w.x) + Sqr(alphaY_ * w.y) + w.z * w.z); }
  float Lambda(const Vec3& w) const { return (Stretch(w) / AbsCosTheta(w) - 1) / 2; }
  float G1(const Vec3& w) const { return 2 * AbsCosTheta(w) / (AbsCosTheta(w) + Stretch(w)); }
  /// Share of microfacets seen from both directions, height-correlated (pbrt-v4, equation 9.22).
  float G(const Vec3& wo, const Vec3& wi) const { return 2 * AbsCosTheta(wo) * AbsCosTheta(wi) * GOverCosines(wo, wi); }
  /// G(wo, wi) / (2 |cos wo| |cos wi|).
  float GOverCosines(const Vec3& wo, const Vec3& wi) const {
    return 1 / (AbsCosTheta(wi) * Stretch(wo) + AbsCosTheta(wo) * Stretch(wi));
  }

  /// Density per solid angle of the normals visible from `w`, for wm on the side of `w`.
  float VisiblePdf(const Vec3& w, const Vec3& wm) const { return D(wm) * VisiblePdfOverD(w) * AbsDot(w, wm); }
  /// G1(w) / |cos w|.
  float VisiblePdfOverD(const Vec3& w) const { return 2 / (AbsCosTheta(w) + Stretch(w)); }
  /// A normal visible from `w`, with Dot(w, wm) > 0, z on the side of w.z.
  Vec3 SampleVisible(const Vec3& w, const Vec2d& u) const;

 private:
  float alphaX_ = 1, alphaY_ = 1;
};

/// pbrt-v3's map from roughness in [0, 1] to alpha (TrowbridgeReitzDistribution::RoughnessToAlpha).
float RoughnessToAlphaV3(float roughness);
/// pbrt-v4's map from roughness in [0, 1] to alpha: the square root.
float RoughnessToAlphaV4(float roughness);

}  // namespace dapple
