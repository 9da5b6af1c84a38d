#include "src/render/convergence_data.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace dapple {

namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMeasures = kErrorMeasures.size();

/// The snapshot of that time, or null.
const MeasuredSnapshot* FindSnapshot(const SeedRun& run, int timeIndex) {
  for (const MeasuredSnapshot& snapshot : run.snapshots)
    if (snapshot.timeIndex == timeIndex) return &snapshot;
  return nullptr;
}

/// One point of the mean curve; nothing where a seed has no snapshot of that time.
std::optional<CurvePoint> PointAt(const std::vector<SeedRun>& seeds, int timeIndex) {
  CurvePoint point;
  point.timeIndex = timeIndex;
  point.low.fill(std::numeric_limits<double>::infinity());
  double logSeconds = 0, logPasses = 0;
  const auto count = static_cast<double>(seeds.size());
  for (const SeedRun& run : seeds) {
    const MeasuredSnapshot* const snapshot = FindSnapshot(run, timeIndex);
    if (!snapshot) return std::nullopt;
    logSeconds += std::log(snapshot->seconds) / count;
    logPasses += std::log(snapshot->passes) / count;
    for (size_t m = 0; m < kMeasures; ++m) {
      point.mean[m] += snapshot->errors[m] / count;
      point.low[m] = std::min(point.low[m], snapshot->errors[m]);
      point.high[m] = std::max(point.high[m], snapshot->errors[m]);
    }
  }
  point.seconds = std::exp(logSeconds);
  point.passes = std::exp(logPasses);
  return point;
}

/// NaN and infinity become null.
Json Number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json ToJson(const MeasuredErrors& errors) {
  Json json;
  for (size_t m = 0; m < kMeasures; ++m) json[std::string(kErrorMeasures[m].key)] = Number(errors[m]);
  return json;
}

Json ToJson(const std::optional<SlopeEstimate>& slope) {
  if (!slope) return nullptr;
  return {{"slope", slope->slope},
          {"halfWidth", slope->halfWidth ? Json(*slope->halfWidth) : Json()},
          {"seeds", slope->seeds}};
}

Json ToJson(const ReachTime& time) {
  static constexpr const char* kNames[] = {"measured", "atMost", "extrapolated", "never"};
  return {{"kind", kNames[static_cast<size_t>(time.kind)]},
          {"seconds", time.kind == ReachTime::Kind::Never ? Json() : Json(time.seconds)}};
}

Json ToJson(const CurvePoint& point) {
  return {{"timeIndex", point.timeIndex}, {"seconds", point.seconds}, {"passes", point.passes},
          {"mean", ToJson(point.mean)},   {"low", ToJson(point.low)}, {"high", ToJson(point.high)}};
}

Json ToJson(const SeedRun& run) {
  Json json = {{"seed", run.seed},       {"prepareSeconds", run.prepareSeconds},
               {"seconds", run.seconds}, {"snapshotSeconds", run.snapshotSeconds},
               {"passes", run.passes},   {"snapshots", Json::array()}};
  for (const MeasuredSnapshot& snapshot : run.snapshots)
    json["snapshots"].push_back({{"timeIndex", snapshot.timeIndex},
                                 {"seconds", snapshot.seconds},
                                 {"passes", snapshot.passes},
                                 {"errors", ToJson(snapshot.errors)}});
  return json;
}

std::vector<double> SecondsOf(const std::vector<CurvePoint>& curve) {
  std::vector<double> seconds;
  for (const CurvePoint& point : curve) seconds.push_back(point.seconds);
  return seconds;
}

Json ToJson(const Contender& contender, const SceneConvergence& scene) {
  Json json = {{"name", contender.name}, {"integrator", contender.integrator}, {"strategy", contender.strategy},
               {"curve", Json::array()}, {"slopes", Json::object()},           {"timeToBest", Json::object()},
               {"seeds", Json::array()}};
  const std::vector<CurvePoint> curve = MeanCurve(contender.seeds);
  for (const CurvePoint& point : curve) json["curve"].push_back(ToJson(point));
  for (const SeedRun& run : contender.seeds) json["seeds"].push_back(ToJson(run));
  for (size_t m = 0; m < kMeasures; ++m) {
    const std::string key(kErrorMeasures[m].key);
    const ConvergenceSlopes slopes = FitSlopes(contender.seeds, m, scene.reference.errors);
    json["slopes"][key] = {{"time", ToJson(slopes.overTime)}, {"passes", ToJson(slopes.overPasses)}};
    if (curve.empty()) continue;
    std::vector<double> errors;
    for (const CurvePoint& point : curve) errors.push_back(point.mean[m]);
    const std::optional<double> slope = slopes.overTime ? std::optional(slopes.overTime->slope) : std::nullopt;
    json["timeToBest"][key] = ToJson(TimeToReach(SecondsOf(curve), errors, BestFinalError(scene.contenders, m), slope));
  }
  return json;
}

