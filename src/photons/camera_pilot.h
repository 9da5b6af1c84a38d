// Camera paths of a pilot: from the lens to the surfaces that gather photons.
#pragma once

#include <algorithm>
#include <cmath>

#include "src/sampling/sampler.h"
#include "src/scene/scene.h"

namespace dapple {

/// How narrow a scattering is that goes a way of this density: 0 for the widest, 1 for specular ones.
inline double Sharpness(double pdf) {
  constexpr double kHalfSharp = 10;  // per solid angle: a lobe of about 0.1 sr
  return pdf / (pdf + kHalfSharp);
}

/// Walks a camera path through specular surfaces, through others the more likely the narrower they scatter (with the
/// probability `Sharpness`: no roughness decides), and through `finalGathers` more. Calls `visit(const
/// SurfaceInteraction&, const Bsdf&, float distance)`, with the length of the path so far, at each that is neither
/// black nor purely specular. Returns the number of segments traced. Uses block n of the sampler at its n-th surface.
template <typename Visitor>
int FollowCameraPath(const Scene& scene, const CameraRay& camera, int finalGathers, Sampler& sampler, Visitor&& visit) {
  constexpr int kMaxBounces = 8;
  Ray ray = camera.ray;
  float distance = 0;
  int segments = 0;
  for (int bounce = 1; bounce <= kMaxBounces;) {
    ++segments;
    const std::optional<SurfaceInteraction> hit = scene.Intersect(ray);
    if (!hit) break;
    distance += hit->t;
    const Material* material = scene.MaterialAt(*hit);
    if (!material) {
      ray = SpawnRay(*hit, ray.d);
      continue;
    }
    const Bsdf bsdf = material->GetBsdf(*hit);
    if (bsdf.IsBlack()) break;
    if (!bsdf.IsPurelySpecular()) visit(*hit, bsdf, distance);
    sampler.StartBlock(bounce++);
    const double uLobe = sampler.Get1D();
    const std::optional<BsdfSample> next = bsdf.Sample(hit->wo, uLobe, sampler.Get2D(), TransportMode::Radiance);
    if (!next) break;
    if (!next->IsSpecular() && sampler.Get1D() >= Sharpness(static_cast<double>(next->pdf)) && finalGathers-- == 0)
      break;
    ray = SpawnRay(*hit, next->wi);
  }
  return segments;
}

/// Calls `follow(const CameraRay&, Sampler&)` for about `paths` rays spread over the whole picture, so that a crop of
/// it is lit by the same photons. Returns the distance between them, in pixels (>= 1).
template <typename Follow>
double ForEachPilotRay(const Scene& scene, int paths, uint64_t seed, Follow&& follow) {
  const Vec2i& resolution = scene.Settings().resolution;
  const double step = std::max(1.0, std::sqrt(static_cast<double>(resolution.x) * resolution.y / paths));
  int64_t path = 0;
  for (double y = step / 2; y < resolution.y; y += step)
    for (double x = step / 2; x < resolution.x; x += step) {
      Sampler sampler = Sampler::ForLightPath(seed, path++, 0, paths);
      const Vec2d uLens = sampler.Get2D();
      const Vec2 position(static_cast<float>(x), static_cast<float>(y));
      follow(scene.GetCamera().GenerateRay(position, uLens, sampler.Get1D()), sampler);
    }
  return step;
}

}  // namespace dapple
