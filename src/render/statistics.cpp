#include "src/render/statistics.h"

#include <nlohmann/json.hpp>

namespace dapple {

TableUse AllTables(const RenderNeeds& needs) {
  const SceneResources& scene = needs.scene;
  return scene.environmentTables + scene.lightTables + scene.choiceTables + needs.preparation.tables;
}

std::string StatisticsToJson(const RenderRecord& record, const RenderResult& result, const RenderNeeds& needs,
                             const Film& film) {
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
        {"probe", stats.probeRays}}},
      {"photons",
       {{"emitted", stats.photonsEmitted},
        {"stored", stats.photonsStored},
        {"inPilots", needs.preparation.pilotPaths}}},
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
      {"noise", nullptr},
  };
  if (const auto noise = film.NoiseEstimate()) json["noise"] = *noise;
  return json.dump(2) + "\n";
}

}  // namespace dapple
