// Numbers as colours: one ramp for all pictures of densities, errors and differences.
#pragma once

#include "src/image/image.h"

namespace dapple {

/// From black by purple, red and yellow to white, ever brighter, so that it reads in gray and to all kinds of eyes.
/// Linear values; `t` is clamped to [0, 1], NaN counts as 1.
Color RampColor(double t);

/// The ramp of log(value / low) / log(high / low): black at `low` and below, white at `high` and above; 0 < low < high.
/// `values` has one channel; the place in the picture is kept.
Image FalseColorLogarithmic(const Image& values, double low, double high);

/// The ramp of the values themselves, in [0, 1].
Image FalseColorLinear(const Image& values);

}  // namespace dapple
