// Textures from images: orientation, filters, wrapping at every seam, scalars, and the cache.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "src/base/numerics.h"
#include "src/materials/image_texture.h"
#include "tests/image/temporary_folder.h"

namespace dapple {
namespace {

TextureContext At(float u, float v) { return TextureContext(Vec2(u, v)); }

/// A gray image from its rows, the top one first.
std::shared_ptr<const Image> Gray(const std::vector<std::vector<float>>& rows) {
  Image image(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), {"Y"});
  for (int y = 0; y < image.Height(); ++y) {
    for (int x = 0; x < image.Width(); ++x) image.At(x, y, 0) = rows[y][x];
  }
  return std::make_shared<const Image>(std::move(image));
}

ImageFloatTexture Texture(std::shared_ptr<const Image> image, WrapMode wrap,
                          ImageFilter filter = ImageFilter::kBilinear) {
  ImageTextureOptions options;
  options.wrap = wrap;
  options.filter = filter;
  return {std::move(image), std::make_shared<UvMapping>(), PixelScalar::kLuminance, options};
}

constexpr WrapMode kAllWraps[] = {WrapMode::kRepeat, WrapMode::kBlack, WrapMode::kClamp, WrapMode::kOctahedralSphere};

TEST(ImageTexture, TexelCentresHoldTheirTexelsAndRowsGoDown) {
  const auto image = Gray({{1, 2, 3}, {4, 5, 6}});
  for (const WrapMode wrap : kAllWraps) {
    for (const ImageFilter filter : {ImageFilter::kPoint, ImageFilter::kBilinear}) {
      const ImageFloatTexture texture = Texture(image, wrap, filter);
      EXPECT_FLOAT_EQ(texture.Evaluate(At(0.5f / 3, 0.75f)), 1);
      EXPECT_FLOAT_EQ(texture.Evaluate(At(0.5f, 0.75f)), 2);
      EXPECT_NEAR(texture.Evaluate(At(2.5f / 3, 0.25f)), 6, 1e-5f);
      EXPECT_FLOAT_EQ(texture.Evaluate(At(0.5f / 3, 0.25f)), 4);
    }
  }
}

TEST(ImageTexture, BilinearIsExactOnLinearRamps) {
  std::vector<std::vector<float>> rows(8, std::vector<float>(16));
  const auto ramp = [](float x, float y) { return 3 * x - 2 * y + 1; };  // in texels from the top left centre
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) rows[y][x] = ramp(static_cast<float>(x), static_cast<float>(y));
  }
  const ImageFloatTexture texture = Texture(Gray(rows), WrapMode::kClamp);
  for (float x = 0; x <= 15; x += 0.37f) {
    for (float y = 0; y <= 7; y += 0.29f) {
      EXPECT_NEAR(texture.Evaluate(At((x + 0.5f) / 16, 1 - (y + 0.5f) / 8)), ramp(x, y), 1e-4f);
    }
  }
}

TEST(ImageTexture, RepeatIsPeriodicAndSmoothAcrossTheSeam) {
  const ImageFloatTexture texture = Texture(Gray({{1, 2, 3, 7}, {4, 5, 6, 9}}), WrapMode::kRepeat);
  // On the seam: the mean of the first and the last texel.
  EXPECT_FLOAT_EQ(texture.Evaluate(At(0, 0.75f)), 4);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(1, 0.75f)), 4);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(-1, 0.75f)), 4);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(-1e-9f, 0.75f)), 4);  // 1 - 1e-9 is 1 as a float
  EXPECT_FLOAT_EQ(texture.Evaluate(At(0.125f, 0)), 2.5f);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(0.125f, 1)), 2.5f);
  for (const float u : {0.03f, 0.2f, 0.61f, 0.97f}) {
    for (const float v : {0.1f, 0.45f, 0.9f}) {
      const float value = texture.Evaluate(At(u, v));
      EXPECT_NEAR(texture.Evaluate(At(u - 5, v)), value, 1e-4f);
      EXPECT_NEAR(texture.Evaluate(At(u + 3, v - 2)), value, 1e-4f);
    }
  }
}

TEST(ImageTexture, ClampContinuesTheEdge) {
  const ImageFloatTexture texture = Texture(Gray({{1, 2}, {4, 5}}), WrapMode::kClamp);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(-0.1f, 0.75f)), 1);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(-100, 2)), 1);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(1.5f, -9)), 5);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(0.5f, 50)), 1.5f);
}

