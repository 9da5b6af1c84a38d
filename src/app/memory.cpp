#include "src/app/memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

namespace dapple {

namespace {

constexpr int64_t kNoBound = std::numeric_limits<int64_t>::max();

/// The number in a file; no bound where there is no such file, or no number in it ("max").
int64_t ReadLimit(const std::filesystem::path& file) {
  int64_t limit = 0;
  return std::ifstream(file) >> limit ? limit : kNoBound;
}

/// The least of the limits of a group and those around it. In a container only the outermost may be seen.
int64_t LeastLimit(const std::filesystem::path& root, std::filesystem::path group, const char* file) {
  int64_t least = kNoBound;
  for (;; group = group.parent_path()) {
    least = std::min(least, ReadLimit(root / group / file));
    if (group.empty()) return least;
  }
}

}  // namespace

int64_t PeakMemoryBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return int64_t{usage.ru_maxrss} * 1024;  // Linux counts in KiB
}

int64_t MachineMemoryBytes() {
  const int64_t pages = sysconf(_SC_PHYS_PAGES);
  const int64_t all = pages > 0 ? pages * sysconf(_SC_PAGESIZE) : kNoBound;
  return std::min(all, GroupMemoryBytes("/proc/self/cgroup", "/sys/fs/cgroup"));
}

// Each line is "NUMBER:CONTROLLERS:/GROUP"; no controllers are named where they are all in one hierarchy (version 2).
int64_t GroupMemoryBytes(const std::filesystem::path& groups, const std::filesystem::path& root) {
  int64_t least = kNoBound;
  std::ifstream lines(groups);
  std::string number, controllers, group;
  while (std::getline(lines, number, ':') && std::getline(lines, controllers, ':') && std::getline(lines, group)) {
    const std::filesystem::path path = std::filesystem::path(group).relative_path();
    if (controllers.empty()) least = std::min(least, LeastLimit(root, path, "memory.max"));
    if (("," + controllers + ",").find(",memory,") != std::string::npos)
      least = std::min(least, LeastLimit(root / "memory", path, "memory.limit_in_bytes"));
  }
  return least;
}

int64_t CurrentMemoryBytes() {
  std::ifstream pages("/proc/self/statm");
  int64_t all = 0, resident = 0;
  pages >> all >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

}  // namespace dapple
