#include "src/render/convergence_run.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <limits>

namespace dapple {

namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Watches a render: decides when a snapshot is due and when the time is up, by a clock without its own work.
class SnapshotTaker {
 public:
  SnapshotTaker(const std::vector<double>& times, ConvergenceRun* run) : times_(times), run_(run) {}

  /// True where the render shall end: no room is left for another pass, or a stop is asked for.
  bool OnProgress(const RenderProgress& progress, bool isStopAsked) {
    const double seconds = progress.seconds - pausedSeconds_;
    const double passSeconds = seconds - run_->seconds;
    run_->seconds = seconds;
    run_->passes = progress.passesDone;
    if (progress.passesDone == 0) return isStopAsked;
    // As the driver foresees it: the next pass takes as long as the slower of the last two.
    const double next = std::max(passSeconds, previousPassSeconds_);
    previousPassSeconds_ = passSeconds;
    const bool isLast = isStopAsked || seconds + next > times_.back();
    int reached = nextTime_;
    while (reached < Count() && times_[static_cast<size_t>(reached)] <= seconds) ++reached;
    if (isLast && !isStopAsked) reached = Count();
    if (isLast || reached > nextTime_) Take(progress, seconds, std::max(reached - 1, 0));
    nextTime_ = reached;
    return isLast;
  }

  /// The caller's work since `begin` does not count.
  void Pause(Clock::time_point begin) { pausedSeconds_ += SecondsSince(begin); }

 private:
  int Count() const { return static_cast<int>(times_.size()); }

  void Take(const RenderProgress& progress, double seconds, int timeIndex) {
    const Clock::time_point begin = Clock::now();
    run_->snapshots.push_back({timeIndex, seconds, progress.passesDone, progress.film->ToImage()});
    run_->snapshotSeconds += SecondsSince(begin);
  }

  const std::vector<double>& times_;
  ConvergenceRun* run_;
  double pausedSeconds_ = 0, previousPassSeconds_ = 0;
  int nextTime_ = 0;  ///< the first that has not been reached
};

}  // namespace

std::vector<double> SnapshotTimes(double budget) {
  constexpr int kHalfOctaves = 16;
  std::vector<double> times;
  for (int i = kHalfOctaves; i >= 0; --i) times.push_back(budget * std::exp2(-0.5 * i));
  return times;
}

ConvergenceRun RunWithSnapshots(const Scene& scene, uint64_t seed, Integrator& integrator,
                                const std::vector<double>& times, Film& film,
                                const std::function<void(double seconds)>& onPass, const std::atomic<bool>* stop,
                                double secondsBefore) {
  assert(!times.empty() && std::is_sorted(times.begin(), times.end()) && film.PassCount() == 0);
  ConvergenceRun run;
  SnapshotTaker taker(times, &run);
  std::atomic<bool> isOver{false};
  const auto isStopAsked = [&] { return stop && stop->load(std::memory_order_relaxed); };
  RenderHooks hooks;
  hooks.stop = &isOver;
  hooks.onProgress = [&](const RenderProgress& progress) {
    const Clock::time_point begin = Clock::now();
    const bool isStopped = isStopAsked();
    if (taker.OnProgress(progress, isStopped)) isOver = true;
    run.stopped = run.stopped || isStopped;
    if (onPass) onPass(run.seconds);
    taker.Pause(begin);
  };
  // The clock of the driver would count the snapshots; the end comes from here.
  RenderBudget budget;
  budget.passes = std::numeric_limits<int>::max();
  run.prepareSeconds = Render(scene, seed, integrator, film, budget, hooks, secondsBefore).prepareSeconds;
  return run;
}

}  // namespace dapple
