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

LightContext ContextOf(const SurfaceInteraction& hit, const Bsdf& bsdf) {
  // The geometric normal: it is what decides, in the BSDF too, from which side light counts. The point is moved off the
  // surface to that side, so that the inside of a lamp is inside, however the point was rounded.
  const Vec3 n = FaceForward(bsdf.GeometricNormal(), hit.wo);
  return {OffsetOrigin(hit.p, hit.pError, hit.ng, n), n, bsdf.Flags().HasTransmission()};
}

Color EmittedAlong(const Scene& scene, const Ray& ray, const SurfaceInteraction* hit, const LastScattering& last) {
  const auto weighted = [&](int index, const Color& radiance) {
    if (radiance.IsBlack() || last.isSpecular) return radiance;
    const Light& light = *scene.Lights()[static_cast<size_t>(index)];
    const double lightPdf = scene.Picker().ProbabilityFor(last.at, index) * light.Pdf_Li(last.at, ray.d, hit);
    return radiance * static_cast<float>(PowerHeuristic(last.pdf, lightPdf));
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

Color SampleDirectLight(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf, Sampler& sampler,
                        PassStats& stats) {
  const Vec2d uDirection = sampler.Get2D();
  const double uLight = sampler.Get1D();
  const LightContext at = ContextOf(hit, bsdf);
  const PickedLight picked = scene.Picker().PickFor(at, uLight);
  if (picked.index < 0) return Color();
  const Light& light = *scene.Lights()[static_cast<size_t>(picked.index)];
  const std::optional<LiSample> li = light.Sample_Li(at, {picked.u, uDirection});
  if (!li) return Color();
  const Color scattered = bsdf.Eval(hit.wo, li->wi, TransportMode::Radiance) * li->L;
  if (scattered.IsBlack()) return Color();
  ++stats.shadowRays;
  if (!scene.Unoccluded(scene.ShadowRay(hit, *li))) return Color();
  const double pdf = picked.probability * li->pdf;
  const double weight = li->isDelta ? 1 : PowerHeuristic(pdf, bsdf.Pdf(hit.wo, li->wi, TransportMode::Radiance));
  return scattered * static_cast<float>(weight / pdf);
}

bool SurvivesRoulette(double u, float etaScale, Color* throughput) {
  const float keep = throughput->MaxComponent() * etaScale;
  if (keep >= 1) return true;
  if (!(u < keep)) return false;
  *throughput /= keep;
  return true;
}

}  // namespace dapple