TEST(ImageTexture, BlackEndsWithHalfATexel) {
  const ImageFloatTexture texture = Texture(Gray({{2, 2}, {2, 2}}), WrapMode::kBlack);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(0.5f, 0.5f)), 2);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(0, 0.5f)), 1);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(0, 0)), 0.5f);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(-0.25f, 0.5f)), 0);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(1e20f, 0.5f)), 0);
  const ImageFloatTexture point = Texture(Gray({{2, 2}, {2, 2}}), WrapMode::kBlack, ImageFilter::kPoint);
  EXPECT_EQ(point.Evaluate(At(0.999f, 0.001f)), 2);
  EXPECT_EQ(point.Evaluate(At(-0.001f, 0.5f)), 0);
  EXPECT_EQ(point.Evaluate(At(0.5f, 1.001f)), 0);
}

// Across an edge of the square map lies the texel of the same edge mirrored about its middle.
TEST(ImageTexture, OctahedralFoldsTheEdges) {
  const ImageFloatTexture texture = Texture(Gray({{1, 2}, {4, 8}}), WrapMode::kOctahedralSphere, ImageFilter::kPoint);
  EXPECT_EQ(texture.Evaluate(At(-0.1f, 0.75f)), 4);
  EXPECT_EQ(texture.Evaluate(At(-0.1f, 0.25f)), 1);
  EXPECT_EQ(texture.Evaluate(At(1.1f, 0.75f)), 8);
  EXPECT_EQ(texture.Evaluate(At(0.25f, 1.1f)), 2);
  EXPECT_EQ(texture.Evaluate(At(0.75f, -0.1f)), 4);
  EXPECT_EQ(texture.Evaluate(At(-0.1f, 1.1f)), 8);
}

TEST(ImageTexture, AnyCoordinateGivesAFiniteValue) {
  for (const WrapMode wrap : kAllWraps) {
    for (const ImageFilter filter : {ImageFilter::kPoint, ImageFilter::kBilinear}) {
      for (const auto& rows : {std::vector<std::vector<float>>{{3}}, {{1, 2, 3}}, {{1}, {2}}}) {
        const ImageFloatTexture texture = Texture(Gray(rows), wrap, filter);
        for (const float u :
             {0.f, 1.f, -1.f, -1e-30f, 1e-30f, 0x1.fffffep-1f, 1e10f, -3e38f, kInfinity, -kInfinity, NAN}) {
          EXPECT_TRUE(std::isfinite(texture.Evaluate(At(u, 0.5f)))) << u;
          EXPECT_TRUE(std::isfinite(texture.Evaluate(At(u, u)))) << u;
        }
      }
    }
  }
}

std::shared_ptr<const Image> OnePixel(const std::vector<std::string>& channels, const std::vector<float>& values) {
  Image image(1, 1, channels);
  for (size_t c = 0; c < values.size(); ++c) image.At(0, 0, static_cast<int>(c)) = values[c];
  return std::make_shared<const Image>(std::move(image));
}

TEST(ImageTexture, ScaleAndInvert) {
  const auto image = OnePixel({"R", "G", "B"}, {0.1f, 0.5f, 2});
  ImageTextureOptions options;
  options.scale = 2;
  const auto color = [&] {
    return ImageColorTexture(image, std::make_shared<UvMapping>(), options).Evaluate(At(0, 0));
  };
  EXPECT_EQ(color(), Color(0.2f, 1, 4));
  options.invert = true;
  EXPECT_EQ(color(), Color(1 - 0.2f, 0, 0));
  EXPECT_FLOAT_EQ(
      ImageFloatTexture(OnePixel({"Y"}, {0.3f}), std::make_shared<UvMapping>(), PixelScalar::kLuminance, options)
          .Evaluate(At(0, 0)),
      0.4f);
}

TEST(ImageTexture, MappingMovesTheImage) {
  const auto mapping = std::make_shared<UvMapping>(Vec2(0.5f, 1), Vec2(0.5f, 0));
  const ImageFloatTexture texture(Gray({{1, 2}}), mapping, PixelScalar::kLuminance);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(0.5f, 0.5f)), 2);
  EXPECT_FLOAT_EQ(texture.Evaluate(At(1.5f, 0.5f)), 1);
}

