#include "src/render/driver.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <limits>
#include <new>

#include <fmt/format.h>

#include "src/base/numerics.h"
#include "src/render/aov.h"

namespace dapple {

namespace {

class Stopwatch {
 public:
  explicit Stopwatch(double secondsBefore) : secondsBefore_(secondsBefore) {}
  double Seconds() const { return secondsBefore_ + std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  double secondsBefore_;
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

/// Looks at the error of a film whenever that is due.
class ErrorWatch {
 public:
  ErrorWatch(std::optional<double> wanted, float exposure) : wanted_(wanted), exposure_(exposure) {}

  void Look(const Film& film) {
    if (!wanted_ || !IsErrorDue(static_cast<int>(film.PassCount()))) return;
    last_ = EstimateError(film, exposure_);
    isLost_ = !last_;
  }
  const std::optional<ErrorEstimate>& Last() const { return last_; }
  bool IsReached() const { return last_ && last_->Total() < *wanted_; }
  /// The memory does not suffice to estimate it.
  bool IsLost() const { return isLost_; }
  /// Of the way, in [0, 1], if the square of the error falls as 1 / passes.
  double Fraction() const { return last_ ? std::min(1., Sqr(*wanted_ / last_->Total())) : 0; }

 private:
  std::optional<double> wanted_;
  float exposure_;
  std::optional<ErrorEstimate> last_;
  bool isLost_ = false;
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
                       const ErrorWatch& error, const PassStats& stats) {
  RenderProgress progress;
  progress.passesDone = static_cast<int>(film.PassCount());
  progress.seconds = elapsed;
  progress.stats = stats;
  progress.film = &film;
  progress.error = error.Last();
  progress.fraction = error.Fraction();
  if (budget.passes) {
    progress.fraction = std::max(progress.fraction, static_cast<double>(progress.passesDone) / *budget.passes);
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
                    const RenderHooks& hooks, double secondsBefore) {
  assert(budget.passes || budget.seconds || budget.error);
  const Stopwatch watch(secondsBefore);
  PassClock clock;
  ErrorWatch error(budget.error, scene.Settings().exposure);
  RenderResult result;
  const auto report = [&] {
    if (hooks.onProgress) hooks.onProgress(Measure(budget, film, watch.Seconds(), clock, error, result.stats));
  };

  WithinMemory("the preparation", [&] { integrator.Prepare(scene, seed); });
  result.prepareSeconds = watch.Seconds();
  error.Look(film);
  report();
  while (true) {
    const int passesBefore = static_cast<int>(film.PassCount());
    const double begin = watch.Seconds();
    if (error.IsReached() || IsSpent(budget, passesBefore, begin, clock)) break;
    // Else nothing would end it.
    if (error.IsLost() && !budget.passes && !budget.seconds) break;
    if (IsStopAsked(hooks)) {
      result.stopped = true;
      break;
    }
    const int pass = NextPass(budget, film);
    WithinMemory(fmt::format("pass {}", pass), [&] {
      if (!film.ExtraChannels().empty()) result.stats += RecordFirstHits(scene, seed, pass, film);
      const PassStats stats = integrator.RenderPass(pass, film);
      for (const auto& [source, count] : stats.nonFinite.BySource()) film.CountNonFinite(NameOf(source, scene), count);
      result.stats += stats;
    });
    assert(film.PassCount() == passesBefore + 1);
    ++result.passes;
    clock.Add(watch.Seconds() - begin);
    error.Look(film);
    report();
  }
  result.seconds = watch.Seconds();
  return result;
}

}  // namespace dapple
