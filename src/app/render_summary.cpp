#include "src/app/render_summary.h"

#include <algorithm>
#include <string>

#include "src/app/format.h"
#include "src/app/memory.h"

namespace dapple {

namespace {

std::string Count(int64_t count) { return FormatCount(static_cast<double>(count)); }

std::string Bytes(int64_t bytes) { return FormatBytes(static_cast<double>(bytes)); }

std::string Rate(int64_t count, double seconds) {
  return FormatCount(static_cast<double>(count) / std::max(seconds, 1e-9)) + "/s";
}

std::string PassesLine(const RenderResult& result, const Film& film) {
  std::string text = fmt::format("{} in {} (of which preparation {})", FormatNumberOf(result.passes, "pass", "passes"),
                                 FormatDuration(result.seconds), FormatDuration(result.prepareSeconds));
  if (film.PassCount() > result.passes)
    text += fmt::format("; with those before, {}", FormatNumberOf(film.PassCount(), "pass", "passes"));
  return text + "\n";
}

std::string WorkLines(const RenderResult& result, const RenderNeeds& needs) {
  const PassStats& stats = result.stats;
  std::string text = fmt::format("rays      {} ({}): {} camera, {} shadow, {} photon, {} probe; {} more in pilots\n",
                                 Count(stats.Rays()), Rate(stats.Rays(), result.seconds), Count(stats.cameraRays),
                                 Count(stats.shadowRays), Count(stats.photonRays), Count(stats.probeRays),
                                 Count(needs.preparation.pilots.rays));
  if (stats.photonsEmitted > 0 || needs.preparation.pilots.lightPaths > 0) {
    text += fmt::format("photons   {} emitted ({}), {} stored; {} more in pilots\n", Count(stats.photonsEmitted),
                        Rate(stats.photonsEmitted, result.seconds), Count(stats.photonsStored),
                        Count(needs.preparation.pilots.lightPaths));
  }
  if (stats.gathers > 0) {
    text += fmt::format("gathers   {}, {:.3g} photons each\n", Count(stats.gathers),
                        static_cast<double>(stats.photonsGathered) / static_cast<double>(stats.gathers));
  }
  if (stats.splats > 0) text += fmt::format("splats    {}\n", Count(stats.splats));
  return text;
}

std::string HeldLine(const RenderNeeds& needs, const PassStats& stats) {
  const SceneResources& scene = needs.scene;
  const TableUse tables = AllTables(needs);
  std::string text =
      fmt::format("held      geometry {}; {} ({}); {} ({})", Bytes(scene.geometryBytes),
                  FormatNumberOf(tables.count, "table", "tables"), Bytes(tables.bytes),
                  FormatNumberOf(scene.images.opened, "image file", "image files"), Bytes(scene.images.bytes));
  if (stats.photonMaps > 0) text += fmt::format("; a photon map of up to {}", Bytes(stats.photonMapBytes));
  return text + "\n";
}

}  // namespace

void PrintSummary(const RenderResult& result, const RenderNeeds& needs, const Film& film,
                  const std::optional<ErrorEstimate>& error) {
  Print(PassesLine(result, film) + WorkLines(result, needs));
  if (error) Print(fmt::format("accuracy  {}\n", FormatError(*error, film.TracksBlur())));
  Print(HeldLine(needs, result.stats) + fmt::format("memory    {} at its peak\n", Bytes(PeakMemoryBytes())));
}

}  // namespace dapple
