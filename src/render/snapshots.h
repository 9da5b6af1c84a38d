// When pictures are taken on the way: after every so many passes, or at times in geometric steps. A snapshot only reads
// the film between passes, so it changes nothing of what comes after.
#pragma once

#include <optional>
#include <string>

#include "src/render/driver.h"

namespace dapple {

class SnapshotSchedule {
 public:
  /// After each multiple of `passes` (>= 1) in the film.
  static SnapshotSchedule EveryPasses(int passes);
  /// After the first pass that ends at or behind each of first, first * factor, first * factor^2, ... seconds; `first`
  /// > 0, `factor` > 1.
  static SnapshotSchedule AtTimes(double first, double factor);

  /// True where a snapshot is to be taken now. To be asked once with each progress, in order.
  bool IsDue(const RenderProgress& progress);

 private:
  int every_ = 0;  ///< 0: by time
  double next_ = 0, factor_ = 2;
};

/// "picture.exr" after 16 passes: "picture.00016.exr".
std::string SnapshotName(const std::string& output, int passes);
/// The number of passes after which a snapshot of `output` has the file name of `path`, in whatever folder; nothing
/// where none has.
std::optional<int> SnapshotPasses(const std::string& output, const std::string& path);

}  // namespace dapple
