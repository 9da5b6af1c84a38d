#include "src/image/image_io.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>

#include <gtest/gtest.h>

#include "src/base/hash.h"
#include "src/image/image_formats.h"
#include "tests/image/temporary_folder.h"

namespace dapple {
namespace {

// Without the disk, for the thousands of broken files.
Image Decode(const std::string& name, const std::string& bytes) {
  return DecodeImage(bytes, name, ColorEncoding::SRgb(), FileLocation(name));
}

// A grey PNG of 2 x 1 pixels, 16 bits: 0x0100 and 0xffff (written by hand: one stored deflate block).
std::string BigEndian(uint32_t v) {
  return {static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8), static_cast<char>(v)};
}

std::string PngChunk(const std::string& type, const std::string& data) {
  // stb_image leaves the checksum unread.
  return BigEndian(static_cast<uint32_t>(data.size())) + type + data + BigEndian(0);
}

std::string Png16(const std::string& scanline, uint32_t width) {
  const std::string header = BigEndian(width) + BigEndian(1) + std::string("\x10\x00\x00\x00\x00", 5);
  const auto n = static_cast<uint16_t>(scanline.size());
  std::string stored = "\x78\x01\x01";
  for (const uint16_t v : {n, static_cast<uint16_t>(~n)})
    stored += {static_cast<char>(v & 0xff), static_cast<char>(v >> 8)};
  return "\x89PNG\r\n\x1a\n" + PngChunk("IHDR", header) + PngChunk("IDAT", stored + scanline + BigEndian(0)) +
         PngChunk("IEND", "");
}

std::string Floats(std::initializer_list<float> values, bool bigEndian) {
  std::string bytes;
  for (const float value : values) {
    uint32_t bits = std::bit_cast<uint32_t>(value);
    if (bigEndian) bits = __builtin_bswap32(bits);
    bytes.append(reinterpret_cast<const char*>(&bits), 4);
  }
  return bytes;
}

std::string TgaHeader(int type, int width, int height, int bits) {
  std::string header(18, '\0');
  header[2] = static_cast<char>(type);
  header[12] = static_cast<char>(width & 0xff);
  header[13] = static_cast<char>(width >> 8);
  header[14] = static_cast<char>(height & 0xff);
  header[15] = static_cast<char>(height >> 8);
  header[16] = static_cast<char>(bits);
  header[17] = 0x20;  // rows from the top
  return header;
}

std::string Jpeg(int side, uint8_t red, uint8_t green, uint8_t blue) {
  std::string pixels, bytes;
  for (int i = 0; i < side * side; ++i)
    pixels += {static_cast<char>(red), static_cast<char>(green), static_cast<char>(blue)};
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
  };
  stbi_write_jpg_to_func(append, &bytes, side, side, 3, pixels.data(), 95);
  return bytes;
}

TEST(ColorEncoding, SRgbCodesComeBack) {
  for (int code = 0; code < 256; ++code) {
    const float linear = ColorEncoding::SRgb().Decode(static_cast<float>(code) / 255);
    EXPECT_EQ(std::lround(255 * EncodeSRgb(linear)), code);
  }
  // IEC 61966-2-1: half grey is 0.2140.
  EXPECT_NEAR(ColorEncoding::SRgb().Decode(0.5f), 0.21404f, 1e-5f);
  EXPECT_EQ(EncodeSRgb(std::nanf("")), 0);
  EXPECT_EQ(EncodeSRgb(-1), 0);
  EXPECT_EQ(EncodeSRgb(INFINITY), 1);
}

TEST(Png, EightBitCodesComeBackThroughEachEncoding) {
  const TemporaryFolder folder;
  Image image = Image::Rgb(16, 16);
  for (int i = 0; i < 256; ++i) {
    const float linear = ColorEncoding::SRgb().Decode(static_cast<float>(i) / 255);
    image.SetColor(i % 16, i / 16, {linear, linear / 2, 0.25f});
  }
  WritePng(folder.Path("a.png"), image);
  WritePng(folder.Path("b.png"), image);
  EXPECT_EQ(folder.Read("a.png"), folder.Read("b.png"));
  const Image linear = ReadImage(folder.Path("a.png"), ColorEncoding::Linear());
  const Image sRgb = ReadImage(folder.Path("a.png"));
  const Image gamma = ReadImage(folder.Path("a.png"), ColorEncoding::Gamma(2));
  ASSERT_EQ(sRgb.ChannelNames(), (std::vector<std::string>{"R", "G", "B"}));
  for (int i = 0; i < 256; ++i) {
    const float code = static_cast<float>(i) / 255;
    EXPECT_FLOAT_EQ(sRgb.ColorAt(i % 16, i / 16).r, image.ColorAt(i % 16, i / 16).r);
    EXPECT_EQ(linear.ColorAt(i % 16, i / 16).r, code);
    EXPECT_FLOAT_EQ(gamma.ColorAt(i % 16, i / 16).r, code * code);
  }
}

