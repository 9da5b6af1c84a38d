// Whether a scene is still the one that it was: a hash of all that its picture follows from.
#pragma once

#include <string>
#include <vector>

#include "src/io/scene_description.h"

namespace dapple {

struct SceneContent {
  std::string hash;                ///< 32 hexadecimal digits
  std::vector<std::string> files;  ///< that the scene is read from, each once: its text, and what its parameters name
};

/// The hash follows from what the statements say and from the content of each regular file that a parameter names
/// (meshes, images, spectra) of something that is used (scene_use.h), as far as it can be read; and not from comments,
/// layout, how the text is cut into files, or where it lies. The sampler's and the integrator's statements are left
/// out: what Dapple takes from them the command line may say too, so it belongs to the options of the render; and so is
/// how environments are sampled, which the choice of the algorithm may change. Files of what is not used are listed and
/// not opened.
SceneContent HashSceneContent(const SceneDescription& scene);

/// By which technique each infinite light draws directions, in the scene's order: "irradiance,importance"; "none" where
/// there is none. For a light that is the same from everywhere, where the file says nothing: "uniform light".
std::string DescribeEnvironmentSampling(const SceneDescription& scene);

}  // namespace dapple
