#include "integrators/light_tracing.h"

#include <vector>

#include "integrators/camera_path.h"
#include "integrators/pixel_loop.h"
#include "src/base/hash.h"
#include "src/base/parallel.h"

namespace dapple {

void LightTracingIntegrator::Prepare(const Scene& scene, uint64_t seed) {
  if (!scene.GetCamera().CanConnect())
    throw Error(
        "integrator light_tracing cannot join light paths to this camera; use a perspective camera, path or sppm");
  scene_ = &scene;
  seed_ = seed;
  emission_.emplace(scene);
}

PassStats LightTracingIntegrator::RenderPass(int pass, Film& film) const {
  PassStats stats = RenderEmitters(pass, film);
  stats += RenderLightPaths(pass, film);
  film.FinishPass(pass);
  return stats;
}

PassStats LightTracingIntegrator::RenderEmitters(int pass, Film& film) const {
  return ForEachPixel(film, [&](const Vec2i& pixel, PassStats& stats) {
    Sampler sampler = Sampler::ForPixel(seed_, pixel, pass);
    const PixelSample sample = SamplePixel(*scene_, film, pixel, sampler);
    Ray ray = sample.camera.ray;
    Color emitted;
    for (;;) {
      ++stats.cameraRays;
      const std::optional<SurfaceInteraction> hit = scene_->Intersect(ray);
      emitted += EmittedAlong(*scene_, ray, hit ? &*hit : nullptr, {});
      if (!hit || scene_->MaterialAt(*hit)) break;
      ray = SpawnRay(*hit, ray.d);
    }
    film.AddSample(pixel, emitted * sample.weight, pass);
  });
}

PassStats LightTracingIntegrator::RenderLightPaths(int pass, Film& film) const {
  const Vec2i& resolution = film.FullResolution();
  const int64_t paths = photonsPerPass_ ? *photonsPerPass_ : int64_t{resolution.x} * resolution.y;
  constexpr int64_t kChunk = 4096;
  std::vector<PassStats> chunkStats(static_cast<size_t>((paths + kChunk - 1) / kChunk));
  ParallelForChunks(paths, kChunk, [&](int64_t begin, int64_t end) {
    PassStats stats;
    for (int64_t path = begin; path < end; ++path) {
      Sampler sampler = Sampler::ForLightPath(seed_, path, pass, paths);
      const std::optional<EmissionSample> emitted = EmitPhoton(*emission_, sampler);
      if (!emitted) continue;
      ++stats.photonsEmitted;
      stats.photonRays += TraceLightPath(*scene_, *emitted, sampler, maxDepth_, [&](const LightVertex& vertex) {
        // The lens is a decision of its own, apart from the walk's.
        constexpr int kLensBlock = 1 << 16;
        Sampler lens = sampler;
        lens.StartBlock(kLensBlock + vertex.scattered);
        Join(vertex, lens.Get2D(), 1 / static_cast<float>(paths), pass, film, stats);
      });
    }
    chunkStats[static_cast<size_t>(begin / kChunk)] = stats;
  });
  PassStats sum;
  for (const PassStats& stats : chunkStats) sum += stats;
  return sum;
}

void LightTracingIntegrator::Join(const LightVertex& vertex, const Vec2d& uLens, float weight, int pass, Film& film,
                                  PassStats& stats) const {
  const SurfaceInteraction& hit = vertex.hit;
  if (vertex.bsdf.IsPurelySpecular()) return;
  const std::optional<WiSample> join = scene_->GetCamera().Sample_Wi(hit.p, uLens);
  if (!join) return;
  const Imath::Box2d reach = film.SplatBounds();
  if (!reach.intersects(Vec2d(join->film.x, join->film.y))) return;
  const Color value = vertex.flux * vertex.bsdf.Eval(hit.wo, join->wi, TransportMode::Importance) *
                      (weight * join->We / static_cast<float>(join->pdf));
  if (value.IsBlack()) return;
  ++stats.shadowRays;
  if (!scene_->Unoccluded(SpawnRayTo(hit, join->lens, 0, Vec3(0)))) return;
  ++stats.splats;
  film.AddSplat(join->film, value, pass);
}

}  // namespace dapple
