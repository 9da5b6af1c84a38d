// Microfacet theory: what distributions of microfacet normals have in common.
//
// A distribution (`Ggx`, `Beckmann`, `CosinePower`) is a small value in the local frame, z along the normal, and has
//   D(wm)                       area of microfacets per solid angle of normal; D(wm) |cos(wm)| integrates to one over a
//                               hemisphere
//   G1(w, wm)                   masking: the share of the facets of normal wm that is seen from w, where Dot(w, wm) > 0
//   G(wo, wi, wm)               masking and shadowing: the share that is seen from both; refraction where wo and wi are
//                               on different sides
//   GOverCosines(wo, wi, wm)    G / (2 |cos wo| |cos wi|), without the division by small cosines
//   VisiblePdf(w, wm)           density per solid angle of the normals visible from w: G1 D |w.wm| / |cos w|
//   VisiblePdfOverD(w, wm)      G1 / |cos w|
//   SampleVisible(w, u, uc)     a normal visible from w, with Dot(w, wm) > 0, z on the side of w.z. Takes from the
//                               uniform number `uc` what it needs, and leaves there one that is uniform again
//   InvertVisible(w, wm)        random numbers that make `SampleVisible` give wm
//   MinAlpha()                  roughness as GGX's alpha; the smaller one where there are two
// Either side of the surface counts as outside, and signs of z are ignored but where they are spoken of. The masking
// of each is such that the projected area of visible facets is that of the surface (Heitz 2014, equation 16).
#pragma once

#include "src/base/frame.h"
#include "src/base/numerics.h"
#include "src/base/vec.h"

namespace dapple {

/// Random numbers from which a facet is drawn.
struct FacetNumbers {
  Vec2d u;
  double uc = 0.5;
};

/// Smith's masking, for facets that know nothing of their neighbours (Heitz 2014, section 5), and height-correlated
/// (pbrt-v4, equation 9.22). `Distribution` has Stretch(w) = |cos w| (1 + 2 Lambda(w)), which unlike Lambda is finite
/// at grazing angles.
template <typename Distribution>
class SmithMasking {
 public:
  float Lambda(const Vec3& w) const { return (Stretch(w) / AbsCosTheta(w) - 1) / 2; }
  float G1(const Vec3& w) const { return 2 * AbsCosTheta(w) / (AbsCosTheta(w) + Stretch(w)); }
  float G1(const Vec3& w, const Vec3&) const { return G1(w); }
  float G(const Vec3& wo, const Vec3& wi) const { return 2 * AbsCosTheta(wo) * AbsCosTheta(wi) * GOverCosines(wo, wi); }
  float G(const Vec3& wo, const Vec3& wi, const Vec3&) const { return G(wo, wi); }
  float GOverCosines(const Vec3& wo, const Vec3& wi, const Vec3& = {}) const {
    return 1 / (AbsCosTheta(wi) * Stretch(wo) + AbsCosTheta(wo) * Stretch(wi));
  }
  float VisiblePdfOverD(const Vec3& w, const Vec3& = {}) const { return 2 / (AbsCosTheta(w) + Stretch(w)); }
  float VisiblePdf(const Vec3& w, const Vec3& wm) const {
    return static_cast<const Distribution&>(*this).D(wm) * VisiblePdfOverD(w) * AbsDot(w, wm);
  }

 private:
  float Stretch(const Vec3& w) const { return static_cast<const Distribution&>(*this).Stretch(w); }
};

/// The masking of V-shaped grooves (Cook and Torrance 1982; Heitz 2014, section 6.2): each facet has one twin, its
/// mirror image about z. It keeps the projected area for every distribution that has this symmetry, also where Smith's
/// Lambda has no closed form. `Distribution` has D, SampleNormal(u) (by D cos, z > 0) and its inverse InvertNormal(wm).
/// Visible normals: Heitz and d'Eon 2014, "Importance sampling microfacet-based BSDFs using the distribution of visible
/// normals", section 5.
template <typename Distribution>
class VCavities {
 public:
  float G1(const Vec3& w, const Vec3& wm) const {
    return std::min(1.f, 2 * AbsCosTheta(wm) * AbsCosTheta(w) / AbsDot(w, wm));
  }
  /// What is masked is the facet's lower end: the same one for both directions of a reflection, and of a refraction one
  /// end for each.
  float G(const Vec3& wo, const Vec3& wi, const Vec3& wm) const {
    const float o = G1(wo, wm), i = G1(wi, wm);
    return SameHemisphere(wo, wi) ? std::min(o, i) : std::max(0.f, o + i - 1);
  }
  float GOverCosines(const Vec3& wo, const Vec3& wi, const Vec3& wm) const {
    constexpr float kLargest = 1e30f;  // two cosines together may be too small for floats
    const float cosO = AbsCosTheta(wo), cosI = AbsCosTheta(wi);
    const float unmasked = std::min(kLargest, 1 / (2 * cosO * cosI));
    if (!SameHemisphere(wo, wi)) return G(wo, wi, wm) * unmasked;
    return std::min(unmasked, AbsCosTheta(wm) / (AbsDot(wo, wm) * std::max(cosO, cosI)));
  }
  float VisiblePdfOverD(const Vec3& w, const Vec3& wm) const {
    return std::min(1 / AbsCosTheta(w), 2 * AbsCosTheta(wm) / AbsDot(w, wm));
  }
  float VisiblePdf(const Vec3& w, const Vec3& wm) const {
    return Self().D(wm) * VisiblePdfOverD(w, wm) * AbsDot(w, wm);
  }

  Vec3 SampleVisible(const Vec3& w, const Vec2d& u, double* uc) const {
    const Vec3 wm = Self().SampleNormal(u) * (w.z < 0 ? -1.f : 1.f);
    const double share = ShareOf(w, wm);
    if (*uc < share) {
      *uc = std::min(*uc / share, kBelowOne);
      return wm;
    }
    *uc = std::min((*uc - share) / (1 - share), kBelowOne);
    return Twin(wm);
  }
  FacetNumbers InvertVisible(const Vec3& w, const Vec3& wm) const {
    return {Self().InvertNormal(wm.z < 0 ? -wm : wm), ShareOf(w, wm) / 2};
  }

 private:
  static constexpr double kBelowOne = 0x1.fffffffffffffp-1;

  static Vec3 Twin(const Vec3& wm) { return {-wm.x, -wm.y, wm.z}; }
  /// Of what is seen of a groove, how much is its side of normal `wm`.
  static double ShareOf(const Vec3& w, const Vec3& wm) {
    const double here = static_cast<double>(Dot(w, wm)), there = static_cast<double>(Dot(w, Twin(wm)));
    if (!(here > 0)) return 0;
    return there > 0 ? here / (here + there) : 1;
  }
  const Distribution& Self() const { return static_cast<const Distribution&>(*this); }
};

/// pbrt-v3's map from roughness in [0, 1] to alpha (TrowbridgeReitzDistribution::RoughnessToAlpha).
float RoughnessToAlphaV3(float roughness);
/// pbrt-v4's map from roughness in [0, 1] to alpha: the square root.
float RoughnessToAlphaV4(float roughness);

}  // namespace dapple
