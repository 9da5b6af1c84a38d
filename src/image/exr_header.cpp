#include "src/image/exr_header.h"

#include <cstdint>
#include <cstring>

#include <fmt/format.h>

namespace dapple {

namespace {

struct FixedSize {
  std::string_view type;
  size_t bytes;
};
// What OpenEXR 3.1 reads of attributes of these types.
constexpr FixedSize kFixedSizes[] = {{"box2f", 16},
                                     {"box2i", 16},
                                     {"chromaticities", 32},
                                     {"compression", 1},
                                     {"deepImageState", 1},
                                     {"double", 8},
                                     {"envmap", 1},
                                     {"float", 4},
                                     {"int", 4},
                                     {"keycode", 28},
                                     {"lineOrder", 1},
                                     {"m33d", 72},
                                     {"m33f", 36},
                                     {"m44d", 128},
                                     {"m44f", 64},
                                     {"rational", 8},
                                     {"tiledesc", 9},
                                     {"timecode", 8},
                                     {"v2d", 16},
                                     {"v2f", 8},
                                     {"v2i", 8},
                                     {"v3d", 24},
                                     {"v3f", 12},
                                     {"v3i", 12}};

// Little-endian bytes, one after the other. What is beyond the end is zero, and `isBeyond` says so.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : rest_(bytes) {}

  std::string_view Take(size_t count) {
    isBeyond_ |= count > rest_.size();
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(taken.size());
    return taken;
  }
  std::string_view Text() {
    const std::string_view text = Take(std::min(rest_.find('\0'), rest_.size()));
    Take(1);
    return text;
  }
  uint32_t Number() {
    uint32_t number = 0;
    const std::string_view raw = Take(sizeof(number));
    std::memcpy(&number, raw.data(), raw.size());
    return number;
  }
  size_t Left() const { return rest_.size(); }
  bool IsBeyond() const { return isBeyond_; }
  bool IsExactlyRead() const { return rest_.empty() && !isBeyond_; }
  bool StartsWithZero() const { return rest_.starts_with('\0'); }

 private:
  std::string_view rest_;
  bool isBeyond_ = false;
};

/// Names, each with 16 bytes of its channel, up to an empty one.
bool IsChannelList(Bytes value) {
  constexpr size_t kChannelBytes = 16;
  while (!value.Text().empty()) value.Take(kChannelBytes);
  return value.IsExactlyRead();
}

bool IsListOfStrings(Bytes value) {
  while (value.Left() > 0) value.Take(value.Number());
  return value.IsExactlyRead();
}

/// Width, height and so many pixels of four bytes.
bool IsPreview(Bytes value) {
  const uint64_t width = value.Number(), height = value.Number();
  return !value.IsBeyond() && value.Left() % 4 == 0 && width * height == value.Left() / 4;
}

/// Whether the library reads no more and no less of `value` than all of it.
bool HasItsSize(std::string_view type, std::string_view value) {
  for (const FixedSize& fixed : kFixedSizes)
    if (fixed.type == type) return value.size() == fixed.bytes;
  if (type == "chlist") return IsChannelList(Bytes(value));
  if (type == "stringvector") return IsListOfStrings(Bytes(value));
  if (type == "preview") return IsPreview(Bytes(value));
  if (type == "floatvector") return value.size() % sizeof(float) == 0;
  return true;  // read as it is
}

}  // namespace

void CheckExrHeader(std::string_view bytes, const FileLocation& location) {
  constexpr unsigned kSeveralParts = 0x1000;
  Bytes rest(bytes);
  rest.Number();  // the mark of the format
  const bool hasParts = rest.Number() & kSeveralParts;
  // An empty name ends a header, and an empty header the headers of several parts. Where the file ends too early the
  // library says so.
  for (bool isFirst = true; !rest.IsBeyond(); isFirst = false) {
    const std::string_view name = rest.Text();
    if (name.empty() && (!hasParts || isFirst || rest.StartsWithZero())) return;
    if (name.empty()) continue;
    const std::string_view type = rest.Text();
    const size_t size = rest.Number();
    const std::string_view value = rest.Take(size);
    if (value.size() != size || !HasItsSize(type, value))
      throw Error(location, fmt::format("cannot read the EXR file: attribute \"{}\" does not take the {} bytes that it "
                                        "claims",
                                        name.substr(0, 64), size));
  }
}

}  // namespace dapple
