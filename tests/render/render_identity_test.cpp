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
    const std::string difference = Differences(With(name, "other"), mine);
    if (name == "scene") {
      EXPECT_EQ(difference, "the scene's content");
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

TEST(RenderIdentity, BetweenPortableBuildsTheMachineDoesNotMatter) {
  const auto onMachine = [](const std::string& set, const std::string& name) {
    RenderIdentity identity = SomeIdentity();
    for (auto& [fieldName, value] : identity.fields) {
      if (fieldName == "instruction set") value = set;
      if (fieldName == "build" || fieldName == "processor") value = name;
    }
    return identity;
  };
  const std::string portable = "portable (x86-64-v3)", native = "native (AVX2, FMA)";
  EXPECT_EQ(Differences(onMachine(portable, "a"), onMachine(portable, "b")), "");
  EXPECT_EQ(Differences(onMachine(native, "a"), onMachine(native, "b")),
            "the build of the program; processor a, not b");
  EXPECT_NE(Differences(onMachine(native, "a"), onMachine(portable, "a")), "");
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
