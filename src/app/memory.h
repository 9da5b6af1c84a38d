// How much memory this process has taken, and the machine has.
#pragma once

#include <cstdint>

namespace dapple {

/// The most that was resident at one time so far, in bytes.
int64_t PeakMemoryBytes();

/// What the machine has in all; no bound where the system does not say.
int64_t MachineMemoryBytes();

/// What of it is held now; 0 where the system does not tell.
int64_t CurrentMemoryBytes();

}  // namespace dapple
