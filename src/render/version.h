// Which build this is: the same version and instruction set give the same bits on processors of one kind.
#pragma once

#include <string>

namespace dapple {

/// "0.1.0"
std::string Version();

/// "portable (x86-64-v3)", or "native" with the widest vectors that this build may use: "native (AVX2)".
std::string InstructionSet();

/// True where bits are the same on all machines: the instruction set of a portable build.
bool IsPortable(const std::string& instructionSet);

/// A hash of the running program's file, 32 hexadecimal digits: another one is another build. Throws `Error` where the
/// system does not give it.
std::string BuildId();

/// The processor's name as the system tells it ("AMD EPYC 7B13"); "unknown" where it does not.
std::string ProcessorName();

}  // namespace dapple
