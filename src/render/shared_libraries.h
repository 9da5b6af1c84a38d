// Which shared libraries the loader has given the program: a part of its arithmetic is theirs, and they change without
// it.
#pragma once

#include <string>

namespace dapple {

/// All that the program needs, and that they need in their turn, by name, with the first digits of their build id:
/// "libc.so.6 51657f81, libembree3.so.3 d29d2b57"; of one that has no build id, of a hash of its code. What is opened
/// while the program runs, or loaded before it on someone's request, is left out. "none" for a static program.
std::string SharedLibraries();

}  // namespace dapple
