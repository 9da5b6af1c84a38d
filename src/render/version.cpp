#include "src/render/version.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

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

#if defined(__clang__)
constexpr std::string_view kCompiler = __VERSION__;
#else
constexpr std::string_view kCompiler = "GCC " __VERSION__;
#endif

/// Beginnings of the names of extensions by which Embree, the C library and others choose among versions of a function.
/// What a newer kernel tells beside them (of caches, of its own mitigations) is no difference.
constexpr std::array<std::string_view, 14> kExtensions = {"abm",   "amx", "asimd",  "avx", "bmi",  "f16c", "fma",
                                                          "lzcnt", "pni", "popcnt", "sse", "ssse", "sve",  "xop"};

/// The value of the first line of /proc/cpuinfo that begins with `name`; "" where there is none.
std::string OfFirstProcessor(std::string_view name) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const size_t colon = line.find(": ");
    if (line.starts_with(name) && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "";
}

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

std::string Compiler() {
  constexpr std::string_view kFlags = DAPPLE_COMPILER_FLAGS;
  return std::string(kCompiler) + (kFlags.empty() ? "" : " ") + std::string(kFlags);
}

std::string ProcessorName() {
  const std::string name = OfFirstProcessor("model name");
  return name.empty() ? "unknown" : name;
}

std::string ProcessorExtensions() {
  const std::string flags = OfFirstProcessor("flags");
  std::istringstream words(flags.empty() ? OfFirstProcessor("Features") : flags);
  std::set<std::string> extensions;
  for (std::string word; words >> word;)
    if (std::ranges::any_of(kExtensions, [&](std::string_view name) { return word.starts_with(name); }))
      extensions.insert(word);
  return extensions.empty() ? "unknown" : fmt::format("{}", fmt::join(extensions, ", "));
}

}  // namespace dapple
