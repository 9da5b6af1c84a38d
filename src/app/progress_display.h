// How a render shows its progress: a bar that is rewritten on a terminal, a plain line per tenth elsewhere.
#pragma once

#include <chrono>
#include <string>

#include "src/render/driver.h"

namespace dapple {

/// Writes to the error stream. The bar's line is ended by the destructor, so that what follows begins on its own line.
class ProgressDisplay {
 public:
  /// `exposure`: of the picture, whose error is shown.
  explicit ProgressDisplay(float exposure);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void Show(const RenderProgress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  void ShowBar(const RenderProgress& progress);
  void ShowLine(const RenderProgress& progress);
  /// In words; found anew where that takes at most a fiftieth of the time. Empty where it is not known yet.
  const std::string& ErrorOf(const RenderProgress& progress);

  float exposure_;
  bool isTerminal_;
  Clock::time_point lastShown_{};
  int tenthsShown_ = 0;
  std::string error_;
  Clock::time_point errorBegin_{};
  Clock::duration errorCost_{};
};

}  // namespace dapple
