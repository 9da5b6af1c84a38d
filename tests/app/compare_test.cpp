// `dapple compare` from end to end.
#include <cmath>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "src/image/flip.h"
#include "src/image/image_io.h"
#include "tests/app/program.h"
#include "tests/image/test_images.h"

namespace dapple {
namespace {

class Compare : public ProgramTest {
 protected:
  nlohmann::json Json(const std::string& arguments) const {
    const ProgramResult result = Run("compare --json " + arguments);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return nlohmann::json::parse(result.out);
  }
  void ExpectError(const std::string& arguments, const std::string& beginning) const {
    const ProgramResult result = Run("compare " + arguments);
    EXPECT_EQ(result.exitCode, 1) << arguments;
    EXPECT_TRUE(BeginsWith(result.err, beginning));
  }
  /// As some renderers write: in tiles.
  void WriteTiled(const std::string& name, const Image& image) const {
    Imf::Header header(image.Width(), image.Height());
    for (const char* channel : {"R", "G", "B"}) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    header.setTileDescription(Imf::TileDescription(16, 16, Imf::ONE_LEVEL));
    Imf::TiledOutputFile file(Path(name).c_str(), header);
    Imf::FrameBuffer buffer;
    const char* const channels[] = {"R", "G", "B"};
    for (size_t c = 0; c < 3; ++c)
      buffer.insert(channels[c],
                    Imf::Slice(Imf::FLOAT, const_cast<char*>(reinterpret_cast<const char*>(&image.Values()[c])),
                               3 * sizeof(float), 3 * sizeof(float) * static_cast<size_t>(image.Width())));
    file.setFrameBuffer(buffer);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  }
};

TEST_F(Compare, MeasuresKnownImages) {
  WriteExr(Path("ref.exr"), Constant(40, 30, Color(2)));
  WriteExr(Path("same.exr"), Constant(40, 30, Color(2)));
  WriteExr(Path("more.exr"), Constant(40, 30, Color(3)));
  const nlohmann::json json = Json("ref.exr same.exr more.exr");
  EXPECT_EQ(json["relativeEpsilon"], 0.01);
  ASSERT_EQ(json["images"].size(), 2u);
  for (const char* measure : {"mse", "relativeMse", "trimmedRelativeMse", "mape", "flip", "ldrFlip", "nonFinite"})
    EXPECT_EQ(json["images"][0][measure], 0) << measure;
  EXPECT_EQ(json["images"][0]["meanRatio"], 1);
  const nlohmann::json& more = json["images"][1];
  EXPECT_DOUBLE_EQ(more["mse"], 1);
  EXPECT_NEAR(more["relativeMse"], 1 / 4.01, 1e-12);
  EXPECT_NEAR(more["trimmedRelativeMse"], 1 / 4.01, 1e-12);
  EXPECT_NEAR(more["mape"], 1 / 2.01, 1e-12);
  EXPECT_DOUBLE_EQ(more["meanRatio"], 1.5);
  EXPECT_EQ(more["ldrFlip"], 0) << "a screen shows both white";
  EXPECT_GT(more["flip"], 0);
}

TEST_F(Compare, NamesThatAreNoUtf8MakeJsonToo) {
  WriteExr(Path("caf\xe9.exr"), Constant(4, 3, Color(2)));
  const nlohmann::json json = Json("'caf\xe9.exr' 'caf\xe9.exr'");
  EXPECT_EQ(json["reference"], "caf\xef\xbf\xbd.exr");
  EXPECT_EQ(json["images"][0]["mse"], 0);
}

TEST_F(Compare, TilesScanlinesHalfAndFloatAreOne) {
  const Image test = Constant(40, 30, Color(0.75f)), reference = Constant(40, 30, Color(0.5f));
  WriteExr(Path("ref.exr"), reference);
  WriteExr(Path("half.exr"), test, {}, ExrPixelType::kHalf);  // 0.75 is a half
  WriteTiled("tiled.exr", test);
  const nlohmann::json json = Json("ref.exr half.exr tiled.exr");
  for (const nlohmann::json& image : json["images"]) EXPECT_DOUBLE_EQ(image["mse"], 0.0625) << image;
}

TEST_F(Compare, CropsAreComparedWhereTheyAre) {
  Image reference = Constant(40, 30, Color(1));
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 20; ++x) reference.SetColor(x, y, Color(5));
  Image crop = Constant(20, 10, Color(1));
  crop.origin = {20, 12};
  crop.fullSize = {40, 30};
  WriteExr(Path("ref.exr"), reference);
  WriteExr(Path("crop.exr"), crop);
  const nlohmann::json json = Json("ref.exr crop.exr")["images"][0];
  EXPECT_EQ(json["mse"], 0);
  EXPECT_EQ(json["width"], 20);
  EXPECT_EQ(json["isCut"], true);
  EXPECT_TRUE(Contains(Run("compare ref.exr crop.exr").out, "where the data windows overlap, 20 x 10 pixels"));
}

TEST_F(Compare, WhatCannotBeComparedIsToldAtTheFile) {
  WriteExr(Path("ref.exr"), Constant(8, 8, Color(1)));
  WriteExr(Path("wide.exr"), Constant(9, 8, Color(1)));
  WriteExr(Path("gray.exr"), Image(8, 8, {"Y"}));
  WriteExr(Path("depth.exr"), Image(8, 8, {"Z"}));
  WriteExr(Path("nan.exr"), Constant(8, 8, Color(NAN)));
  ExpectError("ref.exr wide.exr", "wide.exr: error: cannot compare pictures of 9 x 8 and 8 x 8 pixels");
  ExpectError("ref.exr gray.exr", "gray.exr: error: cannot compare colour channels Y with RGB");
  ExpectError("ref.exr depth.exr",
              "depth.exr: error: cannot compare: the image has none of the channels R, G, B and Y");
  ExpectError("ref.exr nan.exr", "nan.exr: error: cannot compare images: no pixel is finite in both");
  ExpectError("ref.exr missing.exr", "missing.exr: error: image file \"missing.exr\" not found");
  const ProgramResult pictures = Run("compare ref.exr ref.exr -d a.png -d b.png");
  EXPECT_EQ(pictures.exitCode, 2);
  EXPECT_TRUE(BeginsWith(pictures.err, "error: 1 image but 2 pictures of differences"));
  EXPECT_EQ(Run("compare ref.exr").exitCode, 2);
}

TEST_F(Compare, NonFinitePixelsAreCounted) {
  Image test = Constant(8, 8, Color(1));
  test.SetColor(3, 3, Color(INFINITY));
  test.SetColor(4, 4, {1, NAN, 1});
  WriteExr(Path("ref.exr"), Constant(8, 8, Color(1)));
  WriteExr(Path("test.exr"), test);
  const nlohmann::json json = Json("ref.exr test.exr")["images"][0];
  EXPECT_EQ(json["nonFinite"], 2);
  EXPECT_EQ(json["mse"], 0);
}

TEST_F(Compare, DrawsTheDifferences) {
  Image test = Constant(32, 32, Color(0.5f));
  for (int y = 0; y < 32; ++y)
    for (int x = 16; x < 32; ++x) test.SetColor(x, y, Color(0.9f));
  WriteExr(Path("ref.exr"), Constant(32, 32, Color(0.5f)));
  WriteExr(Path("test.exr"), test);
  ASSERT_EQ(Run("compare ref.exr test.exr -d map.exr").exitCode, 0);
  ASSERT_EQ(Run("compare ref.exr test.exr -d map.png --of relative").exitCode, 0);
  const Image map = ReadImage(Path("map.exr"));
  const FlipReference flip(Constant(32, 32, Color(0.5f)), FlipRange::High);
  EXPECT_EQ(map.At(31, 9, 0), flip.Compare(test).map.At(31, 9, 0));
  EXPECT_EQ(map.At(0, 9, 0), 0.f);
  const Image picture = ReadImage(Path("map.png"));
  EXPECT_EQ(picture.ColorAt(3, 3), Color(0));
  EXPECT_GT(picture.ColorAt(30, 3).Luminance(), 0.5f);
}

}  // namespace
}  // namespace dapple
