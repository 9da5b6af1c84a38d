// The driver: prepares an integrator and runs its passes, one after another, until a budget is spent or a stop is asked
// for.
//
// What is true of every algorithm lives here and nowhere else: budgets, progress, stopping, the sums of what was done.
// The driver knows nothing of files and terminals: the caller watches through `RenderHooks` and writes the film
// (output.h).
//
//   const RenderResult result = Render(scene, seed, *integrator, film, {.passes = 64}, {});
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>

#include "integrators/integrator.h"
#include "src/image/film.h"
#include "src/render/error_estimate.h"
#include "src/scene/scene.h"

namespace dapple {

/// Which passes are rendered. A render ends when they are all there, the time is up or the error is small enough,
/// whichever is first; at least one of the three must be set.
struct RenderBudget {
  /// Passes that the film shall hold in the end, >= 1: `firstPass` to firstPass + passes - 1.
  std::optional<int> passes;
  /// Wall-clock seconds from the beginning of the preparation (with those before it), > 0. No pass begins whose end is
  /// foreseen (from the passes before it) to lie beyond; one pass is always rendered. So it is kept to within the
  /// unsteadiness of one pass.
  std::optional<double> seconds;
  int firstPass = 0;  ///< >= 0; other than 0 where a render is split into ranges of passes
  /// What the estimated error (error_estimate.h) is to fall below, > 0. It is looked at where `IsErrorDue` says so, so
  /// the number of passes does not depend on time or threads. The film should track the blur of an integrator that
  /// estimates densities.
  std::optional<double> error = std::nullopt;
};

/// Where a render stands.
struct RenderProgress {
  int passesDone = 0;                  ///< in the film
  double seconds = 0;                  ///< since the beginning of the preparation, with those before it
  std::optional<double> secondsLeft;   ///< estimated; nothing before the first pass, but with a time budget
  double fraction = 0;                 ///< of the budget that is spent, in [0, 1]
  PassStats stats;                     ///< of this render's passes
  const Film* film = nullptr;          ///< for what the watcher wants to know of it (noise, a snapshot); between passes
  std::optional<ErrorEstimate> error;  ///< when it was looked at last, where the budget has one
};

/// How the caller watches and stops a render.
struct RenderHooks {
  /// Called after the preparation (no passes done) and after each pass, between passes, by the thread that called
  /// `Render`.
  std::function<void(const RenderProgress&)> onProgress;
  /// Where it becomes true the render ends after the pass that is running. May be set by a signal handler.
  const std::atomic<bool>* stop = nullptr;
};

struct RenderResult {
  int passes = 0;  ///< rendered by this call
  double prepareSeconds = 0;
  double seconds = 0;  ///< preparation and passes, wall clock
  PassStats stats;
  bool stopped = false;  ///< ended by the stop flag before the budget was spent
};

/// Prepares the integrator and adds to the film the passes of the budget that it does not hold yet, in rising order. A
/// film that already holds passes must come from the same scene, seed and integrator, and its passes must be of the
/// budget, which counts them too. Extra channels of the film are those that `FilmChannels` (aov.h) names. Passes run
/// one after another, each parallel in itself. `secondsBefore` were spent on this render already (on choosing the
/// integrator) and count as preparation, toward the budget too. Errors of the integrator are passed on.
RenderResult Render(const Scene& scene, uint64_t seed, Integrator& integrator, Film& film, const RenderBudget& budget,
                    const RenderHooks& hooks = {}, double secondsBefore = 0);

}  // namespace dapple
