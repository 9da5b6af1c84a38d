// FLIP: how different two images look when a person flips between them, pixel by pixel from 0 (the same) to 1.
//
// Written from the papers: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom and Fairchild 2020, "FLIP: a
// difference evaluator for alternating images" (LDR-FLIP), and Andersson, Nilsson, Shirley and Akenine-Moeller 2021,
// "Visualizing errors in rendered high dynamic range images" (HDR-FLIP). A reference is prepared once for many tests:
//
//   const FlipReference flip(reference, FlipRange::High);
//   const FlipResult result = flip.Compare(test);
#pragma once

#include <cstdint>
#include <vector>

#include "src/image/image.h"

namespace dapple {

/// Which values can be told apart.
enum class FlipRange {
  Low,   ///< linear values clamped to [0, 1], as a screen shows them
  High,  ///< all: the images are tone mapped at a series of exposures, and the largest difference of a pixel counts
};

/// Pixels that an eye sees in a degree: those of a screen `widthMetres` wide, of `widthPixels`, at `distanceMetres`. By
/// default the papers' viewer: 0.7 m away from a screen of 3840 pixels and 0.7 m, 67 pixels a degree.
double PixelsPerDegree(double distanceMetres = 0.7, double widthMetres = 0.7, int widthPixels = 3840);

/// The exposures in stops (powers of two) at which HDR-FLIP looks, evenly apart: at the first the brightest pixel of
/// the image, at the last its median is tone mapped to 0.85. Where half of the image is black the median is that of the
/// rest; one exposure, 0, for a black image.
struct FlipExposures {
  double first = 0, last = 0;
  int count = 1;

  double At(int i) const { return count > 1 ? first + i * (last - first) / (count - 1) : first; }
};
FlipExposures ExposuresOf(const Image& reference);

struct FlipResult {
  double mean = 0;  ///< over the pixels that are finite in both images
  Image map;        ///< one channel, Y, in [0, 1]; 1 where a pixel of either image is not finite
};

/// A reference as FLIP sees it. Negative values count as 0, and so do the pixels that are not finite: they are in no
/// mean, but the filters of their neighbours reach them.
class FlipReference {
 public:
  /// `pixelsPerDegree` > 0.
  explicit FlipReference(const Image& reference, FlipRange range, double pixelsPerDegree = PixelsPerDegree());

  /// Throws `Error` where the sizes differ or no pixel is finite in both.
  FlipResult Compare(const Image& test) const;

 private:
  using Plane = std::vector<float>;

  /// An image at one exposure as the two pipelines of the metric see it.
  struct View {
    Plane lightness, a, b;  ///< filtered as an eye does, in CIELAB with the Hunt effect
    Plane edges, points;    ///< magnitudes of the filters' responses
  };
  /// A kernel of two sides, from -radius to radius.
  using Kernel = std::vector<float>;
  /// A sum of two Gaussians: how an eye blurs one channel.
  struct Blur {
    Kernel first, second;
    float share = 0;  ///< of the first
  };

  Plane Convolve(const Plane& plane, const Kernel& alongX, const Kernel& alongY) const;
  Plane Apply(const Plane& plane, const Blur& blur) const;
  View Look(const Image& image, double exposure) const;
  void LookForFeatures(const Plane& luminance, View* view) const;
  /// The largest of `map` and the difference, at each pixel.
  void AddDifference(const View& reference, const View& test, Plane* map) const;

  int width_, height_;
  FlipRange range_;
  FlipExposures exposures_;
  Blur achromatic_, redGreen_, blueYellow_;
  Kernel smooth_, edge_, point_;
  std::vector<uint8_t> isFinite_;
  std::vector<View> views_;  ///< one for each exposure
};

}  // namespace dapple
