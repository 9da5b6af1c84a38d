#include "integrators/path.h"

#include "integrators/camera_path.h"
#include "integrators/pixel_loop.h"

namespace dapple {

void PathIntegrator::Prepare(const Scene& scene, uint64_t seed) {
  scene_ = &scene;
  seed_ = seed;
  if (options_.cameraSamples) samples_ = SampleAllocation::ByNoise(scene, seed, *options_.cameraSamples, Tracer());
}

SampleAllocation::Tracer PathIntegrator::Tracer() const {
  return [this](const CameraRay& camera, Sampler& sampler, PassStats& stats) {
    return Radiance(CameraWalk(camera.ray), sampler, stats);
  };
}

PassStats PathIntegrator::RenderPass(int pass, Film& film) const {
  const PassStats stats = RenderPixels(*scene_, seed_, pass, samples_, Tracer(), film);
  film.FinishPass(pass);
  return stats;
}

Color PathIntegrator::Radiance(CameraWalk walk, Sampler& sampler, PassStats& stats) const {
  Color radiance;
  for (;;) {
    ++stats.cameraRays;
    const std::optional<SurfaceInteraction> hit = scene_->Intersect(walk.ray);
    radiance +=
        walk.throughput * EmittedAlong(*scene_, walk.ray, hit ? &*hit : nullptr, walk.last, stats, options_.direct);
    if (!hit) return radiance;
    const Material* material = scene_->MaterialAt(*hit);
    if (!material) {
      walk.ray = SpawnRay(*hit, walk.ray.d);
      continue;
    }
    if (walk.scattered >= options_.maxDepth) return radiance;
    const Bsdf bsdf = material->GetBsdf(*hit);
    if (bsdf.IsBlack()) return radiance;

    ++walk.scattered;
    sampler.StartBlock(walk.scattered);
    const Vec2d uDirection = sampler.Get2D();
    const double uLobe = sampler.Get1D();
    const double uRoulette = sampler.Get1D();
    LightContext at = ContextOf(*scene_, *hit, bsdf, options_.direct);
    if (!bsdf.IsPurelySpecular())
      radiance += walk.throughput * SampleDirectLight(*scene_, *hit, bsdf, at, sampler, stats, options_.direct);

    const std::optional<BsdfSample> next = SampleWayOn(*scene_, *hit, bsdf, uLobe, uDirection, stats);
    if (!next) return radiance;
    walk.Scatter(*hit, *next, std::move(at));
    if (!SurvivesRoulette(uRoulette, &walk)) return radiance;
  }
}

}  // namespace dapple
