// Which build this is: the same version and instruction set give the same bits on processors of one kind.
#pragma once

#include <string>

namespace dapple {

/// "0.1.0"
std::string Version();

/// "portable (x86-64-v3)", or "native" with the widest vectors that this build may use: "native (AVX2)".
std::string InstructionSet();

}  // namespace dapple
