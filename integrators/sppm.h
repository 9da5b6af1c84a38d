// Stochastic progressive photon mapping (Hachisuka and Jensen 2009): camera paths end at the first surface that is not
// specular, and gather there. Glossy surfaces see what a mirror sees, blurred, and few photons come from where they
// look: camera paths go on through them, as through mirrors.
#pragma once

#include "integrators/photon_gatherer.h"

namespace dapple {

class SppmIntegrator final : public PhotonGatherer {
 public:
  explicit SppmIntegrator(const IntegratorOptions& options) : PhotonGatherer(options, {}) {}

  std::string_view Name() const override { return "sppm"; }
};

}  // namespace dapple
