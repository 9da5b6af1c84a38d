// What integrators with photons share: the plan of their passes, and the photons of a pass.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "integrators/integrator.h"
#include "src/photons/gather_radius.h"
#include "src/photons/light_path.h"
#include "src/photons/photon_map.h"

namespace dapple {

/// Light paths of a pass where nothing is gathered: as asked for, else one a pixel of the picture.
int64_t LightPathsOfPass(const Scene& scene, const IntegratorOptions& options);

/// What the pilot of emission has learned or learns now, as the options say; `finalGathers` as below.
EmissionGuide GuideOf(const Scene& scene, const IntegratorOptions& options, int finalGathers, uint64_t seed);

/// About what `PhotonPlan` gives a pass.
PassForecast ForecastPhotonPass(const Scene& scene, const IntegratorOptions& options, int finalGathers, uint64_t seed);

/// What an integrator does with the photons of its passes.
struct PhotonUse {
  int finalGathers = 0;           ///< diffuse scatterings of a camera path before it gathers
  bool forecastsPhotons = false;  ///< it goes by how many a gather may expect
};

/// How photons are emitted, how many, within what radius they are gathered, and by how many camera paths.
struct PhotonPlan {
  /// Learned by pilots whose length follows, as all else, from the arguments alone. Where the options do not say how
  /// many light paths a pass has, it spends as much on them as on one camera path a pixel, within a quarter and four
  /// times as many paths as pixels and 2^22 at most; where they do, there are as many camera paths as cost as much, at
  /// most 16 a pixel.
  PhotonPlan(const Scene& scene, const IntegratorOptions& options, const PhotonUse& use, uint64_t seed);

  PreparationUse Use() const;

  /// False where no photon could be gathered: nothing emits, or nothing scatters in more than one direction, or paths
  /// are too short. Then there are no pilots, and `ShootPhotons` shoots none.
  bool isNeeded;
  EmissionSampler emission;
  int64_t paths = 1;
  int cameraSamples = 1;  ///< camera paths a pixel and pass
  GatherRadius radius;    ///< of all photons
  PilotUse pilots;
};

/// The same for photons that met nothing but specular surfaces.
GatherRadius CausticRadius(const PhotonPlan& plan, const Scene& scene, const IntegratorOptions& options, uint64_t seed);

/// Counts what a walk has traced of a light path, and where it ended at a value that is not finite.
inline void AddLightPath(const LightPathEnd& end, const EmissionSample& emitted, PassStats* stats) {
  stats->photonRays += end.segments;
  if (!end.isNonFinite) return;
  stats->nonFinite.Add(end.material < 0 ? NonFiniteSource::Light(emitted.light)
                                        : NonFiniteSource::Material(end.material));
}

/// The flux of a photon as surfaces gather it. Photons lie as densely as their surface is turned to where they come
/// from; a surface is as bright as its shading normal is turned there. The ratio is that of the photon's own place: a
/// facet that light grazes leaves few photons, and must not count the many of the next facet as so few.
inline Color ShadedFlux(const LightVertex& vertex) {
  const SurfaceInteraction& hit = vertex.hit;
  if (hit.ns == hit.ng) return vertex.flux;
  const float cosine = AbsDot(hit.ng, hit.wo);
  return cosine > 0 ? vertex.flux * (AbsDot(hit.ns, hit.wo) / cosine) : Color();
}

/// Photons where they met surfaces: `photons[i]` stands at `positions[i]`.
template <typename Photon>
struct ShotPhotons {
  std::vector<Vec3> positions;
  std::vector<Photon> photons;
  PassStats stats;

  void Store(const Vec3& position, const Photon& photon) {
    positions.push_back(position);
    photons.push_back(photon);
  }

  /// Adds what comes behind; with it this is about that share of all.
  void Append(const ShotPhotons& next, double share) {
    stats += next.stats;
    const size_t count = photons.size() + next.photons.size();
    if (count > photons.capacity()) {
      // As many as the paths so far make likely, and a tenth: room that is not filled takes no memory.
      const double likely = 1.1 * static_cast<double>(count) / share;
      const size_t room = std::max(count + count / 2, static_cast<size_t>(likely));
      positions.reserve(room);
      photons.reserve(room);
    }
    positions.insert(positions.end(), next.positions.begin(), next.positions.end());
    photons.insert(photons.end(), next.photons.begin(), next.photons.end());
  }

  /// Moves those photons out for which `isWanted(const Photon&)`; both parts keep their order.
  template <typename Predicate>
  ShotPhotons Extract(Predicate&& isWanted) {
    ShotPhotons wanted;
    const auto count = static_cast<size_t>(std::count_if(photons.begin(), photons.end(), isWanted));
    wanted.positions.reserve(count);
    wanted.photons.reserve(count);
    size_t kept = 0;
    for (size_t i = 0; i < photons.size(); ++i) {
      if (isWanted(photons[i])) {
        wanted.Store(positions[i], photons[i]);
      } else {
        positions[kept] = positions[i];
        photons[kept++] = photons[i];
      }
    }
    positions.resize(kept);
    photons.resize(kept);
    return wanted;
  }
};

/// Walks the light paths of a pass: `walk(const EmissionSample&, const Sampler&, ShotPhotons<Photon>&)` stores what it
/// likes. The photons come in the order of the paths.
template <typename Photon, typename Walk>
ShotPhotons<Photon> ShootPhotons(const PhotonPlan& plan, uint64_t seed, int pass, Walk&& walk) {
  if (!plan.isNeeded) return {};
  ShotPhotons<Photon> all;
  const auto trace = [&](const EmissionSample& emitted, const Sampler& sampler, ShotPhotons<Photon>& chunk) {
    ++chunk.stats.photonsEmitted;
    walk(emitted, sampler, chunk);
  };
  const auto take = [&](const ShotPhotons<Photon>& chunk, int64_t pathsSoFar) {
    all.Append(chunk, static_cast<double>(pathsSoFar) / static_cast<double>(plan.paths));
  };
  ForEachLightPath<ShotPhotons<Photon>>(plan.emission, seed, pass, plan.paths, trace, take);
  all.stats.photonsStored += static_cast<int64_t>(all.photons.size());
  return all;
}

/// Why what was gathered at `hit` is not finite, though all photons are.
template <typename Map>
NonFiniteSource SourceOfGather(const Scene& scene, const Map& map, float radius, const SurfaceInteraction& hit,
                               const Bsdf& bsdf) {
  Color sum;
  map.ForEachWithin(hit.p, radius, [&](const Vec3&, const auto& photon, float) {
    sum += bsdf.Eval(hit.wo, photon.wi.Decode(), TransportMode::Radiance);
  });
  return SourceAt(scene, hit, [&] { return sum; });
}

/// The map of the photons, which is none where there are no photons. Adds what was done to `*stats`, which are of one
/// pass.
template <typename Photon>
PhotonMap<Photon> BuildPhotonMap(ShotPhotons<Photon> shot, PassStats* stats) {
  *stats += shot.stats;
  if (shot.positions.empty()) return {};
  PhotonMap<Photon> map(std::move(shot.positions), std::move(shot.photons));
  ++stats->photonMaps;
  stats->photonMapBytes += map.MemoryBytes();
  return map;
}

}  // namespace dapple
