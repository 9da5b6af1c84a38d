#include "src/render/snapshots.h"

#include <gtest/gtest.h>

namespace dapple {
namespace {

/// The passes after which a snapshot is due, where pass p ends at `seconds` * p.
std::vector<int> DueAfter(SnapshotSchedule schedule, double seconds, int passes) {
  std::vector<int> due;
  for (int pass = 0; pass <= passes; ++pass) {
    RenderProgress progress;
    progress.passesDone = pass;
    progress.seconds = seconds * pass;
    progress.stats.cameraRays = pass;
    if (schedule.IsDue(progress)) due.push_back(pass);
  }
  return due;
}

TEST(Snapshots, AreTakenEverySoManyPasses) {
  EXPECT_EQ(DueAfter(SnapshotSchedule::EveryPasses(4), 1, 13), (std::vector<int>{4, 8, 12}));
  EXPECT_EQ(DueAfter(SnapshotSchedule::EveryPasses(1), 1, 3), (std::vector<int>{1, 2, 3}));
}

TEST(Snapshots, AreTakenAtTimesInGeometricSteps) {
  EXPECT_EQ(DueAfter(SnapshotSchedule::AtTimes(1, 2), 0.25, 40), (std::vector<int>{4, 8, 16, 32}));
  // A pass that is longer than a step gives one snapshot, not several.
  EXPECT_EQ(DueAfter(SnapshotSchedule::AtTimes(1, 2), 10, 4), (std::vector<int>{1, 2, 4}));
}

TEST(Snapshots, AreNamedByTheirPasses) {
  EXPECT_EQ(SnapshotName("picture.exr", 16), "picture.00016.exr");
  EXPECT_EQ(SnapshotName("some.folder/a.b.png", 123456), "some.folder/a.b.123456.png");
}

}  // namespace
}  // namespace dapple
