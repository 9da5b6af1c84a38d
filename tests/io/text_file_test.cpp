#include "src/io/text_file.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/io/reader_test_support.h"

namespace dapple {
namespace {

/// Text whose compressed and plain forms are both longer than the chunks that the reader works in.
std::string LongText() {
  std::string text;
  unsigned state = 1;
  while (text.size() < (std::size_t{5} << 20)) {
    state = state * 1664525u + 1013904223u;
    text += std::to_string(state);
    text += '\n';
  }
  return text;
}

double Parse(const std::string& text, NumberStatus expected = NumberStatus::Ok) {
  double value = -12345;
  const char* end = nullptr;
  EXPECT_EQ(ParseNumber(text.data(), text.data() + text.size(), &value, &end), expected) << text;
  if (expected == NumberStatus::Ok) {
    EXPECT_EQ(end, text.data() + text.size()) << text;
  }
  return value;
}

TEST(TextFile, ReadsPlainBytesAsTheyAre) {
  const TestFolder folder;
  const std::string bytes("a\r\n\0\xff z", 7);
  EXPECT_EQ(ReadTextFile(folder.Write("plain", bytes)), bytes);
  EXPECT_EQ(ReadTextFile(folder.Write("empty", "")), "");
}

TEST(TextFile, GzipGivesBackWhatWentIn) {
  const TestFolder folder;
  const std::string text = LongText();
  EXPECT_EQ(ReadTextFile(folder.Write("long.gz", Gzip(text))), text);
  EXPECT_EQ(ReadTextFile(folder.Write("empty.gz", Gzip(""))), "");
  EXPECT_EQ(ReadTextFile(folder.Write("two.gz", Gzip("one ") + Gzip("two"))), "one two");
  EXPECT_EQ(ReadTextFile(folder.Write("named_otherwise", Gzip("text"))), "text");
}

TEST(TextFile, DamagedGzipIsAnError) {
  const TestFolder folder;
  const std::string whole = Gzip(LongText());
  const auto cut = folder.Write("cut.gz", whole.substr(0, whole.size() / 2));
  EXPECT_EQ(MessageOf([&] { ReadTextFile(cut); }), cut.string() + ": error: the gzip data ends early");
  for (const std::size_t length : {2, 5, 9, 10, 11, 18})
    EXPECT_THROW(ReadTextFile(folder.Write("cut2.gz", whole.substr(0, length))), Error) << length;
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 0x10;
  EXPECT_THROW(ReadTextFile(folder.Write("flipped.gz", flipped)), Error);
}

TEST(TextFile, AFileMadeToFillTheMemoryIsAnError) {
  const TestFolder folder;
  const std::string zeros = Gzip(std::string(std::size_t{40} << 20, ' '));
  EXPECT_EQ(ReadTextFile(folder.Write("large.gz", zeros)).size(), std::size_t{40} << 20);
  const auto bomb = folder.Write("bomb.gz", zeros + zeros + zeros + zeros);
  EXPECT_EQ(MessageOf([&] { ReadTextFile(bomb); }),
            bomb.string() + ": error: the gzip data inflates to more than 64 MB and 100 times its size");
}

TEST(TextFile, MissingFilesAreNamedAtThePlaceThatNamesThem) {
  const FileLocation place(std::make_shared<const std::string>("scene.pbrt"), 3, 9);
  EXPECT_EQ(MessageOf([&] { ReadTextFile("/nowhere/at/all.spd", place); }),
            "scene.pbrt:3:9: error: no file \"/nowhere/at/all.spd\"");
  EXPECT_EQ(MessageOf([&] { ReadTextFile("/", place); }), "scene.pbrt:3:9: error: \"/\" is not a file");
  EXPECT_THROW(ReadTextFile(std::string(10000, 'x')), Error);
}

TEST(ParseNumber, TakesDecimalNumbers) {
  EXPECT_EQ(Parse("12"), 12);
  EXPECT_EQ(Parse("-1.5"), -1.5);
  EXPECT_EQ(Parse("+.5"), 0.5);
  EXPECT_EQ(Parse("5."), 5);
  EXPECT_EQ(Parse("1e3"), 1000);
  EXPECT_EQ(Parse("2.5E-3"), 0.0025);
  EXPECT_EQ(Parse("10000000.123456789"), 10000000.123456789);
  EXPECT_EQ(Parse("0"), 0);
}

TEST(ParseNumber, TooSmallIsZeroTooLargeIsOverflow) {
  EXPECT_EQ(Parse("1e-999"), 0);
  EXPECT_EQ(Parse("-1e-999"), 0);
  EXPECT_EQ(Parse("0." + std::string(400, '0') + "1"), 0);
  EXPECT_EQ(Parse("1e-99999999999999999999999"), 0);
  EXPECT_EQ(Parse("0e99999999"), 0);
  Parse("1e999", NumberStatus::Overflow);
  Parse("-1e999", NumberStatus::Overflow);
  Parse("1" + std::string(400, '0'), NumberStatus::Overflow);
  Parse("1e99999999999999999999999", NumberStatus::Overflow);
  // Long mantissas whose exponents bring them back into the range.
  EXPECT_NEAR(Parse("1" + std::string(400, '0') + "e-400"), 1, 1e-15);
  EXPECT_NEAR(Parse("0." + std::string(399, '0') + "1e400"), 1, 1e-15);
  EXPECT_GT(Parse("5e-324"), 0);
  EXPECT_EQ(Parse("1.7976931348623157e308"), std::numeric_limits<double>::max());
}

TEST(ParseNumber, RefusesOtherSpellings) {
  for (const char* text : {"", "+", "-", ".", "+-1", "--1", "nan", "inf", "-inf", "+nan", "-nan", "e5", "-e5", "x"})
    Parse(text, NumberStatus::Malformed);
}

TEST(Quoted, ShowsAnyBytes) {
  EXPECT_EQ(Quoted("abc"), "\"abc\"");
  EXPECT_EQ(Quoted(std::string_view("a\0\xff", 3)), "\"a\\x00\\xff\"");
  EXPECT_EQ(Quoted(std::string(100, 'a')), "\"" + std::string(40, 'a') + "...\"");
}

}  // namespace
}  // namespace dapple
