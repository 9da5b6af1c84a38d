#include "src/render/snapshots.h"

#include <cassert>
#include <charconv>
#include <filesystem>

#include <fmt/format.h>

namespace dapple {

SnapshotSchedule SnapshotSchedule::EveryPasses(int passes) {
  assert(passes >= 1);
  SnapshotSchedule schedule;
  schedule.every_ = passes;
  return schedule;
}

SnapshotSchedule SnapshotSchedule::AtTimes(double first, double factor) {
  assert(first > 0 && factor > 1);
  SnapshotSchedule schedule;
  schedule.next_ = first;
  schedule.factor_ = factor;
  return schedule;
}

bool SnapshotSchedule::IsDue(const RenderProgress& progress) {
  // The first report, after the preparation, has no pass of this render yet.
  if (progress.passesDone == 0 || progress.stats.Rays() == 0) return false;
  if (every_ > 0) return progress.passesDone % every_ == 0;
  if (progress.seconds < next_) return false;
  while (next_ <= progress.seconds) next_ *= factor_;
  return true;
}

std::string SnapshotName(const std::string& output, int passes) {
  const std::filesystem::path path(output);
  return (path.parent_path() / fmt::format("{}.{:05}{}", path.stem().string(), passes, path.extension().string()))
      .string();
}

std::optional<int> SnapshotPasses(const std::string& output, const std::string& path) {
  const auto fileName = [](const std::string& of) { return std::filesystem::path(of).filename().string(); };
  const std::string name = fileName(path), stem = std::filesystem::path(output).stem().string();
  if (name.size() <= stem.size()) return std::nullopt;
  int passes = 0;
  std::from_chars(name.data() + stem.size() + 1, name.data() + name.size(), passes);
  if (passes < 1 || name != fileName(SnapshotName(output, passes))) return std::nullopt;
  return passes;
}

}  // namespace dapple
