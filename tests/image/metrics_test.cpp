#include "src/image/metrics.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "src/base/error.h"

namespace dapple {
namespace {

Image Constant(int width, int height, const Color& color) {
  Image image = Image::Rgb(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.SetColor(x, y, color);
  return image;
}

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
  EXPECT_EQ(same.meanRatio, 1);
  const ImageDifference difference = CompareImages(Constant(3, 2, {3, 2, 1}), Constant(3, 2, {2, 2, 0}));
  EXPECT_DOUBLE_EQ(difference.mse, 2. / 3);
  EXPECT_DOUBLE_EQ(difference.relativeMse, (1 / 4.01 + 1 / 0.01) / 3);
  EXPECT_DOUBLE_EQ(difference.trimmedRelativeMse, difference.relativeMse);
  EXPECT_DOUBLE_EQ(difference.meanRatio, 1.5);
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
