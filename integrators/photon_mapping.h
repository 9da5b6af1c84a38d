// Photon mapping with two maps (Jensen 1996, "Global illumination using photon maps"; Jensen 2001, chapter 9): a
// caustic map that is seen directly, and a map of all other photons behind a final gather, so that what is seen of them
// is not their noise but their mean over all directions. A camera path goes on through specular and glossy surfaces and
// the first wide one to the next wide one, which gathers both maps: from the first wide one by the density of the BSDF
// mixed with that of the directions from which photons came there (src/photons/gather_guide.h).
#pragma once

#include "integrators/photon_gatherer.h"

namespace dapple {

class PhotonMappingIntegrator final : public PhotonGatherer {
 public:
  explicit PhotonMappingIntegrator(const IntegratorOptions& options)
      : PhotonGatherer(options, {.finalGathers = 1, .hasCausticMap = true}) {}

  std::string_view Name() const override { return "photon_mapping"; }
};

}  // namespace dapple
