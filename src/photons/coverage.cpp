#include "src/photons/coverage.h"

#include <algorithm>

#include "src/base/frame.h"
#include "src/base/hash.h"

namespace dapple {

namespace {

/// Whether photons may lie there: all along one shape if they do at `at`, which gathers them.
bool HoldsPhotons(const Scene& scene, const SurfaceInteraction& there, const SurfaceInteraction& at) {
  if (there.shape == at.shape) return true;
  const Material* material = scene.MaterialAt(there);
  if (!material) return false;
  const Bsdf bsdf = material->GetBsdf(there);
  return !bsdf.IsBlack() && !bsdf.IsPurelySpecular();
}

/// Whether the site's surface lies above or below a point of its tangent disk.
bool IsOfSurface(const Scene& scene, const SurfaceInteraction& at, const GatherSite& site, const Vec3& offset,
                 int64_t* rays) {
  // At the rim too, rounding must not hide the surface.
  const float height = std::max(SafeSqrt(Sqr(site.radius) - LengthSquared(offset)), 0.1f * site.radius);
  const Vec3 begin = site.p + offset + site.n * height, end = site.p + offset - site.n * height;
  Ray ray{begin, -site.n, 2 * height};
  for (;;) {
    ++*rays;
    const std::optional<SurfaceInteraction> hit = scene.Intersect(ray);
    if (!hit) return false;
    if (IsOnSameSurface(site, hit->p, DistanceSquared(hit->p, site.p), hit->ng, site.n) &&
        HoldsPhotons(scene, *hit, at))
      return true;
    ray = SpawnRay(*hit, ray.d);
    ray.tMax = Dot(ray.o - end, site.n);
    if (!(ray.tMax > 0)) return false;
  }
}

}  // namespace

float InverseCoverage(const Scene& scene, const SurfaceInteraction& hit, const GatherSite& site, KernelShape shape,
                      uint64_t seed, int64_t* rays) {
  constexpr int kMostTrials = 64;
  GatherSite eitherSide = site;
  eitherSide.transmits = true;
  const Frame frame = Frame::FromZ(site.n);
  const Kernel kernel(shape, site.radius);
  int trials = 1;
  for (; trials < kMostTrials; ++trials) {
    const uint64_t u = Hash(seed, trials);
    const Vec2 offset =
        kernel.Sample({static_cast<double>(u >> 32) * 0x1p-32, static_cast<double>(u & 0xffffffff) * 0x1p-32});
    if (IsOfSurface(scene, hit, eitherSide, frame.ToWorld(Vec3(offset.x, offset.y, 0)), rays)) break;
  }
  return static_cast<float>(trials);
}

}  // namespace dapple