TEST(Png, OutOfRangeAndNaNAreClamped) {
  const TemporaryFolder folder;
  Image image = Image::Rgb(1, 1);
  image.SetColor(0, 0, {std::nanf(""), -4, 1e30f});
  WritePng(folder.Path("a.png"), image);
  EXPECT_EQ(ReadImage(folder.Path("a.png")).ColorAt(0, 0), Color(0, 0, 1));
}

TEST(Png, WhatFollowsTheEndIsLeftAlone) {
  const TemporaryFolder folder;
  WritePng(folder.Path("a.png"), Image::Rgb(3, 2));
  std::ofstream(folder.Path("a.png"), std::ios::app | std::ios::binary) << std::string(16, '\xff');
  EXPECT_EQ(ReadImage(folder.Path("a.png")).Width(), 3);
}

TEST(Png, SixteenBits) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("a.png", Png16(std::string("\0\x01\0\xff\xff", 5), 2));
  const Image image = ReadImage(path, ColorEncoding::Linear());
  ASSERT_EQ(image.Width(), 2);
  EXPECT_EQ(image.ChannelNames(), std::vector<std::string>{"Y"});
  EXPECT_FLOAT_EQ(image.At(0, 0, 0), 256 / 65535.f);
  EXPECT_EQ(image.At(1, 0, 0), 1);
  EXPECT_EQ(image.ColorAt(1, 0), Color(1));
}

TEST(Png, CutShortAnywhereIsAnError) {
  const TemporaryFolder folder;
  Image image = Image::Rgb(30, 30);
  for (size_t i = 0; i < image.Values().size(); ++i) image.Values()[i] = static_cast<float>(Hash(i) & 0xff) / 255;
  WritePng(folder.Path("whole.png"), image);
  const std::string bytes = folder.Read("whole.png");
  for (size_t length = 0; length + 12 < bytes.size(); length += 31)
    EXPECT_THROW(Decode("cut.png", bytes.substr(0, length)), Error) << length;
}

TEST(Png, HeaderThatLiesAboutItsSize) {
  const TemporaryFolder folder;
  EXPECT_THROW(ReadImage(folder.Write("a.png", Png16(std::string("\0\x01\0\xff\xff", 5), 65000))), Error);
  EXPECT_THROW(ReadImage(folder.Write("a.png", Png16(std::string("\0\x01\0\xff\xff", 5), 0x7fffffff))), Error);
}

// stb_image would take the memory that a chunk claims before it reads it.
TEST(Png, ChunkThatLiesAboutItsSize) {
  std::string bytes = Png16(std::string("\0\1\0\xff\xff", 5), 2);
  const size_t length = bytes.find("IDAT") - 4;
  for (const uint32_t claim : {1000u, 0x7fffffffu, 0x80000000u, 0xffffffffu})
    EXPECT_THROW(Decode("lie.png", bytes.replace(length, 4, BigEndian(claim))), Error) << claim;
}

// A header alone must not cost the time of its pixels.
TEST(Tga, MorePixelsThanItsBytesCanHold) {
  EXPECT_THROW(Decode("a.tga", TgaHeader(10, 60, 60, 32) + std::string("\xff\1\2\3\4", 5)), Error);
  EXPECT_THROW(Decode("a.tga", TgaHeader(2, 1000, 1000, 32)), Error);
}

TEST(Jpeg, FlatColour) {
  const TemporaryFolder folder;
  const Image image = ReadImage(folder.Write("a.jpeg", Jpeg(20, 200, 100, 50)), ColorEncoding::Linear());
  ASSERT_EQ(image.Width(), 20);
  ASSERT_EQ(image.ChannelNames(), (std::vector<std::string>{"R", "G", "B"}));
  for (int i = 0; i < 20; ++i) {
    EXPECT_NEAR(image.At(i, 19 - i, 0), 200 / 255., 0.02);
    EXPECT_NEAR(image.At(i, 19 - i, 1), 100 / 255., 0.02);
    EXPECT_NEAR(image.At(i, 19 - i, 2), 50 / 255., 0.02);
  }
}

