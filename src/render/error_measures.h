// The measures in which convergence is told, each with its name and definition, and how they are taken.
//
//   const ErrorMeter meter(reference);
//   const MeasuredErrors errors = meter.Measure(picture);
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "src/image/film.h"
#include "src/image/flip.h"
#include "src/image/image.h"

namespace dapple {

struct ErrorMeasure {
  std::string_view key;         ///< in files
  std::string_view name;        ///< for people
  std::string_view definition;  ///< in words, for test t and reference r
};

inline constexpr std::array<ErrorMeasure, 5> kErrorMeasures = {{
    {"relativeMse", "relative MSE", "mean over pixels and channels of (t \u2212 r)\u00b2 / (r\u00b2 + 0.01)"},
    {"trimmedRelativeMse", "trimmed relative MSE", "the same without the worst 0.1 % of pixels"},
    {"mse", "MSE", "mean over pixels and channels of (t \u2212 r)\u00b2"},
    {"mape", "MAPE", "mean over pixels and channels of |t \u2212 r| / (|r| + 0.01)"},
    {"flip", "FLIP", "HDR-FLIP (Andersson et al. 2021) at 67 pixels a degree, mean over pixels"},
}};

/// One value for each of `kErrorMeasures`.
using MeasuredErrors = std::array<double, kErrorMeasures.size()>;

class ErrorMeter {
 public:
  explicit ErrorMeter(Image reference) : reference_(std::move(reference)), flip_(reference_, FlipRange::High) {}

  const Image& Reference() const { return reference_; }
  /// Throws `Error` where the sizes differ or no pixel can be compared.
  MeasuredErrors Measure(const Image& test) const;

 private:
  Image reference_;
  FlipReference flip_;
};

/// What noise leaves in `film`'s own image, by each measure, times the exposure; nothing before both its halves have a
/// pass. With half-images h of n passes and the image m, the image m + (h0 - h1) sqrt(n0 n1) / (n0 + n1) is as far
/// from m as m is from what it converges to, in the variance of each pixel, as halves are independent. It is measured
/// like any other; FLIP, which then compares noise with noise, comes out about a tenth too high. Bias is not seen.
std::optional<MeasuredErrors> ErrorsOfNoise(const Film& film, float exposure);

}  // namespace dapple
