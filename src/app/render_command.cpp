// `dapple render`: reads a scene, renders it within a budget, writes the picture.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Option.hpp>
#include <fmt/ranges.h>

#include "src/app/command.h"
#include "src/app/format.h"
#include "src/app/memory.h"
#include "src/app/progress_display.h"
#include "src/app/render_outputs.h"
#include "src/app/scene_options.h"
#include "src/app/signals.h"
#include "src/base/parallel.h"
#include "src/image/atomic_file.h"
#include "src/render/driver.h"
#include "src/render/statistics.h"

namespace dapple {

namespace {

struct RenderOptions : SceneOptions {
  std::vector<std::string> outputs;
  std::string statistics;
  bool isQuiet = false;
  bool recordsSeconds = false;
};

/// In the current folder: the name that the scene's film gives, or the scene's own, as an EXR file; for a range of
/// passes with the range, as the exact sums.
std::string DefaultOutput(const RenderOptions& options, const RenderSettings& settings) {
  const std::filesystem::path named = std::filesystem::path(settings.outputFile).filename();
  const std::string name = named.empty() ? SceneName(options.scene) : named.stem().string();
  if (options.isPart) return fmt::format("{}.{}-{}.dapple", name, options.passes->begin, options.passes->end);
  return name + ".exr";
}

std::string Rate(int64_t count, double seconds) {
  return FormatCount(static_cast<double>(count) / std::max(seconds, 1e-9)) + "/s";
}

void PrintStart(const RenderOptions& options, const Scene& scene, const RenderPlan& plan) {
  const Vec2i& resolution = scene.Settings().resolution;
  fmt::print(stderr, "{}: {} x {}, {} ({}), {}\n", options.scene, resolution.x, resolution.y, plan.choice.name,
             plan.choice.reason, FormatNumberOf(ThreadCount(), "thread", "threads"));
}

void PrintNeeds(const RenderNeeds& needs, const PassStats& stats) {
  const auto bytes = [](int64_t n) { return FormatBytes(static_cast<double>(n)); };
  const SceneResources& scene = needs.scene;
  const TableUse tables = AllTables(needs);
  fmt::print("held      geometry {}; {} ({}); {} ({})", bytes(scene.geometryBytes),
             FormatNumberOf(tables.count, "table", "tables"), bytes(tables.bytes),
             FormatNumberOf(scene.images.opened, "image file", "image files"), bytes(scene.images.bytes));
  if (stats.photonMaps > 0) fmt::print("; a photon map of up to {}", bytes(stats.photonMapBytes));
  fmt::print("\n");
}

void PrintSummary(const RenderResult& result, const RenderNeeds& needs, const Film& film) {
  const PassStats& stats = result.stats;
  const auto count = [](int64_t n) { return FormatCount(static_cast<double>(n)); };
  fmt::print("{} in {} (of which preparation {})\n", FormatNumberOf(result.passes, "pass", "passes"),
             FormatDuration(result.seconds), FormatDuration(result.prepareSeconds));
  fmt::print("rays      {} ({}): {} camera, {} shadow, {} photon, {} probe\n", count(stats.Rays()),
             Rate(stats.Rays(), result.seconds), count(stats.cameraRays), count(stats.shadowRays),
             count(stats.photonRays), count(stats.probeRays));
  if (stats.photonsEmitted > 0) {
    fmt::print("photons   {} emitted ({}), {} stored; {} more in pilots\n", count(stats.photonsEmitted),
               Rate(stats.photonsEmitted, result.seconds), count(stats.photonsStored),
               count(needs.preparation.pilotPaths));
  }
  if (stats.gathers > 0) {
    fmt::print("gathers   {}, {:.3g} photons each\n", count(stats.gathers),
               static_cast<double>(stats.photonsGathered) / static_cast<double>(stats.gathers));
  }
  if (stats.splats > 0) fmt::print("splats    {}\n", count(stats.splats));
  if (const auto noise = film.NoiseEstimate()) fmt::print("noise     relative MSE about {:.2g}\n", *noise);
  PrintNeeds(needs, stats);
  fmt::print("memory    {} at its peak\n", FormatBytes(static_cast<double>(PeakMemoryBytes())));
}

/// A picture of fewer samples than were paid for must not go unnoticed, however quiet the render.
void WarnOfNonFinite(const Film& film) {
  if (film.NonFiniteCount() == 0) return;
  fmt::print(stderr, "warning: {} left out: infinite, not a number, or too large\n",
             FormatNumberOf(film.NonFiniteCount(), "sample was", "samples were"));
}

RenderOrigin MakeOrigin(const RenderOptions& options, const LoadedScene& loaded, const RenderPlan& plan) {
  const RenderSettings& settings = loaded.scene->Settings();
  RenderOrigin origin;
  origin.identity = MakeIdentity(loaded.contentHash, settings, plan.choice.name, plan.options, plan.seed);
  origin.record.scene = std::filesystem::path(options.scene).filename().string();
  origin.record.integrator = plan.choice.name;
  origin.record.seed = plan.seed;
  origin.exposure = settings.exposure;
  return origin;
}

RenderRecord MakeRecord(const RenderOptions& options, const RenderPlan& plan, const RenderOrigin& origin,
                        const RenderResult& result, const Film& film) {
  RenderRecord record = origin.record;
  record.passes = static_cast<int>(film.PassCount());
  if (plan.budget.seconds || options.recordsSeconds) record.seconds = result.seconds;
  return record;
}

RenderResult RenderWithProgress(const Scene& scene, const RenderPlan& plan, const StopSignals& signals, bool isQuiet,
                                Film& film) {
  RenderHooks hooks;
  hooks.stop = &signals.Flag();
  std::optional<ProgressDisplay> display;
  if (!isQuiet) {
    display.emplace();
    hooks.onProgress = [&](const RenderProgress& progress) { display->Show(progress); };
  }
  const auto seed = static_cast<uint64_t>(int64_t{plan.seed});
  return Render(scene, seed, *plan.integrator, film, plan.budget, hooks);
}

int RunRender(RenderOptions options) {
  for (const std::string& output : options.outputs) CheckRenderOutput(output);
  if (!options.statistics.empty()) CheckFolder(options.statistics);
  const ThreadLimit threads(options.threads);
  Diagnostics diagnostics([](const std::string& line) { fmt::print(stderr, "{}\n", line); });
  const LoadedScene loaded = Load(options, diagnostics);
  const Scene& scene = *loaded.scene;
  if (options.outputs.empty()) {
    options.outputs.push_back(DefaultOutput(options, scene.Settings()));
    CheckRenderOutput(options.outputs[0]);
  }
  const RenderPlan plan = MakePlan(scene, options, diagnostics);
  if (!scene.Facts().EmitsLight() && scene.Facts().blackLights > 0) {
    diagnostics.Warn(FileLocation(options.scene), "none of the lights emits anything; the image will be black");
  }
  const RenderOrigin origin = MakeOrigin(options, loaded, plan);
  const StopSignals signals;
  if (!options.isQuiet) PrintStart(options, scene, plan);
  Film film(scene.Settings().resolution, scene.Settings().crop, scene.Settings().filter);
  const RenderResult result = RenderWithProgress(scene, plan, signals, options.isQuiet, film);
  if (film.PassCount() == 0) {
    fmt::print(stderr, "stopped before the first pass; no picture is written\n");
    return 128 + signals.Signal();
  }
  const RenderRecord record = MakeRecord(options, plan, origin, result, film);
  WriteRenderOutputs(options.outputs, origin, record, film);
  if (!options.isQuiet) fmt::print("{}\n", fmt::join(options.outputs, "\n"));
  const RenderNeeds needs{scene.Resources(), plan.integrator->Preparation()};
  if (!options.statistics.empty())
    WriteFileAtomically(options.statistics, StatisticsToJson(record, result, needs, film));
  WarnOfNonFinite(film);
  if (!options.isQuiet) PrintSummary(result, needs, film);
  return result.stopped ? 128 + signals.Signal() : kExitSuccess;
}

}  // namespace

void AddRenderCommand(CLI::App& program, Action* action) {
  CLI::App* const command = program.add_subcommand("render", "Render a scene to an image file");
  const auto options = std::make_shared<RenderOptions>();
  command
      ->add_option("-o,--output", options->outputs,
                   "The picture: .exr (linear, all digits) or .png (sRGB); or .dapple, the exact sums for `dapple "
                   "merge`. May be given several times. By default the name that the scene gives, as .exr in the "
                   "current folder")
      ->allow_extra_args(false)
      ->type_name("FILE");
  options->AddTo(command);
  command->add_option("--stats", options->statistics, "Write what the render did (rays, photons, seconds) as JSON")
      ->type_name("FILE.json");
  command->add_flag("--record-seconds", options->recordsSeconds,
                    "Record in the file how long the render took, with --passes too; else the same seed and passes "
                    "give the same file");
  command->add_flag("--quiet", options->isQuiet, "No progress and no summary; warnings and errors only");
  command->callback([options, action] { *action = [options] { return RunRender(*options); }; });
}

}  // namespace dapple
