// Progressive photon mapping in independent passes: what `sppm` and `photon_mapping` share (Hachisuka and Jensen 2009;
// Knaus and Zwicker 2011).
//
// A pass traces photons, builds photon maps, and follows camera paths through specular surfaces. At each surface that
// is not purely specular direct light is sampled (with multiple importance sampling), and photons within a radius give
// the rest. The radius starts at what a pilot learned for the place (src/photons/gather_radius.h) and shrinks with the
// pass number, so that noise and blur both vanish; no statistics are kept from pass to pass.
//
// Where a surface gathers caustic photons only (light that met nothing but specular surfaces), the camera path goes on
// through it to find all other light. Each light path is so found in one way, whichever surfaces do that: the sum stays
// exact. Which do is all that tells the two algorithms apart.
#pragma once

#include "integrators/camera_path.h"
#include "integrators/photon_shooting.h"
#include "integrators/pixel_loop.h"
#include "src/base/octahedral.h"
#include "src/photons/gather_guide.h"
#include "src/photons/photon_map.h"

namespace dapple {

class PhotonGatherer : public Integrator {
 public:
  void Prepare(const Scene& scene, uint64_t seed) override;
  PassStats RenderPass(int pass, Film& film) const override;
  PreparationUse Preparation() const override;
  PassForecast Forecast(const Scene& scene, uint64_t seed) const override {
    return ForecastPhotonPass(scene, options_, rules_.finalGathers, seed);
  }
  bool EstimatesDensity() const override { return true; }
  int DefaultPasses() const override { return 64; }

 protected:
  struct Rules {
    /// Wide scatterings of a camera path behind which photons of all kinds are gathered: 0, or 1 for a final gather.
    int finalGathers = 0;
    /// Caustic photons have a map of their own, with radii of their own.
    bool hasCausticMap = false;
  };
  PhotonGatherer(const IntegratorOptions& options, const Rules& rules) : options_(options), rules_(rules) {}

 private:
  /// A photon where it met a surface.
  struct Photon {
    Color flux;
    OctahedralVector wi;      ///< to where the light came from
    OctahedralVector normal;  ///< geometric
    int scattered = 0;        ///< scattering events before this surface, at least one
    bool isCaustic = false;   ///< all of them were specular
  };
  using Map = PhotonMap<Photon>;

  /// What the photons of a pass are gathered with.
  struct PhotonPass {
    Map all;             ///< without the caustic ones where those have their own
    Map caustics;        ///< empty where they have not
    float weight;        ///< 1 / light paths of the pass
    float radiusFactor;  ///< on the starting radii
    bool tracksBlur;     ///< gathers with half the radius too
  };
  PhotonPass TracePhotons(int pass, bool tracksBlur, PassStats* stats) const;

  /// A surface on a camera path that gathers.
  struct GatherPoint {
    const SurfaceInteraction& hit;
    const Bsdf& bsdf;
    int maxScattered;  ///< of the photons that are taken
    bool causticsOnly;
    uint64_t seed;  ///< of the coverage's probes
  };
  /// A camera path on its way.
  struct Walk : CameraWalk {
    Walk(const Ray& cameraRay, int gathers) : CameraWalk(cameraRay), gathersLeft(gathers) {}

    int gathersLeft;
    /// The last wide scattering was where all photons were gathered: only light straight from its source is left to
    /// find.
    bool isDone = false;
  };
  PathEstimate Radiance(Walk walk, const PhotonPass& photons, Sampler& sampler, PassStats& stats) const;
  /// Where a final gather from `hit` looks; null where nothing is known.
  const DirectionTable* GuideAt(const SurfaceInteraction& hit, const Bsdf& bsdf) const;
  PathEstimate Gather(const PhotonPass& photons, const GatherPoint& point, PassStats& stats) const;
  PathEstimate Gather(const Map& map, float radius, bool tracksBlur, const GatherPoint& point, PassStats& stats) const;

  IntegratorOptions options_;
  Rules rules_;
  const Scene* scene_ = nullptr;
  std::optional<PhotonPlan> plan_;
  std::optional<GatherRadius> causticRadius_;  // absent without a map of caustics
  GatherGuide gatherGuide_;                    // of final gathers, where there are any
  uint64_t seed_ = 0;
};

}  // namespace dapple
