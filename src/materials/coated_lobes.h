// Lobes under a clear dielectric coat, in closed form: no random walk, exact densities. See lobes.h.
//
// The coat is thin, clear and two-sided: both sides of the surface count as outside, as pbrt-v4's layered materials do.
// What the coat itself reflects is a lobe of its own (`CoatReflection` or `RoughDielectricReflection`).
#pragma once

#include "src/materials/coat_transmittance.h"
#include "src/materials/ggx.h"
#include "src/materials/lobe_flags.h"
#include "src/materials/specular_lobes.h"

namespace dapple {

/// The mirror reflection at a smooth coat.
struct CoatReflection : SpecularLobe {
  float eta = 1.5f;  ///< index of the coat over that outside

  CoatReflection() = default;
  explicit CoatReflection(float eta_) : eta(eta_) {}

  LobeFlags Flags() const { return LobeFlags::kSpecularReflection; }
  std::optional<LobeSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;
  Color Albedo(const Vec3& wo) const;
};

/// A Lambertian base of albedo rho under a coat of index eta, all interreflections summed:
///   f = T(wo) T(wi) rho / (pi eta^2 (1 - rho Ri)),
/// where T is the share of light from outside that enters the coat and Ri the share of diffuse light that returns to
/// the base from inside. This is exact, since a Lambertian base forgets directions. For a smooth coat T = 1 - F and 1 -
/// Ri = Te / eta^2, Te the diffuse mean of T: with rho = 1 the base returns 1 - F(wo), with the coat everything.
struct CoatedDiffuseBase {
  Color albedo;                              ///< of the coated base, for the light that has entered the coat
  float eta = 1.5f;                          ///< index of the coat over that outside
  float entering = 1;                        ///< Te
  float alpha = 0;                           ///< of a rough coat
  const CoatTransmittance* rough = nullptr;  ///< of a rough coat; must outlive the lobe

  CoatedDiffuseBase() = default;
  /// Under a smooth coat. `rho`: the base's albedo in [0, 1]; `diffuseReflectance`: FresnelDiffuseReflectance(eta).
  CoatedDiffuseBase(const Color& rho, float eta_, float diffuseReflectance);
  /// Under a coat of roughness `alpha_`.
  CoatedDiffuseBase(const Color& rho, float eta_, float alpha_, const CoatTransmittance& table);

  float Transmittance(const Vec3& w) const;
  LobeFlags Flags() const { return LobeFlags::kDiffuseReflection; }
  Color Value(const Vec3& wo, const Vec3& wi, TransportMode mode) const;
  float Pdf(const Vec3& wo, const Vec3& wi) const;
  std::optional<LobeSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;
  Color Albedo(const Vec3& wo) const;
  float Roughness() const { return 1; }
};

/// A smooth metal under a smooth coat: one mirror, R = F + (1 - F)^2 Rc / (1 - F Rc), exact.
struct CoatedConductorReflection : SpecularLobe {
  float coatEta = 1.5f;  ///< index of the coat over that outside
  Color eta, k;          ///< of the metal, relative to the coat

  CoatedConductorReflection() = default;
  CoatedConductorReflection(float coatEta_, const Color& eta_, const Color& k_) : coatEta(coatEta_), eta(eta_), k(k_) {}

  LobeFlags Flags() const { return LobeFlags::kSpecularReflection; }
  std::optional<LobeSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;
  Color Albedo(const Vec3& wo) const;
};

/// A rough metal under a smooth coat; both directions are refracted into the coat,
///   f = (1 - F(wo)) (1 - F(wi)) f_metal(wo', wi') / (eta^2 (1 - min(F(wo) Rc(wo'), F(wi) Rc(wi')))).
/// The last factor is an approximation: light that the coat returns to the metal is taken as reflected there into the
/// same lobe. Reciprocal; exact in the limit of a smooth metal; never more light than came in.
struct CoatedRoughConductor {
  Ggx ggx;
  float coatEta = 1.5f;  ///< index of the coat over that outside, above one
  Color eta, k;          ///< of the metal, relative to the coat

  LobeFlags Flags() const { return LobeFlags::kGlossyReflection; }
  Color Value(const Vec3& wo, const Vec3& wi, TransportMode mode) const;
  float Pdf(const Vec3& wo, const Vec3& wi) const;
  std::optional<LobeSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;
  Color Albedo(const Vec3& wo) const;
  float Roughness() const { return ggx.MinAlpha(); }
};

}  // namespace dapple
