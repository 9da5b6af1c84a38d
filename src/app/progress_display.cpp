#include "src/app/progress_display.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <sys/ioctl.h>
#include <unistd.h>

#include "src/app/format.h"

namespace dapple {

namespace {

constexpr int kBarWidth = 24;
constexpr std::chrono::milliseconds kInterval{150};

/// "12 passes, 3.41 M rays/s, 1.20 M photons/s, noise about 3.1 %, 0:12 left"
std::string Describe(const RenderProgress& progress, const std::string& error) {
  if (progress.passesDone == 0) return "prepared";
  std::string text = FormatNumberOf(progress.passesDone, "pass", "passes");
  const double seconds = std::max(progress.seconds, 1e-9);
  text += fmt::format(", {} rays/s", FormatCount(static_cast<double>(progress.stats.Rays()) / seconds));
  if (progress.stats.photonsEmitted > 0) {
    const double photons = static_cast<double>(progress.stats.photonsEmitted);
    text += fmt::format(", {} photons/s", FormatCount(photons / seconds));
  }
  if (!error.empty()) text += ", " + error;
  if (progress.secondsLeft && progress.fraction < 1)
    text += fmt::format(", {} left", FormatDuration(*progress.secondsLeft));
  return text;
}

int TerminalWidth() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

ProgressDisplay::ProgressDisplay(float exposure) : exposure_(exposure), isTerminal_(isatty(STDERR_FILENO) == 1) {}

ProgressDisplay::~ProgressDisplay() {
  if (isTerminal_ && lastShown_ != Clock::time_point{}) std::fputc('\n', stderr);
}

void ProgressDisplay::Show(const RenderProgress& progress) {
  if (isTerminal_) {
    ShowBar(progress);
  } else {
    ShowLine(progress);
  }
}

void ProgressDisplay::ShowBar(const RenderProgress& progress) {
  // Short passes come by the thousand; a terminal need not see them all, but the last.
  const Clock::time_point now = Clock::now();
  if (now - lastShown_ < kInterval && progress.fraction < 1) return;
  lastShown_ = now;
  const int filled = static_cast<int>(std::lround(progress.fraction * kBarWidth));
  std::string line =
      fmt::format("[{:=<{}}{:{}}] {}", "", filled, "", kBarWidth - filled, Describe(progress, ErrorOf(progress)));
  line.resize(std::min(line.size(), static_cast<size_t>(TerminalWidth() - 1)));
  std::fputs(fmt::format("\r{}\x1b[K", line).c_str(), stderr);
  std::fflush(stderr);
}

const std::string& ProgressDisplay::ErrorOf(const RenderProgress& progress) {
  if (progress.error) return error_ = FormatError(*progress.error, progress.film->TracksBlur());
  // The time that it takes is the render's.
  constexpr int kLeastInterval = 50;
  const Clock::time_point begin = Clock::now();
  if (begin - errorBegin_ < kLeastInterval * errorCost_) return error_;
  if (const auto error = EstimateError(*progress.film, exposure_))
    error_ = FormatError(*error, progress.film->TracksBlur());
  errorBegin_ = begin;
  errorCost_ = Clock::now() - begin;
  return error_;
}

void ProgressDisplay::ShowLine(const RenderProgress& progress) {
  const int percent = static_cast<int>(std::floor(progress.fraction * 100 + 1e-9)), tenths = percent / 10;
  // The first pass always has its line: it tells how fast the rest will go.
  if (tenths <= tenthsShown_ && progress.passesDone != 1) return;
  tenthsShown_ = tenths;
  Tell(fmt::format("{:3} %: {}", percent, Describe(progress, ErrorOf(progress))));
}

}  // namespace dapple
