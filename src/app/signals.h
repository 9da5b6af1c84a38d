// Ctrl-C and SIGTERM as a flag, so that a render ends after the pass that is running and its picture is written.
#pragma once

#include <atomic>

namespace dapple {

/// While it lives, the first SIGINT or SIGTERM sets the flag and says so on the error stream; a second one ends the
/// program at once, as a failure. One at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  const std::atomic<bool>& Flag() const;
  /// The signal that came, or 0.
  int Signal() const;
};

}  // namespace dapple
