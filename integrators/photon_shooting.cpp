#include "integrators/photon_shooting.h"

#include <cmath>

#include "src/photons/emission_pilot.h"
#include "src/photons/work_pilot.h"

namespace dapple {

namespace {

int64_t Pixels(const Scene& scene) {
  const Vec2i& resolution = scene.Settings().resolution;
  return int64_t{resolution.x} * resolution.y;
}

/// Four to seven times a power of two: near enough to the balance that a slightly other scene costs only slightly more,
/// and still a few nets of light paths (sampler.h).
int64_t BalancedLightPaths(const Scene& scene, const PathWork& work) {
  constexpr double kMost = 1 << 22;  // photons must fit into memory
  const double ratio = std::clamp(work.camera / work.light, 0.25, 4.0);
  const double paths = std::clamp(static_cast<double>(Pixels(scene)) * ratio, 1024.0, kMost);
  const int64_t net = int64_t{1} << (std::ilogb(paths) - 2);
  return net * std::lround(paths / static_cast<double>(net));
}

/// A power of two.
int BalancedCameraSamples(const Scene& scene, int64_t paths, const PathWork& work) {
  constexpr double kMost = 16;
  const double cameraWork = static_cast<double>(Pixels(scene)) * work.camera;
  const double samples = std::clamp(static_cast<double>(paths) * work.light / cameraWork, 1.0, kMost);
  return 1 << std::lround(std::log2(samples));
}

struct PassSize {
  int64_t lightPaths = 0;
  int cameraSamples = 1;
};

PassSize SizeOfPass(const Scene& scene, const IntegratorOptions& options, const PathWork& work) {
  if (!options.photonsPerPass) return {BalancedLightPaths(scene, work), 1};
  return {*options.photonsPerPass, BalancedCameraSamples(scene, *options.photonsPerPass, work)};
}

/// There must be one scattering before a photon lands, and one where it is gathered.
bool CanGather(const Scene& scene, const IntegratorOptions& options) {
  return scene.Facts().CanUsePhotons() && options.maxDepth >= 2;
}

GatherRadius RadiusOf(const Scene& scene, const EmissionSampler& emission, int64_t paths,
                      const IntegratorOptions& options, bool causticsOnly, bool forecastsPhotons, uint64_t seed) {
  return {scene,
          emission,
          paths,
          {options.maxDepth, options.radiusScale, causticsOnly, options.radius, forecastsPhotons, seed}};
}

}  // namespace

int64_t LightPathsOfPass(const Scene& scene, const IntegratorOptions& options) {
  return options.photonsPerPass ? *options.photonsPerPass : Pixels(scene);
}

EmissionGuide GuideOf(const Scene& scene, const IntegratorOptions& options, int finalGathers, uint64_t seed) {
  if (!options.guideEmission) return {};
  if (options.guide && finalGathers == 0) return *options.guide;
  return LearnEmissionGuide(scene, options.maxDepth, finalGathers, seed);
}

PassForecast ForecastPhotonPass(const Scene& scene, const IntegratorOptions& options, int finalGathers, uint64_t seed) {
  // Light paths of pilots are of fixed number. Measured in a closed room of albedo 0.95, where they are long: 33 MB,
  // and with the pilot of a final gather 60 MB.
  constexpr int64_t kPilotBytes = 36'000'000, kPilotBytesOfFinalGather = 66'000'000;
  PassForecast forecast;
  if (!CanGather(scene, options)) return forecast;
  const PathWork work = EstimateWork(scene, EmissionSampler(scene), options.maxDepth, finalGathers, seed);
  const PassSize size = SizeOfPass(scene, options, work);
  forecast.lightPaths = size.lightPaths;
  forecast.cameraSamples = size.cameraSamples;
  forecast.pilot = work.pilot;
  forecast.storesPhotons = true;
  forecast.pilotBytes = finalGathers > 0 ? kPilotBytesOfFinalGather : kPilotBytes;
  if (options.guideEmission) forecast.pilotBytes += EmissionPilotBytes(scene);
  return forecast;
}

PhotonPlan::PhotonPlan(const Scene& scene, const IntegratorOptions& options, const PhotonUse& use, uint64_t seed)
    : isNeeded(CanGather(scene, options)),
      emission(scene, isNeeded ? GuideOf(scene, options, use.finalGathers, seed) : EmissionGuide()) {
  if (!isNeeded) return;
  const PathWork work = EstimateWork(scene, emission, options.maxDepth, use.finalGathers, seed);
  const PassSize size = SizeOfPass(scene, options, work);
  paths = size.lightPaths;
  cameraSamples = size.cameraSamples;
  radius = RadiusOf(scene, emission, paths, options, false, use.forecastsPhotons, seed);
  pilots = emission.Guide().Pilot() + work.pilot + radius.Pilot();
}

PreparationUse PhotonPlan::Use() const {
  if (!isNeeded) return {};
  return {TableUse::Of(emission.Guide().MemoryBytes()) + TableUse::Of(radius.MemoryBytes()), pilots};
}

GatherRadius CausticRadius(const PhotonPlan& plan, const Scene& scene, const IntegratorOptions& options,
                           uint64_t seed) {
  return RadiusOf(scene, plan.emission, plan.paths, options, true, false, seed);
}

}  // namespace dapple
