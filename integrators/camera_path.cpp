#include "integrators/camera_path.h"

#include "src/sampling/mis.h"

namespace dapple {

PixelSample SamplePixel(const Scene& scene, const Filter& filter, const Vec2i& pixel, Sampler& sampler) {
  const FilterSample offset = filter.Sample(sampler.Get2D());
  const Vec2 position(static_cast<float>(pixel.x + 0.5 + offset.offset.x),
                      static_cast<float>(pixel.y + 0.5 + offset.offset.y));
  const Vec2d uLens = sampler.Get2D();
  return {scene.GetCamera().GenerateRay(position, uLens, sampler.Get1D()), offset.weight};
}

void CameraWalk::Scatter(const SurfaceInteraction& hit, const BsdfSample& next, LightContext at) {
  throughput *= next.weight;
  etaScale *= next.eta * next.eta;
  isAllSpecular &= next.IsSpecular();
  last = {next.IsSpecular(), std::move(at), next.pdf};
  ray = SpawnRay(hit, next.wi);
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
    if (auto table = light->PrepareReceiver(bsdf, hit.wo)) at.tables.push_back(std::move(table));
  return at;
}

Color EmittedAlong(const Scene& scene, const Ray& ray, const SurfaceInteraction* hit, const LastScattering& last,
                   PassStats& stats, const DirectLighting& direct) {
  if (last.isSpecular || direct.technique == DirectTechnique::Bsdf)
    return EmittedAlong(scene, ray, hit, stats, [](int) { return 1; });
  if (direct.technique == DirectTechnique::Light) return Color();
  if (hit)
    return EmittedAlong(scene, ray, hit, stats, [&](int index) {
      return PowerHeuristic(last.pdf, LightPdf(scene, last.at, index, ray.d, hit, direct));
    });
  Color sum;
  for (int index : scene.InfiniteLights()) {
    const RadianceWithPdf value = scene.Lights()[static_cast<size_t>(index)]->LeWithPdf(last.at, ray);
    sum += WeightedEmission(index, value.L, stats, [&] {
      return PowerHeuristic(last.pdf, LightPdf(scene, last.at, index, value.pdf, direct));
    });
  }
  return sum;
}

std::optional<BsdfSample> SampleWayOn(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf, double uLobe,
                                      const Vec2d& uDirection, PassStats& stats) {
  std::optional<BsdfSample> next = bsdf.Sample(hit.wo, uLobe, uDirection, TransportMode::Radiance);
  // The BSDF gives no sample whose weight is not finite.
  if (!next && !bsdf.Albedo(hit.wo).IsFinite()) stats.nonFinite.Add(NonFiniteSource::MaterialAt(scene, hit));
  return next;
}

std::optional<SpecularPair> SplitWayOn(const CameraWalk& walk, const SurfaceInteraction& hit, const Bsdf& bsdf) {
  constexpr float kLeast = 0.01f;
  if (!walk.isAllSpecular) return std::nullopt;
  const auto pair = bsdf.BothWays(hit.wo);
  if (!pair) return std::nullopt;
  // What refraction does to radiance comes back where the path leaves the medium: with it ways would be without number.
  const auto counts = [&](const BsdfSample& way) {
    return (walk.throughput * way.weight).MaxComponent() * walk.etaScale * Sqr(way.eta) >= kLeast;
  };
  return counts(pair->reflected) && counts(pair->transmitted) ? pair : std::nullopt;
}

double LightPdf(const Scene& scene, const LightContext& at, int index, const Vec3& wi, const SurfaceInteraction* hit,
                const DirectLighting& direct) {
  const Light& light = *scene.Lights()[static_cast<size_t>(index)];
  return LightPdf(scene, at, index, light.IsDelta() ? 1 : light.Pdf_Li(at, wi, hit), direct);
}

double LightPdf(const Scene& scene, const LightContext& at, int index, double pdf, const DirectLighting& direct) {
  const Light& light = *scene.Lights()[static_cast<size_t>(index)];
  return direct.SamplesOf(light) * scene.Picker().ProbabilityFor(at, index) * pdf;
}

Color SampleDirectLight(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf, const LightContext& at,
                        Sampler& sampler, PassStats& stats, const DirectLighting& direct) {
  return SampleDirectLight(
      scene, hit, bsdf, at, sampler, stats, direct, [&](int, const LiSample& li, double pdf) -> double {
        if (li.isDelta || direct.technique != DirectTechnique::Mis) return 1;
        return PowerHeuristic(pdf, static_cast<double>(bsdf.Pdf(hit.wo, li.wi, TransportMode::Radiance)));
      });
}

bool SurvivesRoulette(double u, CameraWalk* walk) {
  constexpr int kSureBounces = 3;
  if (walk->scattered <= kSureBounces) return true;
  const float keep = walk->throughput.MaxComponent() * walk->etaScale;
  if (keep >= 1) return true;
  if (!(u < keep)) return false;
  walk->throughput /= keep;
  return true;
}

}  // namespace dapple
