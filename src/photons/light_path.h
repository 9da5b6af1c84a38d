// The photon tracer: one light path, from its emission to its last scattering, handed vertex by vertex to a visitor.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "src/base/parallel.h"
#include "src/photons/emission_sampler.h"
#include "src/sampling/sampler.h"

namespace dapple {

/// A surface that a light path meets.
struct LightVertex {
  const SurfaceInteraction& hit;  ///< hit.wo points back to where the light comes from
  const Bsdf& bsdf;
  Color flux;      ///< that arrives here, as carried by one path
  int scattered;   ///< scattering events before this vertex: 0 for light that comes straight from its source
  bool isCaustic;  ///< there were some, and all of them were specular
};

/// How the walk along a light path ended.
struct LightPathEnd {
  int segments = 0;          ///< that were traced
  bool isNonFinite = false;  ///< the flux was infinite or no number
  int material = -1;         ///< then: of the surface that scattered it; -1: as it was emitted
};

/// The random numbers of the ray with which a light path begins. Uses block 0 of the sampler.
inline LeRandom EmissionNumbers(Sampler& sampler) {
  LeRandom u;
  u.direction = sampler.Get2D();
  u.position = sampler.Get2D();
  u.part = sampler.Get1D();
  return u;
}

/// The ray with which a light path begins.
inline std::optional<EmissionSample> EmitPhoton(const EmissionSampler& emission, Sampler& sampler) {
  return emission.Sample(EmissionNumbers(sampler));
}

/// Walks on from an emitted photon and calls `visit(const LightVertex&)` at each surface it meets, black ones excepted.
/// A vertex is visited only if one more scattering event there keeps the path within `maxDepth` of them. Russian
/// roulette keeps a path with the share of its flux that a scattering leaves, so that the power of photons stays even
/// (Jensen 2001, section 5.2). Vertex n uses block n + 1 of the sampler. Where the path goes on, `scatter(const
/// LightVertex&, const BsdfSample&)` is called with the way it takes. Where the flux is not finite the path
/// ends, and no vertex sees it.
template <typename Visitor, typename Scatter>
LightPathEnd TraceLightPath(const Scene& scene, const EmissionSample& emitted, Sampler sampler, int maxDepth,
                            Visitor&& visit, Scatter&& scatter) {
  Ray ray = emitted.le.ray;
  Color flux = emitted.Flux();
  LightPathEnd end;
  if (!flux.IsFinite()) {
    end.isNonFinite = true;
    return end;
  }
  bool allSpecular = true;
  for (int scattered = 0; scattered < maxDepth && !flux.IsBlack();) {
    ++end.segments;
    const std::optional<SurfaceInteraction> hit = scene.Intersect(ray);
    if (!hit) break;
    const Material* material = scene.MaterialAt(*hit);
    if (!material) {
      ray = SpawnRay(*hit, ray.d);
      continue;
    }
    const Bsdf bsdf = material->GetBsdf(*hit);
    if (bsdf.IsBlack()) break;
    const LightVertex vertex{*hit, bsdf, flux, scattered, allSpecular && scattered > 0};
    visit(vertex);

    sampler.StartBlock(scattered + 1);
    const double uLobe = sampler.Get1D();
    const Vec2d uDirection = sampler.Get2D();
    const std::optional<BsdfSample> next = bsdf.Sample(hit->wo, uLobe, uDirection, TransportMode::Importance);
    const Color scatteredFlux = next ? flux * next->weight : Color();
    // The BSDF gives no sample whose weight is not finite.
    if (next ? !scatteredFlux.IsFinite() : !bsdf.Albedo(hit->wo).IsFinite()) {
      end.isNonFinite = true;
      end.material = scene.Primitives()[static_cast<size_t>(hit->shape)].material;
      break;
    }
    if (!next) break;
    const float keep = std::min(1.f, scatteredFlux.MaxComponent() / flux.MaxComponent());
    if (!(sampler.Get1D() < keep)) break;
    scatter(vertex, *next);
    flux = scatteredFlux / keep;
    ray = SpawnRay(*hit, next->wi);
    allSpecular &= next->IsSpecular();
    ++scattered;
  }
  return end;
}

template <typename Visitor>
LightPathEnd TraceLightPath(const Scene& scene, const EmissionSample& emitted, Sampler sampler, int maxDepth,
                            Visitor&& visit) {
  return TraceLightPath(scene, emitted, sampler, maxDepth, std::forward<Visitor>(visit),
                        [](const LightVertex&, const BsdfSample&) {});
}

/// Begins `paths` light paths of a pass and calls `walk(const EmissionSample&, const Sampler&, Chunk&)` for each that
/// leaves a light. Paths are cut into chunks of 512, whatever the number of threads, which run in parallel, each with
/// a `Chunk` of its own. Calls `take(Chunk&&, int64_t pathsSoFar)` with each in the order of the paths, so that only
/// those of a sixteenth of the paths, or of 2^15 where that is more, are held at a time.
template <typename Chunk, typename Walk, typename Take>
void ForEachLightPath(const EmissionSampler& emission, uint64_t seed, int pass, int64_t paths, Walk&& walk,
                      Take&& take) {
  constexpr int64_t kChunk = 512;
  const int64_t pathsAtATime = kChunk * std::max<int64_t>(64, paths / (16 * kChunk));
  for (int64_t first = 0; first < paths; first += pathsAtATime) {
    const int64_t count = std::min(pathsAtATime, paths - first);
    std::vector<Chunk> chunks(static_cast<size_t>((count + kChunk - 1) / kChunk));
    ParallelForChunks(count, kChunk, [&](int64_t begin, int64_t end) {
      Chunk& chunk = chunks[static_cast<size_t>(begin / kChunk)];
      for (int64_t path = first + begin; path < first + end; ++path) {
        Sampler sampler = Sampler::ForLightPath(seed, path, pass, paths);
        if (const std::optional<EmissionSample> emitted = EmitPhoton(emission, sampler)) walk(*emitted, sampler, chunk);
      }
    });
    for (size_t i = 0; i < chunks.size(); ++i)
      take(std::exchange(chunks[i], {}), std::min(paths, first + static_cast<int64_t>(i + 1) * kChunk));
  }
}

}  // namespace dapple
