#include "src/render/statistics.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/render/json_text.h"

namespace dapple {

namespace {

/// What gave values that were found bad by the film alone.
const std::string kBeyondFilm = "values that the film refused";

}  // namespace

TableUse AllTables(const RenderNeeds& needs) {
  const SceneResources& scene = needs.scene;
  return scene.environmentTables + scene.lightTables + scene.choiceTables + needs.preparation.tables;
}

std::string StatisticsToJson(const RenderRecord& record, const RenderResult& result, const RenderNeeds& needs,
                             const Film& film, const std::optional<ErrorEstimate>& error) {
  const PassStats& stats = result.stats;
  const SceneResources& scene = needs.scene;
  nlohmann::ordered_json json = {
      {"scene", record.scene},
      {"integrator", record.integrator},
      {"seed", record.seed},
      {"passes", record.passes},
      {"version", record.version},
      {"instructionSet", record.instructionSet},
      {"seconds", result.seconds},
      {"prepareSeconds", result.prepareSeconds},
      {"rays",
       {{"camera", stats.cameraRays},
        {"shadow", stats.shadowRays},
        {"photon", stats.photonRays},
        {"probe", stats.probeRays},
        {"inPilots", needs.preparation.pilots.rays}}},
      {"photons",
       {{"emitted", stats.photonsEmitted},
        {"stored", stats.photonsStored},
        {"inPilots", needs.preparation.pilots.lightPaths}}},
      {"photonMaps", {{"built", stats.photonMaps}, {"bytes", stats.photonMapBytes}}},
      {"gathers", {{"count", stats.gathers}, {"photons", stats.photonsGathered}}},
      {"splats", stats.splats},
      {"tables",
       {{"environment", scene.environmentTables.count},
        {"lights", scene.lightTables.count},
        {"choice", scene.choiceTables.count},
        {"learned", needs.preparation.tables.count},
        {"bytes", AllTables(needs).bytes}}},
      {"textures", {{"opened", scene.images.opened}, {"bytes", scene.images.bytes}}},
      {"geometry", {{"bytes", scene.geometryBytes}}},
      {"nonFinite", film.NonFiniteCount()},
      {"nonFiniteSources", nlohmann::ordered_json::object()},
      {"error", nullptr},
  };
  for (const auto& [source, count] : film.NonFiniteBySource()) json["nonFiniteSources"][source] = count;
  if (film.RefusedCount() > 0) json["nonFiniteSources"][kBeyondFilm] = film.RefusedCount();
  if (error) {
    json["error"] = {{"total", error->Total()}, {"noise", error->noise}, {"bias", nullptr}};
    if (film.TracksBlur()) json["error"]["bias"] = error->bias;
  }
  return DumpJson(json, 2) + "\n";
}

std::string DescribeNonFinite(const Film& film) {
  std::string text;
  const auto add = [&](const std::string& source, int64_t count) {
    text += fmt::format("{}{} of {}", text.empty() ? "" : ", ", count, source);
  };
  for (const auto& [source, count] : film.NonFiniteBySource()) add(source, count);
  if (film.RefusedCount() > 0) add(kBeyondFilm, film.RefusedCount());
  return text;
}

}  // namespace dapple
