#include "src/photons/work_pilot.h"

#include "src/base/hash.h"
#include "src/photons/camera_pilot.h"
#include "src/photons/light_path.h"

namespace dapple {

namespace {

constexpr int kPaths = 4096;
// In segments, as bench/photon_map_bench and bench/integrator_bench time them: to put a photon into the map, to gather.
constexpr double kStore = 0.5, kGather = 1.5;

double LightWork(const Scene& scene, const EmissionSampler& emission, int maxDepth, uint64_t seed) {
  const auto chunks = ForEachLightPath<double>(
      emission, seed, 0, kPaths, [&](const EmissionSample& emitted, const Sampler& sampler, double& work) {
        const LightPathEnd end = TraceLightPath(scene, emitted, sampler, maxDepth, [&](const LightVertex& v) {
          if (v.scattered > 0 && !v.bsdf.IsPurelySpecular()) work += kStore;
        });
        work += end.segments;
      });
  double sum = 0;
  for (const double work : chunks) sum += work;
  return sum / kPaths;
}

double CameraWork(const Scene& scene, int finalGathers, uint64_t seed) {
  double work = 0;
  int64_t paths = 0;
  ForEachPilotRay(scene, kPaths, seed, [&](const CameraRay& camera, Sampler& sampler) {
    ++paths;
    // At a surface that gathers there are a shadow ray and one that runs into lights too.
    const auto visit = [&](const SurfaceInteraction&, const Bsdf&, float) { work += 2 + kGather; };
    work += FollowCameraPath(scene, camera, finalGathers, sampler, visit);
  });
  return work / static_cast<double>(std::max<int64_t>(paths, 1));
}

}  // namespace

PathWork EstimateWork(const Scene& scene, const EmissionSampler& emission, int maxDepth, int finalGathers,
                      uint64_t seed) {
  constexpr uint64_t kPilot = 4;
  const uint64_t own = Hash(seed, kPilot);
  // A path that leaves no light at all costs something too.
  return {std::max(1.0, LightWork(scene, emission, maxDepth, own)), std::max(1.0, CameraWork(scene, finalGathers, own)),
          kPaths};
}

}  // namespace dapple
