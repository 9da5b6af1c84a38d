// The interface of all algorithms: prepare once, then render passes that know nothing of each other.
//
// `Prepare` makes immutable state from scene and seed. `RenderPass(pass, film)` adds the pass-th estimate of the whole
// image; it depends on scene, seed, prepared state and pass number alone, and is itself parallel. The image is the mean
// of the passes. Budgets, progress, snapshots and checkpoints belong to the driver (src/render).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "integrators/non_finite.h"
#include "src/image/film.h"
#include "src/photons/kernel.h"
#include "src/photons/pilot_use.h"
#include "src/scene/scene.h"

namespace dapple {

/// What a pass did: counted where it happens, summed over passes.
struct PassStats {
  int64_t cameraRays = 0;      ///< segments traced from the camera, bounces included
  int64_t shadowRays = 0;      ///< visibility tests of connections
  int64_t photonRays = 0;      ///< segments traced from the lights
  int64_t probeRays = 0;       ///< short segments that ask how much of a gather's disk its surface fills
  int64_t photonsEmitted = 0;  ///< light paths that left a light
  int64_t photonsStored = 0;
  int64_t gathers = 0;          ///< photon map queries
  int64_t photonsGathered = 0;  ///< photons within reach of a query
  int64_t splats = 0;           ///< light path vertices joined to the camera
  int64_t photonMaps = 0;       ///< that were built
  int64_t photonMapBytes = 0;   ///< of those of a pass together; of passes, the most
  NonFiniteCounts nonFinite;    ///< contributions that were left out, before they came to the film

  int64_t Rays() const { return cameraRays + shadowRays + photonRays + probeRays; }
  PassStats& operator+=(const PassStats& s);
};

/// What `Prepare` needed beside the scene.
struct PreparationUse {
  TableUse tables;  ///< of what pilots learned
  PilotUse pilots;  ///< what these traced
};

/// About what a pass does and takes, told before anything is prepared.
struct PassForecast {
  int cameraSamples = 1;   ///< camera paths a pixel
  int64_t lightPaths = 0;  ///< without what a pilot would learn: at most a factor of two off or so
  bool storesPhotons = false;
  int64_t pilotBytes = 0;  ///< that preparation takes at most
  PilotUse pilot{};        ///< what it took to tell this
};

/// Whose directions find direct light where a camera path scatters. Light of delta lights is sampled in any case.
enum class DirectTechnique {
  Mis,    ///< the lights' and the BSDF's, joined by multiple importance sampling
  Light,  ///< the lights' alone: next-event estimation
  Bsdf,   ///< the BSDF's alone
};

/// How camera paths find direct light.
struct DirectLighting {
  DirectTechnique technique = DirectTechnique::Mis;
  /// Next-event samples at each vertex, over all lights. Absent: one light is picked, and gets `Light::SampleCount()`.
  std::optional<int> lightSamples;

  /// Next-event samples at a vertex where this light is picked.
  int SamplesOf(const Light& light) const { return lightSamples.value_or(light.SampleCount()); }
};

class EmissionGuide;

/// What the user may set; absent values follow from the scene.
struct IntegratorOptions {
  int maxDepth = 32;                  ///< scattering events on a path from light to camera
  std::optional<int> photonsPerPass;  ///< light paths a pass
  /// Of `path`: a pass takes as many rays as so many camera paths a pixel, and noisy places get more of them
  /// (sample_allocation.h). Absent: one path through each pixel.
  std::optional<int> cameraSamples;
  std::optional<double> radius;  ///< starting radius of density estimates, in scene units
  double radiusScale = 1;        ///< factor on the learned radii (gather_radius.h), where `radius` is absent
  KernelShape kernel = KernelShape::Epanechnikov;  ///< of density estimates
  bool guideEmission = true;  ///< a pilot learns where photons are of use (src/photons/emission_guide.h)
  /// What that pilot has learned already, of this scene, depth and seed, without final gathers; null: not yet.
  std::shared_ptr<const EmissionGuide> guide;
  DirectLighting direct;
};

/// All options by name, as text: two renders of one scene, seed and integrator have the same bits where these are
/// equal.
std::vector<std::pair<std::string, std::string>> DescribeOptions(const IntegratorOptions& options);

class Integrator {
 public:
  virtual ~Integrator() = default;

  virtual std::string_view Name() const = 0;
  /// The scene must outlive the integrator. Called once, before any pass.
  virtual void Prepare(const Scene& scene, uint64_t seed) = 0;
  /// What that took; once prepared.
  virtual PreparationUse Preparation() const { return {}; }
  /// Needs no preparation.
  virtual PassForecast Forecast(const Scene&, uint64_t /*seed*/) const { return {}; }
  /// Adds pass number `pass` (from 0) to the film. May be called in any order and for any set of passes.
  virtual PassStats RenderPass(int pass, Film& film) const = 0;
  /// Whether the picture has a bias, which shrinks with the passes, because densities are estimated: then it adds to
  /// the film's blur where that is tracked.
  virtual bool EstimatesDensity() const { return false; }
  /// Passes where neither the scene nor the user says how many.
  virtual int DefaultPasses() const = 0;
};

/// The names that `MakeIntegrator` knows, without "auto".
std::vector<std::string_view> IntegratorNames();

/// Throws `Error` for an unknown name, listing those known.
std::unique_ptr<Integrator> MakeIntegrator(std::string_view name, const IntegratorOptions& options);

}  // namespace dapple
