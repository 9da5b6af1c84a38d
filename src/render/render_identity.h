// What the bits of a pass follow from, by name: passes of two renders may be joined where their identities are equal.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "integrators/integrator.h"
#include "src/image/film.h"
#include "src/render/aov.h"

namespace dapple {

/// Names and values; the values of "scene", "sources" and "build" are hashes. In the order in which they are told.
struct RenderIdentity {
  std::vector<std::pair<std::string, std::string>> fields;

  /// "" where there is no such field.
  std::string ValueOf(const std::string& name) const;
};

/// Of which scene a render is.
struct SceneIdentity {
  std::string hash;                 ///< of `HashSceneContent`
  std::string environmentSampling;  ///< how directions toward infinite lights are drawn
};

/// The identity of a render by this program on this processor. Of the film counts what it is, not what it holds.
RenderIdentity MakeIdentity(const SceneIdentity& scene, const Film& film, const AovSet& aovs,
                            const std::string& integrator, const IntegratorOptions& options, int seed);

/// What of `other` is not as in `expected`, for people: "seed 8, not 7; the scene's content"; empty where the passes of
/// both are of one picture. Between portable builds of the same sources, by the same compiler and with
/// the same shared libraries, it does not matter which file the program is and on which processor it runs.
std::string Differences(const RenderIdentity& other, const RenderIdentity& expected);

}  // namespace dapple
