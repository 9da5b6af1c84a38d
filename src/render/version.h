// Which build this is, on which machine: of what the bits of a picture follow from, all that the scene and the options
// do not tell.
#pragma once

#include <string>

namespace dapple {

/// "0.1.0"
std::string Version();

/// "portable (x86-64-v3)", or "native" with the widest vectors that this build may use: "native (AVX2)".
std::string InstructionSet();

/// True where bits are the same on all machines: the instruction set of a portable build.
bool IsPortable(const std::string& instructionSet);

/// A hash of the sources that the program was built of, and of how they are compiled, 32 hexadecimal digits.
std::string SourceHash();

/// The compiler and the flags that this build was given beside the project's own: "GCC 12.2.0 -O3 -DNDEBUG".
std::string Compiler();

/// A hash of the running program's file, 32 hexadecimal digits: another one is another build. Throws `Error` where the
/// system does not give it.
std::string BuildId();

/// The processor's name as the system tells it ("AMD EPYC 7B13"); "unknown" where it does not.
std::string ProcessorName();

/// What libraries choose their arithmetic by: the vector and other extensions that the system lets programs use, in
/// alphabetic order, "avx, avx2, fma"; "unknown" where it does not tell. A virtual machine may lack some that
/// processors of the same name have.
std::string ProcessorExtensions();

}  // namespace dapple
