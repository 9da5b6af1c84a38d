// Cuts pbrt scene text into tokens, each with its line and column (bytes, from 1). One pass, no recursion, no copies.
//
// Any bytes may come in; what cannot be a token is an Error with its place.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/error.h"

namespace dapple {

enum class TokenKind { End, Word, String, Number, OpenBracket, CloseBracket };

struct Token {
  TokenKind kind = TokenKind::End;
  std::string_view text;  ///< Word: as written. String: without quotes, escapes resolved; good until the next token.
  double number = 0;
  int line = 0, column = 0;
};

class PbrtLexer {
 public:
  /// `text` must outlive the lexer; `fileName` stands in messages.
  PbrtLexer(std::string_view text, std::shared_ptr<const std::string> fileName);
  PbrtLexer(const PbrtLexer&) = delete;  // tokens point into it
  PbrtLexer& operator=(const PbrtLexer&) = delete;

  /// The next token; End at the end of the text, as often as asked. Throws Error on an unterminated string, an unknown
  /// escape, a malformed number or one beyond the range of double.
  Token Next();
  /// The token that `Next` will give.
  const Token& Peek();

  /// (Not between `Peek` and `Next`.) Reads numbers onto `numbers` as long as they come; what stands behind them is
  /// left for `Next`. The fast way through the large arrays of a mesh.
  void ReadNumbers(std::vector<double>* numbers);

  /// Where a token stands, for messages.
  FileLocation Location(const Token& token) const { return {fileName_, token.line, token.column}; }
  const std::shared_ptr<const std::string>& FileName() const { return fileName_; }

 private:
  Token Scan();
  void SkipBlanks();
  int Column() const;
  double ReadNumber();
  Token ReadString(Token token);
  Token ReadWord(Token token);
  [[noreturn]] void Fail(const std::string& message) const;

  const char* cursor_;
  const char* end_;
  const char* lineStart_;
  int line_ = 1;
  std::shared_ptr<const std::string> fileName_;
  std::string unescaped_;
  Token peeked_;
  bool hasPeeked_ = false;
};

}  // namespace dapple
