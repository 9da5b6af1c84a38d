// OpenEXR files, through the library's scanline interface, which also reads tiled files (their finest level).
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <half.h>

#include "src/image/atomic_file.h"
#include "src/image/exr_header.h"
#include "src/image/image_formats.h"

namespace dapple {

namespace {

// A file whose header lies about its size fails at its first missing row: memory grows with what has been read.
constexpr int kRowsAtOnce = 64;
// Files that unpack to more than this many times their size are not given their memory in advance.
constexpr int64_t kPlausibleCompression = 1024;

class MemoryStream : public Imf::IStream {
 public:
  explicit MemoryStream(std::string_view bytes) : Imf::IStream("memory"), bytes_(bytes) {}

  bool read(char c[], int n) override {
    if (n < 0 || position_ > bytes_.size() || static_cast<size_t>(n) > bytes_.size() - position_)
      throw std::runtime_error("the file ends early");
    std::memcpy(c, bytes_.data() + position_, static_cast<size_t>(n));
    position_ += static_cast<size_t>(n);
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override { position_ = position; }

 private:
  std::string_view bytes_;
  uint64_t position_ = 0;
};

// OpenEXR allocates row buffers from the header alone; its own limit must be set before it reads one.
void LimitOpenExr() {
  static const bool isSet = [] {
    Imf::Header::setMaxImageSize(kMaxImageSide, kMaxImageSide);
    Imf::Header::setMaxTileSize(kMaxImageSide, kMaxImageSide);
    return true;
  }();
  static_cast<void>(isSet);
}

// The file's channel names, R, G, B, A first: the order in which an `Image` holds them.
std::vector<std::string> OrderedNames(const Imf::ChannelList& channels) {
  std::vector<std::string> names;
  for (const char* first : {"R", "G", "B", "A"})
    if (channels.findChannel(first)) names.emplace_back(first);
  const size_t colors = names.size();
  for (auto channel = channels.begin(); channel != channels.end(); ++channel)
    if (std::find(names.begin(), names.begin() + static_cast<ptrdiff_t>(colors), channel.name()) ==
        names.begin() + static_cast<ptrdiff_t>(colors))
      names.emplace_back(channel.name());
  return names;
}

bool IsSubsampled(const Imf::ChannelList& channels) {
  for (auto channel = channels.begin(); channel != channels.end(); ++channel)
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) return true;
  return false;
}

bool IsLuminanceChroma(const Imf::ChannelList& channels) {
  return channels.findChannel("Y") && channels.findChannel("RY") && channels.findChannel("BY");
}

std::vector<float> ReadRows(Imf::InputFile& file, const std::vector<std::string>& names, int64_t fileBytes) {
  const Imath::Box2i window = file.header().dataWindow();
  const int width = window.max.x - window.min.x + 1;
  const int height = window.max.y - window.min.y + 1;
  const size_t rowValues = static_cast<size_t>(width) * names.size();
  const size_t allValues = rowValues * static_cast<size_t>(height);
  std::vector<float> values;
  if (static_cast<int64_t>(allValues * sizeof(float)) / kPlausibleCompression <= fileBytes) values.reserve(allValues);
  for (int row = 0; row < height; row += kRowsAtOnce) {
    const int rows = std::min(kRowsAtOnce, height - row);
    values.resize(values.size() + rowValues * static_cast<size_t>(rows));
    Imf::FrameBuffer buffer;
    for (size_t c = 0; c < names.size(); ++c) {
      buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, values.data() + rowValues * static_cast<size_t>(row) + c,
                                               Imath::V2i(window.min.x, window.min.y + row), width, rows,
                                               names.size() * sizeof(float), rowValues * sizeof(float)));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y + row, window.min.y + row + rows - 1);
  }
  return values;
}

// Luminance and subsampled chroma, which the library turns into R, G, B of half precision.
Image ReadLuminanceChroma(std::string_view bytes) {
  MemoryStream stream(bytes);
  Imf::RgbaInputFile file(stream);
  const Imath::Box2i window = file.dataWindow();
  const int width = window.max.x - window.min.x + 1;
  const int height = window.max.y - window.min.y + 1;
  Imf::Array2D<Imf::Rgba> pixels(1, width);
  Image image = Image::Rgb(width, height);
  for (int y = 0; y < height; ++y) {
    const auto row = static_cast<ptrdiff_t>(window.min.y) + y;
    file.setFrameBuffer(&pixels[0][0] - window.min.x - row * width, 1, static_cast<size_t>(width));
    file.readPixels(static_cast<int>(row));
    for (int x = 0; x < width; ++x) image.SetColor(x, y, Color(pixels[0][x].r, pixels[0][x].g, pixels[0][x].b));
  }
  return image;
}

