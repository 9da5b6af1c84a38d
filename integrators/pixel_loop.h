// The loop over the pixels of a film: tiles in parallel, one thread a tile.
#pragma once

#include <functional>

#include "integrators/sample_allocation.h"
#include "src/image/film.h"

namespace dapple {

/// Calls `render(pixel, stats)` for each pixel of the film's crop. Tiles run in parallel; each has counters of its own,
/// and their sum is returned. Tiles, and the pixels of each, follow a Hilbert curve, so that what one pixel looked up
/// is still in the cache for the next.
PassStats ForEachPixel(const Film& film, const std::function<void(const Vec2i& pixel, PassStats& stats)>& render);

/// What is added to a pixel: black, counted for the integrator, where sums of what was finite are not.
inline Color FiniteSample(const Color& value, PassStats& stats) {
  return Finite(value, &stats.nonFinite, [] { return NonFiniteSource::Integrator(); });
}

/// What a camera path finds.
struct PathEstimate {
  PathEstimate() = default;
  PathEstimate(const Color& found, const Color& foundBlur = Color()) : radiance(found), blur(foundBlur) {}
  PathEstimate& operator+=(const PathEstimate& other) {
    radiance += other.radiance;
    blur += other.blur;
    return *this;
  }
  friend PathEstimate operator*(const Color& throughput, const PathEstimate& estimate) {
    return {throughput * estimate.radiance, throughput * estimate.blur};
  }

  Color radiance;
  Color blur;  ///< by how much that exceeds what gathers of half the radius give (`Film::AddBlur`)
};

/// Adds an estimate of each pixel of the film's crop: the mean over as many camera paths as `samples` gives it of
/// `radiance(camera, sampler, stats)`, where block 0 of the sampler is used up.
PassStats RenderPixels(const Scene& scene, uint64_t seed, int pass, const SampleAllocation& samples,
                       const std::function<PathEstimate(const CameraRay&, Sampler&, PassStats&)>& radiance, Film& film);

}  // namespace dapple
