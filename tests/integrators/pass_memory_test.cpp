// The memory of a pass: photons as they are shot, and the map while it is built. The process is measured from outside,
// so the figures are exact where this runs alone, as ctest has it.
#include <gtest/gtest.h>

#include "integrators/integrator.h"
#include "tests/support/process_memory.h"
#include "tests/support/sanitizers.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

using testing_support::ForgetPeak;
using testing_support::ProcessBytes;

class PassMemory : public testing::TestWithParam<const char*> {};

TEST_P(PassMemory, OfAMillionPhotonsIs64MegabytesAtMost) {
  if (testing_support::kIsSanitized) GTEST_SKIP() << "the sanitizer has memory of its own";
  // A closed room, and glass in it: a few photons a light path.
  const auto scene = testing_support::SceneFromText(
      "LookAt 0 -0.9 0  0 1 0  0 0 1 Camera \"perspective\" \"float fov\" [60] "
      "Film \"image\" \"integer xresolution\" [16] \"integer yresolution\" [16] WorldBegin "
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 9 9] Translate 0 0 0.7 Shape \"sphere\" \"float "
      "radius\" "
      "[0.1] AttributeEnd AttributeBegin Material \"glass\" Shape \"sphere\" \"float radius\" [0.4] AttributeEnd "
      "Material \"matte\" \"rgb Kd\" [.6 .6 .6] ReverseOrientation Shape \"sphere\" \"float radius\" [1.7] WorldEnd");
  IntegratorOptions options;
  options.photonsPerPass = 700000;
  options.radius = 0.02;
  options.guideEmission = false;
  const auto integrator = MakeIntegrator(GetParam(), options);
  integrator->Prepare(*scene, 1);
  const RenderSettings& settings = scene->Settings();
  Film film(settings.resolution, settings.crop, settings.filter);

  const int64_t before = ProcessBytes("VmRSS");
  if (!ForgetPeak()) GTEST_SKIP() << "this system does not tell the peak of a part of a program";
  const PassStats stats = integrator->RenderPass(0, film);
  const auto peak = static_cast<double>(ProcessBytes("VmHWM") - before);
  const auto photons = static_cast<double>(stats.photonsStored);
  RecordProperty("photons", std::to_string(stats.photonsStored));
  RecordProperty("peakBytesPerPhoton", std::to_string(peak / photons));
  EXPECT_GT(photons, 1000000);
  EXPECT_LT(peak, 64 * photons);
}

INSTANTIATE_TEST_SUITE_P(All, PassMemory, testing::Values("photon_mapping", "sppm", "hybrid"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace dapple
