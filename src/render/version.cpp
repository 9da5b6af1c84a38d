#include "src/render/version.h"

#include <string_view>

namespace dapple {

namespace {

// What the compiler was allowed to use; other layers are compiled with the same options.
constexpr std::string_view kVectors =
#if defined(__AVX512F__)
    "AVX-512";
#elif defined(__AVX2__) && defined(__FMA__)
    "AVX2, FMA";
#elif defined(__AVX__)
    "AVX";
#elif defined(__ARM_NEON)
    "NEON";
#else
    "baseline";
#endif

}  // namespace

std::string Version() { return DAPPLE_VERSION; }

std::string InstructionSet() {
  constexpr std::string_view kSet = DAPPLE_INSTRUCTION_SET;
  if constexpr (kSet == "portable") return "portable (x86-64-v3)";
  return std::string(kSet) + " (" + std::string(kVectors) + ")";
}

}  // namespace dapple
