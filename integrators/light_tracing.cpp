#include "integrators/light_tracing.h"

#include "integrators/camera_path.h"
#include "integrators/photon_shooting.h"
#include "integrators/pixel_loop.h"
#include "src/photons/emission_pilot.h"

namespace dapple {

void LightTracingIntegrator::Prepare(const Scene& scene, uint64_t seed) {
  scene_ = &scene;
  seed_ = seed;
  emission_.emplace(
      scene, options_.guideEmission ? LearnJoinedEmissionGuide(scene, options_.maxDepth, seed) : EmissionGuide());
  paths_ = LightPathsOfPass(scene, options_);
}

PreparationUse LightTracingIntegrator::Preparation() const {
  const EmissionGuide& guide = emission_->Guide();
  return {TableUse::Of(guide.MemoryBytes()), guide.Pilot()};
}

PassForecast LightTracingIntegrator::Forecast(const Scene& scene, uint64_t) const {
  PassForecast forecast;
  forecast.lightPaths = LightPathsOfPass(scene, options_);
  if (options_.guideEmission) forecast.pilotBytes = EmissionPilotBytes(scene);
  return forecast;
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
    const PixelSample sample = SamplePixel(*scene_, film.PixelFilter(), pixel, sampler);
    Ray ray = sample.camera.ray;
    Color emitted;
    for (;;) {
      ++stats.cameraRays;
      const std::optional<SurfaceInteraction> hit = scene_->Intersect(ray);
      emitted += EmittedAlong(*scene_, ray, hit ? &*hit : nullptr, {}, stats);
      if (!hit || scene_->MaterialAt(*hit)) break;
      ray = SpawnRay(*hit, ray.d);
    }
    film.AddSample(pixel, FiniteSample(emitted * sample.weight, stats), pass);
  });
}

PassStats LightTracingIntegrator::RenderLightPaths(int pass, Film& film) const {
  PassStats sum;
  ForEachLightPath<PassStats>(
      *emission_, seed_, pass, paths_,
      [&](const EmissionSample& emitted, const Sampler& sampler, PassStats& chunk) {
        ++chunk.photonsEmitted;
        const auto join = [&](const LightVertex& vertex) {
          // The lens is a decision of its own, apart from the walk's.
          constexpr int kLensBlock = 1 << 16;
          Sampler lens = sampler;
          lens.StartBlock(kLensBlock + vertex.scattered);
          Join(vertex, lens.Get2D(), 1 / static_cast<float>(paths_), pass, film, chunk);
        };
        AddLightPath(TraceLightPath(*scene_, emitted, sampler, options_.maxDepth, join), emitted, &chunk);
      },
      [&](const PassStats& chunk, int64_t) { sum += chunk; });
  return sum;
}

void LightTracingIntegrator::Join(const LightVertex& vertex, const Vec2d& uLens, float weight, int pass, Film& film,
                                  PassStats& stats) const {
  const SurfaceInteraction& hit = vertex.hit;
  if (vertex.bsdf.IsPurelySpecular()) return;
  const std::optional<WiSample> join = scene_->GetCamera().Sample_Wi(hit.p, uLens);
  if (!join) return;
  std::array<Vec2, Camera::kMostRepeats + 1> places;
  const int count = FilmPlaces(film, join->film, &places);
  if (count == 0) return;
  const auto scatter = [&] { return vertex.bsdf.Eval(hit.wo, join->wi, TransportMode::Importance); };
  const Color value = Finite(vertex.flux * scatter() * (weight * join->We / static_cast<float>(join->pdf)),
                             &stats.nonFinite, [&] { return SourceAt(*scene_, hit, scatter); });
  if (value.IsBlack()) return;
  ++stats.shadowRays;
  if (!scene_->Unoccluded(SpawnRayTo(hit, join->lens, 0, Vec3(0)))) return;
  ++stats.splats;
  for (int i = 0; i < count; ++i) film.AddSplat(places[static_cast<size_t>(i)], value, pass);
}

int LightTracingIntegrator::FilmPlaces(const Film& film, const Vec2& position,
                                       std::array<Vec2, Camera::kMostRepeats + 1>* places) const {
  const Imath::Box2d reach = film.SplatBounds();
  int count = 0;
  const auto keep = [&](const Vec2& place) {
    if (reach.intersects(Vec2d(place.x, place.y))) (*places)[static_cast<size_t>(count++)] = place;
  };
  keep(position);
  std::array<Vec2, Camera::kMostRepeats> repeats;
  const int repeated = scene_->GetCamera().FilmRepeats(position, &repeats);
  for (int i = 0; i < repeated; ++i) keep(repeats[static_cast<size_t>(i)]);
  return count;
}

}  // namespace dapple
