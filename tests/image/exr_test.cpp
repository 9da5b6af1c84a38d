#include <cmath>
#include <cstring>
#include <limits>

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <half.h>

#include "src/image/image_formats.h"
#include "src/image/image_io.h"
#include "tests/image/temporary_folder.h"

namespace dapple {
namespace {

// Without the disk, for the thousands of broken files.
Image Decode(const std::string& name, const std::string& bytes) {
  return DecodeImage(bytes, name, ColorEncoding::SRgb(), FileLocation(name));
}

Image MakeRamp(int width, int height, std::vector<std::string> names) {
  Image image(width, height, std::move(names));
  for (size_t i = 0; i < image.Values().size(); ++i) image.Values()[i] = std::ldexp(static_cast<float>(i) - 7.25f, -3);
  return image;
}

void ExpectSamePixels(const Image& a, const Image& b) {
  ASSERT_EQ(a.Width(), b.Width());
  ASSERT_EQ(a.Height(), b.Height());
  ASSERT_EQ(a.ChannelNames(), b.ChannelNames());
  EXPECT_TRUE(std::equal(a.Values().begin(), a.Values().end(), b.Values().begin()));
}

TEST(Exr, FloatsComeBackBitForBit) {
  const TemporaryFolder folder;
  Image image = MakeRamp(7, 70, {"R", "G", "B"});
  image.At(0, 0, 0) = std::numeric_limits<float>::denorm_min();
  image.At(1, 0, 0) = std::numeric_limits<float>::max();
  image.At(2, 0, 0) = -std::numeric_limits<float>::infinity();
  WriteExr(folder.Path("a.exr"), image);
  const Image read = ReadImage(folder.Path("a.exr"));
  ExpectSamePixels(read, image);
  EXPECT_EQ(read.origin, Vec2i(0, 0));
  EXPECT_EQ(read.fullSize, Vec2i(7, 70));
  EXPECT_EQ(folder.FileCount(), 1u);
}

TEST(Exr, NaNsAreKept) {
  const TemporaryFolder folder;
  Image image(1, 1, {"Y"});
  image.At(0, 0, 0) = std::numeric_limits<float>::quiet_NaN();
  WriteExr(folder.Path("a.exr"), image);
  EXPECT_TRUE(std::isnan(ReadImage(folder.Path("a.exr")).At(0, 0, 0)));
}

TEST(Exr, CropKeepsItsPlace) {
  const TemporaryFolder folder;
  Image image = MakeRamp(5, 4, {"R", "G", "B"});
  image.origin = {10, 20};
  image.fullSize = {640, 480};
  WriteExr(folder.Path("a.exr"), image);
  const Image read = ReadImage(folder.Path("a.exr"));
  ExpectSamePixels(read, image);
  EXPECT_EQ(read.origin, image.origin);
  EXPECT_EQ(read.fullSize, image.fullSize);
}

TEST(Exr, AnyChannelNames) {
  const TemporaryFolder folder;
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"Y"}, {"R", "G", "B", "A"}, {"R", "G", "B", "Z", "albedo.R"}, {"G"}, {"depth"}}) {
    const Image image = MakeRamp(3, 3, names);
    WriteExr(folder.Path("a.exr"), image);
    ExpectSamePixels(ReadImage(folder.Path("a.exr")), image);
  }
}

TEST(Exr, HalfRoundsToTheNearest) {
  const TemporaryFolder folder;
  Image image = Image::Rgb(1, 1);
  image.SetColor(0, 0, {1.0001f, -3, 1e9f});
  WriteExr(folder.Path("a.exr"), image, {}, ExrPixelType::kHalf);
  EXPECT_EQ(ReadImage(folder.Path("a.exr")).ColorAt(0, 0), Color(1, -3, 65504));
}

TEST(Exr, MetadataComesBackAndBytesAreTheSame) {
  const TemporaryFolder folder;
  const ImageMetadata metadata = {{"scene", "a \"quoted\" name"}, {"seconds", 1.0 / 3}, {"passes", 64}};
  const Image image = MakeRamp(4, 4, {"R", "G", "B"});
  WriteExr(folder.Path("a.exr"), image, metadata);
  WriteExr(folder.Path("b.exr"), image, metadata);
  const ImageMetadata read = ReadExrMetadata(folder.Path("a.exr"));
  for (const auto& [name, value] : metadata) {
    ASSERT_TRUE(read.contains(name)) << name;
    EXPECT_EQ(read.at(name), value) << name;
  }
  EXPECT_EQ(folder.Read("a.exr"), folder.Read("b.exr"));
}

