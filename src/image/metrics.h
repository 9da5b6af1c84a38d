// How far an image is from a reference: the measures in which tests and convergence curves speak.
#pragma once

#include <cstdint>

#include "src/image/image.h"

namespace dapple {

/// What is added to r^2 in relative errors and to |r| in MAPE, so that black pixels do not count without bound.
inline constexpr double kRelativeEpsilon = 0.01;

/// Differences of a test image t from a reference r, over the pixels that are finite in both.
struct ImageDifference {
  /// Mean over pixels and channels of (t - r)^2.
  double mse = 0;
  /// Mean over pixels and channels of (t - r)^2 / (r^2 + 0.01).
  double relativeMse = 0;
  /// The same without the 0.1 % of pixels (rounded down) whose relative error is the largest: fireflies left out.
  double trimmedRelativeMse = 0;
  /// Mean absolute percentage error, as a share: mean over pixels and channels of |t - r| / (|r| + 0.01).
  double mape = 0;
  /// Mean of t over mean of r (all channels together); 1 where both are black, infinity where only r is.
  double meanRatio = 1;
  /// Pixels left out because t or r is infinite or NaN there.
  int64_t nonFinite = 0;
};

/// Compares the colours (`Image::ColorAt`). Throws `Error` where the sizes differ or no pixel can be compared.
ImageDifference CompareImages(const Image& test, const Image& reference);

/// The relative error of each pixel, one channel Y: the root of the mean over channels of (t - r)^2 / (r^2 + 0.01),
/// whose mean square is `relativeMse`; infinity where t or r is not finite. Throws `Error` where the sizes differ.
Image RelativeErrors(const Image& test, const Image& reference);

/// Makes two images of the same picture comparable: where their data windows differ, both cut to what they share.
/// Throws `Error` where they are of pictures of different sizes, where the windows share no pixel, and where one lacks
/// a colour channel that the other has or has none at all.
struct ComparablePair {
  Image test, reference;
  bool isCut = false;  ///< some pixels of either are left out
};
ComparablePair MakeComparable(const Image& test, const Image& reference);

/// The mean of each block of blockSize x blockSize pixels, as an image with one pixel a block and the same channels;
/// blocks at the right and lower edges may be smaller. A NaN or infinity makes its block's mean one. `blockSize` >= 1.
Image BlockMeans(const Image& image, int blockSize);

}  // namespace dapple
