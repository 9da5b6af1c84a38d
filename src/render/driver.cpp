#include "src/render/driver.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <limits>
#include <new>

#include <fmt/format.h>

#include "src/render/aov.h"

namespace dapple {

namespace {

class Stopwatch {
 public:
  double Seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Foresees how long passes take. The next one is taken for as long as the slower of the last two, so that a hiccup
/// makes the forecast careful and not the first pass, cold as it is, for ever.
class PassClock {
 public:
  void Add(double seconds) {
    previous_ = passes_ > 0 ? last_ : seconds;
    last_ = seconds;
    total_ += seconds;
    ++passes_;
  }
  double Next() const { return std::max(last_, previous_); }
  int Passes() const { return passes_; }
  /// Of all passes; there must be one.
  double Mean() const { return total_ / passes_; }

 private:
  int passes_ = 0;
  double last_ = 0, previous_ = 0, total_ = 0;
};

/// The first pass of the budget that the film does not hold.
int NextPass(const RenderBudget& budget, const Film& film) {
  const PassRange andOn{budget.firstPass, std::numeric_limits<int>::max()};
  return static_cast<int>(film.Passes().FirstMissing(andOn)->begin);
}

/// Runs `work`; memory that does not suffice becomes an `Error` that says for what.
template <typename F>
void WithinMemory(const std::string& what, F work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    throw Error(fmt::format("the memory does not suffice for {}; fewer photons or a smaller picture take less", what));
  }
}

bool IsStopAsked(const RenderHooks& hooks) { return hooks.stop && hooks.stop->load(std::memory_order_relaxed); }

bool IsSpent(const RenderBudget& budget, int passesInFilm, double elapsed, const PassClock& clock) {
  if (budget.passes && passesInFilm >= *budget.passes) return true;
  return budget.seconds && clock.Passes() > 0 && elapsed + clock.Next() > *budget.seconds;
}

RenderProgress Measure(const RenderBudget& budget, const Film& film, double elapsed, const PassClock& clock,
                       const PassStats& stats) {
  RenderProgress progress;
  progress.passesDone = static_cast<int>(film.PassCount());
  progress.seconds = elapsed;
  progress.stats = stats;
  progress.film = &film;
  if (budget.passes) {
    progress.fraction = static_cast<double>(progress.passesDone) / *budget.passes;
    if (clock.Passes() > 0) progress.secondsLeft = clock.Mean() * std::max(0, *budget.passes - progress.passesDone);
  }
  if (budget.seconds) {
    progress.fraction = std::max(progress.fraction, elapsed / *budget.seconds);
    const double left = std::max(0., *budget.seconds - elapsed);
    progress.secondsLeft = std::min(progress.secondsLeft.value_or(left), left);
  }
  progress.fraction = std::min(progress.fraction, 1.);
  return progress;
}

}  // namespace

RenderResult Render(const Scene& scene, uint64_t seed, Integrator& integrator, Film& film, const RenderBudget& budget,
                    const RenderHooks& hooks) {
  assert(budget.passes || budget.seconds);
  const Stopwatch watch;
  PassClock clock;
  RenderResult result;
  const auto report = [&] {
    if (hooks.onProgress) hooks.onProgress(Measure(budget, film, watch.Seconds(), clock, result.stats));
  };

  WithinMemory("the preparation", [&] { integrator.Prepare(scene, seed); });
  result.prepareSeconds = watch.Seconds();
  report();
  while (true) {
    const int passesBefore = static_cast<int>(film.PassCount());
    const double begin = watch.Seconds();
    if (IsSpent(budget, passesBefore, begin, clock)) break;
    if (IsStopAsked(hooks)) {
      result.stopped = true;
      break;
    }
    const int pass = NextPass(budget, film);
    WithinMemory(fmt::format("pass {}", pass), [&] {
      if (!film.ExtraChannels().empty()) result.stats += RecordFirstHits(scene, seed, pass, film);
      const PassStats stats = integrator.RenderPass(pass, film);
      film.CountNonFinite(stats.nonFinite.Total());
      result.stats += stats;
    });
    assert(film.PassCount() == passesBefore + 1);
    ++result.passes;
    clock.Add(watch.Seconds() - begin);
    report();
  }
  result.seconds = watch.Seconds();
  return result;
}

}  // namespace dapple
