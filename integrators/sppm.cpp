#include "integrators/sppm.h"

#include "integrators/pixel_loop.h"
#include "src/photons/kernel.h"
#include "src/photons/radius_schedule.h"
#include "src/photons/same_surface.h"

namespace dapple {

namespace {

// Surfaces that look in few enough directions for the camera path to go on through them.
bool IsGlossy(const Bsdf& bsdf) {
  constexpr float kMaxRoughness = 0.25f;
  return !bsdf.Flags().HasDiffuse() && bsdf.MinRoughness() < kMaxRoughness;
}

}  // namespace

void SppmIntegrator::Prepare(const Scene& scene, uint64_t seed) {
  scene_ = &scene;
  seed_ = seed;
  plan_.emplace(scene, options_, seed);
}

PassStats SppmIntegrator::RenderPass(int pass, Film& film) const {
  PassStats stats;
  const Map map = TracePhotons(pass, &stats);
  const PhotonPass photons{map, 1 / static_cast<float>(plan_->paths), RadiusFactor(pass)};
  stats += ForEachPixel(film, [&](const Vec2i& pixel, PassStats& tileStats) {
    Sampler sampler = Sampler::ForPixel(seed_, pixel, pass);
    const PixelSample sample = SamplePixel(*scene_, film, pixel, sampler);
    film.AddSample(pixel, Radiance(sample.camera, photons, sampler, tileStats) * sample.weight, pass);
  });
  film.FinishPass(pass);
  return stats;
}

SppmIntegrator::Map SppmIntegrator::TracePhotons(int pass, PassStats* stats) const {
  ShotPhotons<Photon> shot = ShootPhotons<
      Photon>(*plan_, seed_, pass, [&](const EmissionSample& emitted, const Sampler& sampler, auto& chunk) {
    const auto store = [&](const LightVertex& v) {
      // Light straight from its source is sampled where it is needed.
      if (v.scattered == 0 || v.bsdf.IsPurelySpecular()) return;
      chunk.Store(v.hit.p, {v.flux, OctahedralVector(v.hit.wo), OctahedralVector(v.hit.ng), v.scattered, v.isCaustic});
    };
    chunk.stats.photonRays += TraceLightPath(*scene_, emitted, sampler, options_.maxDepth, store);
  });
  return BuildPhotonMap(std::move(shot), stats);
}

Color SppmIntegrator::Radiance(const CameraRay& camera, const PhotonPass& photons, Sampler& sampler,
                               PassStats& stats) const {
  Ray ray = camera.ray;
  Color radiance, throughput(1);
  LastScattering last;
  float etaScale = 1;
  bool isBehindGlossy = false, isDone = false;
  for (int scattered = 0;;) {
    ++stats.cameraRays;
    const std::optional<SurfaceInteraction> hit = scene_->Intersect(ray);
    // Sources that a glossy surface sees by specular ones reach it as caustic photons.
    if (!isBehindGlossy || !last.isSpecular)
      radiance += throughput * EmittedAlong(*scene_, ray, hit ? &*hit : nullptr, last, options_.direct);
    if (!hit) return radiance;
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
      const float radius = plan_->radius.At(hit->p).radius * photons.radiusFactor;
      radiance += throughput * photons.weight *
                  Gather(photons.map, *hit, bsdf, {radius, options_.maxDepth - scattered, isGlossy}, stats);
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
    if (!SurvivesRoulette(scattered, uRoulette, etaScale, &throughput)) return radiance;
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