TEST(Jpeg, CutShortAnywhereIsAnError) {
  const TemporaryFolder folder;
  const std::string bytes = Jpeg(40, 200, 100, 50);
  for (size_t length = 0; length + 2 < bytes.size(); length += 3)
    EXPECT_THROW(Decode("a.jpg", bytes.substr(0, length)), Error) << length;
}

TEST(Tga, FlatWithAlphaAndRunLengths) {
  const TemporaryFolder folder;
  // One pixel of blue, green, red, alpha; alpha is never decoded.
  const Image flat = ReadImage(folder.Write("a.TGA", TgaHeader(2, 1, 1, 32) + "\x10\x20\xff\x80"));
  EXPECT_EQ(flat.ChannelNames(), (std::vector<std::string>{"R", "G", "B", "A"}));
  EXPECT_EQ(flat.At(0, 0, 0), 1);
  EXPECT_FLOAT_EQ(flat.At(0, 0, 1), ColorEncoding::SRgb().Decode(32 / 255.f));
  EXPECT_FLOAT_EQ(flat.At(0, 0, 3), 128 / 255.f);
  const Image runs =
      ReadImage(folder.Write("b.tga", TgaHeader(10, 4, 1, 24) + "\x82\x01\x02\x03" + std::string("\0\xff\xff\xff", 4)),
                ColorEncoding::Linear());
  EXPECT_FLOAT_EQ(runs.At(2, 0, 0), 3 / 255.f);
  EXPECT_EQ(runs.ColorAt(3, 0), Color(1));
}

TEST(Tga, CutShortOrHugeIsAnError) {
  const TemporaryFolder folder;
  const std::string bytes = TgaHeader(2, 10, 60, 24) + std::string(10 * 60 * 3, 'x');
  ReadImage(folder.Write("a.tga", bytes));
  for (size_t length = 0; length < bytes.size(); length += 7)
    EXPECT_THROW(Decode("a.tga", bytes.substr(0, length)), Error) << length;
  EXPECT_THROW(ReadImage(folder.Write("b.tga", TgaHeader(10, 16000, 16000, 24) + "\x82\x01\x02\x03")), Error);
}

TEST(Hdr, FlatOldAndNewRuns) {
  const TemporaryFolder folder;
  const std::string header = "#?RADIANCE\n# made by hand\nFORMAT=32-bit_rle_rgbe\n\n";
  // Exponent 129: mantissas count in 2^-7.
  const Image flat =
      ReadImage(folder.Write("a.hdr", header + "-Y 1 +X 2\n" + std::string("\x80\x40\x20\x81\xff\xff\xff\0", 8)));
  EXPECT_EQ(flat.ColorAt(0, 0), Color(1, 0.5f, 0.25f));
  EXPECT_EQ(flat.ColorAt(1, 0), Color(0));
  const Image oldRuns = ReadImage(folder.Write(
      "b.hdr", header + "-Y 1 +X 9\n" + std::string("\x80\x40\x20\x81\x01\x01\x01\x07\x80\x80\x80\x82", 12)));
  EXPECT_EQ(oldRuns.ColorAt(7, 0), Color(1, 0.5f, 0.25f));
  EXPECT_EQ(oldRuns.ColorAt(8, 0), Color(2));
  const std::string newRow = std::string("\x02\x02\0\x08", 4) + "\x88\x80" + "\x88\x40" +
                             std::string("\x08\x10\x20\x30\x40\x50\x60\x70\x80", 9) + "\x88\x81";
  const Image newRuns = ReadImage(folder.Write("c.hdr", header + "-Y 2 +X 8\n" + newRow + newRow));
  for (int x = 0; x < 8; ++x) EXPECT_EQ(newRuns.ColorAt(x, 1), Color(1, 0.5f, static_cast<float>(x + 1) / 8)) << x;
}

