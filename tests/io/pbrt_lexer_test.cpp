#include "src/io/pbrt_lexer.h"

#include <gtest/gtest.h>

#include "tests/io/reader_test_support.h"

namespace dapple {
namespace {

const auto kFile = std::make_shared<const std::string>("a.pbrt");

struct Seen {
  TokenKind kind;
  std::string text;
  int line, column;
  friend bool operator==(const Seen& a, const Seen& b) = default;
};

std::vector<Seen> Tokens(std::string_view text) {
  PbrtLexer lexer(text, kFile);
  std::vector<Seen> tokens;
  for (Token token = lexer.Next(); token.kind != TokenKind::End; token = lexer.Next())
    tokens.push_back({token.kind, std::string(token.text), token.line, token.column});
  return tokens;
}

std::string ErrorOf(std::string_view text) {
  return MessageOf([&] { Tokens(text); });
}

TEST(PbrtLexer, CutsTokensWithTheirPlaces) {
  const auto tokens = Tokens("LookAt 0 -1.5\r\n  \"float fov\" [39]# comment \"[\n\t]x");
  const std::vector<Seen> expected = {
      {TokenKind::Word, "LookAt", 1, 1},      {TokenKind::Number, "0", 1, 8},       {TokenKind::Number, "-1.5", 1, 10},
      {TokenKind::String, "float fov", 2, 3}, {TokenKind::OpenBracket, "[", 2, 15}, {TokenKind::Number, "39", 2, 16},
      {TokenKind::CloseBracket, "]", 2, 18},  {TokenKind::CloseBracket, "]", 3, 2}, {TokenKind::Word, "x", 3, 3}};
  EXPECT_EQ(tokens, expected);
}

TEST(PbrtLexer, EndsAsOftenAsAsked) {
  PbrtLexer lexer(" # nothing", kFile);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(lexer.Next().kind, TokenKind::End);
  EXPECT_TRUE(Tokens("").empty());
  EXPECT_TRUE(Tokens("\xef\xbb\xbf").empty());
}

TEST(PbrtLexer, ByteOrderMarkTakesNoColumn) {
  EXPECT_EQ(Tokens("\xef\xbb\xbfScale"), (std::vector<Seen>{{TokenKind::Word, "Scale", 1, 1}}));
}

TEST(PbrtLexer, PeekChangesNothing) {
  PbrtLexer lexer("\"a\\\\b\" 2", kFile);
  EXPECT_EQ(lexer.Peek().text, "a\\b");
  EXPECT_EQ(lexer.Peek().text, "a\\b");
  EXPECT_EQ(lexer.Next().text, "a\\b");
  EXPECT_EQ(lexer.Next().number, 2);
}

TEST(PbrtLexer, ResolvesEscapes) {
  const auto tokens = Tokens(R"("\b\f\n\r\t\\\'\"" "a\"b" "" "\\")");
  ASSERT_EQ(tokens.size(), 4u);
  EXPECT_EQ(tokens[0].text, "\b\f\n\r\t\\'\"");
  EXPECT_EQ(tokens[1].text, "a\"b");
  EXPECT_EQ(tokens[2].text, "");
  EXPECT_EQ(tokens[3].text, "\\");
  EXPECT_EQ(tokens[3].column, 30);
}

TEST(PbrtLexer, NumbersAreDoubles) {
  PbrtLexer lexer("10000000.0625 +5 .25 1e-2", kFile);
  for (const double expected : {10000000.0625, 5., .25, .01}) EXPECT_EQ(lexer.Next().number, expected);
}

TEST(PbrtLexer, ReadNumbersStopsAtTheFirstOtherToken) {
  PbrtLexer lexer("1 2 # c\n 3] 4", kFile);
  std::vector<double> numbers;
  lexer.ReadNumbers(&numbers);
  EXPECT_EQ(numbers, (std::vector<double>{1, 2, 3}));
  const Token token = lexer.Next();
  EXPECT_EQ(token.kind, TokenKind::CloseBracket);
  EXPECT_EQ(token.line, 2);
  EXPECT_EQ(token.column, 3);
}

TEST(PbrtLexer, MalformedNumbersAreErrors) {
  EXPECT_EQ(ErrorOf("Scale 1 1.2.3 1"), "a.pbrt:1:9: error: expected a number, found \"1.2.3\"");
  EXPECT_EQ(ErrorOf("\n -"), "a.pbrt:2:2: error: expected a number, found \"-\"");
  EXPECT_EQ(ErrorOf("1e999"), "a.pbrt:1:1: error: the number \"1e999\" is beyond the range of double");
  EXPECT_EQ(ErrorOf("-inf"), "a.pbrt:1:1: error: expected a number, found \"-inf\"");
  EXPECT_EQ(ErrorOf("+nan"), "a.pbrt:1:1: error: expected a number, found \"+nan\"");
  EXPECT_EQ(ErrorOf("0x10"), "a.pbrt:1:1: error: expected a number, found \"0x10\"");
  EXPECT_EQ(ErrorOf("1e999x"), "a.pbrt:1:1: error: expected a number, found \"1e999x\"");
}

TEST(PbrtLexer, OpenStringsAreErrors) {
  EXPECT_EQ(ErrorOf("Include \"abc"), "a.pbrt:1:9: error: the string is not closed by \" on its line");
  EXPECT_EQ(ErrorOf("a\n \"abc\nb\""), "a.pbrt:2:2: error: the string is not closed by \" on its line");
  EXPECT_EQ(ErrorOf("\"abc\\"),
            "a.pbrt:1:5: error: unknown escape in a string, expected one of \\b \\f \\n \\r \\t \\\\ \\' \\\"");
  EXPECT_NE(ErrorOf("\"a\\qb\"").find("a.pbrt:1:3: error: unknown escape"), std::string::npos);
}

TEST(PbrtLexer, AnyBytesEndInTokensOrAnError) {
  unsigned state = 12345;
  const std::string alphabet("\"\\[]#\n\r\t .-+e0192abcZ\0\xff\x80", 25);
  for (int round = 0; round < 20000; ++round) {
    std::string text;
    state = state * 1664525u + 1013904223u;
    const unsigned length = (state >> 16) % 24;
    for (unsigned i = 0; i < length; ++i) {
      state = state * 1664525u + 1013904223u;
      text += alphabet[(state >> 16) % alphabet.size()];
    }
    PbrtLexer lexer(text, kFile);
    try {
      std::size_t count = 0;
      for (Token token = lexer.Next(); token.kind != TokenKind::End; token = lexer.Next()) {
        EXPECT_GE(token.line, 1);
        EXPECT_GE(token.column, 1);
        ASSERT_LE(++count, text.size());
      }
    } catch (const Error& error) {
      EXPECT_GE(error.Location().line, 1);
      EXPECT_GE(error.Location().column, 1);
    }
  }
}

TEST(PbrtLexer, ManyBracketsNeedNoStack) {
  const std::string brackets(std::size_t{20} << 20, '[');
  PbrtLexer lexer(brackets, kFile);
  std::size_t count = 0;
  while (lexer.Next().kind == TokenKind::OpenBracket) ++count;
  EXPECT_EQ(count, brackets.size());
}

}  // namespace
}  // namespace dapple
