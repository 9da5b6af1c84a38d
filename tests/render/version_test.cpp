#include "src/render/version.h"

#include <gtest/gtest.h>

namespace dapple {
namespace {

TEST(Version, SourcesAreAHash) {
  EXPECT_EQ(SourceHash().size(), 32u);
  EXPECT_EQ(SourceHash().find_first_not_of("0123456789abcdef"), std::string::npos) << SourceHash();
}

TEST(Version, TheCompilerIsTheOneThatMadeThis) {
  EXPECT_NE(Compiler().find(__VERSION__), std::string::npos) << Compiler();
}

#if defined(__x86_64__)
// As the processor itself tells; the system may hold some back.
TEST(Version, ExtensionsAreThoseThatTheProcessorHas) {
  const std::string extensions = ", " + ProcessorExtensions() + ",";
  const auto has = [&](const std::string& name) { return extensions.find(", " + name + ",") != std::string::npos; };
  EXPECT_TRUE(has("sse2")) << extensions;
  EXPECT_LE(has("avx"), __builtin_cpu_supports("avx") != 0) << extensions;
  EXPECT_LE(has("avx2"), __builtin_cpu_supports("avx2") != 0) << extensions;
  EXPECT_LE(has("fma"), __builtin_cpu_supports("fma") != 0) << extensions;
  EXPECT_LE(has("avx512f"), __builtin_cpu_supports("avx512f") != 0) << extensions;
  EXPECT_LE(has("avx512bw"), __builtin_cpu_supports("avx512bw") != 0) << extensions;
  EXPECT_FALSE(has("fpu") || has("nx") || has("hypervisor")) << extensions;
}
#endif

}  // namespace
}  // namespace dapple
