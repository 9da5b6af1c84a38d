#include "integrators/sppm.h"

#include <vector>

#include "integrators/pixel_loop.h"
#include "src/base/parallel.h"
#include "src/photons/emission_pilot.h"
#include "src/photons/kernel.h"
#include "src/photons/radius_schedule.h"
#include "src/photons/same_surface.h"

namespace dapple {

namespace {

// Knaus and Zwicker's alpha: bias squared and variance fall alike, with the power -2/3 of the passes.
constexpr double kAlpha = 2.0 / 3;

// Surfaces that look in few enough directions for the camera path to go on through them.
bool IsGlossy(const Bsdf& bsdf) {
  constexpr float kMaxRoughness = 0.25f;
  return !bsdf.Flags().HasDiffuse() && bsdf.MinRoughness() < kMaxRoughness;
}

}  // namespace

void SppmIntegrator::Prepare(const Scene& scene, uint64_t seed) {
  scene_ = &scene;
  seed_ = seed;
  emission_.emplace(scene,
                    options_.guideEmission ? LearnEmissionGuide(scene, options_.maxDepth, seed) : EmissionGuide());
}

PassStats SppmIntegrator::RenderPass(int pass, Film& film) const {
  const Vec2i& resolution = film.FullResolution();
  const int64_t paths = options_.photonsPerPass ? *options_.photonsPerPass : int64_t{resolution.x} * resolution.y;
  PassStats stats;
  const Map map = TracePhotons(pass, paths, &stats);
  const PhotonPass photons{map, 1 / static_cast<float>(paths), RadiusFactor(pass, kAlpha)};
  stats += ForEachPixel(film, [&](const Vec2i& pixel, PassStats& tileStats) {
    Sampler sampler = Sampler::ForPixel(seed_, pixel, pass);
    const PixelSample sample = SamplePixel(*scene_, film, pixel, sampler);
    film.AddSample(pixel, Radiance(sample.camera, photons, sampler, tileStats) * sample.weight, pass);
  });
  film.FinishPass(pass);
  return stats;
}

SppmIntegrator::Map SppmIntegrator::TracePhotons(int pass, int64_t paths, PassStats* stats) const {
  struct Chunk {
    std::vector<Vec3> positions;
    std::vector<Photon> photons;
    PassStats stats;
  };
  constexpr int64_t kChunk = 4096;
  std::vector<Chunk> chunks(static_cast<size_t>((paths + kChunk - 1) / kChunk));
  ParallelForChunks(paths, kChunk, [&](int64_t begin, int64_t end) {
    Chunk& chunk = chunks[static_cast<size_t>(begin / kChunk)];
    for (int64_t path = begin; path < end; ++path) {
      Sampler sampler = Sampler::ForLightPath(seed_, path, pass, paths);
      const std::optional<EmissionSample> emitted = EmitPhoton(*emission_, sampler);
      if (!emitted) continue;
      ++chunk.stats.photonsEmitted;
      const auto store = [&](const LightVertex& v) {
        // Light straight from its source is sampled where it is needed.
        if (v.scattered == 0 || v.bsdf.IsPurelySpecular()) return;
        chunk.positions.push_back(v.hit.p);
        chunk.photons.push_back(
            {v.flux, OctahedralVector(v.hit.wo), OctahedralVector(v.hit.ng), v.scattered, v.isCaustic});
      };
      chunk.stats.photonRays += TraceLightPath(*scene_, *emitted, sampler, options_.maxDepth, store);
    }
  });

  std::vector<Vec3> positions;
  std::vector<Photon> photons;
  size_t count = 0;
  for (const Chunk& chunk : chunks) count += chunk.photons.size();
  positions.reserve(count);
  photons.reserve(count);
  for (Chunk& chunk : chunks) {
    positions.insert(positions.end(), chunk.positions.begin(), chunk.positions.end());
    photons.insert(photons.end(), chunk.photons.begin(), chunk.photons.end());
    *stats += chunk.stats;
    chunk = {};
  }
  stats->photonsStored += static_cast<int64_t>(count);
  return {std::move(positions), photons};
}

Color SppmIntegrator::Radiance(const CameraRay& camera, const PhotonPass& photons, Sampler& sampler,
                               PassStats& stats) const {
  Ray ray = camera.ray;
  Color radiance, throughput(1);
  LastScattering last;
  float etaScale = 1, distance = 0;
  bool isBehindGlossy = false, isDone = false;
  for (int scattered = 0;;) {
    ++stats.cameraRays;
    const std::optional<SurfaceInteraction> hit = scene_->Intersect(ray);
    // Sources that a glossy surface sees by specular ones reach it as caustic photons.
    if (!isBehindGlossy || !last.isSpecular)
      radiance += throughput * EmittedAlong(*scene_, ray, hit ? &*hit : nullptr, last, options_.direct);
    if (!hit) return radiance;
    distance += hit->t;
    const Material* material = scene_->MaterialAt(*hit);
    if (!material) {
      ray = SpawnRay(*hit, ray.d);
      continue;
    }
    if (scattered >= options_.maxDepth || isDone) return radiance;
    const Bsdf bsdf = material->GetBsdf(*hit);
    if (bsdf.IsBlack()) return radiance;

    ++scattered;
    sampler.StartBlock(scattered);
    const Vec2d uDirection = sampler.Get2D();
    const double uLobe = sampler.Get1D();
    const double uRoulette = sampler.Get1D();
    const bool isGlossy = IsGlossy(bsdf);
    const LightContext at = ContextOf(*scene_, *hit, bsdf, options_.direct);
    if (!bsdf.IsPurelySpecular()) {
      radiance += throughput * SampleDirectLight(*scene_, *hit, bsdf, at, sampler, stats, options_.direct);
      const double footprint = camera.footprintAtLens + camera.footprintSpread * distance;
      const double radius = options_.radius.value_or(options_.radiusInPixels * footprint) * photons.radiusFactor;
      radiance +=
          throughput * photons.weight *
          Gather(photons.map, *hit, bsdf, {static_cast<float>(radius), options_.maxDepth - scattered, isGlossy}, stats);
    }

    const std::optional<BsdfSample> next = bsdf.Sample(hit->wo, uLobe, uDirection, TransportMode::Radiance);
    if (!next) return radiance;
    throughput *= next->weight;
    etaScale *= next->eta * next->eta;
    last = {next->IsSpecular(), at, next->pdf};
    if (!last.isSpecular) {
      isBehindGlossy |= isGlossy;
      // Where all photons were gathered, only light straight from its source is left to find.
      isDone = !isGlossy;
    }
    ray = SpawnRay(*hit, next->wi);
    constexpr int kSureBounces = 8;
    if (scattered > kSureBounces && !SurvivesRoulette(uRoulette, etaScale, &throughput)) return radiance;
  }
}

Color SppmIntegrator::Gather(const Map& map, const SurfaceInteraction& hit, const Bsdf& bsdf,
                             const GatherLimits& limits, PassStats& stats) const {
  ++stats.gathers;
  const EpanechnikovKernel kernel(limits.radius);
  const GatherSite site(hit.p, hit.ng, hit.wo, limits.radius, bsdf.Flags().HasTransmission());
  Color sum;
  map.ForEachWithin(hit.p, limits.radius, [&](const Vec3& position, const Photon& photon, float distanceSquared) {
    ++stats.photonsGathered;
    if (photon.scattered > limits.maxScattered || (limits.causticsOnly && !photon.isCaustic)) return;
    const Vec3 wi = photon.wi.Decode();
    if (!IsOnSameSurface(site, position, distanceSquared, photon.normal.Decode(), wi)) return;
    // Photons are dense by |ng.wi|, and Eval has the shading normal's cosine.
    const float cosine = AbsDot(hit.ng, wi);
    if (cosine > 0)
      sum += bsdf.Eval(hit.wo, wi, TransportMode::Radiance) * photon.flux * (kernel(distanceSquared) / cosine);
  });
  return sum;
}

}  // namespace dapple
