// Radiance pictures (Ward 1991, "Real pixels"): text header, then scanlines of RGBE, flat or run-length encoded.
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "src/image/image_formats.h"

namespace dapple {

namespace {

using Rgbe = std::array<uint8_t, 4>;

// Bytes of the file one after the other; never beyond the end.
class Reader {
 public:
  Reader(std::string_view bytes, const FileLocation& location) : rest_(bytes), location_(location) {}

  uint8_t Byte() {
    if (rest_.empty()) Fail("the file ends early");
    const auto byte = static_cast<uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return byte;
  }
  Rgbe Pixel() {
    Rgbe pixel;
    for (uint8_t& byte : pixel) byte = Byte();
    return pixel;
  }
  // The next four bytes, still there afterwards.
  Rgbe Peek() const {
    Reader copy(*this);
    return copy.Pixel();
  }
  std::string_view Line() {
    const size_t end = rest_.find('\n');
    if (end == std::string_view::npos) Fail("the header ends early");
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
  }
  size_t BytesLeft() const { return rest_.size(); }
  [[noreturn]] void Fail(std::string_view what) const {
    throw Error(location_, fmt::format("cannot read the Radiance HDR image: {}", what));
  }

 private:
  std::string_view rest_;
  const FileLocation& location_;
};

// "-Y 512 +X 1024", the order of rows and columns that nearly all files have.
Vec2i ReadSize(Reader& reader, const FileLocation& location) {
  const std::string_view line = reader.Line();
  Vec2i size;
  const auto number = [&](std::string_view key, int& value) {
    const size_t start = line.find(key);
    if (start == std::string_view::npos) return false;
    const char* first = line.data() + start + key.size();
    return std::from_chars(first, line.data() + line.size(), value).ec == std::errc();
  };
  if (!line.starts_with("-Y ") || !number("-Y ", size.y) || !number(" +X ", size.x))
    reader.Fail(fmt::format("expected \"-Y height +X width\", got \"{}\"", line.substr(0, 64)));
  CheckImageSize(size.x, size.y, location);
  return size;
}

void ReadHeader(Reader& reader) {
  bool isRgbe = true;
  for (std::string_view line = reader.Line(); !line.empty(); line = reader.Line())
    if (line.starts_with("FORMAT=")) isRgbe = line == "FORMAT=32-bit_rle_rgbe";
  if (!isRgbe) reader.Fail("expected FORMAT=32-bit_rle_rgbe");
}

// New encoding: the four components apart, each in runs (count above 128) and literal pieces.
void ReadComponentRuns(Reader& reader, std::span<Rgbe> row) {
  for (size_t component = 0; component < 4; ++component) {
    for (size_t x = 0; x < row.size();) {
      const size_t code = reader.Byte();
      const bool isRun = code > 128;
      const size_t count = isRun ? code - 128 : code;
      if (count == 0 || count > row.size() - x) reader.Fail("a run passes the end of its row");
      const uint8_t value = isRun ? reader.Byte() : uint8_t{0};
      for (size_t i = 0; i < count; ++i) row[x++][component] = isRun ? value : reader.Byte();
    }
  }
}

// Flat pixels; in the old encoding (1, 1, 1, n) repeats the last pixel, n shifted by a byte for each such code in a
// row.
void ReadPixels(Reader& reader, std::span<Rgbe> row) {
  unsigned shift = 0;
  for (size_t x = 0; x < row.size();) {
    const Rgbe pixel = reader.Pixel();
    if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1 || x == 0) {
      row[x++] = pixel;
      shift = 0;
      continue;
    }
    const size_t count = shift < 32 ? size_t{pixel[3]} << shift : row.size();
    if (count > row.size() - x) reader.Fail("a run passes the end of its row");
    for (size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
    shift += 8;
  }
}

void ReadRow(Reader& reader, std::span<Rgbe> row) {
  constexpr size_t kMinWidth = 8, kMaxWidth = 0x7fff;
  const Rgbe start = reader.Peek();
  if (row.size() < kMinWidth || row.size() > kMaxWidth || start[0] != 2 || start[1] != 2 || start[2] >= 128)
    return ReadPixels(reader, row);
  if (row.size() != (static_cast<size_t>(start[2]) << 8 | start[3])) reader.Fail("a row of another width");
  reader.Pixel();
  ReadComponentRuns(reader, row);
}

}  // namespace

Image ReadHdr(std::string_view bytes, const FileLocation& location) {
  Reader reader(bytes, location);
  ReadHeader(reader);
  const Vec2i size = ReadSize(reader, location);
  // No row takes fewer than four bytes, however it is encoded.
  if (reader.BytesLeft() < 4 * static_cast<size_t>(size.y)) reader.Fail("the file ends early");
  std::vector<float> values;
  std::vector<Rgbe> row(static_cast<size_t>(size.x));
  for (int y = 0; y < size.y; ++y) {
    ReadRow(reader, row);
    for (const Rgbe& pixel : row) {
      const float scale = pixel[3] == 0 ? 0.f : std::ldexp(1.f, pixel[3] - (128 + 8));
      for (size_t c = 0; c < 3; ++c) values.push_back(static_cast<float>(pixel[c]) * scale);
    }
  }
  return {size.x, size.y, {"R", "G", "B"}, std::move(values)};
}

}  // namespace dapple
