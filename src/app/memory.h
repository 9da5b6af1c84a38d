// How much memory this process has taken, and the machine has.
#pragma once

#include <cstdint>
#include <filesystem>

namespace dapple {

/// The most that was resident at one time so far, in bytes.
int64_t PeakMemoryBytes();

/// What the machine has in all, or what the control groups of this process may take of it where that is less; no bound
/// where the system does not say.
int64_t MachineMemoryBytes();

/// The least limit on memory of the control groups, of both versions, that the file `groups` (/proc/self/cgroup) names
/// and of those around them, which stand as folders under `root` (/sys/fs/cgroup); no bound where there is none.
int64_t GroupMemoryBytes(const std::filesystem::path& groups, const std::filesystem::path& root);

/// What this process holds now; 0 where the system does not tell.
int64_t CurrentMemoryBytes();

}  // namespace dapple
