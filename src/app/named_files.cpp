#include "src/app/named_files.h"

#include <filesystem>
#include <set>

#include <CLI/Error.hpp>
#include <fmt/format.h>

namespace dapple {

namespace {

/// One for all paths that lead to a file, whether it is there or not.
std::filesystem::path Canonical(const std::string& path) {
  std::error_code failure;
  const std::filesystem::path absolute = std::filesystem::absolute(path, failure);
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(absolute, failure);
  return failure ? absolute.lexically_normal() : canonical;
}

class FileCollector {
 public:
  explicit FileCollector(const SceneDescription& scene) : scene_(scene) {
    for (const std::filesystem::path& text : scene.textFiles) files_.insert(text.string());
  }

  void Add(const Entity& entity) {
    for (const Parameter& parameter : entity.params.All()) Add(parameter);
  }
  template <typename T>
  void AddAll(const std::vector<T>& entities) {
    for (const T& entity : entities) Add(entity);
  }

  std::vector<std::string> Files() const { return {files_.begin(), files_.end()}; }

 private:
  void Add(const Parameter& parameter) {
    if (parameter.type != ParameterType::String && parameter.type != ParameterType::Spectrum) return;
    for (const std::string& text : parameter.strings) {
      std::error_code failure;
      const std::filesystem::path path = scene_.ResolvePath(text, parameter.location);
      if (!text.empty() && std::filesystem::is_regular_file(path, failure)) files_.insert(path.string());
    }
  }

  const SceneDescription& scene_;
  std::set<std::string> files_;
};

}  // namespace

std::string FindClash(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
  std::vector<NamedFile> others;
  for (const NamedFile& file : read) others.push_back({file.role, Canonical(file.path).string()});
  for (const NamedFile& file : written) {
    const std::string path = Canonical(file.path).string();
    for (const NamedFile& other : others) {
      if (path != other.path) continue;
      return file.role == other.role ? fmt::format("two of {} are one file: '{}'", file.role, file.path)
                                     : fmt::format("{} and {} are one file: '{}'", other.role, file.role, file.path);
    }
    others.push_back({file.role, path});
  }
  return "";
}

void RequireNoClash(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read) {
  if (const std::string clash = FindClash(written, read); !clash.empty()) throw CLI::ValidationError(clash);
}

std::vector<NamedFile> NamedFiles(const std::string& role, const std::vector<std::string>& paths) {
  std::vector<NamedFile> files;
  for (const std::string& path : paths) files.push_back({role, path});
  return files;
}

std::vector<std::string> FilesOf(const SceneDescription& scene) {
  FileCollector collector(scene);
  collector.Add(scene.camera);
  collector.Add(scene.pixelFilter);
  collector.AddAll(scene.materials);
  collector.AddAll(scene.textures);
  collector.AddAll(scene.lights);
  collector.AddAll(scene.areaLights);
  collector.AddAll(scene.shapes);
  for (const ObjectDefinition& object : scene.objects) collector.AddAll(object.shapes);
  return collector.Files();
}

}  // namespace dapple
