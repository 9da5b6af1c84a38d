// What a scattering lobe does: a set of {diffuse, glossy, specular} x {reflection, transmission}; and which way light
// is followed.
#pragma once

#include <cstdint>
#include <optional>

#include "src/base/color.h"
#include "src/base/vec.h"

namespace dapple {

/// What a walk carries: radiance from the eye, or importance's dual, flux from the lights (Veach 1997, section 3.7).
enum class TransportMode { Radiance, Importance };

/// A set of kinds of scattering.
class LobeFlags {
 public:
  enum Kind : uint8_t {
    kDiffuseReflection = 1,
    kDiffuseTransmission = 2,
    kGlossyReflection = 4,
    kGlossyTransmission = 8,
    kSpecularReflection = 16,
    kSpecularTransmission = 32,
  };

  constexpr LobeFlags() = default;
  constexpr LobeFlags(Kind kind) : bits_(kind) {}

  constexpr bool IsEmpty() const { return bits_ == 0; }
  /// Nothing but delta distributions, and at least one.
  constexpr bool IsSpecular() const { return HasSpecular() && !HasNonSpecular(); }
  constexpr bool HasDiffuse() const { return Has(kDiffuseReflection | kDiffuseTransmission); }
  constexpr bool HasGlossy() const { return Has(kGlossyReflection | kGlossyTransmission); }
  constexpr bool HasSpecular() const { return Has(kSpecularReflection | kSpecularTransmission); }
  constexpr bool HasNonSpecular() const { return HasDiffuse() || HasGlossy(); }
  constexpr bool HasReflection() const { return Has(kDiffuseReflection | kGlossyReflection | kSpecularReflection); }
  constexpr bool HasTransmission() const {
    return Has(kDiffuseTransmission | kGlossyTransmission | kSpecularTransmission);
  }

  constexpr LobeFlags& operator|=(LobeFlags other) {
    bits_ = static_cast<uint8_t>(bits_ | other.bits_);
    return *this;
  }
  friend constexpr LobeFlags operator|(LobeFlags a, LobeFlags b) { return a |= b; }
  friend constexpr LobeFlags operator|(Kind a, Kind b) { return LobeFlags(a) | LobeFlags(b); }
  friend constexpr bool operator==(LobeFlags, LobeFlags) = default;

 private:
  constexpr bool Has(LobeFlags kinds) const { return (bits_ & kinds.bits_) != 0; }

  uint8_t bits_ = 0;
};

/// A direction drawn from one lobe, in the local frame.
struct LobeSample {
  Vec3 wi;
  float pdf = 0;    ///< per solid angle; specular: the discrete probability of this branch
  Color value;      ///< specular: the part of the radiance that goes this way (not yet over pdf); else unused
  float eta = 1;    ///< n_to / n_from; 1 unless refracted
  LobeFlags flags;  ///< of the branch that was drawn
};

}  // namespace dapple
