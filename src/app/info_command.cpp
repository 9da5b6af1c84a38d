// `dapple info`: what a scene holds, how it would be rendered and why, what that needs and what it can skip.
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/app/command.h"
#include "src/app/format.h"
#include "src/app/memory.h"
#include "src/app/scene_options.h"
#include "src/base/parallel.h"
#include "src/sampling/seed.h"

namespace dapple {

namespace {

/// One line under a heading of the first column; only the first line of a heading names it.
void PrintLine(std::string_view heading, const std::string& text) { fmt::print("{:<10}{}\n", heading, text); }

std::string LightsByKind(const Scene& scene) {
  std::map<std::string_view, int64_t> kinds;
  for (const auto& light : scene.Lights()) ++kinds[light->Name()];
  std::vector<std::string> parts;
  for (const auto& [kind, count] : kinds) parts.push_back(fmt::format("{} {}", count, kind));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Each with the number that names it, as many as one cares to read.
void PrintLights(const Scene& scene) {
  constexpr size_t kMost = 12;
  const size_t count = scene.Lights().size(), shown = std::min(count, kMost);
  for (size_t i = 0; i < shown; ++i) {
    const Light& light = *scene.Lights()[i];
    const Color power = light.Power();
    PrintLine("",
              fmt::format("light {}: {}, power {:.4g} {:.4g} {:.4g} W", i, light.Name(), power.r, power.g, power.b));
  }
  if (count > shown) PrintLine("", fmt::format("and {} more", count - shown));
}

std::string DescribeSurfaces(const SceneFacts& facts) {
  std::vector<std::string> parts;
  if (facts.hasSpecular) parts.emplace_back("smooth mirrors, metals or glass");
  if (facts.hasNonSpecular && facts.minRoughness < 1) {
    parts.push_back(fmt::format("rough ones (from {:.3g} on)", facts.minRoughness));
  } else if (facts.hasNonSpecular) {
    parts.emplace_back("diffuse ones");
  }
  if (parts.empty()) return "none that scatters light";
  return fmt::format("{}{}", fmt::join(parts, ", "), facts.hasTransmission ? "; light passes through some" : "");
}

void PrintContents(const Scene& scene) {
  const SceneFacts& facts = scene.Facts();
  PrintLine("geometry", fmt::format("{}, {}, {}", FormatNumberOf(facts.shapes, "shape", "shapes"),
                                    FormatNumberOf(facts.primitives, "primitive", "primitives"),
                                    FormatNumberOf(facts.instances, "instance", "instances")));
  PrintLine("lights", facts.EmitsLight() ? LightsByKind(scene) : "none: the picture will be black");
  PrintLights(scene);
  PrintLine("surfaces", DescribeSurfaces(facts));
}

void PrintPlan(const Scene& scene, const RenderPlan& plan) {
  const RenderSettings& settings = scene.Settings();
  const Vec2i size(settings.crop.Width(), settings.crop.Height());
  const bool isCropped = size != settings.resolution;
  PrintLine("picture", fmt::format("{} x {} pixels{}", settings.resolution.x, settings.resolution.y,
                                   isCropped ? fmt::format(", of which {} x {} are rendered", size.x, size.y) : ""));
  PrintLine("algorithm", fmt::format("{}: {}", plan.choice.name, plan.choice.reason));
  PrintLine("budget",
            plan.budget.seconds
                ? fmt::format("{} ({})", FormatDuration(*plan.budget.seconds), plan.budgetReason)
                : fmt::format("{} ({})", FormatNumberOf(*plan.budget.passes, "pass", "passes"), plan.budgetReason));
  PrintLine("depth", fmt::format("{} on a path",
                                 FormatNumberOf(plan.options.maxDepth, "scattering event", "scattering events")));
}

/// `loadedBytes`: the most that loading the scene took.
void PrintNeeds(const Scene& scene, const PassForecast& forecast, int64_t loadedBytes) {
  const auto pixels = static_cast<double>(scene.Settings().crop.Area());
  std::string work = fmt::format("a pass has {} camera paths", FormatCount(forecast.cameraSamples * pixels));
  if (forecast.lightPaths > 0)
    work += fmt::format(" and about {} light paths", FormatCount(static_cast<double>(forecast.lightPaths)));
  PrintLine("needs", work);
  constexpr double kFilmBytesPerPixel = 2 * Color::kComponents * sizeof(FixedPoint);  // two halves, see film.h
  PrintLine("", fmt::format("{} for the film; the scene, loaded, took {}", FormatBytes(kFilmBytesPerPixel * pixels),
                            FormatBytes(static_cast<double>(loadedBytes))));
}

void PrintSkips(const Scene& scene, const Integrator& integrator, const PassForecast& forecast) {
  const SceneFacts& facts = scene.Facts();
  std::vector<std::string> skips;
  if (forecast.lightPaths == 0)
    skips.push_back(fmt::format("photons and photon maps: {}",
                                integrator.EstimatesDensity() ? "none could come to anything here"
                                                              : "the algorithm follows paths from the camera only"));
  if (facts.blackLights > 0) {
    skips.push_back(fmt::format("{} that emit nothing", FormatNumberOf(facts.blackLights, "light", "lights")));
  }
  if (!facts.hasInfiniteLight)
    skips.emplace_back("an environment and its tables: rays that leave the scene find nothing");
  if (!facts.hasAreaLight) skips.emplace_back("tables of area lights: there are none");
  if (!facts.MayHaveCaustics()) skips.emplace_back("caustics: nothing here could throw or catch one");
  for (size_t i = 0; i < skips.size(); ++i) PrintLine(i == 0 ? "skips" : "", skips[i]);
}

int RunInfo(const SceneOptions& options) {
  const ThreadLimit threads(options.threads);
  Diagnostics diagnostics(Tell);
  const LoadedScene loaded = Load(options, diagnostics);
  const int64_t loadedBytes = PeakMemoryBytes();
  const RenderPlan plan = MakePlan(*loaded.scene, options, diagnostics);
  WarnOfUnused(options, {plan.choice.name}, diagnostics);
  const PassForecast forecast = plan.integrator->Forecast(*loaded.scene, SeedFrom(plan.seed));
  PrintLine("scene", options.scene);
  PrintLine("format", fmt::format("pbrt version {}: {}", loaded.version, loaded.versionReason));
  PrintContents(*loaded.scene);
  PrintPlan(*loaded.scene, plan);
  PrintNeeds(*loaded.scene, forecast, loadedBytes);
  PrintSkips(*loaded.scene, *plan.integrator, forecast);
  return kExitSuccess;
}

}  // namespace

void AddInfoCommand(CLI::App& program, Action* action) {
  CLI::App* const command = program.add_subcommand("info", "Say what a scene holds and how it would be rendered");
  const auto options = std::make_shared<SceneOptions>();
  options->AddTo(command);
  command->callback([options, action] {
    RequireDirect(*options, {options->integrator});
    *action = [options] { return RunInfo(*options); };
  });
}

}  // namespace dapple
