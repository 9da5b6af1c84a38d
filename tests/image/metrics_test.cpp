#include "src/image/metrics.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "src/base/error.h"
#include "tests/image/test_images.h"

namespace dapple {
namespace {

TEST(Image, ColoursOfAllKindsOfChannels) {
  const auto color = [](std::vector<std::string> names, std::vector<float> values) {
    return Image(1, 1, std::move(names), std::move(values)).ColorAt(0, 0);
  };
  EXPECT_EQ(color({"R", "G", "B"}, {1, 2, 3}), Color(1, 2, 3));
  EXPECT_EQ(color({"A", "B", "G", "R"}, {1, 2, 3, 4}), Color(4, 3, 2));
  EXPECT_EQ(color({"R", "G"}, {1, 2}), Color(1, 2, 0));
  EXPECT_EQ(color({"A", "Y"}, {1, 2}), Color(2));
  EXPECT_EQ(color({"R"}, {5}), Color(5));
  EXPECT_EQ(color({"depth", "id"}, {5, 6}), Color(5));
}

TEST(CompareImages, ClosedForms) {
  const ImageDifference same = CompareImages(Constant(3, 2, Color(2)), Constant(3, 2, Color(2)));
  EXPECT_EQ(same.mse, 0);
  EXPECT_EQ(same.relativeMse, 0);
  EXPECT_EQ(same.trimmedRelativeMse, 0);
  EXPECT_EQ(same.mape, 0);
  EXPECT_EQ(same.meanRatio, 1);
  const ImageDifference difference = CompareImages(Constant(3, 2, {3, 2, 1}), Constant(3, 2, {2, 2, 0}));
  EXPECT_DOUBLE_EQ(difference.mse, 2. / 3);
  EXPECT_DOUBLE_EQ(difference.relativeMse, (1 / 4.01 + 1 / 0.01) / 3);
  EXPECT_DOUBLE_EQ(difference.trimmedRelativeMse, difference.relativeMse);
  EXPECT_DOUBLE_EQ(difference.mape, (1 / 2.01 + 1 / 0.01) / 3);
  EXPECT_DOUBLE_EQ(difference.meanRatio, 1.5);
}

// An offset d, and a factor f, over a ramp of values: sums that can be written down.
TEST(CompareImages, OffsetsAndFactorsOfARamp) {
  constexpr int kWidth = 64;
  Image ramp = Image::Rgb(kWidth, 1), shifted = ramp, scaled = ramp;
  double squares = 0, relative = 0, share = 0, sum = 0;
  for (int x = 0; x < kWidth; ++x) {
    const float r = static_cast<float>(x) / 8;
    ramp.SetColor(x, 0, Color(r));
    shifted.SetColor(x, 0, Color(r - 0.25f));
    scaled.SetColor(x, 0, Color(r * 1.5f));
    squares += double{r} * double{r} / kWidth;
    relative += 0.0625 / (double{r} * double{r} + 0.01) / kWidth;
    share += 0.25 / (double{r} + 0.01) / kWidth;
    sum += double{r} / kWidth;
  }
  const ImageDifference shift = CompareImages(shifted, ramp);
  EXPECT_NEAR(shift.mse, 0.0625, 1e-12);
  EXPECT_NEAR(shift.relativeMse, relative, 1e-12 * relative);
  EXPECT_NEAR(shift.mape, share, 1e-12 * share);
  EXPECT_NEAR(shift.meanRatio, (sum - 0.25) / sum, 1e-12);
  const ImageDifference factor = CompareImages(scaled, ramp);
  EXPECT_NEAR(factor.mse, squares / 4, 1e-9);
  EXPECT_NEAR(factor.meanRatio, 1.5, 1e-12);
}

TEST(RelativeErrors, TheirMeanSquareIsTheRelativeMse) {
  const Image test = RandomImage(13, 11, 1, 4.f), reference = RandomImage(13, 11, 2, 2.f);
  const Image errors = RelativeErrors(test, reference);
  double squares = 0;
  for (const float error : errors.Values()) squares += double{error} * double{error} / (13 * 11);
  EXPECT_NEAR(squares, CompareImages(test, reference).relativeMse, 1e-5 * squares);
  Image bad = test;
  bad.SetColor(3, 4, Color(NAN));
  EXPECT_EQ(RelativeErrors(bad, reference).At(3, 4, 0), INFINITY);
}

TEST(MakeComparable, CutsToThePixelsThatBothHave) {
  Image whole = RandomImage(8, 6, 3, 1.f), part = RandomImage(4, 5, 4, 1.f);
  part.origin = {6, 2};  // over the right edge, as a data window may lie
  part.fullSize = {8, 6};
  const ComparablePair pair = MakeComparable(part, whole);
  EXPECT_TRUE(pair.isCut);
  ASSERT_EQ(pair.test.Width(), 2);
  ASSERT_EQ(pair.test.Height(), 4);
  EXPECT_EQ(pair.test.ColorAt(1, 3), part.ColorAt(1, 3));
  EXPECT_EQ(pair.reference.ColorAt(1, 3), whole.ColorAt(7, 5));
  EXPECT_EQ(pair.reference.origin, Vec2i(6, 2));
  EXPECT_FALSE(MakeComparable(whole, whole).isCut);
}

TEST(MakeComparable, WhatCannotBeComparedIsAnError) {
  const Image color = Constant(4, 4, Color(1));
  EXPECT_THROW(MakeComparable(Constant(4, 5, Color(1)), color), Error);
  EXPECT_THROW(MakeComparable(Image(4, 4, {"Y"}), color), Error);
  EXPECT_THROW(MakeComparable(Image(4, 4, {"R", "G"}), color), Error);
  EXPECT_THROW(MakeComparable(Image(4, 4, {"depth"}), Image(4, 4, {"depth"})), Error);
  EXPECT_NO_THROW(MakeComparable(Image(4, 4, {"A", "B", "G", "R", "depth"}), color));
  EXPECT_NO_THROW(MakeComparable(Image(4, 4, {"Y"}), Image(4, 4, {"Y", "A"})));
  Image left = Constant(2, 4, Color(1)), right = left;
  right.origin = {2, 0};
  left.fullSize = right.fullSize = {4, 4};
  EXPECT_THROW(MakeComparable(left, right), Error);
}

TEST(CompareImages, TrimmingDropsTheWorstThousandth) {
  const Image reference = Constant(100, 40, Color(1));
  Image test = Constant(100, 40, Color(1.1f));
  for (int i = 0; i < 4; ++i) test.SetColor(7 * i, 9 * i, Color(1000));
  const double background = (1.1f - 1.) * (1.1f - 1.) / 1.01;
  EXPECT_NEAR(CompareImages(test, reference).trimmedRelativeMse, background, 1e-12);
  EXPECT_GT(CompareImages(test, reference).relativeMse, 900);
  test.SetColor(50, 20, Color(1000));  // a fifth: one more than 0.1 % of 4000
  EXPECT_GT(CompareImages(test, reference).trimmedRelativeMse, 200);
}

TEST(CompareImages, BadPixelsAreCountedAndLeftOut) {
  Image test = Constant(4, 4, Color(2)), reference = Constant(4, 4, Color(1));
  test.SetColor(0, 0, {1, std::nanf(""), 1});
  reference.SetColor(1, 1, Color(INFINITY));
  const ImageDifference difference = CompareImages(test, reference);
  EXPECT_EQ(difference.nonFinite, 2);
  EXPECT_DOUBLE_EQ(difference.mse, 1);
  EXPECT_DOUBLE_EQ(difference.meanRatio, 2);
}

TEST(CompareImages, BlackReferences) {
  EXPECT_EQ(CompareImages(Constant(2, 2, Color(0)), Constant(2, 2, Color(0))).meanRatio, 1);
  EXPECT_EQ(CompareImages(Constant(2, 2, Color(1)), Constant(2, 2, Color(0))).meanRatio,
            std::numeric_limits<double>::infinity());
}

TEST(CompareImages, WhatCannotBeComparedIsAnError) {
  EXPECT_THROW(CompareImages(Constant(2, 3, Color(1)), Constant(3, 2, Color(1))), Error);
  EXPECT_THROW(CompareImages(Constant(1, 1, Color(INFINITY)), Constant(1, 1, Color(1))), Error);
  EXPECT_THROW(CompareImages(Image(), Image()), Error);
}

TEST(BlockMeans, PartialBlocksToo) {
  Image image(5, 3, {"Y", "A"});
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x) image.At(x, y, 0) = static_cast<float>(x + 10 * y);
  const Image means = BlockMeans(image, 2);
  ASSERT_EQ(means.Width(), 3);
  ASSERT_EQ(means.Height(), 2);
  EXPECT_EQ(means.At(0, 0, 0), 5.5f);
  EXPECT_EQ(means.At(2, 0, 0), 9.f);
  EXPECT_EQ(means.At(0, 1, 0), 20.5f);
  EXPECT_EQ(means.At(2, 1, 0), 24.f);
  EXPECT_EQ(means.At(2, 1, 1), 0.f);
  EXPECT_EQ(BlockMeans(image, 100).Width(), 1);
}

}  // namespace
}  // namespace dapple
