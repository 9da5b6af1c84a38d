#include "src/materials/spectrum.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>

#include <ImathMatrix.h>

#include "src/base/vec.h"

namespace dapple {
namespace {

/// Planck's spectral radiance at `nm`, up to a constant factor: T in kelvin, > 0.
double Planck(double nm, double kelvin) {
  constexpr double kC2 = 1.438776877e7;  // second radiation constant h c / k, nm K
  const double micrometres = nm / 1000;
  return std::pow(micrometres, -5) / std::expm1(kC2 / (nm * kelvin));
}

/// Sum over the observer's wavelengths, 1 nm apart, of `spectrum` times its functions.
template <typename F>
Xyz SumOverObserver(F spectrum) {
  Xyz sum;
  for (int i = 0; i < kCieSamples; ++i) {
    sum = sum + CieColorMatching()[static_cast<size_t>(i)] * spectrum(static_cast<double>(kCieFirst + i));
  }
  return sum;
}

Color ToColor(const Vec3d& c) { return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)}; }

Color WithoutNegative(const Color& c) {
  return Map(c, [](float x) { return std::max(0.f, x); });
}

// ---- RGB spaces

struct RgbSpace {
  Chromaticity red, green, blue, white;
};

constexpr RgbSpace kRec709 = {{0.64, 0.33}, {0.3, 0.6}, {0.15, 0.06}, {0.3127, 0.3290}};

/// The matrix of a space from its primaries and white; Imath's rows are the primaries: (r, g, b) * matrix = XYZ.
Imath::M33d RgbToXyz(const RgbSpace& space) {
  const Xyz r = XyzOfChromaticity(space.red), b = XyzOfChromaticity(space.blue), w = XyzOfChromaticity(space.white);
  const Xyz g = XyzOfChromaticity(space.green);
  const Imath::M33d primaries(r.x, r.y, r.z, g.x, g.y, g.z, b.x, b.y, b.z);
  const Vec3d scale = Vec3d(w.x, w.y, w.z) * primaries.inverse();
  return {scale.x * r.x, scale.x * r.y, scale.x * r.z, scale.y * g.x, scale.y * g.y,
          scale.y * g.z, scale.z * b.x, scale.z * b.y, scale.z * b.z};
}

/// XYZ under one white to XYZ under another, by the cone responses of Bradford (Lam 1985).
Imath::M33d Bradford(const Chromaticity& from, const Chromaticity& to) {
  const Imath::M33d cone(0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296);
  const Xyz a = XyzOfChromaticity(from), b = XyzOfChromaticity(to);
  const Vec3d coneA = Vec3d(a.x, a.y, a.z) * cone, coneB = Vec3d(b.x, b.y, b.z) * cone;
  const Imath::M33d gain(coneB.x / coneA.x, 0, 0, 0, coneB.y / coneA.y, 0, 0, 0, coneB.z / coneA.z);
  return cone * gain * cone.inverse();
}

std::optional<RgbSpace> FindColorSpace(std::string_view name) {
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (lower == "srgb") return kRec709;
  if (lower == "rec2020") return RgbSpace{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, kRec709.white};
  if (lower == "dci-p3") return RgbSpace{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kRec709.white};
  if (lower == "aces2065-1") return RgbSpace{{0.7347, 0.2653}, {0, 1}, {0.0001, -0.0770}, {0.32168, 0.33767}};
  return {};
}

/// The place of the byte `offset` of a file's text.
FileLocation PlaceInFile(const std::string& path, std::string_view text, size_t offset) {
  const auto begin = text.begin(), at = begin + static_cast<std::ptrdiff_t>(offset);
  const size_t lineStart = offset == 0 ? std::string::npos : text.rfind('\n', offset - 1);
  const size_t column = lineStart == std::string::npos ? offset + 1 : offset - lineStart;
  return {std::make_shared<const std::string>(path), 1 + static_cast<int>(std::count(begin, at, '\n')),
          static_cast<int>(column)};
}

/// All numbers of a text in which # starts a comment.
std::vector<double> ParseNumbers(const std::string& path, std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n\f\v";
  std::vector<double> numbers;
  for (size_t i = 0; (i = text.find_first_not_of(kSpace, i)) != std::string::npos;) {
    if (text[i] == '#') {
      i = std::min(text.find('\n', i), text.size());
      continue;
    }
    const size_t end = std::min(text.find_first_of(" \t\r\n\f\v#", i), text.size());
    const size_t start = text[i] == '+' ? i + 1 : i;
    double value = 0;
    const auto [stop, code] = std::from_chars(text.data() + start, text.data() + end, value);
    if (code != std::errc() || stop != text.data() + end) {
      throw Error(PlaceInFile(path, text, i), "\"" + std::string(text.substr(i, std::min<size_t>(end - i, 40))) +
                                                  "\" in a spectrum; expected a number");
    }
    numbers.push_back(value);
    i = end;
  }
  return numbers;
}

}  // namespace

