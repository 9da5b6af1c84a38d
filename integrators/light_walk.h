// A light path as multiple importance sampling follows it: at each of its surfaces, by how much more or less densely
// camera paths would have found it so far (merging_weights.h), in all the ways that `hybrid` has.
#pragma once

#include "integrators/camera_path.h"
#include "integrators/emission_ratio.h"
#include "integrators/merging_weights.h"
#include "src/photons/camera_pilot.h"
#include "src/photons/light_path.h"

namespace dapple {

/// Merging at a place: functions of the place alone, so that both walks agree on them. All zero: there is none.
struct MergeSite {
  float radius = 0;
  double eta = 0;      ///< weight of merging, scene units squared, see merging_weights.h
  double photons = 0;  ///< of this pass, expected within the radius
};

/// The probability with which a camera path goes on, along a way of this density, from where it gathered so many
/// photons.
inline double ContinueProbability(double pdf, double photons) {
  const double sharpness = Sharpness(pdf);
  return sharpness + (1 - sharpness) / (1 + photons);
}

/// The weights of a light path, vertex by vertex. `siteAt(const Vec3&)` gives the `MergeSite` of a place.
template <typename SiteAt>
class LightWalk {
 public:
  /// All must outlive the walk.
  LightWalk(const Scene& scene, const DirectLighting& direct, const EmissionSample& emitted, const SiteAt& siteAt)
      : scene_(scene), direct_(direct), emitted_(emitted), siteAt_(siteAt) {}

  /// At a surface; the sums but for the density with which the camera's walk goes on from here along the path.
  const MergingWeights::Sums& Arrive(const LightVertex& vertex) {
    if (vertex.scattered > 0) weights_.Arrive(AbsCosIn(vertex));
    return weights_.Before();
  }

  void Scatter(const LightVertex& vertex, const BsdfSample& next) {
    const double cosOut = static_cast<double>(AbsDot(vertex.hit.ng, next.wi));
    if (vertex.scattered == 0) {
      weights_.Begin(PathsAtFirst(vertex, next), cosOut);
    } else if (next.IsSpecular()) {
      weights_.ScatterSpecular(cosOut);
    } else {
      const MergeSite site = siteAt_(vertex.hit.p);
      const double pdf = CameraPdf(vertex, next);
      weights_.Scatter(site.eta, static_cast<double>(next.pdf), pdf * ContinueProbability(pdf, site.photons),
                       Sharpness(pdf), cosOut);
    }
  }

 private:
  static double AbsCosIn(const LightVertex& vertex) {
    return static_cast<double>(AbsDot(vertex.hit.ng, vertex.hit.wo));
  }

  /// The density with which the camera's walk, coming the way that `next` goes, would go on to where the light came
  /// from.
  static double CameraPdf(const LightVertex& vertex, const BsdfSample& next) {
    return static_cast<double>(vertex.bsdf.Pdf(next.wi, vertex.hit.wo, TransportMode::Radiance));
  }

  /// Of a path that leaves its first surface: the densities of light sampling there and of scattering into the light,
  /// over that of the light path, of which `next` is the newest part.
  double PathsAtFirst(const LightVertex& vertex, const BsdfSample& next) const {
    const LeSample& le = emitted_.le;
    const Light& light = *scene_.Lights()[static_cast<size_t>(emitted_.light)];
    const double distanceSquared = LengthSquared(ToDouble(vertex.hit.p) - ToDouble(le.ray.o));
    const double ratio = EmissionRatio(emitted_.Pdf(), static_cast<double>(le.cosTheta), le.deltaPos, distanceSquared) *
                         AbsCosIn(vertex);
    if (next.IsSpecular()) return light.IsDelta() ? 0 : 1 / ratio;
    // As the camera's walk comes there.
    SurfaceInteraction seen = vertex.hit;
    seen.wo = next.wi;
    const SurfaceInteraction origin = OriginOf(le);
    double paths = LightPdf(scene_, ContextOf(scene_, seen, vertex.bsdf, direct_), emitted_.light, vertex.hit.wo,
                            light.IsInfinite() ? nullptr : &origin, direct_);
    if (!light.IsDelta()) {
      const double pdf = CameraPdf(vertex, next);
      paths += pdf * ContinueProbability(pdf, siteAt_(vertex.hit.p).photons);
    }
    return paths / (ratio * static_cast<double>(next.pdf));
  }

  const Scene& scene_;
  const DirectLighting& direct_;
  const EmissionSample& emitted_;
  const SiteAt& siteAt_;
  MergingWeights weights_;
};

}  // namespace dapple
