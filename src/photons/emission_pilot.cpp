#include "src/photons/emission_pilot.h"

#include <algorithm>
#include <cmath>

#include "src/base/hash.h"
#include "src/base/octahedral.h"
#include "src/base/parallel.h"
#include "src/photons/camera_pilot.h"
#include "src/photons/light_path.h"
#include "src/photons/photon_map.h"

namespace dapple {

namespace {

constexpr uint64_t kPilot = 2;
constexpr int64_t kMostPhotons = 1 << 16;

/// A point that the camera looks at; it stands for the surface within its reach.
struct VisiblePoint {
  float reach = 0;
  OctahedralVector n;  ///< normal on the side from which it is seen
  bool transmits = false;
};

struct VisiblePoints {
  PhotonMap<VisiblePoint> map;
  float maxReach = 0;
  int64_t rays = 0;  ///< that found them

  /// Whether light that comes from `hit.wo` arrives near one of them, on a surface that lies like theirs and on a side
  /// that they are seen from.
  bool AreLit(const SurfaceInteraction& hit) const {
    constexpr float kMinNormalCosine = 0.5f;
    const Vec3 lit = FaceForward(hit.ng, hit.wo);
    bool areLit = false;
    map.ForEachWithin(hit.p, maxReach, [&](const Vec3&, const VisiblePoint& point, float distanceSquared) {
      if (areLit || !(distanceSquared < Sqr(point.reach))) return;
      const float cosine = Dot(lit, point.n.Decode());
      areLit = (point.transmits ? std::abs(cosine) : cosine) > kMinNormalCosine;
    });
    return areLit;
  }
};

VisiblePoints FindVisiblePoints(const Scene& scene, int finalGathers, uint64_t seed) {
  constexpr int kPaths = 8192;
  std::vector<Vec3> positions;
  std::vector<VisiblePoint> points;
  int64_t rays = 0;
  const double step = ForEachPilotRay(scene, kPaths, seed, [&](const CameraRay& camera, Sampler& sampler) {
    rays += FollowCameraPath(
        scene, camera, finalGathers, sampler, [&](const SurfaceInteraction& hit, const Bsdf& bsdf, float distance) {
          positions.push_back(hit.p);
          // What lies between this point and those of the next paths, seen at a slant; in pixels first.
          constexpr float kMinCosine = 0.2f;
          const float width = camera.footprintAtLens + camera.footprintSpread * distance;
          const float reach = width / std::max(kMinCosine, AbsDot(hit.ng, hit.wo));
          points.push_back({reach, OctahedralVector(FaceForward(hit.ng, hit.wo)), bsdf.Flags().HasTransmission()});
        });
  });
  VisiblePoints visible;
  visible.rays = rays;
  if (points.empty()) return visible;
  // Far points would reach over all others.
  std::vector<float> reaches;
  for (const VisiblePoint& point : points) reaches.push_back(point.reach);
  const auto middle = reaches.begin() + static_cast<ptrdiff_t>(reaches.size() / 2);
  std::nth_element(reaches.begin(), middle, reaches.end());
  for (VisiblePoint& point : points) {
    point.reach = std::min(point.reach, 4 * *middle) * static_cast<float>(step);
    visible.maxReach = std::max(visible.maxReach, point.reach);
  }
  visible.map = PhotonMap<VisiblePoint>(std::move(positions), std::move(points));
  return visible;
}

/// Whether the picture, or what a crop leaves out of it, shows the vertex.
bool IsInPicture(const Scene& scene, const LightVertex& vertex, int* rays) {
  const std::optional<WiSample> join = scene.GetCamera().Sample_Wi(vertex.hit.p, Vec2d(0.5));
  if (!join) return false;
  const Vec2& film = join->film;
  const Vec2i& resolution = scene.Settings().resolution;
  if (!(film.x >= 0 && film.y >= 0 && film.x < static_cast<float>(resolution.x) &&
        film.y < static_cast<float>(resolution.y)))
    return false;
  if (vertex.bsdf.Eval(vertex.hit.wo, join->wi, TransportMode::Importance).IsBlack()) return false;
  ++*rays;
  return scene.Unoccluded(SpawnRayTo(vertex.hit, join->lens, 0, Vec3(0)));
}

/// `isUseful(const LightVertex&, int* rays)` says whether a light path comes to something where it meets a surface that
/// is not purely specular, and counts what it traces to know.
template <typename IsUseful>
PilotPhoton TracePilotPhoton(const Scene& scene, const EmissionSampler& emission, Sampler sampler, int maxDepth,
                             const IsUseful& isUseful) {
  const std::optional<EmissionSample> emitted = EmitPhoton(emission, sampler);
  if (!emitted) return {};
  int useful = 0, rays = 0;
  const auto visit = [&](const LightVertex& vertex) {
    useful += !vertex.bsdf.IsPurelySpecular() && isUseful(vertex, &rays);
  };
  rays += TraceLightPath(scene, *emitted, sampler, maxDepth, visit).segments;
  return {emitted->light,
          emitted->own.position,
          emitted->own.direction,
          emitted->le.deltaPos,
          emitted->le.deltaDir,
          useful / emitted->bend,
          rays};
}

/// `cameraRays`: that were traced to know what is useful.
template <typename IsUseful>
EmissionGuide Learn(const Scene& scene, int maxDepth, uint64_t seed, int64_t cameraRays, const IsUseful& isUseful) {
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
    guide = EmissionGuide(power, pilot, cameraRays);
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
  if (visible.maxReach == 0) return {{}, {}, visible.rays};
  return Learn(scene, maxDepth, seed, visible.rays,
               [&](const LightVertex& vertex, int*) { return vertex.scattered > 0 && visible.AreLit(vertex.hit); });
}

EmissionGuide LearnJoinedEmissionGuide(const Scene& scene, int maxDepth, uint64_t seed) {
  if (scene.Lights().empty()) return {};
  return Learn(scene, maxDepth, seed, 0,
               [&](const LightVertex& vertex, int* rays) { return IsInPicture(scene, vertex, rays); });
}

}  // namespace dapple
