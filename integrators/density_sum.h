// A density estimate at a place of a surface: what its photons add up to, and, on request, by how much that exceeds
// what a gather with half the radius gives.
//
//   DensitySum sum(kernel, hit, bsdf.Flags().HasTransmission(), radius, film.TracksBlur());
//   map.ForEachWithin(hit.p, radius, [&](position, photon, distanceSquared) {
//     const PhotonPlace place{position, distanceSquared, photon.normal.Decode(), wi};
//     if (sum.Takes(place)) sum.Add(place, value);
//   });
//   const PathEstimate estimate = sum.Estimate(scene, seed, &stats.probeRays);
#pragma once

#include "integrators/pixel_loop.h"
#include "src/photons/coverage.h"
#include "src/photons/kernel.h"
#include "src/photons/same_surface.h"

namespace dapple {

/// The radius for which blur is told, as a share of the gather's own.
inline constexpr float kBlurRadius = 0.5f;

/// Where a photon lies, as `IsOnSameSurface` takes it.
struct PhotonPlace {
  const Vec3& position;
  float distanceSquared;
  Vec3 normal, wi;
};

class DensitySum {
 public:
  DensitySum(KernelShape shape, const SurfaceInteraction& hit, bool transmits, float radius, bool tracksBlur)
      : shape_(shape),
        hit_(hit),
        site_(hit.p, hit.ng, hit.wo, radius, transmits),
        narrowSite_(hit.p, hit.ng, hit.wo, radius * kBlurRadius, transmits),
        kernel_(shape, radius),
        narrowKernel_(shape, radius * kBlurRadius),
        narrowSquared_(tracksBlur ? Sqr(radius * kBlurRadius) : -1) {}

  /// Whether a photon within the radius lies on the surface.
  bool Takes(const PhotonPlace& at) const {
    return IsOnSameSurface(site_, at.position, at.distanceSquared, at.normal, at.wi);
  }

  /// Adds the `value` of a photon that is taken: its `ShadedFlux` times the BSDF with its cosine (`Bsdf::Eval`), W /
  /// sr. The photon has the cosine of its own shading normal, so that of the gathering point's is divided out; what
  /// bumps do to it stays.
  void Add(const PhotonPlace& at, const Color& value, float weight = 1) {
    const float cosine = AbsDot(hit_.ns, at.wi);
    if (!(cosine > 0)) return;
    sum_ += value * (kernel_(at.distanceSquared) / cosine * weight);
    if (at.distanceSquared < narrowSquared_ &&
        IsOnSameSurface(narrowSite_, at.position, at.distanceSquared, at.normal, at.wi))
      narrowSum_ += value * (narrowKernel_(at.distanceSquared) / cosine * weight);
  }

  /// Radiance: what was added, divided by how much of the disk the surface fills (coverage.h).
  PathEstimate Estimate(const Scene& scene, uint64_t seed, int64_t* rays) const {
    const auto covered = [&](const Color& sum, const GatherSite& site) {
      return sum.IsBlack() ? sum : sum * InverseCoverage(scene, hit_, site, shape_, seed, rays);
    };
    const Color radiance = covered(sum_, site_);
    return {radiance, narrowSquared_ > 0 ? radiance - covered(narrowSum_, narrowSite_) : Color()};
  }

 private:
  KernelShape shape_;
  const SurfaceInteraction& hit_;
  GatherSite site_, narrowSite_;
  Kernel kernel_, narrowKernel_;
  float narrowSquared_;  ///< -1 where blur is not asked for
  Color sum_, narrowSum_;
};

}  // namespace dapple
