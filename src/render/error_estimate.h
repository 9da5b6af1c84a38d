// How far a picture is from what it converges to, estimated from its own passes: noise and bias together.
//
//   if (const auto error = EstimateError(film, exposure)) fmt::print("{}", error->Total());
//
// The error is the root of the relative MSE of metrics.h: what `dapple compare` would measure of this picture if it had
// the converged one. What no pass has found, because the algorithm cannot or is not likely to, is not in it.
#pragma once

#include <optional>

#include "src/image/film.h"

namespace dapple {

/// Roots of relative MSEs: 0.01 is one per cent.
struct ErrorEstimate {
  double noise = 0;
  double bias = 0;  ///< of density estimates; 0 where the film does not track blur

  double Total() const;
};

/// Estimates the error of `film`'s image times the exposure; nothing before both its halves have a pass, or where the
/// memory does not suffice: no render ends for want of it. Depends on the film alone, on no number of threads.
///
/// Noise: half-images are independent, so ((h0 - h1)^2 n0 n1 / (n0 + n1)^2) has the variance of a pixel as its mean,
/// stratified as its samples are; it is noisy in each pixel, and right in the mean over all.
///
/// Bias: D is by how much the picture exceeds that with half the radius (`Film::AddBlur`). The halves' D are
/// independent too, so the mean of D0 D1 is that of the squared bias of D, without its noise. Where radiance is smooth,
/// the bias goes with the square of the radius and is 1 / (1 - 1/4) = 1.33 D. At a step (the edge of a shadow or a
/// caustic) its root mean square is 2.15 times that of D (of the convolution of a small step with the Epanechnikov
/// kernel; 2.18 with the cone), and more where the step is high, since the blurred picture is brighter than its dark
/// side should be: 2.8 times where one side is 3 times as bright, 4.3 where 10 times. The factor used, 1.9, is at
/// most 1.43 too high where all is smooth and 1.5 too low at steps up to three; a picture whose error is all bias, at
/// high steps, has up to 2.3 times the error that is told.
///
/// Both are relative to what the picture will be. The picture itself does not tell that where a single bright sample
/// dominates a pixel: divided by its own square a firefly would count as nothing. In its place stands the median of
/// both halves and the mean of the pixels around.
std::optional<ErrorEstimate> EstimateError(const Film& film, float exposure);

/// Whether a render that stops by its error looks at it after so many passes: even numbers in steps of a quarter to an
/// eighth, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, ... So where it stops depends on the picture alone, and looking takes
/// little of its time.
bool IsErrorDue(int passes);

}  // namespace dapple
