// Lobes of rough interfaces: metals, glass, and a gloss over a diffuse base. Single scattering. See lobes.h.
//
// Each is a template over the distribution of its microfacets: `Ggx`, `Beckmann` or `CosinePower`, compiled for these
// three. (Clang learned in version 17 what their deduction guides say.)
#pragma once

#include "src/materials/lobe_flags.h"
#include "src/materials/microfacet_kind.h"

namespace dapple {

/// A rough metal (pbrt-v4, section 9.6; equation 9.31).
template <typename Microfacets>
struct RoughConductor {
  Microfacets microfacets;
  Color eta, k;

  LobeFlags Flags() const { return LobeFlags::kGlossyReflection; }
  Color Value(const Vec3& wo, const Vec3& wi, TransportMode mode) const;
  float Pdf(const Vec3& wo, const Vec3& wi) const;
  std::optional<LobeSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;
  Color Albedo(const Vec3& wo) const;
  float Roughness() const { return microfacets.MinAlpha(); }
};
template <typename Microfacets, typename... Rest>
RoughConductor(Microfacets, Rest...) -> RoughConductor<Microfacets>;

/// The reflection alone of a rough dielectric interface: the gloss of pbrt-v3's "plastic" and "uber", and rough coats.
/// The index may differ by side, since pbrt-v3's plastic reflects as seen from inside.
template <typename Microfacets>
struct RoughDielectricReflection {
  Microfacets microfacets;
  Color reflectance{1};       ///< factor of Fresnel's reflectance
  float etaAbove = 1.5f;      ///< Fresnel's eta for directions with z > 0
  float etaBelow = 1 / 1.5f;  ///< and with z < 0

  LobeFlags Flags() const { return LobeFlags::kGlossyReflection; }
  Color Value(const Vec3& wo, const Vec3& wi, TransportMode mode) const;
  float Pdf(const Vec3& wo, const Vec3& wi) const;
  std::optional<LobeSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;
  Color Albedo(const Vec3& wo) const;
  float Roughness() const { return microfacets.MinAlpha(); }
};
template <typename Microfacets, typename... Rest>
RoughDielectricReflection(Microfacets, Rest...) -> RoughDielectricReflection<Microfacets>;

/// Indices too near to each other for the half vector of refraction to be known: use a smooth interface.
inline bool NearIndexMatch(float eta) { return std::abs(eta - 1) < 1e-3f; }

/// A rough interface that reflects and refracts (Walter et al. 2007; pbrt-v4, section 9.7).
template <typename Microfacets>
struct RoughDielectric {
  Microfacets microfacets;
  float eta = 1.5f;                        ///< index below (z < 0) over index above; not 1, see `NearIndexMatch`
  Color reflectance{1}, transmittance{1};  ///< factors of Fresnel's shares, v3's Kr and Kt

  LobeFlags Flags() const;
  Color Value(const Vec3& wo, const Vec3& wi, TransportMode mode) const;
  float Pdf(const Vec3& wo, const Vec3& wi) const;
  std::optional<LobeSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;
  Color Albedo(const Vec3& wo) const;
  float Roughness() const { return microfacets.MinAlpha(); }

 private:
  /// Probability of reflection at a microfacet that reflects the share `fresnel`; 0 where nothing goes on.
  float ReflectionProbability(float fresnel) const;
};
template <typename Microfacets, typename... Rest>
RoughDielectric(Microfacets, Rest...) -> RoughDielectric<Microfacets>;

/// A rough gloss blended over a diffuse base by Fresnel (Ashikhmin and Shirley 2000; pbrt-v3, section 8.5,
/// "substrate").
template <typename Microfacets>
struct FresnelBlend {
  Microfacets microfacets;
  Color diffuse, specular;  ///< Rd and Rs, in [0, 1]

  LobeFlags Flags() const { return LobeFlags::kDiffuseReflection | LobeFlags::kGlossyReflection; }
  Color Value(const Vec3& wo, const Vec3& wi, TransportMode mode) const;
  float Pdf(const Vec3& wo, const Vec3& wi) const;
  std::optional<LobeSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;
  Color Albedo(const Vec3& wo) const;
  float Roughness() const { return microfacets.MinAlpha(); }

 private:
  /// Probability of drawing the gloss rather than the base.
  float GlossProbability(const Vec3& wo) const;
};
template <typename Microfacets, typename... Rest>
FresnelBlend(Microfacets, Rest...) -> FresnelBlend<Microfacets>;

}  // namespace dapple
