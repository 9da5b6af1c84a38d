#include "src/io/scene_description.h"

#include <algorithm>

namespace dapple {

namespace {

bool Exists(const std::filesystem::path& path) {
  std::error_code failure;  // names too long for the file system exist nowhere
  return std::filesystem::exists(path, failure);
}

}  // namespace

std::unordered_map<std::string_view, int> SceneDescription::MaterialsByName() const {
  std::unordered_map<std::string_view, int> indices;
  for (std::size_t i = 1; i < materials.size(); ++i)
    if (!materials[i].name.empty()) indices[materials[i].name] = static_cast<int>(i);
  return indices;
}

std::filesystem::path SceneDescription::ResolvePath(const std::string& name, const FileLocation& namedAt) const {
  std::filesystem::path path(name);
  if (path.is_absolute()) return path;
  std::filesystem::path besideScene = folder / path;
  if (Exists(besideScene) || !namedAt.file) return besideScene;
  std::filesystem::path besideFile = std::filesystem::path(*namedAt.file).parent_path() / path;
  return Exists(besideFile) ? besideFile : besideScene;
}

namespace {

void Set(LightDescription* light, Parameter parameter) {
  parameter.location = light->location;
  light->params.Add(std::move(parameter));
}

}  // namespace

bool HasImage(const LightDescription& light) {
  const auto namesImage = [](const Parameter& p) { return p.name == "mapname" || p.name == "filename"; };
  return std::ranges::any_of(light.params.All(), namesImage);
}

int SetOnInfiniteLights(SceneDescription* description, const Parameter& parameter) {
  int count = 0;
  for (LightDescription& light : description->lights) {
    if (!IsInfinite(light)) continue;
    Set(&light, parameter);
    ++count;
  }
  return count;
}

void SetDefaultOnEnvironmentMaps(SceneDescription* description, const Parameter& parameter) {
  for (LightDescription& light : description->lights) {
    if (IsInfinite(light) && HasImage(light) && !light.params.Has(parameter.name)) Set(&light, parameter);
  }
}

}  // namespace dapple
