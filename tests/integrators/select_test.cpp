// Which algorithm "auto" picks, on small scenes of each kind, and why; and that the choice is the same wherever a scene
// lies, however large and bright it is, and for any seed.
#include "integrators/select.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "integrators/rare_light.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

using testing_support::SceneFromText;

const std::string kFloor =
    "Material \"matte\" \"rgb Kd\" [.5 .5 .5] Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
    "\"point P\" [-3 -3 -1  3 -3 -1  3 3 -1  -3 3 -1] ";
const std::string kBall = "Shape \"sphere\" \"float radius\" [0.7] ";
const std::string kPoint = "LightSource \"point\" \"point from\" [1 1 4] \"rgb I\" [20 20 20] ";
const std::string kSky = "LightSource \"infinite\" \"rgb L\" [1 1 1] ";

/// An area light above: a ball of that radius, as bright as the point light.
std::string Lamp(double radius) {
  return fmt::format(
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [{0} {0} {0}] Material \"matte\" \"rgb Kd\" [0 0 0] "
      "Translate 1 1 4 Shape \"sphere\" \"float radius\" [{1}] AttributeEnd ",
      20 / (3.14159 * radius * radius), radius);
}

/// Of that roughness (GGX alpha).
std::string RoughMetal(double alpha) {
  return fmt::format("Material \"metal\" \"float roughness\" [{}] \"bool remaproughness\" \"false\" ", alpha);
}
std::string RoughGlass(double alpha) {
  return fmt::format(
      "Material \"glass\" \"float uroughness\" [{0}] \"float vroughness\" [{0}] \"bool remaproughness\" \"false\" ",
      alpha);
}

/// `world`, seen by a camera, all of it times `scale` and then moved.
std::unique_ptr<Scene> SceneOf(const std::string& world, double scale = 1, double moved = 0) {
  return SceneFromText(
      fmt::format("LookAt {0} {1} {2}  {0} {0} {0}  0 0 1 ", moved, moved - 5 * scale, moved + 4 * scale) +
      "Camera \"perspective\" \"float fov\" [45] "
      "Film \"image\" \"integer xresolution\" [64] \"integer yresolution\" [64] WorldBegin " +
      fmt::format("Translate {0} {0} {0} Scale {1} {1} {1} ", moved, scale) + world + "WorldEnd");
}

IntegratorChoice Choose(const std::string& world, const IntegratorOptions& options = {}, uint64_t seed = 1) {
  return SelectIntegrator(*SceneOf(world), options, seed);
}

void ExpectChoice(const IntegratorChoice& choice, const std::string& name, const std::string& why) {
  EXPECT_EQ(choice.name, name) << choice.reason;
  EXPECT_NE(choice.reason.find(why), std::string::npos) << choice.reason;
}

TEST(SelectIntegrator, PathsWhereTheFactsSayThatTheyFindAll) {
  ExpectChoice(Choose("LightSource \"point\" \"rgb I\" [0 0 0] " + kFloor), "path", "nothing emits light");
  ExpectChoice(Choose(kPoint + "Material \"mirror\" " + kBall), "path", "no surface could receive photons");
  ExpectChoice(Choose(kPoint + kFloor + kBall), "path", "no mirror, glass or polished surface");
  ExpectChoice(Choose(kPoint + kFloor + RoughMetal(0.4) + kBall), "path", "no mirror, glass or polished surface");
  ExpectChoice(Choose(kSky + kFloor + RoughMetal(0.05) + kBall), "path", "only large lights");
  IntegratorOptions direct;
  direct.maxDepth = 1;
  ExpectChoice(Choose(kPoint + kFloor + "Material \"glass\" " + kBall, direct), "path", "direct light alone");
}

TEST(SelectIntegrator, PhotonsForCausticsOfSmallLights) {
  for (const std::string material : {"Material \"glass\" ", "Material \"mirror\" "})
    for (const std::string& light : {kPoint, Lamp(0.05)})
      ExpectChoice(Choose(light + kFloor + material + kBall), "hybrid", "of the light seen comes in ways that paths");
}

TEST(SelectIntegrator, PhotonsForNearlySmoothSurfacesToo) {
  ExpectChoice(Choose(Lamp(0.05) + kFloor + RoughGlass(0.01) + kBall), "hybrid", "of the light seen");
  EXPECT_EQ(Choose(Lamp(0.05) + kFloor + RoughGlass(0.5) + kBall).name, "path");
}

TEST(SelectIntegrator, PhotonsForLightThatNoPathFinds) {
  // What the ball throws on the floor is little under the sky, and no path that ends at the point finds it.
  const std::string dim = "LightSource \"point\" \"point from\" [1 1 4] \"rgb I\" [2 2 2] ";
  const std::string ball = "Material \"glass\" Shape \"sphere\" \"float radius\" [0.2] ";
  ExpectChoice(Choose(kSky + dim + kFloor + ball), "hybrid", "of the light seen comes in ways that no path finds");
  ExpectChoice(Choose(kSky + kFloor + ball), "path", "");
}

