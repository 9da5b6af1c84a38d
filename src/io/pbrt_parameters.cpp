#include "src/io/pbrt_parameters.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "src/io/nearest_name.h"
#include "src/io/text_file.h"

namespace dapple {

namespace {

struct SpelledType {
  std::string_view spelling;
  ParameterType type;
};

constexpr SpelledType kSpelledTypes[] = {{"integer", ParameterType::Integer},
                                         {"float", ParameterType::Float},
                                         {"bool", ParameterType::Bool},
                                         {"string", ParameterType::String},
                                         {"point2", ParameterType::Point2},
                                         {"vector2", ParameterType::Vector2},
                                         {"point3", ParameterType::Point3},
                                         {"point", ParameterType::Point3},
                                         {"vector3", ParameterType::Vector3},
                                         {"vector", ParameterType::Vector3},
                                         {"normal", ParameterType::Normal},
                                         {"normal3", ParameterType::Normal},
                                         {"rgb", ParameterType::Rgb},
                                         {"color", ParameterType::Rgb},
                                         {"xyz", ParameterType::Xyz},
                                         {"spectrum", ParameterType::Spectrum},
                                         {"blackbody", ParameterType::Blackbody},
                                         {"texture", ParameterType::Texture}};

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

std::string_view TakeWord(std::string_view& text) {
  while (!text.empty() && IsBlank(text.front())) text.remove_prefix(1);
  std::size_t length = 0;
  while (length < text.size() && !IsBlank(text[length])) ++length;
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length);
  return word;
}

ParameterType FindType(std::string_view spelling, const FileLocation& location) {
  std::vector<std::string> known;
  std::string list;
  for (const SpelledType& spelled : kSpelledTypes) {
    if (spelled.spelling == spelling) return spelled.type;
    known.emplace_back(spelled.spelling);
    list += (list.empty() ? "" : ", ") + known.back();
  }
  throw Error(location, fmt::format("unknown parameter type {}{}; known are {}", Quoted(spelling),
                                    DidYouMean(spelling, known), list));
}

/// Type, name and place from "type name".
Parameter ParseDeclaration(const Token& token, const FileLocation& location, PbrtVersionVotes& votes) {
  std::string_view rest = token.text;
  const std::string_view type = TakeWord(rest);
  const std::string_view name = TakeWord(rest);
  if (name.empty() || !TakeWord(rest).empty())
    throw Error(location, fmt::format("expected a parameter \"type name\", found {}", Quoted(token.text)));
  Parameter parameter;
  parameter.type = FindType(type, location);
  parameter.name = name;
  parameter.location = location;
  votes.Saw(WordKind::ParameterType, type, location);
  return parameter;
}

/// What values a type takes, for messages.
std::string_view ExpectedValues(ParameterType type) {
  switch (type) {
    case ParameterType::String:
    case ParameterType::Texture:
      return "strings";
    case ParameterType::Bool:
      return "true or false";
    case ParameterType::Spectrum:
      return "numbers or strings";
    default:
      return "numbers";
  }
}

class ValueReader {
 public:
  ValueReader(PbrtLexer& lexer, Parameter& parameter, PbrtVersionVotes& votes)
      : lexer_(lexer), parameter_(parameter), votes_(votes) {}

  void Read() {
    const Token first = lexer_.Next();
    if (first.kind != TokenKind::OpenBracket) {
      AddValue(first);
      return;
    }
    const FileLocation open = lexer_.Location(first);
    while (true) {
      ReadNumbers();
      const Token token = lexer_.Next();
      if (token.kind == TokenKind::CloseBracket) return;
      if (token.kind == TokenKind::End) throw Error(open, "the \"[\" is not closed");
      AddValue(token);
    }
  }

 private:
  bool TakesNumbers() const {
    const bool isOther = parameter_.type == ParameterType::String || parameter_.type == ParameterType::Texture ||
                         parameter_.type == ParameterType::Bool;
    return !isOther && parameter_.strings.empty();
  }

  bool TakesStrings() const {
    const bool isStrings = parameter_.type == ParameterType::String || parameter_.type == ParameterType::Texture;
    return isStrings || (parameter_.type == ParameterType::Spectrum && parameter_.numbers.empty());
  }

  void ReadNumbers() {
    if (TakesNumbers()) lexer_.ReadNumbers(&parameter_.numbers);
  }

