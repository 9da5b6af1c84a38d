#include "src/io/pbrt_lexer.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "src/io/text_file.h"

namespace dapple {

namespace {

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

bool EndsWord(char c) { return IsBlank(c) || c == '"' || c == '[' || c == ']' || c == '#'; }

bool StartsNumber(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '+'; }

/// What `\c` stands for; 0: nothing.
char Unescape(char c) {
  switch (c) {
    case 'b':
      return '\b';
    case 'f':
      return '\f';
    case 'n':
      return '\n';
    case 'r':
      return '\r';
    case 't':
      return '\t';
    case '\\':
    case '\'':
    case '"':
      return c;
    default:
      return 0;
  }
}

}  // namespace

PbrtLexer::PbrtLexer(std::string_view text, std::shared_ptr<const std::string> fileName)
    : cursor_(text.data()), end_(text.data() + text.size()), fileName_(std::move(fileName)) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) cursor_ += kByteOrderMark.size();
  lineStart_ = cursor_;
}

Token PbrtLexer::Next() {
  if (!hasPeeked_) return Scan();
  hasPeeked_ = false;
  return peeked_;
}

const Token& PbrtLexer::Peek() {
  if (!hasPeeked_) peeked_ = Scan();
  hasPeeked_ = true;
  return peeked_;
}

Token PbrtLexer::Scan() {
  SkipBlanks();
  Token token;
  token.line = line_;
  token.column = Column();
  if (cursor_ == end_) return token;
  token.text = {cursor_, 1};
  if (*cursor_ == '"') return ReadString(token);
  if (*cursor_ == '[' || *cursor_ == ']') {
    token.kind = *cursor_ == '[' ? TokenKind::OpenBracket : TokenKind::CloseBracket;
    ++cursor_;
    return token;
  }
  if (!StartsNumber(*cursor_)) return ReadWord(token);
  const char* const begin = cursor_;
  token.kind = TokenKind::Number;
  token.number = ReadNumber();
  token.text = {begin, static_cast<std::size_t>(cursor_ - begin)};
  return token;
}

void PbrtLexer::ReadNumbers(std::vector<double>* numbers) {
  SkipBlanks();
  while (cursor_ != end_ && StartsNumber(*cursor_)) {
    numbers->push_back(ReadNumber());
    SkipBlanks();
  }
}

void PbrtLexer::SkipBlanks() {
  for (; cursor_ != end_; ++cursor_) {
    if (*cursor_ == '#') cursor_ = std::find(cursor_, end_, '\n');
    if (cursor_ == end_ || !IsBlank(*cursor_)) return;
    if (*cursor_ != '\n') continue;
    ++line_;
    lineStart_ = cursor_ + 1;
  }
}

int PbrtLexer::Column() const {
  constexpr std::ptrdiff_t kLargest = std::numeric_limits<int>::max();
  return static_cast<int>(std::min(cursor_ - lineStart_ + 1, kLargest));
}

double PbrtLexer::ReadNumber() {
  double value = 0;
  const char* behind = cursor_;
  const NumberStatus status = ParseNumber(cursor_, end_, &value, &behind);
  if (status == NumberStatus::Ok && (behind == end_ || EndsWord(*behind))) {
    cursor_ = behind;
    return value;
  }
  const char* const wordEnd = std::find_if(cursor_, end_, EndsWord);
  const std::string word = Quoted({cursor_, static_cast<std::size_t>(wordEnd - cursor_)});
  if (status == NumberStatus::Overflow && behind == wordEnd)
    Fail(fmt::format("the number {} is beyond the range of double", word));
  Fail(fmt::format("expected a number, found {}", word));
}

Token PbrtLexer::ReadString(Token token) {
  token.kind = TokenKind::String;
  const char* const begin = cursor_ + 1;
  const char* cursor = begin;
  const auto isSpecial = [](char c) { return c == '"' || c == '\\' || c == '\n'; };
  cursor = std::find_if(cursor, end_, isSpecial);
  token.text = {begin, static_cast<std::size_t>(cursor - begin)};
  if (cursor != end_ && *cursor == '\\') {
    unescaped_ = token.text;
    while (cursor != end_ && *cursor == '\\') {
      const char c = cursor + 1 != end_ ? Unescape(cursor[1]) : '\0';
      if (c == 0) {
        cursor_ = cursor;
        Fail("unknown escape in a string, expected one of \\b \\f \\n \\r \\t \\\\ \\' \\\"");
      }
      unescaped_ += c;
      const char* const next = std::find_if(cursor + 2, end_, isSpecial);
      unescaped_.append(cursor + 2, next);
      cursor = next;
    }
    token.text = unescaped_;
  }
  if (cursor == end_ || *cursor == '\n') Fail("the string is not closed by \" on its line");
  cursor_ = cursor + 1;
  return token;
}

Token PbrtLexer::ReadWord(Token token) {
  token.kind = TokenKind::Word;
  const char* const begin = cursor_;
  cursor_ = std::find_if(begin, end_, EndsWord);
  token.text = {begin, static_cast<std::size_t>(cursor_ - begin)};
  return token;
}

void PbrtLexer::Fail(const std::string& message) const { throw Error({fileName_, line_, Column()}, message); }

}  // namespace dapple
