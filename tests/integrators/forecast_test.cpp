// What is told of a pass before anything is prepared, against what it does.
#include <gtest/gtest.h>

#include "integrators/integrator.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

using testing_support::SceneFromText;

constexpr int kSide = 32;

// A glass ball under a lamp, on a floor.
std::string GlassBall() {
  return "LookAt 0 -4 3  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" [40] "
         "Film \"image\" \"integer xresolution\" [32] \"integer yresolution\" [32] PixelFilter \"box\" WorldBegin "
         "LightSource \"point\" \"rgb I\" [5 5 5] \"point from\" [1 0 3] Material \"matte\" Shape \"disk\" "
         "Material \"glass\" Translate 0 0 .5 Shape \"sphere\" \"float radius\" [.4] WorldEnd";
}

struct Pass {
  PassForecast forecast;
  PassStats done;
  PreparationUse preparation;
};

Pass PassOf(const Scene& scene, std::string_view integrator, const IntegratorOptions& options) {
  const auto algorithm = MakeIntegrator(integrator, options);
  Pass pass{algorithm->Forecast(scene, 1), {}, {}};
  algorithm->Prepare(scene, 1);
  Film film(scene.Settings().resolution, scene.Settings().crop, scene.Settings().filter);
  pass.done = algorithm->RenderPass(0, film);
  pass.preparation = algorithm->Preparation();
  return pass;
}

TEST(Forecast, IsAboutWhatAPassDoes) {
  const auto scene = SceneFromText(GlassBall());
  for (const std::string_view integrator : IntegratorNames()) {
    const Pass pass = PassOf(*scene, integrator, {});
    EXPECT_LE(pass.forecast.lightPaths, 2 * pass.done.photonsEmitted) << integrator;
    EXPECT_LE(pass.done.photonsEmitted, 2 * pass.forecast.lightPaths) << integrator;
    EXPECT_EQ(pass.forecast.storesPhotons, pass.done.photonMaps > 0) << integrator;
    EXPECT_EQ(pass.forecast.pilotBytes > 0, pass.preparation.pilots.lightPaths > 0) << integrator;
    EXPECT_GE(pass.forecast.pilotBytes, pass.preparation.tables.bytes) << integrator;
  }
}

TEST(Forecast, KnowsHowManyCameraPathsGoWithPhotonsThatAreAskedFor) {
  const auto scene = SceneFromText(GlassBall());
  IntegratorOptions options;
  options.maxDepth = 2;
  options.photonsPerPass = 8 * kSide * kSide;
  for (const std::string_view integrator : {"photon_mapping", "sppm", "hybrid"}) {
    const Pass pass = PassOf(*scene, integrator, options);
    EXPECT_EQ(pass.forecast.lightPaths, options.photonsPerPass) << integrator;
    // At most three rays a camera path, and both ways of glass.
    const auto paths = int64_t{pass.forecast.cameraSamples} * kSide * kSide;
    EXPECT_GT(pass.forecast.cameraSamples, 1) << integrator;
    EXPECT_GE(pass.done.cameraRays, paths) << integrator;
    EXPECT_LE(pass.done.cameraRays, 4 * paths) << integrator;
  }
}

TEST(Forecast, TellsOfNoPhotonsWherePathsAreTooShortForAny) {
  const auto scene = SceneFromText(GlassBall());
  IntegratorOptions options;
  options.maxDepth = 1;
  for (const std::string_view integrator : {"photon_mapping", "sppm", "hybrid"}) {
    const Pass pass = PassOf(*scene, integrator, options);
    EXPECT_EQ(pass.done.photonsEmitted, 0) << integrator;
    EXPECT_EQ(pass.forecast.lightPaths, 0) << integrator;
    EXPECT_FALSE(pass.forecast.storesPhotons) << integrator;
  }
}

// One radius for all places needs no pilot that learns radii, unless weights go by the photons within it.
TEST(Preparation, LearnsNoRadiiWhereOneIsGiven) {
  const auto scene = SceneFromText(GlassBall());
  IntegratorOptions chosen, given;
  chosen.guideEmission = given.guideEmission = false;
  given.radius = 0.05;
  for (const std::string_view integrator : {"photon_mapping", "sppm", "hybrid"}) {
    const int64_t before = PassOf(*scene, integrator, chosen).preparation.pilots.lightPaths;
    const int64_t after = PassOf(*scene, integrator, given).preparation.pilots.lightPaths;
    EXPECT_EQ(after < before, integrator != "hybrid") << integrator << ": " << before << ", then " << after;
  }
}

}  // namespace
}  // namespace dapple
