// Writes the seeds of the image readers, a few hundred bytes each, into FOLDER/exr and FOLDER/image:
//
//   make_corpus FOLDER
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <vector>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStdIO.h>
#include <ImfTiledOutputFile.h>
#include <stb/stb_image_write.h>

#include "src/image/image_io.h"

namespace dapple {
namespace {

constexpr int kWidth = 10, kHeight = 6;  // even, for chroma

class Folder {
 public:
  explicit Folder(std::filesystem::path path) : path_(std::move(path)) { std::filesystem::create_directories(path_); }
  void Write(const std::string& name, const std::string& bytes) const {
    std::ofstream file(path_ / name, std::ios::binary);
    if (!(file << bytes)) throw Error(FileLocation((path_ / name).string()), "cannot be written");
  }

 private:
  std::filesystem::path path_;
};

std::vector<float> Ramp() {
  std::vector<float> values;
  for (int i = 0; i < kWidth * kHeight; ++i) values.push_back(0.25f * static_cast<float>(i % 7));
  return values;
}

template <typename T>
Imf::FrameBuffer BufferOf(const Imf::Header& header, Imf::PixelType type, const T* values) {
  Imf::FrameBuffer buffer;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
    buffer.insert(channel.name(), Imf::Slice::Make(type, values, Imath::V2i(0, 0), kWidth, kHeight));
  return buffer;
}

std::string ScanlineExr(Imf::Compression compression, std::initializer_list<const char*> channels,
                        Imf::LineOrder order = Imf::INCREASING_Y) {
  Imf::Header header(kWidth, kHeight, 1, Imath::V2f(0, 0), 1, order, compression);
  for (const char* channel : channels) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
  Imf::StdOSStream stream;
  {
    const std::vector<float> values = Ramp();
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(BufferOf(header, Imf::FLOAT, values.data()));
    file.writePixels(kHeight);
  }
  return stream.str();
}

std::string TiledExr(Imf::LevelMode mode) {
  Imf::Header header(kWidth, kHeight);
  header.channels().insert("R", Imf::Channel(Imf::FLOAT));
  header.compression() = Imf::ZIP_COMPRESSION;
  header.setTileDescription(Imf::TileDescription(4, 4, mode));
  Imf::StdOSStream stream;
  {
    const std::vector<float> values = Ramp();
    Imf::TiledOutputFile file(stream, header);
    file.setFrameBuffer(BufferOf(header, Imf::FLOAT, values.data()));
    for (int y = 0; y < file.numYLevels(); ++y)
      for (int x = 0; x < file.numXLevels(); ++x)
        if (file.isValidLevel(x, y)) file.writeTiles(0, file.numXTiles(x) - 1, 0, file.numYTiles(y) - 1, x, y);
  }
  return stream.str();
}

std::string LuminanceChromaExr() {
  Imf::StdOSStream stream;
  {
    const std::vector<Imf::Rgba> pixels(kWidth * kHeight, Imf::Rgba(0.5f, 0.25f, 0.125f));
    Imf::RgbaOutputFile file(stream, Imf::Header(kWidth, kHeight), Imf::WRITE_YC);
    file.setFrameBuffer(pixels.data(), 1, kWidth);
    file.writePixels(kHeight);
  }
  return stream.str();
}

void WriteExrSeeds(const Folder& folder) {
  const std::array<Imf::Compression, 9> all = {Imf::NO_COMPRESSION,  Imf::RLE_COMPRESSION,  Imf::ZIPS_COMPRESSION,
                                               Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,  Imf::PXR24_COMPRESSION,
                                               Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION};
  for (size_t i = 0; i < all.size(); ++i)
    folder.Write("lines" + std::to_string(i) + ".exr", ScanlineExr(all[i], {"B", "G", "R"}));
  folder.Write("any.exr", ScanlineExr(Imf::NO_COMPRESSION, {"Y", "id.x"}, Imf::DECREASING_Y));
  folder.Write("tiles.exr", TiledExr(Imf::ONE_LEVEL));
  folder.Write("mipmap.exr", TiledExr(Imf::MIPMAP_LEVELS));
  folder.Write("ripmap.exr", TiledExr(Imf::RIPMAP_LEVELS));
  folder.Write("chroma.exr", LuminanceChromaExr());
}

void Append(void* context, void* data, int size) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
}

void WriteImageSeeds(const Folder& folder) {
  std::vector<uint8_t> codes;
  for (int i = 0; i < 4 * kWidth * kHeight; ++i) codes.push_back(static_cast<uint8_t>(37 * i));
  for (int channels = 1; channels <= 4; ++channels) {
    std::string png, jpeg, tga, runs;
    stbi_write_png_to_func(Append, &png, kWidth, kHeight, channels, codes.data(), kWidth * channels);
    stbi_write_jpg_to_func(Append, &jpeg, kWidth, kHeight, channels, codes.data(), 50);
    stbi_write_tga_with_rle = 0;
    stbi_write_tga_to_func(Append, &tga, kWidth, kHeight, channels, codes.data());
    stbi_write_tga_with_rle = 1;
    stbi_write_tga_to_func(Append, &runs, kWidth, kHeight, channels, codes.data());
    const std::string number = std::to_string(channels);
    folder.Write(number + ".png", png);
    folder.Write(number + ".jpg", jpeg);
    folder.Write(number + ".tga", tga);
    folder.Write(number + "runs.tga", runs);
  }
  // Ten pixels in the old encoding (one, and nine more of it), and in the new one: runs, and a literal piece.
  const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 10\n";
  folder.Write("old.hdr", header + "\x80\x40\x20\x81\1\1\1\x09");
  folder.Write("new.hdr", header + std::string("\2\2\0\x0a", 4) + "\x8a\x80\x8a\x40\12abcdefghij\x8a\x81");
  const std::vector<float> ramp = Ramp();
  const std::string pixels(reinterpret_cast<const char*>(ramp.data()), 12 * sizeof(float));
  folder.Write("gray.pfm", "Pf\n4 3\n-1\n" + pixels);
  folder.Write("color.pfm", "PF\n2 2\n1.0\n" + pixels);
}

}  // namespace
}  // namespace dapple

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_corpus FOLDER\n";
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  dapple::WriteExrSeeds(dapple::Folder(folder / "exr"));
  dapple::WriteImageSeeds(dapple::Folder(folder / "image"));
  return 0;
}
