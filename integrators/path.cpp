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
    return Radiance(camera.ray, sampler, stats);
  };
  const PassStats stats = RenderPixels(*scene_, seed_, pass, 1, radiance, film);
  film.FinishPass(pass);
  return stats;
}

Color PathIntegrator::Radiance(Ray ray, Sampler& sampler, PassStats& stats) const {
  Color radiance, throughput(1);
  LastScattering last;
  float etaScale = 1;
  for (int scattered = 0;;) {
    ++stats.cameraRays;
    const std::optional<SurfaceInteraction> hit = scene_->Intersect(ray);
    radiance += throughput * EmittedAlong(*scene_, ray, hit ? &*hit : nullptr, last, stats, direct_);
    if (!hit) return radiance;
    const Material* material = scene_->MaterialAt(*hit);
    if (!material) {
      ray = SpawnRay(*hit, ray.d);
      continue;
    }
    if (scattered >= maxDepth_) return radiance;
    const Bsdf bsdf = material->GetBsdf(*hit);
    if (bsdf.IsBlack()) return radiance;

    ++scattered;
    sampler.StartBlock(scattered);
    const Vec2d uDirection = sampler.Get2D();
    const double uLobe = sampler.Get1D();
    const double uRoulette = sampler.Get1D();
    const LightContext at = ContextOf(*scene_, *hit, bsdf, direct_);
    if (!bsdf.IsPurelySpecular())
      radiance += throughput * SampleDirectLight(*scene_, *hit, bsdf, at, sampler, stats, direct_);

    const std::optional<BsdfSample> next = SampleWayOn(*scene_, *hit, bsdf, uLobe, uDirection, stats);
    if (!next) return radiance;
    throughput *= next->weight;
    etaScale *= next->eta * next->eta;
    last = {next->IsSpecular(), at, next->pdf};
    ray = SpawnRay(*hit, next->wi);
    if (!SurvivesRoulette(scattered, uRoulette, etaScale, &throughput)) return radiance;
  }
}

}  // namespace dapple
