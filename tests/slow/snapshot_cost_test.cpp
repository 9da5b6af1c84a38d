// What the pictures of a convergence curve cost: time, for their bits are in tests/render/convergence_test.cpp.
#include <gtest/gtest.h>

#include "src/io/build_scene.h"
#include "src/render/convergence_run.h"

namespace dapple {
namespace {

// Seventeen pictures of 30,720 pixels in three seconds, in which other work on the machine may come between: below the
// 2 % that is promised.
TEST(SnapshotCost, IsBelowTwoPercentOfTheRender) {
  Diagnostics diagnostics([](const std::string& line) { ADD_FAILURE() << line; });
  const auto scene = LoadScene(DAPPLE_SOURCE_DIR "/scenes/ring.pbrt", {}, diagnostics);
  Film film(scene->Settings().resolution, scene->Settings().crop, scene->Settings().filter);
  const ConvergenceRun run = RunWithSnapshots(*scene, 0, *MakeIntegrator("path", {}), SnapshotTimes(3), film);
  EXPECT_GE(run.snapshots.size(), 10u);
  EXPECT_LT(run.snapshotSeconds, 0.02 * run.seconds) << run.snapshots.size() << " snapshots";
  RecordProperty("percent", std::to_string(100 * run.snapshotSeconds / run.seconds));
}

}  // namespace
}  // namespace dapple
