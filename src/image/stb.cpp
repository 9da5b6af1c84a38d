// PNG, JPEG and TGA through stb_image, PNG out through stb_image_write; their code is compiled here only.
// (Radiance HDR has its own reader: stb_image 2.27 never ends on a file that is cut short, CVE-2021-42715.)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_STDIO
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_TGA
#define STBI_MAX_DIMENSIONS 65536
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "src/image/atomic_file.h"
#include "src/image/image_formats.h"

namespace dapple {

namespace {

// How many pixels a file may hold at most: one whose header says more is refused before they cost time. Deflate (PNG)
// packs 1032 bytes into one; JPEG takes a bit for each block of 8 x 8, which the oddest subsampling spreads over 128
// pixels; TGA's shortest run is 128 pixels in two bytes.
int64_t MostPixels(std::string_view bytes) {
  const auto size = static_cast<int64_t>(bytes.size());
  if (bytes.starts_with('\xff')) return 8 * 128 * size;
  if (!bytes.starts_with("\x89PNG") || size < 26) return 64 * size;
  const int64_t depth = std::max<int64_t>(bytes[24], 1), type = bytes[25];
  const int64_t channels = type == 2 ? 3 : type == 4 ? 2 : type == 6 ? 4 : 1;
  return 1032 * 8 * size / (depth * channels);
}

static_assert(STBI_MAX_DIMENSIONS == kMaxImageSide);

// Feeds stb_image and notices when it wants more than the file holds: it would go on with what its memory held before.
struct Source {
  std::string_view bytes;
  size_t position = 0;
  bool endsEarly = false;
  const char* refillBuffer = nullptr;

  // stb_image refills its own buffer with what there is, and does so first; any other read must be filled.
  static int Read(void* user, char* data, int size) {
    auto& source = *static_cast<Source*>(user);
    if (!source.refillBuffer) source.refillBuffer = data;
    const size_t count = std::min(static_cast<size_t>(size), source.bytes.size() - source.position);
    std::memcpy(data, source.bytes.data() + source.position, count);
    source.position += count;
    if (count < static_cast<size_t>(size)) source.endsEarly |= count == 0 || data != source.refillBuffer;
    return static_cast<int>(count);
  }
  static void Skip(void* user, int count) {
    auto& source = *static_cast<Source*>(user);
    const auto target = static_cast<int64_t>(source.position) + count;
    source.endsEarly |= target < 0 || target > static_cast<int64_t>(source.bytes.size());
    source.position = static_cast<size_t>(std::clamp<int64_t>(target, 0, static_cast<int64_t>(source.bytes.size())));
  }
  static int AtEnd(void* user) {
    const auto& source = *static_cast<Source*>(user);
    return source.position >= source.bytes.size();
  }
};

constexpr stbi_io_callbacks kCallbacks = {&Source::Read, &Source::Skip, &Source::AtEnd};

// stb_image 2.27 writes beyond its tables where a JPEG file's Huffman table names more than 256 codes: such files are
// refused beforehand. Walks through the file as stb_image does: segment by segment, and from marker to marker in scans.
void CheckJpegTables(std::string_view bytes, const FileLocation& location) {
  constexpr unsigned kTables = 0xc4, kStart = 0xd8, kFirstRestart = 0xd0, kEnd = 0xd9, kMaxCodes = 256;
  const auto byteAt = [&](size_t i) { return i < bytes.size() ? static_cast<uint8_t>(bytes[i]) : 0u; };
  for (size_t i = bytes.find('\xff'); i < bytes.size(); i = bytes.find('\xff', i)) {
    while (byteAt(i) == 0xff) ++i;
    const unsigned marker = byteAt(i++);
    if (marker == 0 || (marker >= kFirstRestart && marker <= kStart)) continue;
    if (marker == kEnd) return;
    const size_t end = i + (byteAt(i) << 8 | byteAt(i + 1));
    if (marker == kTables) {
      for (size_t table = i + 2; table < end && table < bytes.size();) {
        size_t codes = 0;
        for (size_t length = 1; length <= 16; ++length) codes += byteAt(table + length);
        if (codes > kMaxCodes) throw Error(location, "cannot read the image: a Huffman table of more than 256 codes");
        table += 17 + codes;
      }
    }
    i = std::max(i, end);
  }
}

// stb_image 2.27 gives a chunk of a PNG file the memory that its length says, up to 2 GB, before it reads the chunk:
// such files are refused beforehand.
void CheckPngChunks(std::string_view bytes, const FileLocation& location) {
  constexpr size_t kSignature = 8, kLengthAndType = 8, kChecksum = 4;
  for (size_t i = kSignature; i + kLengthAndType <= bytes.size();) {
    size_t length = 0;
    for (size_t b = 0; b < 4; ++b) length = length << 8 | static_cast<uint8_t>(bytes[i + b]);
    // What follows the end belongs to others.
    if (bytes.substr(i + 4, 4) == "IEND") return;
    i += kLengthAndType;
    if (length > bytes.size() - i) throw Error(location, "cannot read the image: the file ends early");
    i += length + kChecksum;
  }
}

struct StbFree {
  void operator()(void* pixels) const { stbi_image_free(pixels); }
};

std::vector<std::string> ChannelNamesOf(int channels) {
  if (channels <= 2) return channels == 1 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"Y", "A"};
  return channels == 3 ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"R", "G", "B", "A"};
}

