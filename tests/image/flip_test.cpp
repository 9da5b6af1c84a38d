#include "src/image/flip.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "src/base/error.h"
#include "tests/image/test_images.h"

namespace dapple {
namespace {

double Flip(const Image& test, const Image& reference, FlipRange range = FlipRange::Low) {
  return FlipReference(reference, range).Compare(test).mean;
}

/// Gray stripes of that width, across or along, around 0.5.
Image Stripes(int width, float contrast, bool isAcross = true) {
  Image image = Image::Rgb(48, 40);
  for (int y = 0; y < image.Height(); ++y) {
    for (int x = 0; x < image.Width(); ++x) {
      const bool isLight = (isAcross ? x : y) / width % 2 == 0;
      image.SetColor(x, y, Color(0.5f + (isLight ? contrast : -contrast)));
    }
  }
  return image;
}

TEST(Flip, IdenticalImagesDoNotDiffer) {
  for (const FlipRange range : {FlipRange::Low, FlipRange::High}) {
    const Image image = RandomImage(33, 17, 4, 3.f);
    const FlipResult result = FlipReference(image, range).Compare(image);
    EXPECT_EQ(result.mean, 0);
    EXPECT_EQ(*std::ranges::max_element(result.map.Values()), 0.f);
  }
}

// Without edges only colour counts, and its scale is fixed by the two colours that lie furthest apart, pure green and
// pure blue: their difference is 1. White and black are 100 apart in lightness alone: with c the 0.7th power of green's
// distance from blue, |dL| + |d(a, b)| = 203.2 in CIELAB with the Hunt effect, the published scale gives
// 0.95 + 0.05 (100^0.7 - 0.4 c) / (0.6 c).
TEST(Flip, ConstantImagesAreAsFarApartAsTheirColours) {
  EXPECT_NEAR(Flip(Constant(9, 7, Color(0, 1, 0)), Constant(9, 7, Color(0, 0, 1))), 1, 1e-5);
  // CIE L*a*b* of Rec. 709 primaries under D65: green (87.737, -86.183, 83.180), blue (32.297, 79.188, -107.860).
  const double green = 0.87737, blue = 0.32297;
  const double distance =
      (87.737 - 32.297) + std::hypot(-86.183 * green - 79.188 * blue, 83.180 * green + 107.860 * blue);
  const double c = std::pow(distance, 0.7);
  const double expected = 0.95 + 0.05 * (std::pow(100., 0.7) - 0.4 * c) / (0.6 * c);
  EXPECT_NEAR(Flip(Constant(9, 7, Color(1)), Constant(9, 7, Color(0))), expected, 1e-4);
  EXPECT_NEAR(expected, 0.967, 5e-4);
}

// In gray HyAB is the difference of lightness L* = 116 Y^(1/3) - 16; below the bend the scale is a power of it.
TEST(Flip, GraysDifferByTheirLightness) {
  const auto lightness = [](double y) { return 116 * std::cbrt(y) - 16; };
  const double unit =
      Flip(Constant(8, 8, Color(0.3f)), Constant(8, 8, Color(0.2f))) / std::pow(lightness(0.3) - lightness(0.2), 0.7);
  for (const float y : {0.21f, 0.25f, 0.35f, 0.5f})
    EXPECT_NEAR(Flip(Constant(8, 8, Color(y)), Constant(8, 8, Color(0.2f))),
                unit * std::pow(lightness(double{y}) - lightness(0.2), 0.7), 1e-4)
        << y;
}

TEST(Flip, LowRangeIsSymmetric) {
  const Image a = RandomImage(31, 29, 1, 1.f), b = RandomImage(31, 29, 2, 1.f);
  EXPECT_DOUBLE_EQ(Flip(a, b), Flip(b, a));
  EXPECT_GT(Flip(a, b), 0.1);
}

TEST(Flip, GrowsWithTheDifference) {
  const Image reference = Stripes(4, 0.1f);
  double previous = 0;
  for (const float contrast : {0.12f, 0.16f, 0.22f, 0.3f, 0.45f}) {
    const double flip = Flip(Stripes(4, contrast), reference);
    EXPECT_GT(flip, previous) << contrast;
    previous = flip;
  }
  EXPECT_LT(previous, 1);
}

TEST(Flip, RowsAndColumnsAreAlike) {
  const Image flat = Constant(40, 48, Color(0.5f));
  Image across = Stripes(3, 0.2f), along = Image::Rgb(40, 48);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 40; ++x) along.SetColor(x, y, across.ColorAt(y, x));
  EXPECT_NEAR(Flip(across, Constant(48, 40, Color(0.5f))), Flip(along, flat), 1e-6);
}

// An eye blurs what is fine: stripes of a pixel are nearly flat from afar, and plain from near by.
TEST(Flip, FineDetailIsLostFromAfar) {
  const Image fine = Stripes(1, 0.2f), flat = Constant(48, 40, Color(0.5f));
  const double near = FlipReference(flat, FlipRange::Low, 10).Compare(fine).mean;
  const double far = FlipReference(flat, FlipRange::Low, 200).Compare(fine).mean;
  EXPECT_LT(far, near / 2);
}

TEST(Flip, AnEdgeCountsMoreThanItsColourAlone) {
  // The left half agrees; the right half differs as two constant images do. At the step the features add to it.
  Image reference = Constant(64, 9, Color(0.5f)), test = reference;
  for (int y = 0; y < 9; ++y)
    for (int x = 32; x < 64; ++x) test.SetColor(x, y, Color(0.6f));
  const double constant = Flip(Constant(64, 9, Color(0.6f)), reference);
  const Image map = FlipReference(reference, FlipRange::Low).Compare(test).map;
  EXPECT_NEAR(map.At(63, 4, 0), constant, 1e-5);
  EXPECT_LT(map.At(0, 4, 0), 1e-5);
  EXPECT_GT(map.At(34, 4, 0), constant * 1.1);
}

TEST(Flip, ExposuresSpanFromTheBrightestToTheMedian) {
  Image image = Constant(10, 10, Color(1));
  image.SetColor(3, 3, Color(64));
  const FlipExposures exposures = ExposuresOf(image);
  EXPECT_NEAR(exposures.last - exposures.first, 6, 1e-6);  // 64 is six stops above 1
  EXPECT_EQ(exposures.count, 6);
  EXPECT_EQ(ExposuresOf(Constant(4, 4, Color(0))).count, 1);
  EXPECT_EQ(ExposuresOf(Constant(4, 4, Color(3))).count, 2);
  // Exposures follow the image: twice the light, one stop less.
  EXPECT_NEAR(ExposuresOf(Constant(4, 4, Color(6))).first, ExposuresOf(Constant(4, 4, Color(3))).first - 1, 1e-6);
}

TEST(Flip, HighRangeDoesNotDependOnTheUnitOfLight) {
  const Image reference = RandomImage(24, 24, 5, 30.f), test = RandomImage(24, 24, 6, 30.f);
  Image brightReference = reference, brightTest = test;
  for (float& value : brightReference.Values()) value *= 1024;
  for (float& value : brightTest.Values()) value *= 1024;
  EXPECT_NEAR(Flip(test, reference, FlipRange::High), Flip(brightTest, brightReference, FlipRange::High), 1e-5);
}

TEST(Flip, HighRangeSeesWhatAScreenClips) {
  Image reference = Constant(16, 16, Color(0.5f)), test = reference;
  for (int x = 0; x < 16; ++x) {
    for (int y = 0; y < 8; ++y) {
      reference.SetColor(x, y, Color(20));
      test.SetColor(x, y, Color(60));
    }
  }
  EXPECT_EQ(Flip(test, reference, FlipRange::Low), 0);
  EXPECT_GT(Flip(test, reference, FlipRange::High), 0.05);
}

TEST(Flip, BadPixelsAreLeftOutOfTheMeanAndShownInTheMap) {
  Image reference = Constant(40, 40, Color(0.5f)), test = reference;
  reference.SetColor(2, 3, Color(INFINITY));
  test.SetColor(2, 3, Color(NAN));
  const FlipResult result = FlipReference(reference, FlipRange::High).Compare(test);
  EXPECT_EQ(result.mean, 0);  // both count as black there, so their neighbours agree
  EXPECT_EQ(result.map.At(2, 3, 0), 1.f);
  EXPECT_EQ(result.map.At(3, 3, 0), 0.f);
  EXPECT_THROW(FlipReference(Constant(2, 2, Color(1)), FlipRange::Low).Compare(Constant(2, 2, Color(NAN))), Error);
  EXPECT_THROW(FlipReference(Constant(2, 2, Color(1)), FlipRange::Low).Compare(Constant(2, 3, Color(1))), Error);
}

TEST(Flip, TheViewerOfThePapers) { EXPECT_NEAR(PixelsPerDegree(), 67.02, 0.005); }

}  // namespace
}  // namespace dapple
