// What every fuzz target asks of its reader: whatever the bytes, either the thing that was read, or a dapple::Error
// that names the input. Any other exception, a crash, a hang or a large allocation ends the target, and libFuzzer keeps
// the input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "src/base/error.h"

namespace dapple {

/// The name by which readers know the input.
inline constexpr const char* kFuzzInput = "input";

/// Ends the target where a promise of the reader does not hold.
inline void Require(bool holds, const char* promise) {
  if (holds) return;
  std::fprintf(stderr, "not so: %s\n", promise);
  std::abort();
}

/// Calls `read(bytes)`.
template <typename Read>
int Fuzz(const uint8_t* data, size_t size, Read read) {
  try {
    read(std::string_view(reinterpret_cast<const char*>(data), size));
  } catch (const Error& error) {
    if (!error.Location().file) std::fprintf(stderr, "%s\n", error.what());
    Require(error.Location().file != nullptr, "an error has a place");
  }
  return 0;
}

/// Receives warnings and forgets them.
inline Diagnostics NoDiagnostics() {
  return Diagnostics([](const std::string&) {});
}

}  // namespace dapple
