#include "integrators/pixel_loop.h"

#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "src/base/parallel.h"

namespace dapple {
namespace {

Film FilmOf(const PixelBounds& crop) { return {Vec2i(500, 500), crop, Filter::Box()}; }

TEST(PixelLoop, VisitsEachPixelOfTheCropOnceAndAddsUpTheCounters) {
  for (const PixelBounds& crop :
       {PixelBounds{{0, 0}, {500, 500}}, PixelBounds{{3, 5}, {40, 22}}, PixelBounds{{100, 0}, {101, 500}},
        PixelBounds{{7, 490}, {499, 500}}, PixelBounds{{499, 499}, {500, 500}}}) {
    std::vector<int> visits(500 * 500);
    const PassStats stats = ForEachPixel(FilmOf(crop), [&](const Vec2i& pixel, PassStats& tileStats) {
      EXPECT_TRUE(crop.Contains(pixel));
      ++visits[static_cast<size_t>(pixel.y * 500 + pixel.x)];
      ++tileStats.cameraRays;
    });
    EXPECT_EQ(stats.cameraRays, crop.Area());
    for (int y = crop.min.y; y < crop.max.y; ++y)
      for (int x = crop.min.x; x < crop.max.x; ++x) ASSERT_EQ(visits[static_cast<size_t>(y * 500 + x)], 1);
  }
}

TEST(PixelLoop, GoesOnToANeighbour) {
  // On one thread and a square of tiles, each step leads to the next pixel or to the next tile.
  const ThreadLimit limit(1);
  Vec2i last(-1, -1);
  int64_t far = 0;
  ForEachPixel(FilmOf({{10, 20}, {10 + 256, 20 + 256}}), [&](const Vec2i& pixel, PassStats&) {
    const int distance = std::abs(pixel.x - last.x) + std::abs(pixel.y - last.y);
    if (last.x >= 0 && distance > 1) {
      ++far;
      EXPECT_LE(distance, 2 * 16 + 15);
    }
    last = pixel;
  });
  EXPECT_LT(far, 256);
}

}  // namespace
}  // namespace dapple