Json ToJson(const SceneConvergence& scene) {
  Json json = {{"name", scene.name},
               {"file", scene.file},
               {"width", scene.width},
               {"height", scene.height},
               {"seconds", scene.seconds},
               {"reference",
                {{"source", scene.reference.source},
                 {"errors", scene.reference.errors ? ToJson(*scene.reference.errors) : Json()},
                 {"errorSource", scene.reference.errorSource}}},
               {"contenders", Json::array()}};
  for (const Contender& contender : scene.contenders) json["contenders"].push_back(ToJson(contender, scene));
  return json;
}

}  // namespace

std::vector<CurvePoint> MeanCurve(const std::vector<SeedRun>& seeds) {
  std::vector<CurvePoint> curve;
  if (seeds.empty()) return curve;
  for (const MeasuredSnapshot& snapshot : seeds.front().snapshots)
    if (const auto point = PointAt(seeds, snapshot.timeIndex)) curve.push_back(*point);
  return curve;
}

ConvergenceSlopes FitSlopes(const std::vector<SeedRun>& seeds, size_t measure,
                            const std::optional<MeasuredErrors>& referenceErrors) {
  constexpr size_t kFewest = 3;
  const double ofReference = referenceErrors ? (*referenceErrors)[measure] : 0;
  const double least = std::isfinite(ofReference) ? 4 * ofReference : 0;
  std::vector<double> overTime, overPasses;
  for (const SeedRun& run : seeds) {
    std::vector<double> seconds, passes, errors;
    for (const MeasuredSnapshot& snapshot : run.snapshots) {
      const double error = snapshot.errors[measure];
      if (!(error > 0) || error < least) continue;
      seconds.push_back(snapshot.seconds);
      passes.push_back(snapshot.passes);
      errors.push_back(error);
    }
    if (errors.size() < kFewest) continue;
    if (const auto slope = LogLogSlope(seconds, errors)) overTime.push_back(*slope);
    if (const auto slope = LogLogSlope(passes, errors)) overPasses.push_back(*slope);
  }
  return {EstimateSlope(overTime), EstimateSlope(overPasses)};
}

double BestFinalError(const std::vector<Contender>& contenders, size_t measure) {
  double best = std::numeric_limits<double>::infinity();
  for (const Contender& contender : contenders) {
    const std::vector<CurvePoint> curve = MeanCurve(contender.seeds);
    if (!curve.empty()) best = std::min(best, curve.back().mean[measure]);
  }
  return best;
}

std::string ConvergenceToCsv(const std::vector<SceneConvergence>& scenes) {
  std::string csv = "scene,contender,integrator,strategy,seed,timeIndex,seconds,passes";
  for (const ErrorMeasure& measure : kErrorMeasures) csv += fmt::format(",{}", measure.key);
  csv += '\n';
  for (const SceneConvergence& scene : scenes) {
    for (const Contender& contender : scene.contenders) {
      for (const SeedRun& run : contender.seeds) {
        for (const MeasuredSnapshot& snapshot : run.snapshots) {
          // Names of files may hold commas and quotes.
          std::string name = scene.name;
          for (size_t i = 0; (i = name.find('"', i)) != std::string::npos; i += 2) name.insert(i, 1, '"');
          csv += fmt::format("\"{}\",{},{},{},{},{},{},{}", name, contender.name, contender.integrator,
                             contender.strategy, run.seed, snapshot.timeIndex, snapshot.seconds, snapshot.passes);
          for (const double error : snapshot.errors) csv += fmt::format(",{}", error);
          csv += '\n';
        }
      }
    }
  }
  return csv;
}

std::string ConvergenceToMarkdown(const std::vector<SceneConvergence>& scenes, size_t measure) {
  std::vector<std::string> names;
  for (const SceneConvergence& scene : scenes) {
    for (const Contender& contender : scene.contenders)
      if (std::ranges::find(names, contender.name) == names.end()) names.push_back(contender.name);
  }
  std::string table = fmt::format("| {} |", kErrorMeasures[measure].name), rule = "|---|";
  for (const std::string& name : names) {
    table += fmt::format(" `{}` |", name);
    rule += "---|";
  }
  table += "\n" + rule + "\n";
  for (const SceneConvergence& scene : scenes) {
    const double best = BestFinalError(scene.contenders, measure);
    table += fmt::format("| `{}` |", scene.name);
    for (const std::string& name : names) {
      const auto contender = std::ranges::find(scene.contenders, name, &Contender::name);
      const auto curve = contender == scene.contenders.end() ? std::vector<CurvePoint>() : MeanCurve(contender->seeds);
      if (curve.empty()) {
        table += " - |";
        continue;
      }
      const double error = curve.back().mean[measure];
      table += error == best ? fmt::format(" **{:.2g}** |", error) : fmt::format(" {:.2g} |", error);
    }
    table += '\n';
  }
  return table;
}

Json ConvergenceToJson(const std::vector<SceneConvergence>& scenes, const Json& about) {
  Json json = {{"about", about}, {"measures", Json::array()}, {"scenes", Json::array()}};
  for (const ErrorMeasure& measure : kErrorMeasures)
    json["measures"].push_back({{"key", measure.key}, {"name", measure.name}, {"definition", measure.definition}});
  for (const SceneConvergence& scene : scenes) json["scenes"].push_back(ToJson(scene));
  return json;
}

}  // namespace dapple