TEST(Hdr, BrokenFilesAreErrors) {
  const TemporaryFolder folder;
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n";
  const std::string row = std::string("\x02\x02\0\x08", 4) + "\x88\x80\x88\x40\x88\x20\x88\x81";
  ReadImage(folder.Write("a.hdr", header + row + row));
  const std::string bytes = header + row + row;
  for (size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THROW(Decode("a.hdr", bytes.substr(0, length)), Error) << length;
  // A run of no pixels, which some readers never leave; a run beyond its row; a size beyond the file.
  EXPECT_THROW(ReadImage(folder.Write("a.hdr", header + std::string("\x02\x02\0\x08", 4) + std::string(100, '\0'))),
               Error);
  EXPECT_THROW(ReadImage(folder.Write("a.hdr", header + std::string("\x02\x02\0\x08\x89\x80", 6) + row)), Error);
  EXPECT_THROW(ReadImage(folder.Write("a.hdr", "#?RADIANCE\n\n-Y 16000 +X 16000\n" + row)), Error);
  EXPECT_THROW(ReadImage(folder.Write("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 2 +X 8\n" + row + row)),
               Error);
}

TEST(Pfm, ColourAndGrayInBothByteOrders) {
  const TemporaryFolder folder;
  const Image color =
      ReadImage(folder.Write("a.pfm", "PF\n1 2\n-1.0\n" + Floats({1, 2, 3, 4e30f, 5, -6}, /*bigEndian=*/false)));
  EXPECT_EQ(color.ColorAt(0, 1), Color(1, 2, 3));
  EXPECT_EQ(color.ColorAt(0, 0), Color(4e30f, 5, -6));
  const Image gray = ReadImage(folder.Write("b.pfm", "Pf 2 1 1 " + Floats({0.1f, 7}, /*bigEndian=*/true)));
  EXPECT_EQ(gray.ColorAt(0, 0), Color(0.1f));
  EXPECT_EQ(gray.ColorAt(1, 0), Color(7));
}

TEST(Pfm, BrokenFilesAreErrors) {
  const TemporaryFolder folder;
  const std::string pixels = Floats({1, 2, 3}, false);
  for (const std::string& bytes :
       {std::string("PF"), std::string("PF\n1 1\n"), "PF\n1 1\n-1\n" + pixels.substr(1), "PF\n1.5 1\n-1\n" + pixels,
        "PF\n0 1\n-1\n" + pixels, "PF\n-1 1\n-1\n" + pixels, "PF\n60000 4000\n-1\n" + pixels,
        "PF\n1e300 1e300\n-1\n" + pixels, "PF\nnan 1\n-1\n" + pixels, "PF\n1 1\nx\n" + pixels})
    EXPECT_THROW(ReadImage(folder.Write("a.pfm", bytes)), Error) << bytes;
}

TEST(ReadImage, UnknownFormatsFoldersAndEmptyFilesAreErrors) {
  const TemporaryFolder folder;
  EXPECT_THROW(ReadImage(folder.Write("a.png", "GIF89a")), Error);
  EXPECT_THROW(ReadImage(folder.Write("b.exr", "")), Error);
  EXPECT_THROW(ReadImage(folder.Path(".")), Error);
  EXPECT_THROW(ReadImage(folder.Write("c.jpg", "\xff\xd8\xff\xe0 no more")), Error);
}

// Whatever a byte turns into: an image or an error, never a crash, an endless loop or unbounded memory.
TEST(ReadImage, FlippedBytesNeverCrash) {
  const TemporaryFolder folder;
  const std::string hdrRow = std::string("\x02\x02\0\x08", 4) + "\x88\x80\x88\x40\x88\x20\x88\x81";
  Image small = Image::Rgb(6, 6);
  for (size_t i = 0; i < small.Values().size(); ++i) small.Values()[i] = static_cast<float>(Hash(i) & 0xff) / 255;
  WritePng(folder.Path("small.png"), small);
  const std::pair<std::string, std::string> files[] = {
      {"a.png", folder.Read("small.png")},
      {"a.jpg", Jpeg(12, 30, 60, 250)},
      {"a.tga", TgaHeader(10, 4, 3, 24) + "\x87\x01\x02\x03\x83\x04\x05\x06"},
      {"a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 8\n" + hdrRow + hdrRow},
      {"a.pfm", "PF\n1 1\n-1\n" + Floats({1, 2, 3}, false)}};
  for (const auto& [name, bytes] : files) {
    ReadImage(folder.Write(name, bytes));
    for (size_t i = 0; i < bytes.size(); ++i) {
      for (const int flip : {0xff, 0x80, 0x01}) {
        std::string broken = bytes;
        broken[i] = static_cast<char>(broken[i] ^ flip);
        try {
          Decode(name, broken);
        } catch (const Error& error) {
          EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
        }
      }
    }
  }
}

}  // namespace
}  // namespace dapple
