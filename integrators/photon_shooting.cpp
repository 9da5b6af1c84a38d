#include "integrators/photon_shooting.h"

#include "src/photons/emission_pilot.h"

namespace dapple {

int64_t LightPathsOfPass(const Scene& scene, const IntegratorOptions& options) {
  const Vec2i& resolution = scene.Settings().resolution;
  return options.photonsPerPass ? *options.photonsPerPass : int64_t{resolution.x} * resolution.y;
}

PhotonPlan::PhotonPlan(const Scene& scene, const IntegratorOptions& options, uint64_t seed)
    // One scattering before the photon lands, one where it is gathered.
    : isNeeded(scene.Facts().CanUsePhotons() && options.maxDepth >= 2),
      emission(scene,
               isNeeded && options.guideEmission ? LearnEmissionGuide(scene, options.maxDepth, seed) : EmissionGuide()),
      paths(LightPathsOfPass(scene, options)),
      radius(scene, emission, isNeeded ? paths : 0, {options.maxDepth, options.radiusScale, options.radius, seed}) {}

PreparationUse PhotonPlan::Use() const {
  if (!isNeeded) return {};
  return {TableUse::Of(emission.Guide().MemoryBytes()) + TableUse::Of(radius.MemoryBytes()),
          emission.Guide().PilotPhotons() + GatherRadius::kPilotPaths};
}

}  // namespace dapple
