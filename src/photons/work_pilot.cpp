#include "src/photons/work_pilot.h"

#include "src/base/hash.h"
#include "src/photons/camera_pilot.h"
#include "src/photons/light_path.h"

namespace dapple {

namespace {

constexpr int kPaths = 4096;
// In segments, as bench/photon_map_bench and bench/integrator_bench time them: to put a photon into the map, to gather.
constexpr double kStore = 0.5, kGather = 1.5;

struct Counted {
  int64_t paths = 0, segments = 0;
  double others = 0;  ///< work beside the segments

  /// Of a path; one that leaves no light at all costs something too.
  double Work() const {
    const double all = static_cast<double>(segments) + others;
    return std::max(1.0, all / static_cast<double>(std::max<int64_t>(paths, 1)));
  }
};

Counted CountLightPaths(const Scene& scene, const EmissionSampler& emission, int maxDepth, uint64_t seed) {
  Counted sum;
  sum.paths = kPaths;
  ForEachLightPath<Counted>(
      emission, seed, 0, kPaths,
      [&](const EmissionSample& emitted, const Sampler& sampler, Counted& chunk) {
        const LightPathEnd end = TraceLightPath(scene, emitted, sampler, maxDepth, [&](const LightVertex& v) {
          if (v.scattered > 0 && !v.bsdf.IsPurelySpecular()) chunk.others += kStore;
        });
        chunk.segments += end.segments;
      },
      [&](const Counted& chunk, int64_t) {
        sum.segments += chunk.segments;
        sum.others += chunk.others;
      });
  return sum;
}

Counted CountCameraPaths(const Scene& scene, int finalGathers, uint64_t seed) {
  Counted sum;
  ForEachPilotRay(scene, kPaths, seed, [&](const CameraRay& camera, Sampler& sampler) {
    ++sum.paths;
    // At a surface that gathers there are a shadow ray and one that runs into lights too.
    const auto visit = [&](const SurfaceInteraction&, const Bsdf&, float) { sum.others += 2 + kGather; };
    sum.segments += FollowCameraPath(scene, camera, finalGathers, sampler, visit);
  });
  return sum;
}

}  // namespace

PathWork EstimateWork(const Scene& scene, const EmissionSampler& emission, int maxDepth, int finalGathers,
                      uint64_t seed) {
  constexpr uint64_t kPilot = 4;
  const uint64_t own = Hash(seed, kPilot);
  const Counted light = CountLightPaths(scene, emission, maxDepth, own);
  const Counted camera = CountCameraPaths(scene, finalGathers, own);
  return {light.Work(), camera.Work(), {kPaths, light.segments + camera.segments}};
}

}  // namespace dapple
