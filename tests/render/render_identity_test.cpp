#include "src/render/render_identity.h"

#include <gtest/gtest.h>

#include "src/render/version.h"

namespace dapple {
namespace {

RenderIdentity SomeIdentity() {
  return MakeIdentity({"abc", "none"}, Film({4, 3}, {{0, 0}, {4, 3}}, Filter::Box()), {}, "path", {}, 7);
}

RenderIdentity With(const std::string& name, const std::string& value) {
  RenderIdentity identity = SomeIdentity();
  for (auto& [fieldName, fieldValue] : identity.fields)
    if (fieldName == name) fieldValue = value;
  return identity;
}

TEST(RenderIdentity, NamesEachFieldThatDiffers) {
  const RenderIdentity mine = SomeIdentity();
  EXPECT_EQ(Differences(mine, mine), "");
  for (const auto& [name, value] : mine.fields) {
    ASSERT_FALSE(value.empty()) << name;
    if (name == "shared libraries" || name == "processor extensions") continue;  // told by their items: see below
    const std::string difference = Differences(With(name, "other"), mine);
    if (name == "scene") {
      EXPECT_EQ(difference, "the scene's content");
    } else if (name == "sources") {
      EXPECT_EQ(difference, "the sources that the program was built of");
    } else if (name == "build") {
      EXPECT_EQ(difference, "the build of the program");
    } else {
      EXPECT_EQ(difference, name + " other, not " + value);
    }
  }
  EXPECT_EQ(Differences(With("version", "9"), With("seed", "8")), "seed 7, not 8; version 9, not " + Version());
}

TEST(RenderIdentity, AFieldThatOneOfTwoLacksIsADifference) {
  const RenderIdentity mine = SomeIdentity();
  RenderIdentity more = mine;
  more.fields.emplace_back("new-option", "on");
  EXPECT_EQ(Differences(more, mine), "new-option on, not told");
  EXPECT_EQ(Differences(mine, more), "new-option untold, not on");
}

TEST(RenderIdentity, NamesTheLibrariesThatDiffer) {
  const auto difference = [](const std::string& other, const std::string& expected) {
    return Differences(With("shared libraries", other), With("shared libraries", expected));
  };
  const std::string libraries = "libc.so.6 aa, libm.so.6 bb, libz.so.1 cc";
  EXPECT_EQ(difference(libraries, libraries), "");
  EXPECT_EQ(difference("libc.so.6 aa, libm.so.6 b0, libz.so.1 cc", libraries),
            "the installed shared libraries libm.so.6");
  EXPECT_EQ(difference("libc.so.6 aa, libm.so.6 bb, libz.so.1 c", libraries),
            "the installed shared libraries libz.so.1");
  EXPECT_EQ(difference("libc.so.6 aa, libm.so.7 bb", libraries),
            "the installed shared libraries libm.so.6, libm.so.7, libz.so.1");
}

// Processors of one name whose hypervisors let other instructions through.
TEST(RenderIdentity, NamesTheExtensionsThatDiffer) {
  const auto difference = [](const std::string& other, const std::string& expected) {
    RenderIdentity native = With("processor extensions", other), wanted = With("processor extensions", expected);
    for (RenderIdentity* identity : {&native, &wanted})
      for (auto& [name, value] : identity->fields)
        if (name == "instruction set") value = "native (AVX2, FMA)";
    return Differences(native, wanted);
  };
  EXPECT_EQ(difference("avx, avx2", "avx, avx2"), "");
  EXPECT_EQ(difference("avx, avx2", "avx, avx2, avx512bw, avx512f"), "a processor without avx512bw, avx512f");
  EXPECT_EQ(difference("avx, avx2, avx512f", "avx, avx2"), "a processor with avx512f");
  EXPECT_EQ(difference("avx, fma4", "avx, fma"), "a processor with fma4 and without fma");
}

RenderIdentity OfSet(const std::string& instructionSet, const std::string& name, const std::string& value) {
  RenderIdentity identity = With("instruction set", instructionSet);
  for (auto& [fieldName, fieldValue] : identity.fields)
    if (fieldName == name) fieldValue = value;
  return identity;
}

constexpr const char* kPortable = "portable (x86-64-v3)";
constexpr const char* kNative = "native (AVX2, FMA)";

TEST(RenderIdentity, BetweenPortableBuildsTheMachineDoesNotMatter) {
  for (const std::string name : {"build", "processor", "processor extensions"}) {
    EXPECT_EQ(Differences(OfSet(kPortable, name, "a"), OfSet(kPortable, name, "b")), "") << name;
    EXPECT_NE(Differences(OfSet(kNative, name, "a"), OfSet(kNative, name, "b")), "") << name;
  }
  EXPECT_NE(Differences(With("instruction set", kNative), With("instruction set", kPortable)), "");
}

TEST(RenderIdentity, BetweenPortableBuildsWhatTheyAreMadeOfMatters) {
  for (const std::string name : {"sources", "compiler", "shared libraries", "version"})
    EXPECT_NE(Differences(OfSet(kPortable, name, "a 1"), OfSet(kPortable, name, "b 2")), "") << name;
}

TEST(RenderIdentity, HoldsEveryOption) {
  const IntegratorOptions defaults;
  std::vector<IntegratorOptions> changed(8);
  changed[0].maxDepth = 3;
  changed[1].photonsPerPass = 10;
  changed[2].radius = 0.5;
  changed[3].radiusScale = 2;
  changed[4].guideEmission = false;
  changed[5].direct.technique = DirectTechnique::Light;
  changed[6].direct.lightSamples = 4;
  changed[7].kernel = KernelShape::Cone;
  for (size_t i = 0; i < changed.size(); ++i)
    for (size_t j = 0; j < i; ++j) EXPECT_NE(DescribeOptions(changed[i]), DescribeOptions(changed[j])) << i << ' ' << j;
  for (const IntegratorOptions& options : changed) EXPECT_NE(DescribeOptions(options), DescribeOptions(defaults));
}

}  // namespace
}  // namespace dapple