Image ReadExrUnchecked(std::string_view bytes, const FileLocation& location) {
  LimitOpenExr();
  CheckExrHeader(bytes, location);
  MemoryStream stream(bytes);
  Imf::InputFile file(stream);
  const Imf::Header& header = file.header();
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  const int64_t width = int64_t{data.max.x} - data.min.x + 1, height = int64_t{data.max.y} - data.min.y + 1;
  CheckImageSize(width, height, location);
  const std::vector<std::string> names = OrderedNames(header.channels());
  if (names.empty()) throw Error(location, "the image has no channels: expected R, G, B or Y");
  if (width * height > 4 * kMaxImagePixels / static_cast<int64_t>(names.size()))
    throw Error(location,
                fmt::format("image of {} x {} pixels and {} channels is too large", width, height, names.size()));
  const auto read = [&]() -> Image {
    if (!IsSubsampled(header.channels()))
      return {static_cast<int>(width), static_cast<int>(height), names,
              ReadRows(file, names, static_cast<int64_t>(bytes.size()))};
    if (IsLuminanceChroma(header.channels())) return ReadLuminanceChroma(bytes);
    throw Error(location, "subsampled channels: expected channels of full resolution, or Y, RY and BY");
  };
  Image image = read();
  image.origin = {data.min.x - display.min.x, data.min.y - display.min.y};
  image.fullSize = {display.max.x - display.min.x + 1, display.max.y - display.min.y + 1};
  return image;
}

// Runs `work` so that every exception of OpenEXR leaves as an `Error` of the project.
template <typename F>
auto WithErrors(const FileLocation& location, const char* what, F work) {
  try {
    return work();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(location, fmt::format("{}: not enough memory", what));
  } catch (const std::exception& error) {
    throw Error(location, fmt::format("{}: {}", what, error.what()));
  }
}

Imf::Header MakeHeader(const Image& image, const ImageMetadata& metadata, ExrPixelType type) {
  const Imath::Box2i display({0, 0}, {image.fullSize.x - 1, image.fullSize.y - 1});
  const Imath::Box2i data(image.origin, image.origin + Vec2i(image.Width() - 1, image.Height() - 1));
  Imf::Header header(display, data);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const std::string& name : image.ChannelNames())
    header.channels().insert(name, Imf::Channel(type == ExrPixelType::kHalf ? Imf::HALF : Imf::FLOAT));
  for (const auto& [name, value] : metadata) {
    if (const auto* text = std::get_if<std::string>(&value)) header.insert(name, Imf::StringAttribute(*text));
    if (const auto* number = std::get_if<double>(&value)) header.insert(name, Imf::DoubleAttribute(*number));
    if (const auto* integer = std::get_if<int>(&value)) header.insert(name, Imf::IntAttribute(*integer));
  }
  return header;
}

// Finite values stay finite: beyond the largest half they become it.
std::vector<half> ToHalf(std::span<const float> values) {
  constexpr float kLargestHalf = 65504;
  std::vector<half> result;
  result.reserve(values.size());
  for (const float value : values)
    result.emplace_back(std::isfinite(value) ? std::clamp(value, -kLargestHalf, kLargestHalf) : value);
  return result;
}

template <typename T>
std::string EncodeExr(const Image& image, const Imf::Header& header, Imf::PixelType type, const T* values) {
  Imf::FrameBuffer buffer;
  const size_t channels = static_cast<size_t>(image.Channels());
  for (size_t c = 0; c < channels; ++c) {
    buffer.insert(image.ChannelNames()[c],
                  Imf::Slice::Make(type, values + c, image.origin, image.Width(), image.Height(), channels * sizeof(T),
                                   channels * sizeof(T) * static_cast<size_t>(image.Width())));
  }
  Imf::StdOSStream stream;
  {
    Imf::OutputFile file(stream, header);
    file.setFrameBuffer(buffer);
    file.writePixels(image.Height());
  }
  return stream.str();
}

}  // namespace

Image ReadExr(std::string_view bytes, const FileLocation& location) {
  return WithErrors(location, "cannot read the EXR file", [&] { return ReadExrUnchecked(bytes, location); });
}

void WriteExr(const std::string& path, const Image& image, const ImageMetadata& metadata, ExrPixelType type) {
  const FileLocation location(path);
  CheckImageSize(image.Width(), image.Height(), location);
  const std::string bytes = WithErrors(location, "cannot write the EXR file", [&] {
    const Imf::Header header = MakeHeader(image, metadata, type);
    if (type == ExrPixelType::kFloat) return EncodeExr(image, header, Imf::FLOAT, image.Values().data());
    return EncodeExr(image, header, Imf::HALF, ToHalf(image.Values()).data());
  });
  WriteFileAtomically(path, bytes);
}

ImageMetadata ReadExrMetadata(const std::string& path) {
  return WithErrors(FileLocation(path), "cannot read the EXR file", [&] {
    LimitOpenExr();
    const Imf::InputFile file(path.c_str());
    ImageMetadata metadata;
    for (auto entry = file.header().begin(); entry != file.header().end(); ++entry) {
      const Imf::Attribute& attribute = entry.attribute();
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute))
        metadata[entry.name()] = text->value();
      if (const auto* number = dynamic_cast<const Imf::DoubleAttribute*>(&attribute))
        metadata[entry.name()] = number->value();
      if (const auto* number = dynamic_cast<const Imf::FloatAttribute*>(&attribute))
        metadata[entry.name()] = double{number->value()};
      if (const auto* integer = dynamic_cast<const Imf::IntAttribute*>(&attribute))
        metadata[entry.name()] = integer->value();
    }
    return metadata;
  });
}

}  // namespace dapple
