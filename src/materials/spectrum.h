// Spectra, and the linear RGB colours that stand for them: by integration with the CIE 1931 observer.
//
// The renderer works in RGB, so a spectrum becomes a colour once, when the scene is built; how depends on what pbrt
// does with it. pbrt-v3 (as built by default) does the same with every spectrum: `SpectrumToColorV3`. pbrt-v4 renders
// wavelengths, so the colour is the one that gives about the same image: reflectances and indices of refraction are
// seen under white light (`SpectrumToColorV4`), and emission is normalised to luminance one (`EmissionToColorV4`),
// which pbrt-v4 does for every light, before its "scale".
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/color.h"
#include "src/base/error.h"
#include "src/materials/cie.h"

namespace dapple {

/// A function of the wavelength in nm, piecewise linear between samples.
class Spectrum {
 public:
  /// Values beyond the first and the last sample: as these (pbrt-v3), or zero (pbrt-v4).
  enum class Outside { kConstant, kZero };

  /// Samples may come in any order of wavelength. Throws `Error` at `location` where there is none, counts differ, a
  /// number is not finite, a wavelength is not positive or comes twice.
  Spectrum(std::span<const double> wavelengths, std::span<const double> values, Outside outside,
           const FileLocation& location = {});
  /// Wavelength, value, wavelength, value, ..., as in pbrt's files. Throws as above, and where a value is missing.
  static Spectrum FromPairs(std::span<const double> pairs, Outside outside, const FileLocation& location = {});
  /// Planck's radiance, 1 at its peak, whatever the wavelength of the peak; sampled at 1 nm. Zero where kelvin <= 0.
  static Spectrum Blackbody(double kelvin);
  /// `function(nm)` at each nm of the observer's range, constant outside.
  template <typename F>
  static Spectrum Sampled(F function);

  double operator()(double nm) const;

 private:
  Spectrum() = default;

  std::vector<double> wavelengths_, values_;
  Outside outside_ = Outside::kConstant;
};

/// The spectrum of a text of wavelength-value pairs, with comments from # to the end of the line (pbrt's .spd files).
/// Throws `Error` at the place in the file, which is named `fileName`.
Spectrum ParseSpectrum(std::string_view text, const std::string& fileName, Spectrum::Outside outside);

/// Tristimulus values, normalised so that the spectrum that is 1 everywhere has Y = 1 (equal energy).
Xyz ToXyz(const Spectrum& spectrum);

/// Linear Rec. 709 components; negative where the colour is outside the gamut. (0.3127, 0.3290) with Y = 1 becomes (1,
/// 1, 1).
Color XyzToRgb(const Xyz& xyz);

/// What pbrt-v3 makes of any spectrum: reflectance, eta, k or emission (`RGBSpectrum::FromSampled`). Equal energy, with
/// the factor 470 / 471 of pbrt's sum and its rounded matrix; so a constant 1 becomes (1.202, 0.946, 0.907). May be
/// negative.
Color SpectrumToColorV3(const Spectrum& spectrum);

/// A reflectance, an eta or a k in pbrt-v4: its average as seen under D65, so that a constant c becomes (c, c, c). May
/// be negative.
Color SpectrumToColorV4(const Spectrum& spectrum);

/// Emission in pbrt-v4: the colour on the film, scaled to luminance Y = 1; components outside the gamut are set to
/// zero. Black where the spectrum has no luminance.
Color EmissionToColorV4(const Spectrum& spectrum);

/// Emission of a black body in pbrt-v3, with "scale" one: radiance 1 at the peak wavelength; components outside the
/// gamut are set to zero. Black where kelvin <= 0.
Color BlackbodyV3(double kelvin);
/// Emission of a black body in pbrt-v4: luminance 1.
Color BlackbodyV4(double kelvin);

/// What an RGB triple of the scene file is for.
enum class RgbUse {
  kReflectance,  ///< (1, 1, 1) reflects everything, whatever the space's white
  kEmission      ///< (1, 1, 1) has the colour of the space's white
};

/// Linear RGB of pbrt-v4's colour space `name` ("srgb", "aces2065-1", "rec2020", "dci-p3"; case does not matter) in
/// Rec. 709. Components are negative for colours outside that gamut. Whites other than D65 are adapted (Bradford) for
/// reflectances. Throws `Error` at `location` that lists the names where `name` is another one.
Color RgbFromColorSpace(const Color& rgb, std::string_view name, RgbUse use, const FileLocation& location = {});
/// True for the names that `RgbFromColorSpace` knows.
bool IsColorSpaceName(std::string_view name);

template <typename F>
Spectrum Spectrum::Sampled(F function) {
  Spectrum spectrum;
  for (int nm = kCieFirst; nm <= kCieLast; ++nm) {
    spectrum.wavelengths_.push_back(nm);
    spectrum.values_.push_back(function(static_cast<double>(nm)));
  }
  return spectrum;
}

}  // namespace dapple
