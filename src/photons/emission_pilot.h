// The pilot that teaches an `EmissionGuide`: which photons come to something for the camera.
#pragma once

#include <cstdint>

#include "src/photons/emission_guide.h"
#include "src/scene/scene.h"

namespace dapple {

/// Photons of a pilot, at most.
inline constexpr int64_t kMostPilotPhotons = 1 << 16;

/// Follows a few thousand camera paths to the surfaces that gather photons, then rounds of photons, each round guided
/// by those before it. A photon is of use where it lands near such a point with at least one scattering event behind
/// it. `finalGathers`: diffuse scatterings of a camera path before it gathers. The
/// result depends on the arguments alone; it bends nothing where no photon came to anything.
EmissionGuide LearnEmissionGuide(const Scene& scene, int maxDepth, int finalGathers, uint64_t seed);

/// The same for light paths whose vertices are joined to the camera, which must allow it (`Camera::CanConnect`): a
/// vertex is of use where it is in the picture.
EmissionGuide LearnJoinedEmissionGuide(const Scene& scene, int maxDepth, uint64_t seed);

}  // namespace dapple
