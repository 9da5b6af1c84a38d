// The smoothing of grids: what it keeps.
#include "src/base/grid.h"

#include <numeric>

#include <gtest/gtest.h>

namespace dapple {
namespace {

TEST(Grid, SmoothingKeepsConstantsAndIsBinomial) {
  Grid even(5, 3);
  std::fill(even.values.begin(), even.values.end(), 2.0);
  EXPECT_EQ(Smoothed(even).values, even.values);

  Grid peak(5, 5);
  peak.At(2, 2) = 16;
  const Grid smoothed = Smoothed(peak);
  EXPECT_EQ(smoothed.At(2, 2), 4);
  EXPECT_EQ(smoothed.At(1, 2), 2);
  EXPECT_EQ(smoothed.At(3, 3), 1);
  EXPECT_EQ(smoothed.At(0, 2), 0);
}

TEST(Grid, SmoothingKeepsTheSumAtBordersAndOfASingleCell) {
  Grid corner(4, 6);
  corner.At(0, 5) = 3;
  corner.At(3, 2) = 1;
  const Grid smoothed = Smoothed(corner);
  EXPECT_DOUBLE_EQ(std::accumulate(smoothed.values.begin(), smoothed.values.end(), 0.0), 4);

  Grid single(1, 1);
  single.At(0, 0) = 7;
  EXPECT_EQ(Smoothed(single).At(0, 0), 7);
}

}  // namespace
}  // namespace dapple
