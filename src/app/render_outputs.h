// The files in which a render's result is kept: pictures, and the exact sums.
#pragma once

#include <string>
#include <vector>

#include "src/render/render_state.h"

namespace dapple {

/// Checks of an option's text: what is wrong with its ending as that of a picture, .exr or .png; of a result, which may
/// be .dapple too.
std::string CheckPictureName(const std::string& path);
std::string CheckResultName(const std::string& path);

/// True for names of files that hold a picture's layers beside it: .exr.
bool HoldsLayers(const std::string& path);

/// Throws `Error` where no result can be written to `path`, as `CheckOutput` does; takes ".dapple" too.
void CheckRenderOutput(const std::string& path);

/// What came of writing results.
struct WrittenOutputs {
  std::vector<std::string> paths;   ///< those that are written
  std::vector<std::string> errors;  ///< of each of the others, a line
};

/// Writes the picture of the film, or its exact sums, by the extension of each path. One that fails costs no other.
WrittenOutputs WriteRenderOutputs(const std::vector<std::string>& paths, const RenderOrigin& origin,
                                  const RenderRecord& record, const Film& film);

/// A variance that nobody knows must not be taken for none.
void WarnOfVariance(const std::vector<std::string>& paths, const AovSet& aovs, const Film& film);

/// A picture of fewer samples than were paid for must not go unnoticed, however quiet the render.
void WarnOfNonFinite(const Film& film);

}  // namespace dapple
