// How many camera paths each part of the picture gets in a pass: more where they are noisy, as a pilot finds.
//
// The variance of a pixel's mean falls about as 1 / n with its n paths. For the least sum of relative variances in a
// given time n is in proportion to the relative standard deviation over the square root of a path's cost (Neyman 1934),
// and most of the noise is in a small part of a picture: edges, highlights, penumbras. The pilot's paths are used
// for nothing else, and the allocation is the same for all passes: so a pass depends on its number alone still, and a
// pixel's mean is an unbiased one of what its paths find, however many they are.
#pragma once

#include <functional>
#include <vector>

#include "integrators/integrator.h"
#include "src/sampling/sampler.h"

namespace dapple {

class SampleAllocation {
 public:
  /// The radiance that a camera path finds. It counts its rays; block 0 of the sampler is used up.
  using Tracer = std::function<Color(const CameraRay&, Sampler&, PassStats&)>;

  /// The same number of paths, at least one, through each pixel.
  explicit SampleAllocation(int samples) : mean_(samples) {}

  /// As many rays in all as `mean` paths through each pixel would take, by the pilot: at least one path through each,
  /// and at most `kMostOfMean` times the mean. The pilot takes about two paths a pixel, or 2^18 where that is less; of
  /// the whole picture, so that a crop of it is rendered the same way. The result depends on the arguments alone.
  static SampleAllocation ByNoise(const Scene& scene, uint64_t seed, int mean, const Tracer& trace);
  static constexpr int kMostOfMean = 8;

  /// Camera paths through a pixel of the picture in a pass.
  int At(const Vec2i& pixel) const;
  /// Of the pilot; 0 without one.
  int64_t PilotRays() const { return pilotRays_; }
  /// None where the number is the same everywhere.
  TableUse Table() const { return TableUse::Of(static_cast<int64_t>(samples_.size() * sizeof(float))); }

 private:
  int mean_;
  int64_t pilotRays_ = 0;
  int cellSize_ = 1, columns_ = 0;  // cells are squares of so many pixels a side
  std::vector<float> samples_;      // of each cell, in the mean of its pixels; empty: `mean_`
};

}  // namespace dapple
