// One run of an algorithm for a time, with pictures of it taken on the way: what a convergence curve is made of.
//
// The pictures are those of the film between passes, so nothing is rendered twice and nothing of the render changes.
// The clock stands still while they are taken: it counts what the render itself took, preparation included.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "src/image/image.h"
#include "src/render/driver.h"

namespace dapple {

/// `budget` and the times before it, each less than the next by the root of two, down to its 256th part; ascending.
std::vector<double> SnapshotTimes(double budget);

struct Snapshot {
  int timeIndex = 0;   ///< which of the times it stands for
  double seconds = 0;  ///< at the end of its last pass, since the beginning of the preparation; snapshots not counted
  int passes = 0;
  Image picture;  ///< the mean of the passes, without the exposure
};

struct ConvergenceRun {
  double prepareSeconds = 0;
  double seconds = 0;          ///< preparation and passes
  double snapshotSeconds = 0;  ///< taking pictures; not in `seconds`
  int passes = 0;
  bool stopped = false;  ///< before its time was up
  std::vector<Snapshot> snapshots;
};

/// Renders until the last of `times` (ascending, > 0), to within a pass, and takes a snapshot after the first pass that
/// ends at one of them or later; where a pass spans several times the last of them has it. The last snapshot is that of
/// all passes. `film` is empty and holds the passes in the end. `onPass` is called after each pass with the seconds
/// so far; its time does not count. `secondsBefore` were spent on this run already (on choosing the integrator) and
/// count as preparation.
ConvergenceRun RunWithSnapshots(const Scene& scene, uint64_t seed, Integrator& integrator,
                                const std::vector<double>& times, Film& film,
                                const std::function<void(double seconds)>& onPass = {},
                                const std::atomic<bool>* stop = nullptr, double secondsBefore = 0);

}  // namespace dapple
