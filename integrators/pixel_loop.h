// The loop over the pixels of a film: tiles in parallel, one thread a tile.
#pragma once

#include <functional>

#include "integrators/integrator.h"
#include "src/image/film.h"

namespace dapple {

/// Calls `render(pixel, stats)` for each pixel of the film's crop. Tiles run in parallel; each has counters of its own,
/// and their sum is returned. Tiles, and the pixels of each, follow a Hilbert curve, so that what one pixel looked up
/// is still in the cache for the next.
PassStats ForEachPixel(const Film& film, const std::function<void(const Vec2i& pixel, PassStats& stats)>& render);

}  // namespace dapple
