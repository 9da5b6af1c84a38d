#include "src/render/memory_needs.h"

#include <gtest/gtest.h>

#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

using testing_support::SceneFromText;

constexpr int64_t kLightPaths = 1000;

/// Stores photons of so many light paths a pass, and needs nothing else.
class PhotonIntegrator : public Integrator {
 public:
  std::string_view Name() const override { return "photons"; }
  void Prepare(const Scene&, uint64_t) override {}
  PassForecast Forecast(const Scene&, uint64_t) const override {
    return {.lightPaths = kLightPaths, .storesPhotons = true};
  }
  PassStats RenderPass(int, Film&) const override { return {}; }
  int DefaultPasses() const override { return 1; }
};

/// Bytes that the photons of a light path are taken for.
double BytesOfAPath(const std::string& scene) {
  const auto built = SceneFromText(scene + " WorldEnd");
  IntegratorOptions options;
  options.photonsPerPass = kLightPaths;
  return static_cast<double>(EstimateMemory(*built, {}, PhotonIntegrator(), options, 7).photons) / kLightPaths;
}

const std::string kCamera =
    "Camera \"perspective\" Film \"image\" \"integer xresolution\" 4 \"integer yresolution\" 4 WorldBegin ";
// One of a thousand photons that meet the ground go on.
const std::string kSunOnDarkGround =
    "LightSource \"distant\" \"point3 from\" [0 1 0] \"point3 to\" [0 0 0] \"rgb L\" [1e6 1e6 1e6] "
    "Material \"matte\" \"rgb Kd\" [0.001 0.001 0.001] AttributeBegin Rotate 90 1 0 0 Shape \"disk\" \"float radius\" "
    "100 AttributeEnd ";
// A path in it is scattered ten times in the mean, and nine of these leave a photon.
const std::string kLampInWhiteBall =
    "Material \"matte\" \"rgb Kd\" [0.9 0.9 0.9] Translate 0 -50 0 Shape \"sphere\" \"float radius\" 10 "
    "LightSource \"point\" \"rgb I\" [1 1 1] ";

// A guide sends photons where they are of use, and that may be where paths are long, however little power goes there.
TEST(MemoryNeeds, PhotonsAreThoseOfTheLongestPathsThatALightMayGive) {
  const double inBall = BytesOfAPath(kCamera + kLampInWhiteBall);
  const double onGround = BytesOfAPath(kCamera + kSunOnDarkGround);
  EXPECT_GT(inBall, 5 * onGround);
  EXPECT_GE(BytesOfAPath(kCamera + kSunOnDarkGround + kLampInWhiteBall), 0.9 * inBall);
}

TEST(MemoryNeeds, MoreLightsThanGroupsAreReckonedWithToo) {
  std::string many = kCamera + "Material \"matte\" \"rgb Kd\" [0.5 0.5 0.5] Shape \"sphere\" \"float radius\" 10 ";
  for (int i = 0; i < 200; ++i) many += "LightSource \"point\" \"rgb I\" [1 1 1] ";
  // Twice scattered in the mean, one photon each, and some more than that from above.
  const double photons = BytesOfAPath(many) / BytesOfAPath(kCamera + kLampInWhiteBall) * 9;
  EXPECT_GT(photons, 0.9);
  EXPECT_LT(photons, 4);
}

}  // namespace
}  // namespace dapple
