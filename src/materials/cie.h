// Colorimetry of the CIE: the 1931 2-degree standard observer and the standard illuminants (CIE 15:2004).
//
// The observer turns a spectrum into X, Y, Z; spectrum.h does that and goes on to RGB.
#pragma once

#include <array>

namespace dapple {

/// CIE 1931 tristimulus values.
struct Xyz {
  double x = 0, y = 0, z = 0;

  friend constexpr Xyz operator+(const Xyz& a, const Xyz& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Xyz operator*(const Xyz& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
};

/// CIE 1931 chromaticity coordinates.
struct Chromaticity {
  double x = 0, y = 0;
};

/// The chromaticity of `c`; its sum must not be zero.
inline Chromaticity ChromaticityOf(const Xyz& c) {
  const double sum = c.x + c.y + c.z;
  return {c.x / sum, c.y / sum};
}

/// The tristimulus values of that chromaticity with luminance Y = 1.
inline Xyz XyzOfChromaticity(const Chromaticity& c) { return {c.x / c.y, 1, (1 - c.x - c.y) / c.y}; }

/// The observer's range, in nm, both ends included; its functions count as zero outside.
inline constexpr int kCieFirst = 360, kCieLast = 830;
inline constexpr int kCieSamples = kCieLast - kCieFirst + 1;

/// The colour matching functions at 1 nm steps from `kCieFirst`: the 5 nm table of the CIE, interpolated cubically.
const std::array<Xyz, kCieSamples>& CieColorMatching();

/// The sum of ybar over its 1 nm table: what luminance is normalised by.
inline constexpr double kCieYIntegral = 106.856895;

/// CIE illuminant A (a tungsten lamp at 2856 K), 100 at 560 nm; `nm` > 0.
double IlluminantA(double nm);

/// A CIE daylight illuminant: weights of the second and third of the CIE's daylight components.
struct Daylight {
  double m1 = 0, m2 = 0;

  /// Of a correlated colour temperature in kelvin, clamped to [4000, 25000], where it is defined. D65 is at 6503.616 K
  /// (6500 K times 1.4388 / 1.4380). The weights are rounded to three digits, as the definition of D65 has it.
  static Daylight OfTemperature(double kelvin);
  /// The combination of the components that has this chromaticity; off the daylight locus it is only a metamer.
  static Daylight OfChromaticity(const Chromaticity& c);

  /// The relative power, about 100 at 560 nm; `nm` is clamped to [300, 830].
  double operator()(double nm) const;
};

/// The chromaticity of the CIE fluorescent lamp F`number`, 1 to 12.
Chromaticity FluorescentWhite(int number);

}  // namespace dapple
