#include "src/io/scene_hash.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <string_view>

#include "src/base/content_hash.h"
#include "src/io/scene_use.h"

namespace dapple {

namespace {

constexpr std::string_view kSampling = "sampling";

class SceneHasher {
 public:
  explicit SceneHasher(const SceneDescription& scene) : scene_(scene) {
    for (const std::filesystem::path& text : scene.textFiles) files_.insert(text.string());
  }

  void Add(const Entity& entity) {
    hash_.AddText(entity.type);
    Add(entity.params);
  }
  void Add(const ParameterList& params) { Add(params, ""); }
  void Add(const Transform& transform) {
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) hash_.Add(transform.At(row, column));
  }
  void Add(const ShapeDescription& shape) {
    Add(static_cast<const Entity&>(shape));
    Add(shape.worldFromShape);
    hash_.Add(shape.reverseOrientation);
    hash_.Add(shape.material);
    hash_.Add(shape.areaLight);
  }
  void Add(const TextureDescription& texture) {
    Add(static_cast<const Entity&>(texture));
    hash_.Add(texture.isSpectrum);
    Add(texture.worldFromTexture);
  }
  void Add(const MaterialDescription& material) {
    Add(static_cast<const Entity&>(material));
    hash_.AddText(material.name);
  }
  void Add(const LightDescription& light) {
    hash_.AddText(light.type);
    Add(light.params, IsInfinite(light) ? kSampling : "");
    Add(light.worldFromLight);
  }
  void Add(const ObjectDefinition& object) { AddAll(object.shapes); }
  void Add(const InstanceDescription& instance) {
    hash_.Add(instance.object);
    Add(instance.worldFromInstance);
  }
  template <typename T>
  void AddAll(const std::vector<T>& items) {
    hash_.Add(items.size());
    for (const T& item : items) Add(item);
  }
  /// Of those that are not used the statements alone, not the files.
  template <typename T>
  void AddAll(const std::vector<T>& items, const std::vector<bool>& isUsed) {
    hash_.Add(items.size());
    for (size_t i = 0; i < items.size(); ++i) {
      opensFiles_ = isUsed[i];
      Add(items[i]);
    }
    opensFiles_ = true;
  }

  /// The picture's name is left out: a file of that name is what the render itself writes.
  void AddFilm(const Entity& film) {
    hash_.AddText(film.type);
    Add(film.params, "filename");
  }
  void AddNumber(int number) { hash_.Add(number); }

  SceneContent Content() const { return {hash_.Hex(), {files_.begin(), files_.end()}}; }

 private:
  /// All but the one of the name `leftOut`.
  void Add(const ParameterList& params, std::string_view leftOut) {
    const auto counts = [&](const Parameter& parameter) { return parameter.name != leftOut; };
    hash_.Add(std::ranges::count_if(params.All(), counts));
    for (const Parameter& parameter : params.All())
      if (counts(parameter)) Add(parameter);
  }
  void Add(const Parameter& parameter);
  void AddFileOf(const std::string& name, const FileLocation& namedAt);
  void AddContent(const std::filesystem::path& path);

  const SceneDescription& scene_;
  ContentHash hash_;
  std::set<std::string> files_;
  bool opensFiles_ = true;
};

void SceneHasher::Add(const Parameter& parameter) {
  hash_.AddText(parameter.name);
  hash_.Add(parameter.type);
  hash_.Add(parameter.rgbSpace);
  hash_.Add(parameter.floatTexture);
  hash_.Add(parameter.spectrumTexture);
  hash_.Add(parameter.numbers.size());
  for (const double number : parameter.numbers) hash_.Add(number);
  hash_.Add(parameter.integers.size());
  for (const int integer : parameter.integers) hash_.Add(integer);
  hash_.Add(parameter.strings.size());
  const bool mayNameFiles = parameter.type == ParameterType::String || parameter.type == ParameterType::Spectrum;
  for (const std::string& text : parameter.strings) {
    hash_.AddText(text);
    if (mayNameFiles) AddFileOf(text, parameter.location);
  }
}

// Whether a text is the name of a file depends on the parameter; that there is such a file is all that is asked. One
// too many makes the hash only stricter.
void SceneHasher::AddFileOf(const std::string& name, const FileLocation& namedAt) {
  std::error_code failure;
  const std::filesystem::path path = scene_.ResolvePath(name, namedAt);
  if (name.empty() || !std::filesystem::is_regular_file(path, failure)) return;
  files_.insert(path.string());
  if (opensFiles_) AddContent(path);
}

// As far as the file can be read: where it is needed the builder tells what is wrong with it. No further than it says
// that it is long: what says 0, as many do that the system makes while they are read, may have no end.
void SceneHasher::AddContent(const std::filesystem::path& path) {
  constexpr std::uintmax_t kBlock = std::uintmax_t{1} << 20;
  std::error_code failure;
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  if (failure || size == 0) return hash_.AddText("");
  std::ifstream file(path, std::ios::binary);
  std::string block(static_cast<size_t>(std::min(size, kBlock)), '\0');
  std::uintmax_t left = size;
  for (std::uintmax_t part = kBlock; part == kBlock && file; left -= part) {
    part = std::min(left, kBlock);
    file.read(block.data(), static_cast<std::streamsize>(part));
    hash_.AddText(std::string_view(block).substr(0, static_cast<size_t>(file.gcount())));
  }
}

}  // namespace

SceneContent HashSceneContent(const SceneDescription& scene) {
  SceneHasher hasher(scene);
  const SceneUse use = FindUse(scene);
  hasher.Add(scene.camera);
  hasher.Add(scene.camera.cameraFromWorld);
  hasher.AddFilm(scene.film);
  hasher.Add(scene.pixelFilter);
  hasher.Add(scene.options);
  hasher.AddAll(scene.materials, use.materials);
  hasher.AddAll(scene.textures, use.textures);
  hasher.AddAll(scene.lights);
  hasher.AddAll(scene.areaLights, use.areaLights);
  hasher.AddAll(scene.shapes);
  hasher.AddAll(scene.objects, use.objects);
  hasher.AddAll(scene.instances);
  hasher.AddNumber(scene.version);
  return hasher.Content();
}

std::string DescribeEnvironmentSampling(const SceneDescription& scene) {
  std::string text;
  for (const LightDescription& light : scene.lights) {
    if (!IsInfinite(light)) continue;
    const std::vector<Parameter>& all = light.params.All();
    const auto given = std::ranges::find(all, kSampling, &Parameter::name);
    const bool isNamed = given != all.end() && !given->strings.empty();
    text += text.empty() ? "" : ",";
    text += isNamed ? given->strings[0] : HasImage(light) ? kDefaultEnvironmentSampling : "uniform light";
  }
  return text.empty() ? "none" : text;
}

}  // namespace dapple
