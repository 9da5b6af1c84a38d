#include "src/io/text_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <zlib.h>

namespace dapple {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 20;
/// What a gzip file may become: meshes and scenes shrink to a tenth or so, a file made to fill the memory to a
/// thousandth.
constexpr std::size_t kInflatesAnyway = std::size_t{1} << 26, kMostInflation = 100;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

std::string QuotedPath(const std::filesystem::path& path) { return Quoted(path.string(), 4096); }

struct InflateStream {
  z_stream stream = {};
  InflateStream() = default;
  InflateStream(const InflateStream&) = delete;
  InflateStream& operator=(const InflateStream&) = delete;
  ~InflateStream() { inflateEnd(&stream); }
};

/// All members of a gzip file. Throws Error where the data is damaged, ends early, or inflates beyond measure.
std::string Decompress(std::string_view compressed, const FileLocation& file) {
  constexpr int kGzipOnly = 15 + 16;
  InflateStream inflater;
  z_stream& stream = inflater.stream;
  if (inflateInit2(&stream, kGzipOnly) != Z_OK) throw Error(file, "cannot start zlib");
  std::string result;
  std::size_t consumed = 0;
  const auto buffer = std::make_unique<char[]>(kChunk);
  while (true) {
    const std::size_t given = std::min<std::size_t>(compressed.size() - consumed, kChunk);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data() + consumed));  // zlib only reads
    stream.avail_in = static_cast<uInt>(given);
    stream.next_out = reinterpret_cast<Bytef*>(buffer.get());
    stream.avail_out = static_cast<uInt>(kChunk);
    const int status = inflate(&stream, Z_NO_FLUSH);
    consumed += given - stream.avail_in;
    result.append(buffer.get(), kChunk - stream.avail_out);
    if (result.size() > kInflatesAnyway + kMostInflation * compressed.size())
      throw Error(file, fmt::format("the gzip data inflates to more than {} MB and {} times its size",
                                    kInflatesAnyway >> 20, kMostInflation));
    if (status == Z_STREAM_END) {
      const bool isAnotherMember = compressed.substr(consumed).starts_with("\x1f\x8b");
      if (!isAnotherMember) return result;
      inflateReset(&stream);
    } else if (status == Z_BUF_ERROR || (status == Z_OK && consumed == compressed.size() && stream.avail_out != 0)) {
      throw Error(file, "the gzip data ends early");
    } else if (status != Z_OK) {
      throw Error(file, fmt::format("damaged gzip data ({})", stream.msg ? stream.msg : "no detail"));
    }
  }
}

/// Whether the well-formed number in [begin, end), which no double holds, is too large rather than too small: the
/// decimal exponent of its first digit that is not zero decides.
bool IsHuge(const char* begin, const char* end) {
  const char* exponentMark = std::find_if(begin, end, [](char c) { return c == 'e' || c == 'E'; });
  const char* point = std::find(begin, exponentMark, '.');
  const char* first = std::find_if(begin, exponentMark, [](char c) { return c >= '1' && c <= '9'; });
  const std::ptrdiff_t magnitude = first < point ? point - first : point - first + 1;
  bool isNegative = false;
  constexpr std::ptrdiff_t kLimit = std::ptrdiff_t{1} << 60;
  std::ptrdiff_t exponent = 0;
  for (const char* c = exponentMark; c != end; ++c) {
    if (*c == '-') isNegative = true;
    if (IsDigit(*c)) exponent = std::min<std::ptrdiff_t>(exponent * 10 + (*c - '0'), kLimit / 16);
  }
  return magnitude + (isNegative ? -exponent : exponent) > 0;
}

}  // namespace

std::string ReadTextFile(const std::filesystem::path& path, const FileLocation& namedAt) {
  std::error_code failure;
  const bool isThere = std::filesystem::exists(path, failure);
  if (!isThere) throw Error(namedAt, fmt::format("no file {}", QuotedPath(path)));
  if (!std::filesystem::is_regular_file(path, failure))
    throw Error(namedAt, fmt::format("{} is not a file", QuotedPath(path)));
  std::ifstream stream(path, std::ios::binary);
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  std::string bytes(failure ? 0 : static_cast<std::size_t>(size), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (failure || !stream) throw Error(namedAt, fmt::format("cannot read {}", QuotedPath(path)));
  return bytes.starts_with("\x1f\x8b") ? Decompress(bytes, FileLocation(path.string())) : bytes;
}

NumberStatus ParseNumber(const char* begin, const char* last, double* value, const char** end) {
  const char* cursor = begin;
  if (cursor != last && *cursor == '+') ++cursor;
  const char* unsignedBegin = cursor;
  if (cursor == begin && cursor != last && *cursor == '-') ++unsignedBegin;
  if (unsignedBegin == last || (!IsDigit(*unsignedBegin) && *unsignedBegin != '.')) return NumberStatus::Malformed;
  const auto [behind, status] = std::from_chars(cursor, last, *value);
  *end = behind;
  if (status == std::errc()) return NumberStatus::Ok;
  if (status != std::errc::result_out_of_range) return NumberStatus::Malformed;
  *value = 0;
  return IsHuge(unsignedBegin, behind) ? NumberStatus::Overflow : NumberStatus::Ok;
}

std::string Quoted(std::string_view text, std::size_t longest) {
  std::string result = "\"";
  for (const char c : text.substr(0, longest)) {
    if (c >= ' ' && c <= '~')
      result += c;
    else
      result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
  return result + (text.size() > longest ? "...\"" : "\"");
}

}  // namespace dapple
