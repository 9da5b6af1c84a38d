// The work of paths where their lengths are known: inside a closed sphere of albedo one half that glows evenly.
#include "src/photons/work_pilot.h"

#include <cmath>

#include <gtest/gtest.h>

#include "src/photons/camera_pilot.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

class WorkPilot : public ::testing::Test {
 protected:
  PathWork Work(int maxDepth, int finalGathers) const {
    return EstimateWork(*scene_, EmissionSampler(*scene_), maxDepth, finalGathers, 1);
  }

  std::unique_ptr<Scene> scene_ = testing_support::SceneFromText(
      "LookAt 0 0 0  0 0 -1  0 1 0 Camera \"perspective\" Film \"image\" \"integer xresolution\" [64] "
      "\"integer yresolution\" [64] WorldBegin ReverseOrientation Material \"matte\" \"rgb Kd\" [.5 .5 .5] "
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Shape \"sphere\" \"float radius\" [1] WorldEnd");
};

TEST_F(WorkPilot, CountsWhatALightPathTracesAndLeaves) {
  // Half of the paths end at each surface: 2 segments in the mean, with a variance of 2; all surfaces but the first
  // keep a photon, which counts as half a segment. So the mean is 2.5, and 4,096 paths leave it an error of 0.033.
  EXPECT_NEAR(Work(32, 0).light, 2.5, 5 * 0.033);
  // With one scattering at most the first surface is the last: one segment, and no photon.
  EXPECT_EQ(Work(1, 0).light, 1);
}

TEST_F(WorkPilot, CountsWhatACameraPathTracesAndGathers) {
  // A segment; at its end a shadow ray, a ray that runs into lights, and a gather like one and a half. The path goes on
  // with the mean of `Sharpness` of the densities cos / pi that directions are drawn with, which are 2 cos over [0, 1].
  double goesOn = 0;
  constexpr int kSteps = 10000;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = (i + 0.5) / kSteps;
    goesOn += 2 * cosine * Sharpness(cosine / kPiD) / kSteps;
  }
  EXPECT_NEAR(goesOn, 0.021, 0.001);
  const double surfaces = 1 / (1 - goesOn), error = 4.5 * std::sqrt(goesOn / 4096);
  EXPECT_NEAR(Work(32, 0).camera, 4.5 * surfaces, 5 * error);
  // A final gather goes on to one more surface; the work is the same once again.
  EXPECT_NEAR(Work(32, 1).camera, 9 * surfaces, 5 * std::sqrt(2) * error);
}

}  // namespace
}  // namespace dapple
