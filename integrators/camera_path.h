// What camera paths of all integrators share: the first ray, light that a path runs into, light that is sampled for it.
#pragma once

#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>

#include "integrators/integrator.h"
#include "src/sampling/sampler.h"
#include "src/scene/scene.h"

namespace dapple {

/// A ray through a pixel, its film offset drawn by the filter.
struct PixelSample {
  CameraRay camera;
  float weight = 1;  ///< of the filter; its mean is one
};

/// Uses block 0 of the sampler.
PixelSample SamplePixel(const Scene& scene, const Filter& filter, const Vec2i& pixel, Sampler& sampler);

/// How a path came to where it is, as multiple importance sampling must know it of the light it runs into.
struct LastScattering {
  /// True where no light sampling could have found what comes next: the camera's own ray, or a specular scattering.
  bool isSpecular = true;
  LightContext at{Vec3(0)};
  float pdf = 0;  ///< per solid angle, of the direction taken
};

/// A camera path on its way.
struct CameraWalk {
  explicit CameraWalk(const Ray& cameraRay) : ray(cameraRay) {}

  Ray ray;
  Color throughput{1};
  LastScattering last;
  int scattered = 0;
  bool isAllSpecular = true;  ///< so far
  float etaScale = 1;         ///< undoes what refraction does to radiance, for `SurvivesRoulette`

  /// Goes on from `hit`; `at`, unless the scattering is specular: where light was asked for.
  void Scatter(const SurfaceInteraction& hit, const BsdfSample& next, LightContext at = LightContext(Vec3(0)));
  void ScatterSpecular(const SurfaceInteraction& hit, const BsdfSample& next) { Scatter(hit, next); }
};

/// Radiance that the path's last ray runs into: the sum over the lights it finds of their radiance times
/// `weigh(int light)`. `hit` is null where the ray left the scene. As all that follows: what is not finite is left out
/// and counted.
template <typename Weigh>
Color EmittedAlong(const Scene& scene, const Ray& ray, const SurfaceInteraction* hit, PassStats& stats, Weigh&& weigh);

/// The same, weighted against light sampling by the power heuristic (unless `direct` leaves all to one of the two).
Color EmittedAlong(const Scene& scene, const Ray& ray, const SurfaceInteraction* hit, const LastScattering& last,
                   PassStats& stats, const DirectLighting& direct = {});

/// The way on of a camera path from `hit`; nothing where it ends.
std::optional<BsdfSample> SampleWayOn(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf, double uLobe,
                                      const Vec2d& uDirection, PassStats& stats);

/// Radiance scattered at `hit` toward `hit.wo` of light that is sampled at the lights, times `weigh(int light, const
/// LiSample&, double pdf)`, where `pdf` is the density of all samples together. `at` as `ContextOf` gives it. Takes
/// three numbers of the sampler; more samples than one take the branches of its block.
template <typename Weigh>
Color SampleDirectLight(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf, const LightContext& at,
                        Sampler& sampler, PassStats& stats, const DirectLighting& direct, Weigh&& weigh);

/// The same, weighted against BSDF sampling by the power heuristic.
Color SampleDirectLight(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf, const LightContext& at,
                        Sampler& sampler, PassStats& stats, const DirectLighting& direct = {});

/// Both ways on where a camera path that met nothing but specular surfaces comes to a smooth interface, so that what
/// either brings is no matter of chance; nothing where one of them would count for less than a hundredth of what the
/// camera sees. All techniques that find the paths behind share this beginning, so no weight of multiple importance
/// sampling changes. For walks that soon end in a gather of photons; it would cost long paths more time than it saves.
std::optional<SpecularPair> SplitWayOn(const CameraWalk& walk, const SurfaceInteraction& hit, const Bsdf& bsdf);

/// Where `SplitWayOn` parts the walk, sends it on through the interface, and returns what `follow(Walk, Sampler&)`
/// finds by the other way; nothing where it does not. Takes no number of the sampler's block.
template <typename Walk, typename Follow>
auto FollowReflected(Walk* walk, const SurfaceInteraction& hit, const Bsdf& bsdf, const Sampler& sampler,
                     Follow&& follow) -> std::optional<std::invoke_result_t<Follow, Walk, Sampler&>> {
  const auto ways = SplitWayOn(*walk, hit, bsdf);
  if (!ways) return std::nullopt;
  Walk reflected = *walk;
  reflected.ScatterSpecular(hit, ways->reflected);
  walk->ScatterSpecular(hit, ways->transmitted);
  Sampler fork = sampler.Fork();
  return follow(std::move(reflected), fork);
}

/// The density per solid angle (of a delta light: the discrete probability) with which light sampling at `at` finds the
/// direction `wi` to a light, all its samples together. `hit` as for `Light::Pdf_Li`.
double LightPdf(const Scene& scene, const LightContext& at, int light, const Vec3& wi, const SurfaceInteraction* hit,
                const DirectLighting& direct);

/// The same where one sample of the light has the density `pdf`.
double LightPdf(const Scene& scene, const LightContext& at, int light, double pdf, const DirectLighting& direct);

/// Where light is asked for, as lights see it: for both of the above.
LightContext ContextOf(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf,
                       const DirectLighting& direct = {});

/// True where a path still has its share of energy after Russian roulette, which begins after three scattering events;
/// scales its throughput. Radiance that refraction has changed comes back when the path leaves the medium: that change
/// is left out of the probability (pbrt-v4, section 14.5.4).
bool SurvivesRoulette(double u, CameraWalk* walk);

/// What a path runs into of a light, times `weight()`.
template <typename Weight>
Color WeightedEmission(int light, const Color& radiance, PassStats& stats, Weight&& weight) {
  if (radiance.IsBlack()) return radiance;
  return Finite(radiance * static_cast<float>(weight()), &stats.nonFinite,
                [&] { return radiance.IsFinite() ? NonFiniteSource::Integrator() : NonFiniteSource::Light(light); });
}

template <typename Weigh>
Color EmittedAlong(const Scene& scene, const Ray& ray, const SurfaceInteraction* hit, PassStats& stats, Weigh&& weigh) {
  const auto weighted = [&](int light, const Color& radiance) {
    return WeightedEmission(light, radiance, stats, [&] { return weigh(light); });
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

template <typename Weigh>
Color SampleDirectLight(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf, const LightContext& at,
                        Sampler& sampler, PassStats& stats, const DirectLighting& direct, Weigh&& weigh) {
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
    return Finite(scattered * static_cast<float>(weigh(picked.index, *li, count * pdf) / pdf), &stats.nonFinite, [&] {
      if (!(li->L.IsFinite() && IsFinite(li->wi) && std::isfinite(li->pdf) && li->pdf > 0))
        return NonFiniteSource::Light(picked.index);
      return SourceAt(scene, hit, [&] { return bsdf.Eval(hit.wo, li->wi, TransportMode::Radiance); });
    });
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

}  // namespace dapple