TEST(ImageTexture, ScalarsFollowTheVersion) {
  const auto evaluate = [](const std::shared_ptr<const Image>& image, PixelScalar scalar) {
    return ImageFloatTexture(image, std::make_shared<UvMapping>(), scalar).Evaluate(At(0.5f, 0.5f));
  };
  const auto rgb = OnePixel({"R", "G", "B"}, {0.3f, 0.6f, 0});
  EXPECT_FLOAT_EQ(evaluate(rgb, PixelScalar::kLuminance), 0.2126f * 0.3f + 0.7152f * 0.6f);
  EXPECT_FLOAT_EQ(evaluate(rgb, PixelScalar::kAlphaOrAverage), 0.3f);
  const auto cut = OnePixel({"R", "G", "B", "A"}, {0.3f, 0.6f, 0, 0.25f});
  EXPECT_FLOAT_EQ(evaluate(cut, PixelScalar::kAlphaOrAverage), 0.25f);
  EXPECT_FLOAT_EQ(evaluate(cut, PixelScalar::kLuminance), 0.2126f * 0.3f + 0.7152f * 0.6f);
  const auto opaque = OnePixel({"R", "G", "B", "A"}, {0.3f, 0.6f, 0, 1});
  EXPECT_FLOAT_EQ(evaluate(opaque, PixelScalar::kAlphaOrAverage), 0.3f);
  const auto gray = OnePixel({"Y"}, {0.7f});
  EXPECT_EQ(evaluate(gray, PixelScalar::kLuminance), 0.7f);
  EXPECT_EQ(evaluate(gray, PixelScalar::kAlphaOrAverage), 0.7f);
}

TEST(ImageTexture, EmptyImageIsAnError) {
  const auto empty = std::make_shared<const Image>();
  EXPECT_THROW(ImageColorTexture(empty, std::make_shared<UvMapping>()), Error);
  EXPECT_THROW(ImageFloatTexture(empty, std::make_shared<UvMapping>(), PixelScalar::kLuminance), Error);
}

class ImageCacheTest : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::string path_ = folder_.Path("a.img");
  std::vector<std::string> warnings_;
  Diagnostics diagnostics_{[this](const std::string& line) { warnings_.push_back(line); }};
  ImageCache cache_{&diagnostics_};
};

TEST_F(ImageCacheTest, OpensAFileOncePerEncoding) {
  Image image = Image::Rgb(1, 1);
  image.SetColor(0, 0, Color(0.5f));
  WritePng(path_, image);
  EXPECT_EQ(cache_.OpenedCount(), 0);
  const auto first = cache_.Get(path_, ColorEncoding::SRgb());
  EXPECT_EQ(cache_.Get(path_, ColorEncoding::SRgb()), first);
  EXPECT_EQ(cache_.OpenedCount(), 1);
  const auto linear = cache_.Get(path_, ColorEncoding::Linear());
  EXPECT_EQ(cache_.OpenedCount(), 2);
  EXPECT_NEAR(first->ColorAt(0, 0).g, 0.5f, 0.005f);
  EXPECT_NEAR(linear->ColorAt(0, 0).g, 0.735f, 0.005f);  // the sRGB code of 0.5
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(ImageCacheTest, BadPixelsBecomeBlackWithAWarning) {
  Image image = Image::Rgb(2, 1);
  image.SetColor(0, 0, {kInfinity, 2, NAN});
  image.SetColor(1, 0, {1, 2, 3});
  WriteExr(path_, image);
  const auto mended = cache_.Get(path_, ColorEncoding::Linear(), FileLocation("scene.pbrt"));
  EXPECT_EQ(mended->ColorAt(0, 0), Color(0, 2, 0));
  EXPECT_EQ(mended->ColorAt(1, 0), Color(1, 2, 3));
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("scene.pbrt"), std::string::npos);
  cache_.Get(path_, ColorEncoding::Linear());
  EXPECT_EQ(warnings_.size(), 1u);
}

TEST_F(ImageCacheTest, MissingFileIsAnErrorAtTheRequest) {
  try {
    cache_.Get(path_ + ".missing", ColorEncoding::SRgb(), FileLocation("scene.pbrt"));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("scene.pbrt"), std::string::npos);
  }
  EXPECT_EQ(cache_.OpenedCount(), 0);
}

}  // namespace
}  // namespace dapple
