// Light tracing: paths from the lights, each vertex joined to the camera (Arvo 1986; Dutre, Lafortune and Willems 1993;
// pbrt-v4, section 16.1). It sees caustics at their best, and nothing through glass or in mirrors. What the camera sees
// of the lights themselves comes from one ray a pixel. A pass has as many light paths as the picture has pixels, or as
// asked; a pilot learns which emitted rays come into the picture.
#pragma once

#include <array>

#include "integrators/integrator.h"
#include "src/photons/light_path.h"

namespace dapple {

class LightTracingIntegrator final : public Integrator {
 public:
  explicit LightTracingIntegrator(const IntegratorOptions& options) : options_(options) {}

  std::string_view Name() const override { return "light_tracing"; }
  void Prepare(const Scene& scene, uint64_t seed) override;
  PassStats RenderPass(int pass, Film& film) const override;
  PreparationUse Preparation() const override;
  PassForecast Forecast(const Scene& scene, uint64_t seed) const override;
  int DefaultPasses() const override { return 64; }

 private:
  PassStats RenderEmitters(int pass, Film& film) const;
  PassStats RenderLightPaths(int pass, Film& film) const;
  /// Where light that lands on `position` reaches the film's pixels; returns how many.
  int FilmPlaces(const Film& film, const Vec2& position, std::array<Vec2, Camera::kMostRepeats + 1>* places) const;
  void Join(const LightVertex& vertex, const Vec2d& uLens, float weight, int pass, Film& film, PassStats& stats) const;

  IntegratorOptions options_;
  const Scene* scene_ = nullptr;
  std::optional<EmissionSampler> emission_;
  int64_t paths_ = 0;  // of a pass
  uint64_t seed_ = 0;
};

}  // namespace dapple
