#include "src/io/ply_header.h"

#include <algorithm>
#include <charconv>
#include <memory>

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/io/text_file.h"

namespace dapple {

namespace {

constexpr std::size_t kMostProperties = 1000;

struct NamedScalar {
  std::string_view name;
  PlyScalar type;
};
constexpr NamedScalar kScalars[] = {
    {"char", PlyScalar::Int8},      {"int8", PlyScalar::Int8},       {"uchar", PlyScalar::Uint8},
    {"uint8", PlyScalar::Uint8},    {"short", PlyScalar::Int16},     {"int16", PlyScalar::Int16},
    {"ushort", PlyScalar::Uint16},  {"uint16", PlyScalar::Uint16},   {"int", PlyScalar::Int32},
    {"int32", PlyScalar::Int32},    {"uint", PlyScalar::Uint32},     {"uint32", PlyScalar::Uint32},
    {"float", PlyScalar::Float32},  {"float32", PlyScalar::Float32}, {"double", PlyScalar::Float64},
    {"float64", PlyScalar::Float64}};

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& fileName)
      : bytes_(bytes), fileName_(std::make_shared<const std::string>(fileName)) {}

  PlyHeader Parse() {
    if (TakeLine() != "ply") Fail("expected a PLY file, whose first line is \"ply\"");
    bool hasFormat = false;
    while (true) {
      rest_ = TakeLine();
      const std::string_view word = TakeWord();
      if (word == "end_header") break;
      if (word == "format") {
        ParseFormat();
        hasFormat = true;
      } else if (word == "element") {
        ParseElement();
      } else if (word == "property") {
        ParseProperty();
      } else if (word != "comment" && word != "obj_info" && !word.empty()) {
        Fail(fmt::format("expected format, element, property, comment or end_header, found {}", Quoted(word)));
      }
    }
    if (!hasFormat) Fail("the header has no format");
    header_.byteCount = offset_;
    header_.lineCount = line_;
    return std::move(header_);
  }

 private:
  std::string_view TakeLine() {
    ++line_;
    if (offset_ >= bytes_.size()) Fail("the file ends within its header");
    const std::size_t end = std::min(bytes_.find('\n', offset_), bytes_.size());
    std::string_view line = bytes_.substr(offset_, end - offset_);
    offset_ = std::min(end + 1, bytes_.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }

  std::string_view TakeWord() {
    const auto isBlank = [](char c) { return c == ' ' || c == '\t'; };
    while (!rest_.empty() && isBlank(rest_.front())) rest_.remove_prefix(1);
    std::size_t length = 0;
    while (length < rest_.size() && !isBlank(rest_[length])) ++length;
    const std::string_view word = rest_.substr(0, length);
    rest_.remove_prefix(length);
    return word;
  }

  void ParseFormat() {
    const std::string_view format = TakeWord(), version = TakeWord();
    if (format == "ascii")
      header_.format = PlyFormat::Ascii;
    else if (format == "binary_little_endian")
      header_.format = PlyFormat::BinaryLittleEndian;
    else if (format == "binary_big_endian")
      header_.format = PlyFormat::BinaryBigEndian;
    else
      Fail(fmt::format("unknown format {}, expected ascii, binary_little_endian or binary_big_endian", Quoted(format)));
    if (version != "1.0") Fail(fmt::format("unknown version {} of PLY, expected 1.0", Quoted(version)));
  }

  void ParseElement() {
    PlyElement element;
    element.name = TakeWord();
    const std::string_view count = TakeWord();
    const auto [end, status] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (element.name.empty() || status != std::errc() || end != count.data() + count.size())
      Fail(fmt::format("expected \"element NAME COUNT\", found the count {}", Quoted(count)));
    header_.elements.push_back(std::move(element));
  }

  void ParseProperty() {
    if (header_.elements.empty()) Fail("property before the first element");
    PlyProperty property;
    std::string_view type = TakeWord();
    property.isList = type == "list";
    if (property.isList) {
      property.countType = ParseScalar(TakeWord());
      if (IsFloat(property.countType)) Fail("the count of a list has a floating point type, expected an integer type");
      type = TakeWord();
    }
    property.type = ParseScalar(type);
    property.name = TakeWord();
    if (property.name.empty()) Fail("the property has no name");
    auto& properties = header_.elements.back().properties;
    properties.push_back(std::move(property));
    if (properties.size() > kMostProperties)
      Fail(fmt::format("an element has more than {} properties", kMostProperties));
  }

  PlyScalar ParseScalar(std::string_view name) const {
    for (const NamedScalar& scalar : kScalars)
      if (scalar.name == name) return scalar.type;
    Fail(fmt::format("unknown type {}, expected char, uchar, short, ushort, int, uint, float or double", Quoted(name)));
  }

  [[noreturn]] void Fail(const std::string& message) const { throw Error({fileName_, line_, 1}, message); }

  std::string_view bytes_, rest_;
  std::size_t offset_ = 0;
  int line_ = 0;
  std::shared_ptr<const std::string> fileName_;
  PlyHeader header_;
};

}  // namespace

std::size_t SizeOf(PlyScalar type) {
  switch (type) {
    case PlyScalar::Int8:
    case PlyScalar::Uint8:
      return 1;
    case PlyScalar::Int16:
    case PlyScalar::Uint16:
      return 2;
    case PlyScalar::Int32:
    case PlyScalar::Uint32:
    case PlyScalar::Float32:
      return 4;
    case PlyScalar::Float64:
      return 8;
  }
  return 0;
}

std::size_t PlyHeader::VertexCount() const {
  for (const PlyElement& element : elements)
    if (element.name == "vertex") return element.count;
  return 0;
}

PlyHeader ParsePlyHeader(std::string_view bytes, const std::string& fileName) {
  return HeaderParser(bytes, fileName).Parse();
}

}  // namespace dapple
