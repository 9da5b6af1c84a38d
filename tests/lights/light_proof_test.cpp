// The statistics of every light: what it draws follows the densities that it claims, and carries the energy that it
// has.
#include <gtest/gtest.h>

#include "tests/lights/light_checks.h"

namespace dapple {
namespace {

class EveryLightProof : public ::testing::Test {
 protected:
  static bool IsTextured(const LightCase& c) { return c.name.find("textured") != std::string::npos; }

  const std::vector<LightCase> lights_ = AllLights();
};

TEST_F(EveryLightProof, DirectionsTowardItFollowTheirDensity) {
  const std::vector<LightContext> contexts = TestContexts();
  for (const LightCase& c : lights_) {
    for (size_t i = 0; i < contexts.size(); ++i) {
      if (c.light->IsInfinite() && i > 2) continue;  // the same from everywhere
      const LightContext& at = contexts[i];
      const Verdict verdict = CheckDirectionsToLight(c, at);
      EXPECT_TRUE(verdict.passes) << c.name << " from " << at.p << ": " << verdict.message;
    }
  }
}

TEST_F(EveryLightProof, OriginsOfRaysFollowTheirDensity) {
  for (const LightCase& c : lights_) {
    const Verdict verdict = CheckRayOrigins(c);
    EXPECT_TRUE(verdict.passes) << c.name << ": " << verdict.message;
  }
}

TEST_F(EveryLightProof, DirectionsOfRaysFollowTheirDensity) {
  for (const LightCase& c : lights_) {
    const Verdict verdict = CheckRayDirections(c);
    EXPECT_TRUE(verdict.passes) << c.name << ": " << verdict.message;
  }
}

TEST_F(EveryLightProof, OriginsAndDirectionsFollowTheirDensityTogether) {
  for (const LightCase& c : lights_) {
    const Verdict verdict = CheckRays(c);
    EXPECT_TRUE(verdict.passes) << c.name << ": " << verdict.message;
  }
}

TEST_F(EveryLightProof, MeanFluxIsThePowerIsTheQuadratureOfItsEmission) {
  for (const LightCase& c : lights_) {
    // The mean of a texture is taken over points: its own error.
    const Verdict verdict = CheckEnergy(c, IsTextured(c) ? 2e-3 : 2e-4);
    EXPECT_TRUE(verdict.passes) << c.name << ": " << verdict.message;
  }
}

TEST_F(EveryLightProof, BothSidesGiveTheSameLightOnAPatch) {
  for (const LightCase& c : lights_) {
    const std::vector<Patch> patches = TestPatches(c);
    EXPECT_FALSE(patches.empty()) << c.name;
    for (const Patch& patch : patches) {
      const Verdict verdict = CheckBothSides(c, patch);
      EXPECT_TRUE(verdict.passes) << c.name << " at " << patch.center << ": " << verdict.message;
    }
  }
}

// How unlike the flux of two rays may be. Shapes that are not drawn uniformly by area: as the densities differ;
// textures and uniformly emitting environments: at will; maps: within a cell, as colours differ from their largest
// component.
double SpreadOf(const LightCase& c) {
  const auto has = [&](const char* word) { return c.name.find(word) != std::string::npos; };
  if (has("textured") || has("uniform emission")) return std::numeric_limits<double>::infinity();
  if (has("ellipsoid") || has("bilinear")) return 6;
  if (has("uniform environment")) return 1 + 1e-5;
  if (has("environment") || has("projection") || has("goniometric")) return 2.5;
  return has("spot 0.01") ? 1.01 : 1 + 1e-4;
}

TEST_F(EveryLightProof, DrawsAreWhatIsLookedUp) {
  for (const LightCase& c : lights_) {
    const Verdict verdict = CheckLookup(c, SpreadOf(c), IsTextured(c));
    EXPECT_TRUE(verdict.passes) << c.name << ": " << verdict.message;
  }
}

}  // namespace
}  // namespace dapple