TEST(Exr, MetadataThatCollidesIsAnError) {
  const TemporaryFolder folder;
  EXPECT_THROW(WriteExr(folder.Path("a.exr"), Image::Rgb(1, 1), {{"compression", "none"}}), Error);
  EXPECT_EQ(folder.FileCount(), 0u);
}

// Tiles of three types at once, a data window that sticks out of the display window, lines from the bottom.
TEST(Exr, TiledFilesOfTheLibrary) {
  const TemporaryFolder folder;
  constexpr int kWidth = 37, kHeight = 29, kLeft = -5, kTop = 3;
  Imf::Header header(Imath::Box2i({0, 0}, {99, 49}),
                     Imath::Box2i({kLeft, kTop}, {kLeft + kWidth - 1, kTop + kHeight - 1}));
  header.channels().insert("R", Imf::Channel(Imf::HALF));
  header.channels().insert("G", Imf::Channel(Imf::FLOAT));
  header.channels().insert("id", Imf::Channel(Imf::UINT));
  header.compression() = Imf::PIZ_COMPRESSION;
  header.setTileDescription(Imf::TileDescription(8, 16, Imf::MIPMAP_LEVELS));
  std::vector<half> red(kWidth * kHeight);
  std::vector<float> green(kWidth * kHeight);
  std::vector<unsigned> id(kWidth * kHeight);
  for (size_t i = 0; i < red.size(); ++i) {
    red[i] = static_cast<float>(i);
    green[i] = 0.1f * static_cast<float>(i);
    id[i] = static_cast<unsigned>(3 * i);
  }
  {
    Imf::TiledOutputFile file(folder.Path("a.exr").c_str(), header);
    for (int level = 0; level < file.numLevels(); ++level) {
      // Coarser levels take any pixels: the reader wants the finest.
      const int width = file.levelWidth(level), height = file.levelHeight(level);
      const Imath::V2i corner(kLeft, kTop);
      Imf::FrameBuffer buffer;
      const auto row = [](size_t bytes) { return bytes * kWidth; };
      buffer.insert("R", Imf::Slice::Make(Imf::HALF, red.data(), corner, width, height, size_t{2}, row(2)));
      buffer.insert("G", Imf::Slice::Make(Imf::FLOAT, green.data(), corner, width, height, size_t{4}, row(4)));
      buffer.insert("id", Imf::Slice::Make(Imf::UINT, id.data(), corner, width, height, size_t{4}, row(4)));
      file.setFrameBuffer(buffer);
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
  }
  const Image image = ReadImage(folder.Path("a.exr"));
  EXPECT_EQ(image.ChannelNames(), (std::vector<std::string>{"R", "G", "id"}));
  EXPECT_EQ(image.origin, Vec2i(kLeft, kTop));
  EXPECT_EQ(image.fullSize, Vec2i(100, 50));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const size_t i = static_cast<size_t>(y * kWidth + x);
      ASSERT_EQ(image.At(x, y, 0), static_cast<float>(red[i]));
      ASSERT_EQ(image.At(x, y, 1), green[i]);
      ASSERT_EQ(image.At(x, y, 2), static_cast<float>(id[i]));
    }
  }
}

TEST(Exr, EveryCompressionAndLineOrder) {
  const TemporaryFolder folder;
  constexpr int kWidth = 33, kHeight = 150;
  std::vector<float> values(kWidth * kHeight);
  for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 1000);
  for (const auto order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
    for (const auto compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                   Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION}) {
      Imf::Header header(kWidth, kHeight);
      header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
      header.compression() = compression;
      header.lineOrder() = order;
      {
        Imf::OutputFile file(folder.Path("a.exr").c_str(), header);
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), {0, 0}, kWidth, kHeight));
        file.setFrameBuffer(buffer);
        file.writePixels(kHeight);
      }
      const Image image = ReadImage(folder.Path("a.exr"));
      // All values fit the 24 bits of PXR24 too.
      EXPECT_TRUE(std::equal(values.begin(), values.end(), image.Values().begin())) << compression;
    }
  }
}

TEST(Exr, LuminanceAndChromaBecomeColour) {
  const TemporaryFolder folder;
  constexpr int kSide = 16;
  std::vector<Imf::Rgba> pixels(kSide * kSide, Imf::Rgba(0.5f, 0.25f, 0.125f));
  {
    Imf::RgbaOutputFile file(folder.Path("a.exr").c_str(), kSide, kSide, Imf::WRITE_YC);
    file.setFrameBuffer(pixels.data(), 1, kSide);
    file.writePixels(kSide);
  }
  const Image image = ReadImage(folder.Path("a.exr"));
  ASSERT_EQ(image.Width(), kSide);
  for (int i = 0; i < kSide; ++i) {
    const Color color = image.ColorAt(i, i);
    EXPECT_NEAR(color.r, 0.5f, 0.01f);
    EXPECT_NEAR(color.g, 0.25f, 0.01f);
    EXPECT_NEAR(color.b, 0.125f, 0.01f);
  }
}

