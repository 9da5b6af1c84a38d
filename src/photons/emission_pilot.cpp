#include "src/photons/emission_pilot.h"

#include <algorithm>
#include <cmath>

#include "src/base/hash.h"
#include "src/base/parallel.h"
#include "src/photons/camera_pilot.h"
#include "src/photons/light_path.h"
#include "src/photons/photon_map.h"

namespace dapple {

namespace {

constexpr uint64_t kPilot = 2;
constexpr int64_t kMostPhotons = 1 << 16;

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

VisiblePoints FindVisiblePoints(const Scene& scene, int finalGathers, uint64_t seed) {
  constexpr int kPaths = 8192;
  std::vector<Vec3> points;
  std::vector<float> reaches;
  const double step = ForEachPilotRay(scene, kPaths, seed, [&](const CameraRay& camera, Sampler& sampler) {
    FollowCameraPath(scene, camera, finalGathers, sampler,
                     [&](const SurfaceInteraction& hit, const Bsdf&, float distance) {
                       points.push_back(hit.p);
                       // What lies between this point and those of the next paths, seen at a slant; in pixels first.
                       constexpr float kMinCosine = 0.2f;
                       const float width = camera.footprintAtLens + camera.footprintSpread * distance;
                       reaches.push_back(width / std::max(kMinCosine, AbsDot(hit.ng, hit.wo)));
                     });
  });
  for (float& reach : reaches) reach *= static_cast<float>(step);
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

/// Whether the picture, or what a crop leaves out of it, shows the vertex.
bool IsInPicture(const Scene& scene, const LightVertex& vertex) {
  const std::optional<WiSample> join = scene.GetCamera().Sample_Wi(vertex.hit.p, Vec2d(0.5));
  if (!join) return false;
  const Vec2& film = join->film;
  const Vec2i& resolution = scene.Settings().resolution;
  if (!(film.x >= 0 && film.y >= 0 && film.x < static_cast<float>(resolution.x) &&
        film.y < static_cast<float>(resolution.y)))
    return false;
  if (vertex.bsdf.Eval(vertex.hit.wo, join->wi, TransportMode::Importance).IsBlack()) return false;
  return scene.Unoccluded(SpawnRayTo(vertex.hit, join->lens, 0, Vec3(0)));
}

/// `isUseful(const LightVertex&)` says whether a light path comes to something where it meets a surface that is not
/// purely specular.
template <typename IsUseful>
PilotPhoton TracePilotPhoton(const Scene& scene, const EmissionSampler& emission, Sampler sampler, int maxDepth,
                             const IsUseful& isUseful) {
  const std::optional<EmissionSample> emitted = EmitPhoton(emission, sampler);
  if (!emitted) return {};
  int useful = 0;
  TraceLightPath(scene, *emitted, sampler, maxDepth,
                 [&](const LightVertex& vertex) { useful += !vertex.bsdf.IsPurelySpecular() && isUseful(vertex); });
  return {emitted->light,       emitted->own.position, emitted->own.direction,
          emitted->le.deltaPos, emitted->le.deltaDir,  useful / emitted->bend};
}

template <typename IsUseful>
EmissionGuide Learn(const Scene& scene, int maxDepth, uint64_t seed, const IsUseful& isUseful) {
  std::vector<double> power;
  for (const auto& light : scene.Lights()) power.push_back(static_cast<double>(light->Power().MaxComponent()));
  std::vector<PilotPhoton> pilot;
  EmissionGuide guide;
  // About one light path a pixel in all: a small picture is not worth a long pilot.
  const Vec2i& resolution = scene.Settings().resolution;
  const int64_t most = std::clamp<int64_t>(int64_t{resolution.x} * resolution.y / 2, 1 << 13, kMostPhotons / 2);
  const int64_t rounds[] = {most / 2, most / 2, most};
  for (uint64_t round = 0; round < std::size(rounds); ++round) {
    const int64_t photons = rounds[round];
    const size_t first = pilot.size();
    pilot.resize(first + static_cast<size_t>(photons));
    {
      // Gone before the next guide is learned: of many lights each takes much memory.
      const EmissionSampler emission(scene, std::move(guide));
      ParallelForChunks(photons, 1024, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
          const Sampler sampler = Sampler::ForLightPath(Hash(seed, kPilot, round), i, 0, photons);
          pilot[first + static_cast<size_t>(i)] = TracePilotPhoton(scene, emission, sampler, maxDepth, isUseful);
        }
      });
    }
    guide = EmissionGuide(power, pilot);
  }
  return guide;
}

}  // namespace

int64_t EmissionPilotBytes(const Scene& scene) {
  const auto lights = static_cast<int64_t>(scene.Lights().size());
  return kMostPhotons * static_cast<int64_t>(sizeof(PilotPhoton)) + 2 * EmissionGuide::MostMemoryBytes(lights);
}

EmissionGuide LearnEmissionGuide(const Scene& scene, int maxDepth, int finalGathers, uint64_t seed) {
  if (scene.Lights().empty()) return {};
  const VisiblePoints visible = FindVisiblePoints(scene, finalGathers, Hash(seed, kPilot));
  if (visible.maxReach == 0) return {};
  return Learn(scene, maxDepth, seed,
               [&](const LightVertex& vertex) { return vertex.scattered > 0 && visible.IsNear(vertex.hit.p); });
}

EmissionGuide LearnJoinedEmissionGuide(const Scene& scene, int maxDepth, uint64_t seed) {
  if (scene.Lights().empty()) return {};
  return Learn(scene, maxDepth, seed, [&](const LightVertex& vertex) { return IsInPicture(scene, vertex); });
}

}  // namespace dapple
