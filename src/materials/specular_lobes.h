// Delta lobes: mirrors, smooth metals, smooth glass, thin sheets of glass, and holes. See lobes.h.
#pragma once

#include "src/base/frame.h"
#include "src/base/numerics.h"
#include "src/materials/lobe_flags.h"

namespace dapple {

/// What all delta lobes share: nothing can be evaluated, and there is no density.
struct SpecularLobe {
  Color Value(const Vec3&, const Vec3&, TransportMode) const { return Color(); }
  float Pdf(const Vec3&, const Vec3&) const { return 0; }
  float Roughness() const { return 0; }

 protected:
  /// The mirror direction with the share `value` of the light, drawn with probability `pdf`.
  static LobeSample Reflected(const Vec3& wo, const Color& value, float pdf) {
    return {{-wo.x, -wo.y, wo.z}, pdf, value, 1, LobeFlags::kSpecularReflection};
  }
};

/// A mirror of the same reflectance at every angle (pbrt-v3's "mirror").
struct MirrorReflection : SpecularLobe {
  Color reflectance;

  MirrorReflection() = default;
  explicit MirrorReflection(const Color& r) : reflectance(r) {}

  LobeFlags Flags() const { return LobeFlags::kSpecularReflection; }
  std::optional<LobeSample> Sample(const Vec3& wo, double, const Vec2d&, TransportMode) const {
    return Reflected(wo, reflectance, 1);
  }
  Color Albedo(const Vec3&) const { return reflectance; }
};

/// A smooth metal of index eta + i k.
struct ConductorReflection : SpecularLobe {
  Color eta, k;

  ConductorReflection() = default;
  ConductorReflection(const Color& eta_, const Color& k_) : eta(eta_), k(k_) {}

  LobeFlags Flags() const { return LobeFlags::kSpecularReflection; }
  std::optional<LobeSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;
  Color Albedo(const Vec3& wo) const;
};

/// A smooth interface that reflects and refracts; which of them is drawn by the share of light that goes there.
struct SmoothDielectric : SpecularLobe {
  float eta = 1;                           ///< index below (z < 0) over index above
  Color reflectance{1}, transmittance{1};  ///< factors of Fresnel's shares, v3's Kr and Kt

  SmoothDielectric() = default;
  explicit SmoothDielectric(float eta_, const Color& r = Color(1), const Color& t = Color(1))
      : eta(eta_), reflectance(r), transmittance(t) {}

  LobeFlags Flags() const;
  std::optional<LobeSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;
  Color Albedo(const Vec3& wo) const;
};

/// A sheet of glass thin enough that what passes leaves where it entered and goes straight on; all orders of
/// reflection between the two interfaces are summed (pbrt-v4, section 9.5.2).
struct ThinDielectric : SpecularLobe {
  float eta = 1;  ///< index of the sheet over that of its surroundings

  ThinDielectric() = default;
  explicit ThinDielectric(float eta_) : eta(eta_) {}

  LobeFlags Flags() const { return LobeFlags::kSpecularReflection | LobeFlags::kSpecularTransmission; }
  std::optional<LobeSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;
  Color Albedo(const Vec3&) const { return Color(1); }
};

/// Light goes straight on: what opacity below one leaves (pbrt-v3's "uber"), or no surface at all.
struct PassThrough : SpecularLobe {
  Color transmittance{1};

  PassThrough() = default;
  explicit PassThrough(const Color& t) : transmittance(t) {}

  LobeFlags Flags() const { return LobeFlags::kSpecularTransmission; }
  std::optional<LobeSample> Sample(const Vec3& wo, double, const Vec2d&, TransportMode) const {
    return LobeSample{-wo, 1, transmittance, 1, LobeFlags::kSpecularTransmission};
  }
  Color Albedo(const Vec3&) const { return transmittance; }
};

}  // namespace dapple
