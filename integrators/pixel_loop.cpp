#include "integrators/pixel_loop.h"

#include <vector>

#include "src/base/parallel.h"

namespace dapple {

PassStats ForEachPixel(const Film& film, const std::function<void(const Vec2i&, PassStats&)>& render) {
  constexpr int kTileSize = 16;
  const PixelBounds& crop = film.Crop();
  const int columns = (crop.Width() + kTileSize - 1) / kTileSize;
  const int rows = (crop.Height() + kTileSize - 1) / kTileSize;
  std::vector<PassStats> tileStats(static_cast<size_t>(columns) * static_cast<size_t>(rows));
  ParallelFor(static_cast<int64_t>(tileStats.size()), [&](int64_t tile) {
    const int x0 = crop.min.x + static_cast<int>(tile % columns) * kTileSize;
    const int y0 = crop.min.y + static_cast<int>(tile / columns) * kTileSize;
    PassStats stats;
    for (int y = y0; y < std::min(y0 + kTileSize, crop.max.y); ++y)
      for (int x = x0; x < std::min(x0 + kTileSize, crop.max.x); ++x) render({x, y}, stats);
    tileStats[static_cast<size_t>(tile)] = stats;
  });
  PassStats sum;
  for (const PassStats& stats : tileStats) sum += stats;
  return sum;
}

}  // namespace dapple
