// The work of paths where their lengths are known: inside a closed sphere of albedo one half that glows evenly.
#include "src/photons/work_pilot.h"

#include <gtest/gtest.h>

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
  // A segment; at its end a shadow ray, a ray that runs into lights, and a gather like one and a half.
  EXPECT_DOUBLE_EQ(Work(32, 0).camera, 4.5);
  // A final gather goes on to one more surface; the work is the same once again.
  EXPECT_DOUBLE_EQ(Work(32, 1).camera, 9);
}

}  // namespace
}  // namespace dapple
