#include "src/image/false_color.h"

#include <cmath>

#include <gtest/gtest.h>

namespace dapple {
namespace {

// What grows looks brighter, to an eye of whatever colours.
TEST(FalseColor, BrightnessGrowsAlongTheRamp) {
  float previous = -1;
  for (int i = 0; i <= 100; ++i) {
    const float luminance = RampColor(i / 100.).Luminance();
    EXPECT_GT(luminance, previous) << i;
    previous = luminance;
  }
  EXPECT_EQ(RampColor(0), Color(0));
  EXPECT_EQ(RampColor(1), Color(1));
  EXPECT_EQ(RampColor(-3), Color(0));
  EXPECT_EQ(RampColor(INFINITY), Color(1));
  EXPECT_EQ(RampColor(NAN), Color(1));
}

TEST(FalseColor, LogarithmsRunFromLowToHigh) {
  const Image values(6, 1, {"Y"}, {0.f, 0.01f, 0.1f, 1.f, INFINITY, NAN});
  const Image picture = FalseColorLogarithmic(values, 0.01, 1);
  EXPECT_EQ(picture.ColorAt(0, 0), RampColor(0));
  EXPECT_NEAR(picture.ColorAt(1, 0).r, 0, 1e-6);
  EXPECT_NEAR(picture.ColorAt(2, 0).r, RampColor(0.5).r, 1e-5);
  for (int x = 3; x < 6; ++x) EXPECT_NEAR(picture.ColorAt(x, 0).Luminance(), 1, 1e-5);
}

}  // namespace
}  // namespace dapple
