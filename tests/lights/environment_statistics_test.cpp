#include "lights/environment_statistics.h"

#include <cmath>

#include <gtest/gtest.h>

#include "src/base/numerics.h"
#include "tests/lights/light_cases.h"

namespace dapple {
namespace {

constexpr EnvironmentMapping kMappings[] = {EnvironmentMapping::LatLong, EnvironmentMapping::EqualArea};

Image Even(int width, int height, const Color& color) {
  Image image = Image::Rgb(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.SetColor(x, y, color);
  return image;
}

TEST(EnvironmentStatistics, PixelsCoverTheSphere) {
  for (const EnvironmentMapping mapping : kMappings) {
    for (const int height : {1, 2, 7, 64}) {
      double sum = 0;
      for (int y = 0; y < height; ++y) sum += height * EnvironmentPixelSolidAngle(mapping, height, height, y);
      EXPECT_NEAR(sum / (4 * kPiD), 1, 1e-12) << height;
    }
  }
}

TEST(EnvironmentStatistics, DirectionsAndPlacesAreInverse) {
  RandomNumbers random(1);
  for (const EnvironmentMapping mapping : kMappings) {
    for (int i = 0; i < 1000; ++i) {
      const Vec2d p = random.Get2D();
      const Vec3d w = EnvironmentDirectionAt(mapping, p);
      ASSERT_NEAR(Length(w), 1, 1e-12);
      ASSERT_NEAR((EnvironmentSquareAt(mapping, w) - p).length(), 0, 1e-7) << p;
    }
  }
}

TEST(EnvironmentStatistics, AnEvenMapIsAsEvenAsCanBe) {
  for (const EnvironmentMapping mapping : kMappings) {
    const EnvironmentStatistics s = MeasureEnvironment(Even(16, 16, Color(1, 2, 4)), mapping);
    EXPECT_EQ(s.least, Color(1, 2, 4));
    EXPECT_EQ(s.greatest, Color(1, 2, 4));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(s.mean[i], 1 << i, 1e-5);
    EXPECT_EQ(s.leastLuminance, s.greatestLuminance);
    EXPECT_EQ(s.blackShare, 0);
    EXPECT_NEAR(s.lightOfBrightestHundredth, 0.01, 1e-9);
    EXPECT_NEAR(s.effectiveShare, 1, 1e-9);
  }
}

// One white pixel of 1024 in the equal-area map, the rest half black and half of a thousandth.
TEST(EnvironmentStatistics, ASunIsFound) {
  Image image = Even(32, 32, Color(0.001f));
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x) image.SetColor(x, y, Color());
  image.SetColor(20, 25, Color(1));
  const EnvironmentStatistics s = MeasureEnvironment(image, EnvironmentMapping::EqualArea);
  EXPECT_EQ(s.brightestPixel, Vec2i(20, 25));
  EXPECT_EQ(s.least, Color());
  EXPECT_NEAR(s.greatestLuminance / s.leastLuminance, 1000, 0.1);
  EXPECT_NEAR(s.blackShare, 0.5, 1e-9);
  const double light = 1 + 511 * 0.001, brightest = 1 + 0.001 * (10.24 - 1);
  EXPECT_NEAR(s.lightOfBrightestHundredth, brightest / light, 1e-5);
  EXPECT_NEAR(s.effectiveShare, light * light / (1024 * (1 + 511e-6)), 1e-5);
  const Vec2d p = EnvironmentSquareAt(EnvironmentMapping::EqualArea, s.brightestDirection);
  EXPECT_NEAR(p.x * 32, 20.5, 1e-6);
  EXPECT_NEAR(p.y * 32, 25.5, 1e-6);
  const EnvironmentStatistics black = MeasureEnvironment(Even(4, 2, Color()), EnvironmentMapping::LatLong);
  EXPECT_EQ(black.leastLuminance, 0);
  EXPECT_EQ(black.lightOfBrightestHundredth, 0);
  EXPECT_NEAR(black.blackShare, 1, 1e-9);
}

}  // namespace
}  // namespace dapple