Spectrum::Spectrum(std::span<const double> wavelengths, std::span<const double> values, Outside outside,
                   const FileLocation& location)
    : outside_(outside) {
  if (wavelengths.empty() || wavelengths.size() != values.size()) {
    throw Error(location, "a spectrum of " + std::to_string(wavelengths.size()) + " wavelengths and " +
                              std::to_string(values.size()) + " values; expected the same number of both, at least 1");
  }
  std::vector<size_t> order(wavelengths.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return wavelengths[a] < wavelengths[b]; });
  for (const size_t i : order) {
    if (!(wavelengths[i] > 0) || !std::isfinite(wavelengths[i]) || !std::isfinite(values[i])) {
      throw Error(location, "a spectrum with the pair " + std::to_string(wavelengths[i]) + " " +
                                std::to_string(values[i]) +
                                "; expected a positive wavelength in nm and a finite value");
    }
    if (!wavelengths_.empty() && wavelengths[i] == wavelengths_.back()) {
      throw Error(location, "a spectrum with the wavelength " + std::to_string(wavelengths[i]) +
                                " twice; expected each wavelength once");
    }
    wavelengths_.push_back(wavelengths[i]);
    values_.push_back(values[i]);
  }
}

Spectrum Spectrum::FromPairs(std::span<const double> pairs, Outside outside, const FileLocation& location) {
  if (pairs.size() % 2 != 0) {
    throw Error(location, "a spectrum of " + std::to_string(pairs.size()) +
                              " numbers; expected an even number: wavelength value wavelength value ...");
  }
  std::vector<double> wavelengths, values;
  for (size_t i = 0; i < pairs.size(); i += 2) {
    wavelengths.push_back(pairs[i]);
    values.push_back(pairs[i + 1]);
  }
  return {wavelengths, values, outside, location};
}

Spectrum Spectrum::Blackbody(double kelvin) {
  if (!(kelvin > 0)) return Sampled([](double) { return 0.; });
  constexpr double kWien = 2.897771955e6;  // nm K
  // Below some 20 K both numbers underflow, and nothing can be seen.
  const double peak = Planck(kWien / kelvin, kelvin);
  return Sampled([=](double nm) { return peak > 0 ? Planck(nm, kelvin) / peak : 0.; });
}

double Spectrum::operator()(double nm) const {
  const bool inside = nm >= wavelengths_.front() && nm <= wavelengths_.back();
  if (!inside && outside_ == Outside::kZero) return 0;
  if (!(nm > wavelengths_.front())) return values_.front();
  if (nm >= wavelengths_.back()) return values_.back();
  const auto above = std::upper_bound(wavelengths_.begin(), wavelengths_.end(), nm) - wavelengths_.begin();
  const auto i = static_cast<size_t>(above);
  return std::lerp(values_[i - 1], values_[i], (nm - wavelengths_[i - 1]) / (wavelengths_[i] - wavelengths_[i - 1]));
}

Spectrum ParseSpectrum(std::string_view text, const std::string& fileName, Spectrum::Outside outside) {
  return Spectrum::FromPairs(ParseNumbers(fileName, text), outside, FileLocation(fileName));
}

Xyz ToXyz(const Spectrum& spectrum) { return SumOverObserver(spectrum) * (1 / kCieYIntegral); }

Color XyzToRgb(const Xyz& xyz) {
  static const Imath::M33d kMatrix = RgbToXyz(kRec709).inverse();
  return ToColor(Vec3d(xyz.x, xyz.y, xyz.z) * kMatrix);
}

Color SpectrumToColorV3(const Spectrum& spectrum) {
  // pbrt-v3 multiplies its sum over 471 wavelengths by (830 - 360) / (471 * the integral of ybar).
  const Xyz c = ToXyz(spectrum) * ((kCieSamples - 1.) / kCieSamples);
  // ITU-R BT.709 with the rounding of pbrt-v3.
  return ToColor({3.240479 * c.x - 1.537150 * c.y - 0.498535 * c.z, -0.969256 * c.x + 1.875991 * c.y + 0.041556 * c.z,
                  0.055648 * c.x - 0.204043 * c.y + 1.057311 * c.z});
}

Color SpectrumToColorV4(const Spectrum& spectrum) {
  const Daylight d65 = Daylight::OfTemperature(6503.616);
  const Color color = XyzToRgb(SumOverObserver([&](double nm) { return d65(nm) * spectrum(nm); }));
  return color / XyzToRgb(SumOverObserver(d65));
}

Color EmissionToColorV4(const Spectrum& spectrum) {
  const Xyz xyz = ToXyz(spectrum);
  return xyz.y > 0 ? WithoutNegative(XyzToRgb(xyz * (1 / xyz.y))) : Color(0);
}

Color BlackbodyV3(double kelvin) { return WithoutNegative(SpectrumToColorV3(Spectrum::Blackbody(kelvin))); }

Color BlackbodyV4(double kelvin) { return EmissionToColorV4(Spectrum::Blackbody(kelvin)); }

bool IsColorSpaceName(std::string_view name) { return FindColorSpace(name).has_value(); }

Color RgbFromColorSpace(const Color& rgb, std::string_view name, RgbUse use, const FileLocation& location) {
  const std::optional<RgbSpace> space = FindColorSpace(name);
  if (!space) {
    throw Error(location, "color space \"" + std::string(name) +
                              "\" is not known; expected \"srgb\", \"aces2065-1\", \"rec2020\" or \"dci-p3\"");
  }
  if (space->red.x == kRec709.red.x) return rgb;
  Vec3d xyz = Vec3d(rgb.r, rgb.g, rgb.b) * RgbToXyz(*space);
  if (use == RgbUse::kReflectance) xyz = xyz * Bradford(space->white, kRec709.white);
  return XyzToRgb({xyz.x, xyz.y, xyz.z});
}

}  // namespace dapple
