#include "src/render/statistics.h"

#include <nlohmann/json.hpp>

namespace dapple {

std::string StatisticsToJson(const RenderRecord& record, const RenderResult& result, const Film& film) {
  const PassStats& stats = result.stats;
  nlohmann::ordered_json json = {
      {"scene", record.scene},
      {"integrator", record.integrator},
      {"seed", record.seed},
      {"passes", record.passes},
      {"version", record.version},
      {"instructionSet", record.instructionSet},
      {"seconds", result.seconds},
      {"prepareSeconds", result.prepareSeconds},
      {"rays", {{"camera", stats.cameraRays}, {"shadow", stats.shadowRays}, {"photon", stats.photonRays}}},
      {"photons", {{"emitted", stats.photonsEmitted}, {"stored", stats.photonsStored}}},
      {"gathers", {{"count", stats.gathers}, {"photons", stats.photonsGathered}}},
      {"splats", stats.splats},
      {"nonFinite", film.NonFiniteCount()},
      {"noise", nullptr},
  };
  if (const auto noise = film.NoiseEstimate()) json["noise"] = *noise;
  return json.dump(2) + "\n";
}

}  // namespace dapple
