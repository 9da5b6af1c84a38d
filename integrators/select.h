// Which algorithm renders a scene, and why: the rule behind "auto".
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "integrators/integrator.h"

namespace dapple {

/// An integrator's name, and in a few words why it was chosen.
struct IntegratorChoice {
  std::string name;
  std::string reason;
  /// What goes into `IntegratorOptions`, beside what the user has said.
  std::shared_ptr<const EmissionGuide> guide;  ///< what a pilot learned on the way; or null
  std::optional<int> cameraSamples;
  PilotUse pilots{};  ///< those that looked for rare light or taught a guide that is not handed on
};

/// "path", with more camera paths in noisy places, where what the scene holds makes no light that paths find seldom;
/// else a pilot (rare_light.h) tells whether photons are worth what they cost, or find what paths never will: then
/// "hybrid". Where direct light shall
/// be found by one technique alone, "hybrid", which joins all, gives way to "sppm". Depends on scene, options and seed
/// alone.
IntegratorChoice SelectIntegrator(const Scene& scene, const IntegratorOptions& options, uint64_t seed);

/// True where neither the user (empty or "auto") nor the scene's file (empty, or a name that Dapple does not have)
/// names an algorithm: then `SelectIntegrator` does.
bool IsLeftToDapple(std::string_view requested, std::string_view fromScene);

/// True where the algorithm of that name asks lights for directions (`Light::Sample_Li`, or its density) of which any
/// are drawn; of a name that is not Dapple's: true.
inline bool DrawsTowardLights(std::string_view integrator, DirectTechnique technique) {
  return technique != DirectTechnique::Bsdf && integrator != "light_tracing";
}

/// The user's name, else the scene's where Dapple has it, else `SelectIntegrator`. `requested` may be empty or "auto".
IntegratorChoice ResolveIntegrator(std::string_view requested, const Scene& scene, const IntegratorOptions& options,
                                   uint64_t seed);

}  // namespace dapple
