// The pilot that teaches an `EmissionGuide`: which photons come to something for the camera.
#pragma once

#include <cstdint>

#include "src/photons/emission_guide.h"
#include "src/scene/scene.h"

namespace dapple {

/// What learning a guide takes at most, and the guide.
int64_t EmissionPilotBytes(const Scene& scene);

/// Follows a few thousand camera paths to the surfaces that gather photons, then rounds of photons, each round guided
/// by those before it. A photon is of use where it lands near such a point, on the side that is seen, with at least one
/// scattering event behind it. `finalGathers`: diffuse scatterings of a camera path before it gathers. The result
/// depends on the arguments alone; it bends nothing where no photon came to anything.
EmissionGuide LearnEmissionGuide(const Scene& scene, int maxDepth, int finalGathers, uint64_t seed);

/// The same for light paths whose vertices are joined to the camera: a vertex is of use where it is in the picture.
EmissionGuide LearnJoinedEmissionGuide(const Scene& scene, int maxDepth, uint64_t seed);

}  // namespace dapple
