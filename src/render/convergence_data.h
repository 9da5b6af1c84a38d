// What a comparison of convergence found, from measured snapshots to curves, slopes and times, and as files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "src/render/error_measures.h"
#include "src/render/slope_fit.h"

namespace dapple {

/// A snapshot of one seed, measured.
struct MeasuredSnapshot {
  int timeIndex = 0;
  double seconds = 0;
  int passes = 0;
  MeasuredErrors errors{};
};

/// One run of a contender with one seed.
struct SeedRun {
  int seed = 0;
  double prepareSeconds = 0, seconds = 0, snapshotSeconds = 0;
  int passes = 0;
  std::vector<MeasuredSnapshot> snapshots;
};

/// A snapshot time over the seeds: geometric means of seconds and passes, means of errors, and their range.
struct CurvePoint {
  int timeIndex = 0;
  double seconds = 0, passes = 0;
  MeasuredErrors mean{}, low{}, high{};
};

/// An algorithm with its strategies, as it is compared.
struct Contender {
  std::string name;        ///< unique in the comparison
  std::string integrator;  ///< as `MakeIntegrator` knows it
  std::string strategy;    ///< of environment lights; empty: the scene's own
  std::vector<SeedRun> seeds;
};

struct ReferenceInfo {
  std::string source;                    ///< where it comes from, in words
  std::optional<MeasuredErrors> errors;  ///< its own; NaN where a measure's is not known
  std::string errorSource;               ///< how they are known, or why not, in words
};

/// The comparison of one scene.
struct SceneConvergence {
  std::string name, file;
  int width = 0, height = 0;
  double seconds = 0;  ///< the budget
  ReferenceInfo reference;
  std::vector<Contender> contenders;
};

/// The snapshot times that all seeds have, ascending.
std::vector<CurvePoint> MeanCurve(const std::vector<SeedRun>& seeds);

/// Slopes of one measure against time and against passes, a slope a seed. Snapshots of which the reference's own error
/// makes more than a quarter are left out; seeds of fewer than three snapshots give no slope.
struct ConvergenceSlopes {
  std::optional<SlopeEstimate> overTime, overPasses;
};
ConvergenceSlopes FitSlopes(const std::vector<SeedRun>& seeds, size_t measure,
                            const std::optional<MeasuredErrors>& referenceErrors);

/// The least error that any of the contenders has in the end, by one measure; infinity where none has a curve.
double BestFinalError(const std::vector<Contender>& contenders, size_t measure);

/// A line for each snapshot, with a heading.
std::string ConvergenceToCsv(const std::vector<SceneConvergence>& scenes);

/// A table of final errors, a line a scene and a column a contender, as Markdown: means over the seeds, the best bold.
std::string ConvergenceToMarkdown(const std::vector<SceneConvergence>& scenes, size_t measure);

/// Everything: snapshots, curves, slopes, the times to reach the best one's error; `about` is what the caller tells of
/// program and machine.
nlohmann::ordered_json ConvergenceToJson(const std::vector<SceneConvergence>& scenes,
                                         const nlohmann::ordered_json& about);

}  // namespace dapple
