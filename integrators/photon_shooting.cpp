#include "integrators/photon_shooting.h"

#include "src/photons/emission_pilot.h"

namespace dapple {

int64_t LightPathsOfPass(const Scene& scene, const IntegratorOptions& options) {
  const Vec2i& resolution = scene.Settings().resolution;
  return options.photonsPerPass ? *options.photonsPerPass : int64_t{resolution.x} * resolution.y;
}

PhotonPlan::PhotonPlan(const Scene& scene, const IntegratorOptions& options, uint64_t seed)
    : emission(scene, options.guideEmission ? LearnEmissionGuide(scene, options.maxDepth, seed) : EmissionGuide()),
      paths(LightPathsOfPass(scene, options)),
      radius(scene, emission, paths, {options.maxDepth, options.radiusScale, options.radius, seed}) {}

}  // namespace dapple
