// A pilot that counts what light paths and camera paths cost, so that a pass can spend alike on both.
#pragma once

#include <cstdint>

#include "src/photons/emission_sampler.h"
#include "src/scene/scene.h"

namespace dapple {

/// The mean work of one path of each kind, in segments traced. Counted, never timed: the same on any machine.
struct PathWork {
  double light = 1;   ///< segments, and photons stored
  double camera = 1;  ///< segments, light samples and gathers
  PilotUse pilot;     ///< that counted them
};

/// From a few thousand paths of each kind; depends on the arguments alone. `finalGathers` as for `FollowCameraPath`.
PathWork EstimateWork(const Scene& scene, const EmissionSampler& emission, int maxDepth, int finalGathers,
                      uint64_t seed);

}  // namespace dapple
