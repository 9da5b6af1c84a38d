// Reads the parameters of a statement: "type name" value and "type name" [ values ], as often as they come.
#pragma once

#include "src/io/parameters.h"
#include "src/io/pbrt_lexer.h"
#include "src/io/pbrt_version.h"

namespace dapple {

/// The parameters at the lexer's place, up to the first token that is no string. Throws Error on an unknown type,
/// values of the wrong kind or a count that the type cannot have; warns of a parameter that is given twice.
ParameterList ParseParameters(PbrtLexer& lexer, RgbSpace rgbSpace, PbrtVersionVotes& votes, Diagnostics& diagnostics);

/// A token for a message: 'the word "foo"', 'the end of the file'.
std::string Describe(const Token& token);

}  // namespace dapple