TEST(Exr, CutShortAnywhereIsAnError) {
  const TemporaryFolder folder;
  WriteExr(folder.Path("whole.exr"), MakeRamp(20, 40, {"R", "G", "B"}));
  const std::string bytes = folder.Read("whole.exr");
  for (size_t length = 0; length < bytes.size(); length += length < 600 ? 7 : 53)
    EXPECT_THROW(Decode("cut.exr", bytes.substr(0, length)), Error) << length;
}

TEST(Exr, FlippedBytesNeverCrash) {
  const TemporaryFolder folder;
  WriteExr(folder.Path("whole.exr"), MakeRamp(9, 5, {"R", "G"}));
  const std::string bytes = folder.Read("whole.exr");
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::string broken = bytes;
    broken[i] = static_cast<char>(broken[i] ^ 0xff);
    try {
      Decode("broken.exr", broken);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("broken.exr"), std::string::npos);
    }
  }
}

// The header claims 60000 x 4000 pixels; behind it stands what was a file of 4 x 4.
TEST(Exr, HeaderThatLiesAboutItsSize) {
  const TemporaryFolder folder;
  WriteExr(folder.Path("small.exr"), MakeRamp(4, 4, {"R", "G", "B"}));
  std::string bytes = folder.Read("small.exr");
  const size_t window = bytes.find("box2i") + 6 + 4;
  ASSERT_LT(window, bytes.size());
  const auto claim = [&](int32_t right, int32_t bottom) {
    std::memcpy(&bytes[window + 8], &right, 4);
    std::memcpy(&bytes[window + 12], &bottom, 4);
    EXPECT_THROW(ReadImage(folder.Write("lie.exr", bytes)), Error) << right << " " << bottom;
  };
  claim(59999, 3999);
  claim(65535, 65535);
  claim(2000000000, 3);
  claim(3, 2000000000);
  claim(-2, 3);
}

// OpenEXR would take the memory that an attribute claims before it reads it, or read on at another place.
TEST(Exr, AttributesThatLieAboutTheirSize) {
  const TemporaryFolder folder;
  WriteExr(folder.Path("a.exr"), MakeRamp(4, 4, {"R", "G", "B"}), {{"note", "some text"}, {"number", 7}});
  const std::string whole = folder.Read("a.exr");
  const auto errorWith = [&](const std::string& before, int32_t size) -> std::string {
    std::string bytes = whole;
    const size_t place = bytes.find(before) + before.size();
    EXPECT_LT(place, bytes.size()) << before;
    std::memcpy(&bytes[place], &size, sizeof(size));
    try {
      Decode("lie.exr", bytes);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  using namespace std::string_literals;
  EXPECT_EQ(errorWith("note\0string\0"s, 9), "no error") << "the true size";
  EXPECT_EQ(errorWith("note\0string\0"s, 2000000000),
            "lie.exr: error: cannot read the EXR file: attribute \"note\" does not take the 2000000000 bytes that it "
            "claims");
  for (const std::string& attribute : {"number\0int\0"s, "channels\0chlist\0"s, "compression\0compression\0"s,
                                       "dataWindow\0box2i\0"s, "screenWindowWidth\0float\0"s})
    for (const int32_t size : {-1, 0, 3, 5, 1000000, 0x7fffffff})
      EXPECT_NE(errorWith(attribute, size).find("bytes that it claims"), std::string::npos) << attribute << size;
}

TEST(Exr, ErrorsNameTheFileAndThePlaceInTheScene) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("not.exr", std::string("\x76\x2f\x31\x01 and no more", 17));
  try {
    ReadImage(path, ColorEncoding::SRgb(), FileLocation(std::make_shared<std::string>("scene.pbrt"), 12, 8));
    FAIL() << "expected an error";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("scene.pbrt:12:8: error: ")) << message;
    EXPECT_NE(message.find(path), std::string::npos) << message;
  }
  try {
    ReadImage(folder.Path("absent.exr"));
    FAIL() << "expected an error";
  } catch (const Error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with(folder.Path("absent.exr"))) << error.what();
  }
}

}  // namespace
}  // namespace dapple