TEST(SelectIntegrator, ASmallLampThatFacesAwayIsSmall) {
  // One-sided, so that nothing of it shines on the middle of the scene: only a pilot can tell.
  const std::string up =
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [900 900 900] Material \"matte\" \"rgb Kd\" [0 0 0] "
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [1 1 2  1.1 1 2  1 1.1 2] AttributeEnd ";
  const std::string ceiling =
      "Material \"matte\" \"rgb Kd\" [.5 .5 .5] Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
      "\"point P\" [-3 -3 5  3 -3 5  3 3 5  -3 3 5] ";
  const auto scene = SceneOf(up + kFloor + ceiling + RoughMetal(0.05) + kBall);
  EXPECT_EQ(scene->Facts().largestLightShare, 0);
  EXPECT_EQ(scene->Facts().smallestLightShare, 0);
  EXPECT_EQ(SelectIntegrator(*scene, {}, 1).reason.find("only large lights"), std::string::npos);
}

TEST(SelectIntegrator, PathsForLargeLights) {
  EXPECT_EQ(Choose(kSky + kFloor + "Material \"glass\" " + kBall).name, "path");
  EXPECT_EQ(Choose(Lamp(2.5) + kFloor + "Material \"glass\" " + kBall).name, "path");
}

TEST(SelectIntegrator, PathsWhereNoCausticIsSeen) {
  // The glass stands under the floor, in the dark.
  ExpectChoice(Choose(kPoint + kFloor + "Translate 0 0 -3 Material \"glass\" " + kBall), "path",
               "met no light that paths find seldom");
}

TEST(SelectIntegrator, OneTechniqueOfDirectLightLeavesSppm) {
  IntegratorOptions options;
  options.direct.technique = DirectTechnique::Light;
  ExpectChoice(Choose(kPoint + kFloor + "Material \"glass\" " + kBall, options), "sppm", "one technique alone");
}

TEST(SelectIntegrator, WhatIsAskedForIsTaken) {
  const auto scene = SceneOf(kPoint + kFloor + "Material \"glass\" " + kBall);
  ExpectChoice(ResolveIntegrator("path", *scene, {}, 1), "path", "asked for");
  EXPECT_EQ(ResolveIntegrator("auto", *scene, {}, 1).name, "hybrid");
  EXPECT_EQ(ResolveIntegrator("", *scene, {}, 1).name, "hybrid");
}

// The pilot's figures, wherever the scene lies: float rounds rays, so not to the last digit.
TEST(RareLight, IsTheSameForAnySizeAndPlace) {
  const std::string world = Lamp(0.1) + kFloor + "Material \"glass\" " + kBall;
  const RareLight here = FindRareLight(*SceneOf(world), {}, 1);
  EXPECT_GT(here.share, 0.01);
  EXPECT_LT(here.share, 0.5);
  for (const auto& [scale, moved] : {std::pair(1e-3, 0.), std::pair(1e3, 0.), std::pair(1., 1e4)}) {
    const RareLight there = FindRareLight(*SceneOf(world, scale, moved), {}, 1);
    EXPECT_NEAR(there.share / here.share, 1, 0.1) << scale << " " << moved;
    EXPECT_NEAR(there.Gain() / here.Gain(), 1, 0.2) << scale << " " << moved;
  }
}

// The gain is a ratio of variances from sixteen paths a place: good to a factor, far from where the choice turns.
TEST(RareLight, IsNearlyTheSameForAnySeedAndSoIsTheChoice) {
  const auto scene = SceneOf(Lamp(0.1) + kFloor + "Material \"glass\" " + kBall);
  const RareLight first = FindRareLight(*scene, {}, 1);
  for (uint64_t seed = 2; seed < 6; ++seed) {
    const RareLight other = FindRareLight(*scene, {}, seed);
    EXPECT_NEAR(other.share / first.share, 1, 0.1) << seed;
    EXPECT_LT(std::abs(std::log2(other.Gain() / first.Gain())), 1) << seed;
    EXPECT_EQ(SelectIntegrator(*scene, {}, seed).name, "hybrid") << seed;
  }
  EXPECT_EQ(FindRareLight(*scene, {}, 1).noise, first.noise);
}

// A caustic's flux: under a light of no extent all that glass sends on is rare, and the floor shows what arrives.
TEST(RareLight, ShareGrowsWithWhatTheGlassSendsOn) {
  double before = 0;
  for (const double transmitted : {0.25, 0.5, 1.}) {
    const std::string glass =
        fmt::format("Material \"glass\" \"rgb Kr\" [0 0 0] \"rgb Kt\" [{0} {0} {0}] ", transmitted);
    const RareLight rare = FindRareLight(*SceneOf(kPoint + kFloor + glass + kBall), {}, 1);
    EXPECT_GT(rare.share, 1.5 * before) << transmitted;
    before = rare.share;
  }
}

}  // namespace
}  // namespace dapple
