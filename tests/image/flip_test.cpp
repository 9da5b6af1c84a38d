#include "src/image/flip.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "src/base/error.h"
#include "src/base/vec.h"
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

/// LDR-FLIP of one pixel by the papers' formulas as they stand: kernels in two dimensions, sums over all their pixels.
class DirectFlip {
 public:
  explicit DirectFlip(double pixelsPerDegree) : ppd_(pixelsPerDegree) {}

  double At(const Image& reference, const Image& test, int x, int y) const {
    const Vec3d r = Seen(reference, x, y), t = Seen(test, x, y);
    const double power = std::pow(std::abs(r.x - t.x) + std::hypot(r.y - t.y, r.z - t.z), 0.7);
    const Vec3d green = Lab({0, 1, 0}), blue = Lab({0, 0, 1});
    const double most = std::pow(std::abs(green.x - blue.x) + std::hypot(green.y - blue.y, green.z - blue.z), 0.7);
    const double color =
        power < 0.4 * most ? 0.95 * power / (0.4 * most) : 0.95 + 0.05 * (power - 0.4 * most) / (0.6 * most);
    const double edges = std::abs(Feature(reference, x, y, true) - Feature(test, x, y, true));
    const double points = std::abs(Feature(reference, x, y, false) - Feature(test, x, y, false));
    return std::pow(color, 1 - std::sqrt(std::max(edges, points) / std::sqrt(2.)));
  }

 private:
  static Vec3d Xyz(const Vec3d& c) {
    return {(0.4124564 * c.x + 0.3575761 * c.y + 0.1804375 * c.z) / 0.95047,
            0.2126729 * c.x + 0.7151522 * c.y + 0.0721750 * c.z,
            (0.0193339 * c.x + 0.1191920 * c.y + 0.9503041 * c.z) / 1.08883};
  }
  static Vec3d Lab(const Vec3d& c) {
    const auto f = [](double v) { return v > 216. / 24389 ? std::cbrt(v) : (24389. / 27 * v + 16) / 116; };
    const Vec3d xyz = Xyz(c);
    const double lightness = 116 * f(xyz.y) - 16;
    return {lightness, lightness / 100 * 500 * (f(xyz.x) - f(xyz.y)), lightness / 100 * 200 * (f(xyz.y) - f(xyz.z))};
  }
  /// Luminance, X less Y and Y less Z: YCxCz but for factors and an offset, which a normalised blur leaves alone.
  static Vec3d Opponent(const Image& image, int x, int y) {
    const Color c = image.ColorAt(std::clamp(x, 0, image.Width() - 1), std::clamp(y, 0, image.Height() - 1));
    const Vec3d xyz = Xyz({double{c.r}, double{c.g}, double{c.b}});
    return {xyz.y, xyz.x - xyz.y, xyz.y - xyz.z};
  }
  Vec3d Seen(const Image& image, int x, int y) const {
    constexpr double kTerms[3][4] = {{1, 0.0047, 0, 1}, {1, 0.0053, 0, 1}, {34.1, 0.04, 13.5, 0.025}};
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / 2) / M_PI * ppd_));
    Vec3d sum(0), weights(0);
    for (int v = -radius; v <= radius; ++v) {
      for (int u = -radius; u <= radius; ++u) {
        const double squared = (u * u + v * v) / (ppd_ * ppd_);
        const Vec3d value = Opponent(image, x + u, y + v);
        for (int c = 0; c < 3; ++c) {
          double weight = 0;
          for (const int i : {0, 2})
            weight +=
                kTerms[c][i] * std::sqrt(M_PI / kTerms[c][i + 1]) * std::exp(-M_PI * M_PI * squared / kTerms[c][i + 1]);
          sum[c] += weight * value[c];
          weights[c] += weight;
        }
      }
    }
    const Vec3d blurred = sum / weights, xyz(blurred.x + blurred.y, blurred.x, blurred.x - blurred.z);
    // Linear Rec. 709 of XYZ, the usual inverse matrix.
    const double X = xyz.x * 0.95047, Y = xyz.y, Z = xyz.z * 1.08883;
    Vec3d rgb(3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z, -0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z,
              0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z);
    for (int c = 0; c < 3; ++c) rgb[c] = std::clamp(rgb[c], 0., 1.);
    return Lab(rgb);
  }
  double Feature(const Image& image, int x, int y, bool isEdge) const {
    const double sigma = 0.5 * 0.082 * ppd_;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    double response[2];
    for (const bool alongX : {true, false}) {
      double positive = 0, negative = 0, positiveSum = 0, negativeSum = 0;
      for (int v = -radius; v <= radius; ++v) {
        for (int u = -radius; u <= radius; ++u) {
          const double along = alongX ? u : v, gaussian = std::exp(-(u * u + v * v) / (2 * sigma * sigma));
          const double weight = (isEdge ? -along : along * along / (sigma * sigma) - 1) * gaussian;
          const double value = Opponent(image, x + u, y + v).x;
          (weight > 0 ? positive : negative) += std::abs(weight);
          (weight > 0 ? positiveSum : negativeSum) += std::abs(weight) * value;
        }
      }
      response[alongX ? 0 : 1] = positiveSum / positive - negativeSum / negative;
    }
    return std::hypot(response[0], response[1]);
  }

  double ppd_;
};

// The separable filters, the fixed scales and the inverses in use against plain sums in double precision.
TEST(Flip, IsWhatThePapersFormulasGive) {
  const Image reference = RandomImage(40, 32, 21, 1.f);
  Image test = RandomImage(40, 32, 22, 1.f);
  for (int y = 0; y < 32; ++y)  // a half that differs little, one that differs much
    for (int x = 0; x < 20; ++x) test.SetColor(x, y, 0.9f * reference.ColorAt(x, y) + 0.1f * test.ColorAt(x, y));
  for (const double ppd : {67., 20.}) {
    const Image map = FlipReference(reference, FlipRange::Low, ppd).Compare(test).map;
    const DirectFlip direct(ppd);
    for (const auto& [x, y] :
         {std::pair(0, 0), std::pair(5, 16), std::pair(19, 9), std::pair(22, 20), std::pair(39, 31)})
      EXPECT_NEAR(map.At(x, y, 0), direct.At(reference, test, x, y), 2e-4) << x << ", " << y;
  }
}

TEST(Flip, TheViewerOfThePapers) { EXPECT_NEAR(PixelsPerDegree(), 67.02, 0.005); }

}  // namespace
}  // namespace dapple
