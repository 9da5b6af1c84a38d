#include "src/materials/specular_lobes.h"

#include "src/materials/fresnel.h"

namespace dapple {

std::optional<LobeSample> ConductorReflection::Sample(const Vec3& wo, double, const Vec2d&, TransportMode) const {
  return Reflected(wo, Albedo(wo), 1);
}

Color ConductorReflection::Albedo(const Vec3& wo) const { return FresnelConductor(CosTheta(wo), eta, k); }

LobeFlags SmoothDielectric::Flags() const {
  LobeFlags flags;
  if (!reflectance.IsBlack()) flags |= LobeFlags::kSpecularReflection;
  if (!transmittance.IsBlack()) flags |= LobeFlags::kSpecularTransmission;
  return flags;
}

std::optional<LobeSample> SmoothDielectric::Sample(const Vec3& wo, double uc, const Vec2d&, TransportMode mode) const {
  const float fresnel = FresnelDielectric(CosTheta(wo), eta);
  const Color reflected = reflectance * fresnel, transmitted = transmittance * (1 - fresnel);
  const float r = reflected.MaxComponent(), t = transmitted.MaxComponent();
  if (!(r + t > 0)) return std::nullopt;
  const float probability = r / (r + t);
  if (uc < static_cast<double>(probability)) return Reflected(wo, reflected, probability);

  const std::optional<Refraction> refraction = Refract(wo, Vec3(0, 0, 1), eta);
  if (!refraction) return std::nullopt;
  const float scale = mode == TransportMode::Radiance ? 1 / Sqr(refraction->eta) : 1;
  return LobeSample{refraction->w, 1 - probability, transmitted * scale, refraction->eta,
                    LobeFlags::kSpecularTransmission};
}

Color SmoothDielectric::Albedo(const Vec3& wo) const {
  const float fresnel = FresnelDielectric(CosTheta(wo), eta);
  return reflectance * fresnel + transmittance * (1 - fresnel);
}

std::optional<LobeSample> ThinDielectric::Sample(const Vec3& wo, double uc, const Vec2d&, TransportMode) const {
  // R + T R T + T R R R T + ... = 2 R / (1 + R), pbrt's R + T^2 R / (1 - R^2) without its 0 / 0 at R = 1.
  const float once = FresnelDielectric(AbsCosTheta(wo), eta);
  const float reflected = 2 * once / (1 + once);
  if (uc < static_cast<double>(reflected)) return Reflected(wo, Color(reflected), reflected);
  return LobeSample{-wo, 1 - reflected, Color(1 - reflected), 1, LobeFlags::kSpecularTransmission};
}

}  // namespace dapple
