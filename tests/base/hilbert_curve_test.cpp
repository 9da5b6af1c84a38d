#include "src/base/hilbert_curve.h"

#include <cstdlib>
#include <set>

#include <gtest/gtest.h>

namespace dapple {
namespace {

TEST(HilbertCurve, VisitsEachCellOnceStepByStepFromCornerToCorner) {
  for (int level = 0; level <= 6; ++level) {
    const int size = 1 << level;
    std::set<std::pair<int, int>> visited;
    Vec2i last = HilbertCell(level, 0);
    EXPECT_EQ(last, Vec2i(0, 0));
    for (uint32_t i = 0; i < static_cast<uint32_t>(size * size); ++i) {
      const Vec2i cell = HilbertCell(level, i);
      EXPECT_TRUE(cell.x >= 0 && cell.x < size && cell.y >= 0 && cell.y < size);
      EXPECT_TRUE(visited.insert({cell.x, cell.y}).second);
      EXPECT_EQ(std::abs(cell.x - last.x) + std::abs(cell.y - last.y), i > 0 ? 1 : 0);
      last = cell;
    }
    EXPECT_EQ(last, Vec2i(size - 1, 0));
  }
}

TEST(HilbertCurve, StretchesOfFourToThePowerKFillSquares) {
  constexpr int kLevel = 5;
  for (uint32_t i = 0; i < 1u << (2 * kLevel); ++i)
    for (int k = 1; k <= kLevel; ++k) {
      const Vec2i cell = HilbertCell(kLevel, i), first = HilbertCell(kLevel, i >> (2 * k) << (2 * k));
      EXPECT_EQ(cell.x >> k, first.x >> k);
      EXPECT_EQ(cell.y >> k, first.y >> k);
    }
}

}  // namespace
}  // namespace dapple
