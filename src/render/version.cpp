#include "src/render/version.h"

#include <fstream>
#include <iterator>
#include <string_view>

#include "src/base/content_hash.h"
#include "src/base/error.h"

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

constexpr std::string_view kPortable = "portable";

std::string HashOfOwnFile() {
  std::ifstream file("/proc/self/exe", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (bytes.empty()) throw Error("cannot read the program's own file, /proc/self/exe, to tell which build it is");
  ContentHash hash;
  hash.AddText(bytes);
  return hash.Hex();
}

}  // namespace

std::string Version() { return DAPPLE_VERSION; }

std::string InstructionSet() {
  constexpr std::string_view kSet = DAPPLE_INSTRUCTION_SET;
  if constexpr (kSet == kPortable) return "portable (x86-64-v3)";
  return std::string(kSet) + " (" + std::string(kVectors) + ")";
}

bool IsPortable(const std::string& instructionSet) { return instructionSet.starts_with(kPortable); }

std::string BuildId() {
  static const std::string id = HashOfOwnFile();
  return id;
}

std::string ProcessorName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace dapple
