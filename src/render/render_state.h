// A render's exact sums in a file, with what they are of: to go on with it, and to join ranges of its passes.
//
//   WriteState("a.dapple", origin, film);                      // passes 0 to 15, say, and elsewhere 16 to 31
//   RenderState state = ReadState("a.dapple");
//   JoinState(ReadState("b.dapple"), "b.dapple", &state);
//   RequireAllPasses(state.film, std::nullopt);
//   WriteOutput("picture.exr", ToPicture(state.film, origin.exposure, origin.aovs), ToMetadata(RecordOf(state)));
#pragma once

#include <optional>
#include <string>

#include "src/image/film.h"
#include "src/render/aov.h"
#include "src/render/output.h"
#include "src/render/render_identity.h"

namespace dapple {

/// What sums are of: which passes may be added to them, and what is recorded in a picture made of them.
struct RenderOrigin {
  RenderIdentity identity;
  RenderRecord record;  ///< `passes` does not count here: the film has them
  float exposure = 1;
  AovSet aovs;
};

struct RenderState {
  RenderOrigin origin;
  Film film;
};

/// True for names that end in ".dapple".
bool IsStateName(const std::string& path);

/// Writes the state as one file, whole or not at all. Throws `Error`.
void WriteState(const std::string& path, const RenderOrigin& origin, const Film& film);

/// Reads what `WriteState` wrote. Throws `Error` where there is no such file or it is damaged, and where the film does
/// not have the channels of the layers.
RenderState ReadState(const std::string& path);

/// Adds the passes of `part` (of the file `path`) to `*whole`, whose origin becomes that of the part with the lowest
/// pass, so that the sum is the same in any order of parts. Throws `Error` at `path` where it is of another render,
/// saying what differs, or where a pass is in both.
void JoinState(const RenderState& part, const std::string& path, RenderState* whole);

/// Throws `Error` where the film does not hold passes 0 to `passes` - 1 (absent: to its last one) and no other, naming
/// the ranges that are missing or too many.
void RequireAllPasses(const Film& film, std::optional<int> passes);

/// What is recorded in the picture of this state: nothing of how long it took.
RenderRecord RecordOf(const RenderState& state);

}  // namespace dapple
