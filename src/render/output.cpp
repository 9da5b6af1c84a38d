#include "src/render/output.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "src/base/error.h"
#include "src/image/atomic_file.h"

namespace dapple {

namespace {

enum class Format { kExr, kPng };

Format FormatOf(const std::string& path) {
  const std::string extension = LowerCaseExtension(path);
  if (extension == ".exr") return Format::kExr;
  if (extension == ".png") return Format::kPng;
  throw Error(FileLocation(path),
              fmt::format("expected a file name that ends in .exr or .png, not in '{}'", extension));
}

}  // namespace

std::string LowerCaseExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

ImageMetadata ToMetadata(const RenderRecord& record) {
  ImageMetadata metadata{
      {"scene", record.scene},   {"integrator", record.integrator}, {"seed", record.seed},
      {"passes", record.passes}, {"version", record.version},       {"instructionSet", record.instructionSet},
  };
  if (record.seconds) metadata["seconds"] = *record.seconds;
  if (record.error) metadata["error"] = *record.error;
  if (record.clamp) metadata["clamp"] = double{*record.clamp};
  return metadata;
}

void CheckOutput(const std::string& path) {
  FormatOf(path);
  CheckFolder(path);
}

void CheckFolder(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status)) throw Error(FileLocation(path), "expected the name of a file; this is a folder");
  // Devices and pipes are written to where they are.
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    if (access(path.c_str(), W_OK) != 0) throw Error(FileLocation(path), "this is no file, and not writable");
    return;
  }
  const fs::path parent = fs::path(path).parent_path();
  const fs::path folder = parent.empty() ? fs::path(".") : parent;
  if (!fs::is_directory(folder, ignored)) {
    throw Error(FileLocation(path), fmt::format("the folder '{}' does not exist; create it first", folder.string()));
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Error(FileLocation(path), fmt::format("the folder '{}' is not writable", folder.string()));
  }
  // Rights do not tell all: root has them in folders that take no file, and a name may be too long.
  CheckWritable(path);
}

void WriteOutput(const std::string& path, const Image& image, const ImageMetadata& metadata) {
  switch (FormatOf(path)) {
    case Format::kExr:
      return WriteExr(path, image, metadata);
    case Format::kPng:
      return WritePng(path, image);
  }
}

}  // namespace dapple
