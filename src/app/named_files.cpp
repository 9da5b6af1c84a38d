#include "src/app/named_files.h"

#include <filesystem>
#include <optional>

#include <CLI/Error.hpp>
#include <fmt/format.h>

#include "src/render/snapshots.h"

namespace dapple {

namespace {

/// One for all paths that lead to a file, whether it is there or not.
std::filesystem::path Canonical(const std::string& path) {
  std::error_code failure;
  const std::filesystem::path absolute = std::filesystem::absolute(path, failure);
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(absolute, failure);
  return failure ? absolute.lexically_normal() : canonical;
}

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

std::string FindSnapshotClash(const std::vector<std::string>& outputs, const std::vector<NamedFile>& others) {
  for (const NamedFile& other : others) {
    const std::string path = Canonical(other.path).string();
    for (const std::string& output : outputs) {
      const std::optional<int> passes = SnapshotPasses(output, path);
      if (passes && Canonical(SnapshotName(output, *passes)).string() == path)
        return fmt::format("{} is what a snapshot of '{}' will be called: '{}'", other.role, output, other.path);
    }
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

}  // namespace dapple
