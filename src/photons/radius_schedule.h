// The radius of a pass as a function of its number: how density estimation converges without memory of earlier passes.
#pragma once

#include <cmath>

namespace dapple {

/// Knaus and Zwicker's alpha: bias squared and variance fall alike, with the power -2/3 of the passes.
inline constexpr double kRadiusAlpha = 2.0 / 3;

/// The factor on the starting radius in pass number `pass` (from 0): r_{i+1}^2 = r_i^2 (i + alpha) / (i + 1) (Knaus and
/// Zwicker 2011, equation 15), in closed form. Both passes of a pair (even, odd) have the same radius, so that the
/// half-images estimate the same picture. With alpha in (0, 1) variance and bias of the mean image both vanish.
inline float RadiusFactor(int pass, double alpha = kRadiusAlpha) {
  const double i = pass / 2 + 1;
  return static_cast<float>(std::exp(0.5 * (std::lgamma(i + alpha) - std::lgamma(1 + alpha) - std::lgamma(i + 1))));
}

}  // namespace dapple
