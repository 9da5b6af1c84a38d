// Unidirectional path tracing with next-event estimation and multiple importance sampling (Kajiya 1986; Veach 1997,
// chapter 9; pbrt-v4, section 14.5): the reference for all that it can see. It cannot see light of delta lights through
// smooth glass or by mirrors, and sees caustics of small lights badly. A pass is one path a pixel, or as
// much work as several, with more paths where the picture is noisy.
#pragma once

#include "integrators/camera_path.h"
#include "integrators/sample_allocation.h"

namespace dapple {

class PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const IntegratorOptions& options) : options_(options) {}

  std::string_view Name() const override { return "path"; }
  void Prepare(const Scene& scene, uint64_t seed) override;
  PassForecast Forecast(const Scene&, uint64_t) const override {
    return {.cameraSamples = options_.cameraSamples.value_or(1)};
  }
  PassStats RenderPass(int pass, Film& film) const override;
  PreparationUse Preparation() const override { return {samples_.Table(), {0, samples_.PilotRays()}}; }
  int DefaultPasses() const override { return 64; }

  /// What one path brings back from where it is, along its ray; once prepared. Uses the blocks of the sampler after 0.
  Color Radiance(CameraWalk walk, Sampler& sampler, PassStats& stats) const;

 private:
  SampleAllocation::Tracer Tracer() const;

  IntegratorOptions options_;
  SampleAllocation samples_{1};
  const Scene* scene_ = nullptr;
  uint64_t seed_ = 0;
};

}  // namespace dapple
