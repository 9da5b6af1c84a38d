#include "integrators/camera_path.h"

#include "src/sampling/mis.h"

namespace dapple {

PixelSample SamplePixel(const Scene& scene, const Film& film, const Vec2i& pixel, Sampler& sampler) {
  const FilterSample offset = film.PixelFilter().Sample(sampler.Get2D());
  const Vec2 position(static_cast<float>(pixel.x + 0.5 + offset.offset.x),
                      static_cast<float>(pixel.y + 0.5 + offset.offset.y));
  const Vec2d uLens = sampler.Get2D();
  return {scene.GetCamera().GenerateRay(position, uLens, sampler.Get1D()), offset.weight};
}

LightContext ContextOf(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf,
                       const DirectLighting& direct) {
  // The geometric normal: it is what decides, in the BSDF too, from which side light counts. The point is moved off the
  // surface to that side, so that the inside of a lamp is inside, however the point was rounded.
  const Vec3 n = FaceForward(bsdf.GeometricNormal(), hit.wo);
  LightContext at(OffsetOrigin(hit.p, hit.pError, hit.ng, n), n, bsdf.Flags().HasTransmission());
  at.bsdfDrawsToo = direct.technique == DirectTechnique::Mis;
  if (bsdf.IsPurelySpecular()) return at;
  for (const Light* light : scene.LightsThatWantReceivers())
    if (auto table = light->PrepareReceiver(at, bsdf, hit.wo)) at.tables.push_back(std::move(table));
  return at;
}

Color EmittedAlong(const Scene& scene, const Ray& ray, const SurfaceInteraction* hit, const LastScattering& last,
                   const DirectLighting& direct) {
  const auto weighted = [&](int index, const Color& radiance) {
    if (radiance.IsBlack() || last.isSpecular || direct.technique == DirectTechnique::Bsdf) return radiance;
    if (direct.technique == DirectTechnique::Light) return Color();
    const Light& light = *scene.Lights()[static_cast<size_t>(index)];
    const double lightPdf = scene.Picker().ProbabilityFor(last.at, index) * light.Pdf_Li(last.at, ray.d, hit);
    return radiance * static_cast<float>(PowerHeuristic(last.pdf, direct.SamplesOf(light) * lightPdf));
  };
  Color sum;
  if (hit) {
    const int light = scene.AreaLightAt(*hit);
    if (light >= 0) sum = weighted(light, scene.Lights()[static_cast<size_t>(light)]->L(*hit, hit->wo));
  } else {
    for (int light : scene.InfiniteLights())
      sum += weighted(light, scene.Lights()[static_cast<size_t>(light)]->Le(ray));
  }
  return sum;
}

Color SampleDirectLight(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf, const LightContext& at,
                        Sampler& sampler, PassStats& stats, const DirectLighting& direct) {
  const Vec2d uDirection = sampler.Get2D();
  PickedLight picked = scene.Picker().PickFor(at, sampler.Get1D());
  if (picked.index < 0) return Color();
  const int count = direct.SamplesOf(*scene.Lights()[static_cast<size_t>(picked.index)]);

  const auto sample = [&](const Vec2d& u) {
    const Light& light = *scene.Lights()[static_cast<size_t>(picked.index)];
    if (direct.technique == DirectTechnique::Bsdf && !light.IsDelta()) return Color();
    const std::optional<LiSample> li = light.Sample_Li(at, {picked.u, u});
    if (!li) return Color();
    const Color scattered = bsdf.Eval(hit.wo, li->wi, TransportMode::Radiance) * li->L;
    if (scattered.IsBlack()) return Color();
    ++stats.shadowRays;
    if (!scene.Unoccluded(scene.ShadowRay(hit, *li))) return Color();
    const double pdf = picked.probability * li->pdf;
    const bool isWeighted = !li->isDelta && direct.technique == DirectTechnique::Mis;
    const double bsdfPdf = isWeighted ? static_cast<double>(bsdf.Pdf(hit.wo, li->wi, TransportMode::Radiance)) : 0;
    return scattered * static_cast<float>(PowerHeuristic(count * pdf, bsdfPdf) / pdf);
  };
  if (count == 1) return sample(uDirection);
  Color sum;
  for (int i = 0; i < count; ++i) {
    Sampler numbers = sampler.Branch(i, count);
    const Vec2d u = numbers.Get2D();
    const double uLight = numbers.Get1D();
    if (direct.lightSamples) {
      picked = scene.Picker().PickFor(at, uLight);
    } else {
      picked.u = uLight;
    }
    sum += sample(u);
  }
  return sum / static_cast<float>(count);
}

bool SurvivesRoulette(double u, float etaScale, Color* throughput) {
  const float keep = throughput->MaxComponent() * etaScale;
  if (keep >= 1) return true;
  if (!(u < keep)) return false;
  *throughput /= keep;
  return true;
}

}  // namespace dapple
