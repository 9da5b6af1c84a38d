// Reads the parameters of a statement: "type name" value and "type name" [ values ], as often as they come.
#pragma once

#include "src/io/parameters.h"
#include "src/io/pbrt_lexer.h"
#include "src/io/pbrt_version.h"

namespace dapple {

/// The most parameters that a statement may have, or that statements which add to each other may set in all; pbrt's
/// longest lists have some thirty.
inline constexpr std::size_t kMostParameters = 256;

/// The parameters at the lexer's place, up to the first token that is no string. Throws Error on an unknown type,
/// values of the wrong kind, a count that the type cannot have, or more than `kMostParameters`; warns of a parameter
/// that is given twice.
ParameterList ParseParameters(PbrtLexer& lexer, RgbSpace rgbSpace, PbrtVersionVotes& votes, Diagnostics& diagnostics);

/// A token for a message: 'the word "foo"', 'the end of the file'.
std::string Describe(const Token& token);

}  // namespace dapple