// What one of stb_image's loaders gives.
template <typename T>
struct Loaded {
  int width = 0, height = 0, channels = 0;
  std::unique_ptr<T, StbFree> values;
};

template <typename T, typename Loader>
Loaded<T> Load(std::string_view bytes, Loader loader, const FileLocation& location) {
  Source source{bytes};
  Loaded<T> loaded;
  loaded.values.reset(loader(&kCallbacks, &source, &loaded.width, &loaded.height, &loaded.channels, 0));
  if (source.endsEarly) throw Error(location, "cannot read the image: the file ends early");
  if (!loaded.values) throw Error(location, fmt::format("cannot read the image: {}", stbi_failure_reason()));
  return loaded;
}

// Integers decode through a table: each of their values once.
template <typename T>
Image DecodeIntegers(const Loaded<T>& loaded, ColorEncoding encoding) {
  constexpr size_t kMax = std::numeric_limits<T>::max();
  std::vector<float> color(kMax + 1);
  for (size_t i = 0; i <= kMax; ++i) color[i] = encoding.Decode(static_cast<float>(i) / static_cast<float>(kMax));
  Image image(loaded.width, loaded.height, ChannelNamesOf(loaded.channels));
  const std::span<float> values = image.Values();
  const auto channels = static_cast<size_t>(loaded.channels);
  const size_t alpha = channels % 2 == 0 ? channels - 1 : channels;
  for (size_t i = 0; i < values.size(); ++i) {
    const T value = loaded.values.get()[i];
    values[i] = i % channels == alpha ? static_cast<float>(value) / static_cast<float>(kMax) : color[value];
  }
  return image;
}

}  // namespace

Image ReadStb(std::string_view bytes, ColorEncoding encoding, const FileLocation& location) {
  if (bytes.starts_with('\xff')) CheckJpegTables(bytes, location);
  if (bytes.starts_with("\x89PNG")) CheckPngChunks(bytes, location);
  Source source{bytes};
  int width = 0, height = 0, channels = 0;
  if (!stbi_info_from_callbacks(&kCallbacks, &source, &width, &height, &channels))
    throw Error(location, fmt::format("cannot read the image: {}",
                                      source.endsEarly ? "the file ends early" : stbi_failure_reason()));
  CheckImageSize(width, height, location);
  if (int64_t{width} * height > MostPixels(bytes))
    throw Error(location, fmt::format("{} x {} pixels in {} bytes: the file ends early", width, height, bytes.size()));
  Source depth{bytes};
  if (stbi_is_16_bit_from_callbacks(&kCallbacks, &depth))
    return DecodeIntegers(Load<stbi_us>(bytes, stbi_load_16_from_callbacks, location), encoding);
  return DecodeIntegers(Load<stbi_uc>(bytes, stbi_load_from_callbacks, location), encoding);
}

std::string EncodePng(const Image& image, const FileLocation& location) {
  CheckImageSize(image.Width(), image.Height(), location);
  std::vector<uint8_t> codes;
  codes.reserve(static_cast<size_t>(image.Width()) * static_cast<size_t>(image.Height()) * Color::kComponents);
  for (int y = 0; y < image.Height(); ++y) {
    for (int x = 0; x < image.Width(); ++x) {
      const Color color = image.ColorAt(x, y);
      for (int c = 0; c < Color::kComponents; ++c)
        codes.push_back(static_cast<uint8_t>(std::lround(255 * EncodeSRgb(color[c]))));
    }
  }
  std::string bytes;
  const auto append = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
  };
  const int stride = image.Width() * Color::kComponents;
  if (!stbi_write_png_to_func(append, &bytes, image.Width(), image.Height(), Color::kComponents, codes.data(), stride))
    throw Error(location, "cannot encode the PNG file");
  return bytes;
}

void WritePng(const std::string& path, const Image& image) {
  WriteFileAtomically(path, EncodePng(image, FileLocation(path)));
}

}  // namespace dapple
