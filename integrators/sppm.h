// Stochastic progressive photon mapping in independent passes (Hachisuka and Jensen 2009; Knaus and Zwicker 2011).
//
// A pass traces photons, builds a photon map, and follows one camera path a pixel to the first surface that is not
// purely specular. There, direct light is sampled (with multiple importance sampling), and the photons within a radius
// give the rest. The radius starts at what a pilot learned for the place (src/photons/gather_radius.h) and shrinks with
// the pass number, so that noise and blur both vanish; no statistics are kept from pass to pass.
//
// A glossy surface sees what a mirror sees, blurred: few photons come from where it looks. It gathers caustic photons
// only (light that met nothing but specular surfaces), and the camera path goes on through it to find all other light.
// Each light path is so found in one way: the sum stays exact whatever counts as glossy.
#pragma once

#include "integrators/camera_path.h"
#include "integrators/photon_shooting.h"
#include "src/base/octahedral.h"
#include "src/photons/photon_map.h"

namespace dapple {

class SppmIntegrator final : public Integrator {
 public:
  explicit SppmIntegrator(const IntegratorOptions& options) : options_(options) {}

  std::string_view Name() const override { return "sppm"; }
  void Prepare(const Scene& scene, uint64_t seed) override;
  PassStats RenderPass(int pass, Film& film) const override;
  PreparationUse Preparation() const override { return plan_->Use(); }
  int DefaultPasses() const override { return 64; }

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

  Map TracePhotons(int pass, PassStats* stats) const;
  /// What the photons of a pass are gathered with.
  struct PhotonPass {
    const Map& map;
    float weight;        ///< 1 / light paths of the pass
    float radiusFactor;  ///< on the starting radius
  };
  Color Radiance(const CameraRay& camera, const PhotonPass& photons, Sampler& sampler, PassStats& stats) const;
  /// What a gather takes of the photons within its radius.
  struct GatherLimits {
    float radius;
    int maxScattered;
    bool causticsOnly;
  };
  Color Gather(const Map& map, const SurfaceInteraction& hit, const Bsdf& bsdf, const GatherLimits& limits,
               PassStats& stats) const;

  IntegratorOptions options_;
  const Scene* scene_ = nullptr;
  std::optional<PhotonPlan> plan_;
  uint64_t seed_ = 0;
};

}  // namespace dapple