  void AddValue(const Token& token) {
    if (token.kind == TokenKind::Number && TakesNumbers())
      parameter_.numbers.push_back(token.number);
    else if (token.kind == TokenKind::String && TakesStrings())
      parameter_.strings.emplace_back(token.text);
    else if (parameter_.type == ParameterType::Bool && (token.text == "true" || token.text == "false"))
      AddBool(token);
    else
      throw Error(lexer_.Location(token),
                  fmt::format("parameter \"{}\" of type \"{}\" takes {}, found {}", parameter_.name,
                              TypeName(parameter_.type), ExpectedValues(parameter_.type), Describe(token)));
  }

  void AddBool(const Token& token) {
    votes_.Saw(WordKind::BoolSpelling, token.kind == TokenKind::String ? "quoted" : "bare", lexer_.Location(token));
    parameter_.integers.push_back(token.text == "true" ? 1 : 0);
  }

  PbrtLexer& lexer_;
  Parameter& parameter_;
  PbrtVersionVotes& votes_;
};

void ConvertIntegers(Parameter& parameter) {
  parameter.integers.reserve(parameter.numbers.size());
  for (const double number : parameter.numbers) {
    const bool fits = number >= std::numeric_limits<int>::min() && number <= std::numeric_limits<int>::max() &&
                      std::floor(number) == number;
    if (!fits)
      throw Error(parameter.location, fmt::format("value {} of parameter \"{}\" is {}, expected a 32-bit integer",
                                                  parameter.integers.size() + 1, parameter.name, number));
    parameter.integers.push_back(static_cast<int>(number));
  }
  parameter.numbers = {};
}

void CheckCounts(const Parameter& parameter) {
  if (parameter.numbers.empty() && parameter.integers.empty() && parameter.strings.empty())
    throw Error(parameter.location, fmt::format("parameter \"{}\" has no values", parameter.name));
  const std::size_t components = static_cast<std::size_t>(std::max(1, ComponentCount(parameter.type)));
  if (parameter.numbers.size() % components != 0)
    throw Error(parameter.location,
                fmt::format("parameter \"{}\" of type \"{}\" has {} number{}, expected a multiple of {}",
                            parameter.name, TypeName(parameter.type), parameter.numbers.size(),
                            parameter.numbers.size() == 1 ? "" : "s", components));
  if (parameter.type == ParameterType::Texture && parameter.strings.size() > 1)
    throw Error(parameter.location,
                fmt::format("parameter \"{}\" has {} textures, expected 1", parameter.name, parameter.strings.size()));
}

}  // namespace

ParameterList ParseParameters(PbrtLexer& lexer, RgbSpace rgbSpace, PbrtVersionVotes& votes, Diagnostics& diagnostics) {
  ParameterList parameters;
  while (lexer.Peek().kind == TokenKind::String) {
    const Token declaration = lexer.Next();
    Parameter parameter = ParseDeclaration(declaration, lexer.Location(declaration), votes);
    parameter.rgbSpace = rgbSpace;
    ValueReader(lexer, parameter, votes).Read();
    if (parameter.type == ParameterType::Integer) ConvertIntegers(parameter);
    CheckCounts(parameter);
    if (parameter.type == ParameterType::Blackbody)
      votes.Saw(WordKind::BlackbodyForm, parameter.numbers.size() == 1 ? "plain" : "scaled", parameter.location);
    const FileLocation location = parameter.location;
    const std::string name = parameter.name;
    const std::size_t countBefore = parameters.All().size();
    parameters.Add(std::move(parameter));
    if (parameters.All().size() == countBefore)
      diagnostics.Warn(location, fmt::format("parameter \"{}\" is given twice; the last one counts", name));
    if (parameters.All().size() > kMostParameters)
      throw Error(location, fmt::format("more than {} parameters in one statement", kMostParameters));
  }
  return parameters;
}

std::string Describe(const Token& token) {
  switch (token.kind) {
    case TokenKind::End:
      return "the end of the file";
    case TokenKind::Word:
      return Quoted(token.text);
    case TokenKind::String:
      return fmt::format("the string {}", Quoted(token.text));
    case TokenKind::Number:
      return fmt::format("the number {}", Quoted(token.text));
    case TokenKind::OpenBracket:
      return "\"[\"";
    case TokenKind::CloseBracket:
      return "\"]\"";
  }
  return "";
}

}  // namespace dapple
