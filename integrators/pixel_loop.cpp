#include "integrators/pixel_loop.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "integrators/camera_path.h"
#include "src/base/hilbert_curve.h"
#include "src/base/parallel.h"

namespace dapple {

namespace {

constexpr int kTileLevel = 4, kTileSize = 1 << kTileLevel;

/// The pixels of a tile, along the curve.
constexpr std::array<Vec2i, kTileSize * kTileSize> TilePixels() {
  std::array<Vec2i, kTileSize* kTileSize> pixels = {};
  for (uint32_t i = 0; i < pixels.size(); ++i) pixels[i] = HilbertCell(kTileLevel, i);
  return pixels;
}

/// The corners of the tiles that cover `area`: along curves through squares as wide as its shorter side, in a row.
std::vector<Vec2i> TileCorners(const PixelBounds& area) {
  const int columns = (area.Width() + kTileSize - 1) / kTileSize, rows = (area.Height() + kTileSize - 1) / kTileSize;
  const bool isWide = columns > rows;
  int level = 0;
  while (1 << level < std::min(columns, rows)) ++level;
  const int squares = (std::max(columns, rows) + (1 << level) - 1) >> level;
  std::vector<Vec2i> corners;
  for (int square = 0; square < squares; ++square)
    for (uint32_t i = 0; i < 1u << (2 * level); ++i) {
      Vec2i tile = HilbertCell(level, i);
      tile.x += square << level;
      if (!isWide) std::swap(tile.x, tile.y);
      if (tile.x < columns && tile.y < rows) corners.push_back(area.min + tile * kTileSize);
    }
  return corners;
}

}  // namespace

PassStats ForEachPixel(const Film& film, const std::function<void(const Vec2i&, PassStats&)>& render) {
  static const auto pixels = TilePixels();
  const PixelBounds& crop = film.Crop();
  const std::vector<Vec2i> corners = TileCorners(crop);
  std::vector<PassStats> tileStats(corners.size());
  ParallelFor(static_cast<int64_t>(corners.size()), [&](int64_t i) {
    const auto tile = static_cast<size_t>(i);
    PassStats stats;
    for (const Vec2i& offset : pixels) {
      const Vec2i pixel = corners[tile] + offset;
      if (pixel.x < crop.max.x && pixel.y < crop.max.y) render(pixel, stats);
    }
    tileStats[tile] = stats;
  });
  PassStats sum;
  for (const PassStats& stats : tileStats) sum += stats;
  return sum;
}

PassStats RenderPixels(const Scene& scene, uint64_t seed, int pass, const SampleAllocation& samples,
                       const std::function<PathEstimate(const CameraRay&, Sampler&, PassStats&)>& radiance,
                       Film& film) {
  return ForEachPixel(film, [&](const Vec2i& pixel, PassStats& stats) {
    const int count = samples.At(pixel);
    // Added at once: what is clamped is the pixel's value of a pass, however many paths that has.
    PathEstimate sum;
    for (int i = 0; i < count; ++i) {
      Sampler sampler = Sampler::ForPixel(seed, pixel, pass, i, count);
      const PixelSample sample = SamplePixel(scene, film.PixelFilter(), pixel, sampler);
      const float weight = sample.weight / static_cast<float>(count);
      const PathEstimate estimate = radiance(sample.camera, sampler, stats);
      sum += {FiniteSample(estimate.radiance * weight, stats), estimate.blur * weight};
    }
    film.AddSample(pixel, sum.radiance, pass);
    if (film.TracksBlur()) film.AddBlur(pixel, sum.blur, pass);
  });
}

}  // namespace dapple
