#include "integrators/path.h"

#include "integrators/camera_path.h"
#include "integrators/pixel_loop.h"

namespace dapple {

void PathIntegrator::Prepare(const Scene& scene, uint64_t seed) {
  scene_ = &scene;
  seed_ = seed;
}

PassStats PathIntegrator::RenderPass(int pass, Film& film) const {
  const auto radiance = [&](const CameraRay& camera, Sampler& sampler, PassStats& stats) {
    return Radiance(CameraWalk(camera.ray), sampler, stats);
  };
  const PassStats stats = RenderPixels(*scene_, seed_, pass, 1, radiance, film);
  film.FinishPass(pass);
  return stats;
}

Color PathIntegrator::Radiance(CameraWalk walk, Sampler& sampler, PassStats& stats) const {
  Color radiance;
  for (;;) {
    ++stats.cameraRays;
    const std::optional<SurfaceInteraction> hit = scene_->Intersect(walk.ray);
    radiance += walk.throughput * EmittedAlong(*scene_, walk.ray, hit ? &*hit : nullptr, walk.last, stats, direct_);
    if (!hit) return radiance;
    const Material* material = scene_->MaterialAt(*hit);
    if (!material) {
      walk.ray = SpawnRay(*hit, walk.ray.d);
      continue;
    }
    if (walk.scattered >= maxDepth_) return radiance;
    const Bsdf bsdf = material->GetBsdf(*hit);
    if (bsdf.IsBlack()) return radiance;

    ++walk.scattered;
    sampler.StartBlock(walk.scattered);
    const Vec2d uDirection = sampler.Get2D();
    const double uLobe = sampler.Get1D();
    const double uRoulette = sampler.Get1D();
    LightContext at = ContextOf(*scene_, *hit, bsdf, direct_);
    if (!bsdf.IsPurelySpecular())
      radiance += walk.throughput * SampleDirectLight(*scene_, *hit, bsdf, at, sampler, stats, direct_);

    const std::optional<BsdfSample> next = SampleWayOn(*scene_, *hit, bsdf, uLobe, uDirection, stats);
    if (!next) return radiance;
    walk.Scatter(*hit, *next, std::move(at));
    if (!SurvivesRoulette(uRoulette, &walk)) return radiance;
  }
}

}  // namespace dapple
