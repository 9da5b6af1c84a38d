// What camera paths of all integrators share: the first ray, light that a path runs into, light that is sampled for it.
#pragma once

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
PixelSample SamplePixel(const Scene& scene, const Film& film, const Vec2i& pixel, Sampler& sampler);

/// How a path came to where it is, as multiple importance sampling must know it of the light it runs into.
struct LastScattering {
  /// True where no light sampling could have found what comes next: the camera's own ray, or a specular scattering.
  bool isSpecular = true;
  LightContext at{Vec3(0)};
  float pdf = 0;  ///< per solid angle, of the direction taken
};

/// Radiance that the path's last ray runs into, weighted against light sampling by the power heuristic (unless `direct`
/// leaves all to one of the two). `hit` is null where the ray left the scene.
Color EmittedAlong(const Scene& scene, const Ray& ray, const SurfaceInteraction* hit, const LastScattering& last,
                   const DirectLighting& direct = {});

/// Radiance scattered at `hit` toward `hit.wo` of light that is sampled at the lights, weighted against BSDF sampling
/// by the power heuristic. `at` as `ContextOf` gives it. Takes three numbers of the sampler; more samples than one take
/// the branches of its block.
Color SampleDirectLight(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf, const LightContext& at,
                        Sampler& sampler, PassStats& stats, const DirectLighting& direct = {});

/// Where light is asked for, as lights see it: for both of the above.
LightContext ContextOf(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf,
                       const DirectLighting& direct = {});

/// True where `path` still has its share of energy after Russian roulette; scales its throughput. `etaScale` undoes the
/// change of radiance by refraction, which comes back when the path leaves the medium (pbrt-v4, section 14.5.4).
bool SurvivesRoulette(double u, float etaScale, Color* throughput);

}  // namespace dapple
