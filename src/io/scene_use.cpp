#include "src/io/scene_use.h"

namespace dapple {

namespace {

class UseFinder {
 public:
  explicit UseFinder(const SceneDescription& description) : description_(description) {
    use_.materials.resize(description.materials.size());
    use_.textures.resize(description.textures.size());
    use_.areaLights.resize(description.areaLights.size());
    use_.objects.resize(description.objects.size());
  }

  SceneUse Find() {
    for (const LightDescription& light : description_.lights) MarkTextures(light.params);
    for (const ShapeDescription& shape : description_.shapes) Mark(shape);
    for (const InstanceDescription& instance : description_.instances) MarkObject(static_cast<size_t>(instance.object));
    FollowMaterials();
    FollowTextures();
    return std::move(use_);
  }

 private:
  void Mark(const ShapeDescription& shape) {
    MarkTextures(shape.params);
    MarkMaterial(static_cast<size_t>(shape.material));
    if (shape.areaLight >= 0) use_.areaLights[static_cast<size_t>(shape.areaLight)] = true;
  }

  void MarkObject(size_t object) {
    if (use_.objects[object]) return;
    use_.objects[object] = true;
    for (const ShapeDescription& shape : description_.objects[object].shapes) Mark(shape);
  }

  void MarkMaterial(size_t material) {
    if (use_.materials[material]) return;
    use_.materials[material] = true;
    toFollow_.push_back(material);
  }

  /// Of both kinds where both have the name that a parameter gives.
  void MarkTextures(const ParameterList& params) {
    for (const Parameter& parameter : params.All())
      for (const int texture : {parameter.floatTexture, parameter.spectrumTexture})
        if (texture >= 0) use_.textures[static_cast<size_t>(texture)] = true;
  }

  /// To the materials that mixes name, and to all their textures.
  void FollowMaterials() {
    const auto byName = description_.MaterialsByName();
    while (!toFollow_.empty()) {
      const MaterialDescription& material = description_.materials[toFollow_.back()];
      toFollow_.pop_back();
      MarkTextures(material.params);
      if (material.type != "mix") continue;
      for (const Parameter& parameter : material.params.All())
        for (const std::string& name : parameter.strings)
          if (const auto found = byName.find(name); found != byName.end())
            MarkMaterial(static_cast<size_t>(found->second));
    }
  }

  /// To the textures that textures name, which stand before them.
  void FollowTextures() {
    for (size_t i = use_.textures.size(); i-- > 0;)
      if (use_.textures[i]) MarkTextures(description_.textures[i].params);
  }

  const SceneDescription& description_;
  SceneUse use_;
  std::vector<size_t> toFollow_;  // materials that are marked, and their parts not yet
};

}  // namespace

SceneUse FindUse(const SceneDescription& description) { return UseFinder(description).Find(); }

}  // namespace dapple
