#include "src/photons/emission_pilot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/base/hash.h"
#include "src/base/parallel.h"
#include "src/photons/light_path.h"
#include "src/photons/photon_map.h"

namespace dapple {

namespace {

/// Points that the camera looks at; each stands for the surface within its reach.
struct VisiblePoints {
  PhotonMap<float> reaches;
  float maxReach = 0;

  bool IsNear(const Vec3& p) const {
    bool isNear = false;
    reaches.ForEachWithin(p, maxReach, [&](const Vec3&, float reach, float distanceSquared) {
      isNear |= distanceSquared < reach * reach;
    });
    return isNear;
  }
};

void FollowCameraPath(const Scene& scene, const CameraRay& camera, float pixels, Sampler& sampler,
                      std::vector<Vec3>* points, std::vector<float>* reaches) {
  constexpr int kMaxBounces = 8;
  Ray ray = camera.ray;
  float distance = 0;
  for (int bounce = 1; bounce <= kMaxBounces; ++bounce) {
    const std::optional<SurfaceInteraction> hit = scene.Intersect(ray);
    if (!hit) return;
    distance += hit->t;
    const Material* material = scene.MaterialAt(*hit);
    if (!material) {
      ray = SpawnRay(*hit, ray.d);
      continue;
    }
    const Bsdf bsdf = material->GetBsdf(*hit);
    if (!bsdf.IsPurelySpecular() && !bsdf.IsBlack()) {
      points->push_back(hit->p);
      // What lies between this point and those of the next paths, seen at a slant.
      constexpr float kMinCosine = 0.2f;
      const float width = pixels * (camera.footprintAtLens + camera.footprintSpread * distance);
      reaches->push_back(width / std::max(kMinCosine, AbsDot(hit->ng, hit->wo)));
    }
    if (bsdf.Flags().HasDiffuse()) return;
    sampler.StartBlock(bounce);
    const double uLobe = sampler.Get1D();
    const std::optional<BsdfSample> next = bsdf.Sample(hit->wo, uLobe, sampler.Get2D(), TransportMode::Radiance);
    if (!next) return;
    ray = SpawnRay(*hit, next->wi);
  }
}

VisiblePoints FindVisiblePoints(const Scene& scene, uint64_t seed) {
  constexpr double kPaths = 8192;
  // Of the whole picture, so that a crop of it is lit by the same photons.
  const Vec2i& resolution = scene.Settings().resolution;
  const double step = std::max(1.0, std::sqrt(static_cast<double>(resolution.x) * resolution.y / kPaths));
  std::vector<Vec3> points;
  std::vector<float> reaches;
  int64_t path = 0;
  for (double y = step / 2; y < resolution.y; y += step)
    for (double x = step / 2; x < resolution.x; x += step) {
      Sampler sampler = Sampler::ForLightPath(seed, path++, 0, static_cast<int64_t>(kPaths));
      const Vec2d uLens = sampler.Get2D();
      const CameraRay camera =
          scene.GetCamera().GenerateRay({static_cast<float>(x), static_cast<float>(y)}, uLens, sampler.Get1D());
      FollowCameraPath(scene, camera, static_cast<float>(step), sampler, &points, &reaches);
    }
  if (points.empty()) return {};
  // Far points would reach over all others.
  std::vector<float> sorted = reaches;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<int64_t>(sorted.size() / 2), sorted.end());
  const float longest = 4 * sorted[sorted.size() / 2];
  VisiblePoints visible;
  for (float& reach : reaches) {
    reach = std::min(reach, longest);
    visible.maxReach = std::max(visible.maxReach, reach);
  }
  visible.reaches = PhotonMap<float>(std::move(points), reaches);
  return visible;
}

PilotPhoton TracePilotPhoton(const Scene& scene, const EmissionSampler& emission, const VisiblePoints& visible,
                             Sampler sampler, int maxDepth) {
  const std::optional<EmissionSample> emitted = EmitPhoton(emission, sampler);
  if (!emitted) return {};
  int useful = 0;
  TraceLightPath(scene, *emitted, sampler, maxDepth, [&](const LightVertex& vertex) {
    useful += vertex.scattered > 0 && !vertex.bsdf.IsPurelySpecular() && visible.IsNear(vertex.hit.p);
  });
  return {emitted->light,       emitted->own.position, emitted->own.direction,
          emitted->le.deltaPos, emitted->le.deltaDir,  useful / emitted->bend};
}

}  // namespace

EmissionGuide LearnEmissionGuide(const Scene& scene, int maxDepth, uint64_t seed) {
  if (scene.Lights().empty()) return {};
  constexpr uint64_t kPilot = 2;
  const VisiblePoints visible = FindVisiblePoints(scene, Hash(seed, kPilot));
  if (visible.maxReach == 0) return {};

  std::vector<double> power;
  for (const auto& light : scene.Lights()) power.push_back(static_cast<double>(light->Power().MaxComponent()));
  std::vector<PilotPhoton> pilot;
  EmissionGuide guide;
  constexpr int64_t kRounds[] = {1 << 15, 1 << 15, 1 << 16};
  for (uint64_t round = 0; round < std::size(kRounds); ++round) {
    const EmissionSampler emission(scene, guide);
    const int64_t photons = kRounds[round];
    const size_t first = pilot.size();
    pilot.resize(first + static_cast<size_t>(photons));
    ParallelForChunks(photons, 1024, [&](int64_t begin, int64_t end) {
      for (int64_t i = begin; i < end; ++i) {
        const Sampler sampler = Sampler::ForLightPath(Hash(seed, kPilot, round), i, 0, photons);
        pilot[first + static_cast<size_t>(i)] = TracePilotPhoton(scene, emission, visible, sampler, maxDepth);
      }
    });
    guide = EmissionGuide(power, pilot);
  }
  return guide;
}

}  // namespace dapple
