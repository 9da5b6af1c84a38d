// Diffuse lobes: Lambert's reflection and transmission, and Oren and Nayar's rough reflection. See lobes.h.
#pragma once

#include "src/base/frame.h"
#include "src/base/numerics.h"
#include "src/materials/lobe_flags.h"
#include "src/sampling/warps.h"

namespace dapple {

/// By the cosine on the side of the surface that the sign of `side` tells; pdf |cos| / pi.
inline LobeSample SampleCosineOn(float side, const Vec2d& u, LobeFlags flags) {
  const Vec3 w = ToFloat(SampleCosineHemisphere(u));
  LobeSample sample;
  sample.wi = {w.x, w.y, std::copysign(w.z, side)};
  sample.pdf = w.z * kInvPi;
  sample.flags = flags;
  return sample;
}

/// The same radiance to all sides of reflection (Lambert).
struct LambertianReflection {
  Color albedo;  ///< in [0, 1]

  LobeFlags Flags() const { return LobeFlags::kDiffuseReflection; }
  Color Value(const Vec3& wo, const Vec3& wi, TransportMode) const {
    return SameHemisphere(wo, wi) ? albedo * kInvPi : Color();
  }
  float Pdf(const Vec3& wo, const Vec3& wi) const { return SameHemisphere(wo, wi) ? AbsCosTheta(wi) * kInvPi : 0; }
  std::optional<LobeSample> Sample(const Vec3& wo, double, const Vec2d& u, TransportMode) const {
    return SampleCosineOn(wo.z, u, Flags());
  }
  Color Albedo(const Vec3&) const { return albedo; }
  float Roughness() const { return 1; }
};

/// The same radiance to all sides of transmission; no refraction, as a thin sheet.
struct LambertianTransmission {
  Color albedo;  ///< in [0, 1]

  LobeFlags Flags() const { return LobeFlags::kDiffuseTransmission; }
  Color Value(const Vec3& wo, const Vec3& wi, TransportMode) const {
    return wo.z * wi.z < 0 ? albedo * kInvPi : Color();
  }
  float Pdf(const Vec3& wo, const Vec3& wi) const { return wo.z * wi.z < 0 ? AbsCosTheta(wi) * kInvPi : 0; }
  std::optional<LobeSample> Sample(const Vec3& wo, double, const Vec2d& u, TransportMode) const {
    return SampleCosineOn(-wo.z, u, Flags());
  }
  Color Albedo(const Vec3&) const { return albedo; }
  float Roughness() const { return 1; }
};

/// Lambertian V-grooves with normally distributed slopes (Oren and Nayar 1994; pbrt-v3, section 8.4.1).
struct OrenNayarReflection {
  Color albedo;        ///< of the grooves' walls, in [0, 1]
  float a = 1, b = 0;  ///< the model's A and B

  OrenNayarReflection() = default;
  /// `sigmaDegrees`: the standard deviation of the slope's angle, in [0, 90] degrees.
  OrenNayarReflection(const Color& wallAlbedo, float sigmaDegrees) : albedo(wallAlbedo) {
    const float variance = Sqr(static_cast<float>(Radians(sigmaDegrees)));
    a = 1 - variance / (2 * (variance + 0.33f));
    b = 0.45f * variance / (variance + 0.09f);
  }

  LobeFlags Flags() const { return LobeFlags::kDiffuseReflection; }
  Color Value(const Vec3& wo, const Vec3& wi, TransportMode) const {
    if (!SameHemisphere(wo, wi)) return Color();
    // cos(phi_i - phi_o) sin(alpha) tan(beta), where {alpha, beta} = {theta_i, theta_o} and beta is the smaller one.
    const float along = std::max(0.f, wo.x * wi.x + wo.y * wi.y) / std::max(AbsCosTheta(wo), AbsCosTheta(wi));
    return albedo * (kInvPi * (a + b * along));
  }
  float Pdf(const Vec3& wo, const Vec3& wi) const { return SameHemisphere(wo, wi) ? AbsCosTheta(wi) * kInvPi : 0; }
  std::optional<LobeSample> Sample(const Vec3& wo, double, const Vec2d& u, TransportMode) const {
    return SampleCosineOn(wo.z, u, Flags());
  }
  /// The integral of `Value` times cosine, exactly.
  Color Albedo(const Vec3& wo) const;
  float Roughness() const { return 1; }
};

}  // namespace dapple
