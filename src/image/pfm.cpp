// Portable float map (Debevec): "PF" or "Pf", width, height, scale (negative: little endian), one white-space byte,
// then 32-bit floats, rows from the bottom. The scale's magnitude has no agreed meaning and is left out, as others do.
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "src/image/image_formats.h"

namespace dapple {

namespace {

// Takes the next white-space separated word and the one white-space byte behind it.
std::string_view NextWord(std::string_view& rest) {
  constexpr std::string_view kSpace = " \t\r\n";
  rest.remove_prefix(std::min(rest.find_first_not_of(kSpace), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(kSpace));
  rest.remove_prefix(std::min(word.size() + 1, rest.size()));
  return word;
}

float FloatAt(std::string_view bytes, size_t index, bool isBigEndian) {
  uint32_t bits = 0;
  std::memcpy(&bits, bytes.data() + index * sizeof(bits), sizeof(bits));
  return std::bit_cast<float>(isBigEndian ? __builtin_bswap32(bits) : bits);
}

double ParseNumber(std::string_view word, const FileLocation& location) {
  const std::string text(word.substr(0, 64));
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    throw Error(location, fmt::format("PFM header: expected width, height and scale, got \"{}\"", text));
  return value;
}

int64_t ParseSize(std::string_view word, const FileLocation& location) {
  const double value = ParseNumber(word, location);
  if (value != std::floor(value) || std::abs(value) > 1e9)
    throw Error(location, fmt::format("PFM header: expected whole numbers for width and height, got \"{}\"", word));
  return static_cast<int64_t>(value);
}

}  // namespace

Image ReadPfm(std::string_view bytes, const FileLocation& location) {
  std::string_view rest = bytes;
  const size_t channels = NextWord(rest) == "PF" ? 3 : 1;
  const int64_t width = ParseSize(NextWord(rest), location);
  const int64_t height = ParseSize(NextWord(rest), location);
  const double scale = ParseNumber(NextWord(rest), location);
  CheckImageSize(width, height, location);
  const size_t rowValues = static_cast<size_t>(width) * channels;
  const size_t expected = rowValues * static_cast<size_t>(height) * sizeof(float);
  if (rest.size() < expected)
    throw Error(location,
                fmt::format("the PFM file ends early: {} bytes of pixels, expected {}", rest.size(), expected));
  Image image(static_cast<int>(width), static_cast<int>(height),
              channels == 3 ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"});
  for (size_t row = 0; row < static_cast<size_t>(height); ++row) {
    const size_t first = (static_cast<size_t>(height) - 1 - row) * rowValues;
    for (size_t i = 0; i < rowValues; ++i) image.Values()[row * rowValues + i] = FloatAt(rest, first + i, scale > 0);
  }
  return image;
}

}  // namespace dapple
