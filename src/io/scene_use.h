// What of a scene's description its picture may follow from.
#pragma once

#include <vector>

#include "src/io/scene_description.h"

namespace dapple {

/// By index of the description: whether lights, shapes or instances lead there. The builder looks at nothing else (it
/// may look at less: a light of no power needs no image).
struct SceneUse {
  std::vector<bool> materials, textures, areaLights, objects;
};

SceneUse FindUse(const SceneDescription& description);

}  // namespace dapple
