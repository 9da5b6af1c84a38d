#include "integrators/select.h"

#include <algorithm>

#include <fmt/format.h>

#include "integrators/photon_shooting.h"
#include "integrators/rare_light.h"

namespace dapple {

namespace {

/// By how much photons must lower the variance of a pass to be worth it: a pass with photons takes two to three times
/// as long (docs/performance.md).
constexpr double kCostOfPhotons = 3;

/// Surfaces rougher than this (GGX alpha) throw light as wide as diffuse ones, nearly.
constexpr float kPolished = 0.3f;

/// A light that covers a smaller share of all directions is small.
constexpr double kSmallShare = 0.05;

/// Why the scene's facts alone decide for paths; empty where they do not.
std::string_view WhyPathsFindAll(const SceneFacts& facts, int maxDepth) {
  if (!facts.EmitsLight()) return "nothing emits light";
  if (!facts.hasNonSpecular) return "no surface could receive photons";
  if (maxDepth < 2) return "direct light alone is asked for";
  if (facts.hasSpecular) return "";
  if (facts.minRoughness >= kPolished)
    return "no mirror, glass or polished surface throws light on another: no caustics";
  if (!facts.hasDeltaLight && facts.smallestLightShare >= kSmallShare)
    return "only large lights, and no smooth mirror or glass: no sharp caustics";
  return "";
}

/// As many rays a pass as so many camera paths a pixel take: quiet places then have a quarter of the mean at least.
constexpr int kCameraSamples = 4;

IntegratorChoice ChoosePath(std::string_view reason, const IntegratorOptions& options, const PilotUse& pilots = {}) {
  const int samples = options.cameraSamples.value_or(kCameraSamples);
  return {"path",
          fmt::format("{}; a pass takes as long as {} camera paths a pixel, of which noisy places get more", reason,
                      samples),
          nullptr, samples, pilots};
}

/// As few digits as tell.
std::string Digits(double x) { return x < 9.95 ? fmt::format("{:.2g}", x) : fmt::format("{:.0f}", x); }
std::string Percent(double share) { return share < 1e-4 ? "less than 0.01 %" : Digits(100 * share) + " %"; }

/// Where photons do not pay by less noise, but by light that paths never find.
std::string Finding(const RareLight& rare) {
  if (rare.lostShare > 0 && rare.Gain() < kCostOfPhotons)
    return fmt::format("by a pilot {} of the light seen comes in ways that no path finds", Percent(rare.lostShare));
  return fmt::format(
      "by a pilot {} of the light seen comes in ways that paths find seldom; photons lower the variance of a pass {} "
      "times",
      Percent(rare.share), Digits(rare.Gain()));
}

}  // namespace

IntegratorChoice SelectIntegrator(const Scene& scene, const IntegratorOptions& options, uint64_t seed) {
  if (const std::string_view why = WhyPathsFindAll(scene.Facts(), options.maxDepth); !why.empty())
    return ChoosePath(why, options);
  IntegratorOptions guided = options;
  guided.cameraSamples.reset();  // the pilot follows paths of its own
  guided.guide = std::make_shared<const EmissionGuide>(GuideOf(scene, options, 0, seed));
  const RareLight rare = FindRareLight(scene, guided, seed);
  const std::string finding = Finding(rare);
  const PilotUse withGuide = rare.pilot + guided.guide->Pilot();
  if (rare.share == 0)
    return ChoosePath("a pilot of light paths met no light that paths find seldom", options, withGuide);
  if (rare.lostShare == 0 && rare.Gain() < kCostOfPhotons)
    return ChoosePath(finding + ", less than they cost", options, withGuide);
  if (options.direct.technique != DirectTechnique::Mis)
    return {"sppm", finding + "; direct light is asked for by one technique alone", guided.guide, {}, rare.pilot};
  return {"hybrid", finding, guided.guide, {}, rare.pilot};
}

bool IsLeftToDapple(std::string_view requested, std::string_view fromScene) {
  if (!requested.empty()) return requested == "auto";
  const std::vector<std::string_view> known = IntegratorNames();
  return std::find(known.begin(), known.end(), fromScene) == known.end();
}

IntegratorChoice ResolveIntegrator(std::string_view requested, const Scene& scene, const IntegratorOptions& options,
                                   uint64_t seed) {
  const std::string& fromScene = scene.Settings().integrator;
  if (IsLeftToDapple(requested, fromScene)) return SelectIntegrator(scene, options, seed);
  if (requested.empty()) return {fromScene, "the scene asks for it", nullptr, {}};
  return {std::string(requested), "asked for", nullptr, {}};
}

}  // namespace dapple
