// What a render will take of memory beside its scene: told before it starts, so that one that cannot fit does not
// start.
#pragma once

#include <cstdint>

#include "integrators/integrator.h"
#include "src/render/aov.h"
#include "src/scene/scene.h"

namespace dapple {

/// Bytes, estimated from above.
struct MemoryNeeds {
  int64_t film = 0;
  int64_t files = 0;       ///< while pictures are written, or the state
  int64_t photons = 0;     ///< of a pass, where the integrator stores any
  int64_t lightPaths = 0;  ///< of a pass, at most, whose photons these are
  int64_t pilots = 0;      ///< while they learn where photons are of use

  int64_t Sum() const { return film + files + photons + pilots; }
};

/// Throws `Error`, at the resolution where the file has it, where the picture has more pixels than a file may have, or
/// its film alone takes more than the `available` bytes. `tracksBlur`: the film does, for the error.
void RequireFilm(const RenderSettings& settings, const AovSet& aovs, bool tracksBlur, int64_t available);

/// What a light path leaves of photons is counted on a few thousand paths, those of each light and direction apart:
/// where the most are left counts, since emission may be guided there. `tracksBlur` as above.
MemoryNeeds EstimateMemory(const Scene& scene, const AovSet& aovs, const Integrator& integrator,
                           const IntegratorOptions& options, uint64_t seed, bool tracksBlur = false);

/// Throws `Error` where the needs and what is in use already are more than the limit: it says what takes how much, and
/// how many photons a pass would fit.
void RequireMemory(int64_t limit, int64_t inUse, const MemoryNeeds& needs);

}  // namespace dapple
