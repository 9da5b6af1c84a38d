// Path tracing and photons, joined by multiple importance sampling: each light path is found by whatever finds it best.
//
// A pass traces photons and builds a photon map; then camera paths, as in `path`, sample light and run into lights, and
// at each of their vertices also merge with the photons within a radius. Every way to find a light path has its share
// by the balance heuristic (merging_weights.h): a diffuse wall lit by a window stays path traced, the caustic of a
// small lamp on it comes from photons, and what stands between slides from one to the other. No roughness decides.
//
// Work follows the weights. Where many photons are at hand, few camera paths go on after a diffuse scattering; and
// after one, few merge again, for a single direction of light would be all that they learn. Both are probabilities that
// change smoothly with the density of the scattering, and part of the weights. Radii: gather_radius.h.
#pragma once

#include "integrators/light_walk.h"
#include "integrators/photon_shooting.h"
#include "integrators/pixel_loop.h"
#include "src/base/octahedral.h"
#include "src/photons/photon_map.h"

namespace dapple {

class HybridIntegrator final : public Integrator {
 public:
  /// Throws `Error` where direct light is to be found by one technique alone: here all are joined.
  explicit HybridIntegrator(const IntegratorOptions& options);

  std::string_view Name() const override { return "hybrid"; }
  void Prepare(const Scene& scene, uint64_t seed) override;
  PassStats RenderPass(int pass, Film& film) const override;
  PreparationUse Preparation() const override { return plan_->Use(); }
  PassForecast Forecast(const Scene& scene, uint64_t seed) const override {
    return ForecastPhotonPass(scene, options_, 0, seed);
  }
  bool EstimatesDensity() const override { return true; }
  int DefaultPasses() const override { return 64; }

 private:
  /// A photon where it met a surface.
  struct Photon {
    Color flux;
    OctahedralVector wi;      ///< to where the light came from
    OctahedralVector normal;  ///< geometric
    float merging, paths;     ///< `MergingWeights::Before` of its light path
    int scattered;            ///< scattering events before this surface, at least one
  };

  /// How a pass merges.
  struct Merging {
    float radiusFactor;  ///< on the starting radius
    bool tracksBlur;     ///< merges with half the radius too
    PhotonMap<Photon> map;
  };

  /// A camera path on its way.
  struct Walk : CameraWalk {
    using CameraWalk::CameraWalk;

    MergingWeights weights;
    double mergeProbability = 1;

    void ScatterSpecular(const SurfaceInteraction& hit, const BsdfSample& next) {
      Scatter(hit, next);
      weights.ScatterSpecular(static_cast<double>(AbsDot(hit.ng, next.wi)));
    }
  };

  MergeSite SiteAt(const Vec3& p, const Merging& merging) const;

  /// Leaves the map to be filled.
  PassStats ShootPhotons(int pass, Merging* merging) const;
  PathEstimate Radiance(Walk walk, const Merging& merging, Sampler& sampler, PassStats& stats) const;
  /// Radiance that the path's last ray runs into, with its weight. `hit` is null where the ray left the scene.
  Color EmittedAlong(const Walk& walk, const SurfaceInteraction* hit, PassStats& stats) const;
  Color SampleDirectLight(const Walk& walk, const MergeSite& site, const SurfaceInteraction& hit, const Bsdf& bsdf,
                          Sampler& sampler, PassStats& stats) const;
  /// Radiance of the photons within the radius, with their weights.
  PathEstimate Merge(const Walk& walk, const Merging& merging, const MergeSite& at, const SurfaceInteraction& hit,
                     const Bsdf& bsdf, uint64_t seed, PassStats& stats) const;

  IntegratorOptions options_;
  const Scene* scene_ = nullptr;
  std::optional<PhotonPlan> plan_;
  uint64_t seed_ = 0;
};

}  // namespace dapple
