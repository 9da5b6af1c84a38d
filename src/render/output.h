// Image files of a render: which formats there are, whether a path can be written, and what is recorded beside the
// pixels.
//
//   CheckOutput(path);                                   // before hours of work
//   WriteOutput(path, ToPicture(film, exposure), ToMetadata(record));
#pragma once

#include <optional>
#include <string>

#include "src/image/image.h"
#include "src/image/image_io.h"
#include "src/render/version.h"

namespace dapple {

/// What is recorded in the header of an EXR file. All of it but `seconds` follows from what was asked for, so two
/// renders of the same seed and passes give the same file; `seconds` is a measurement and is set where the file is not
/// the same anyway (a budget of time) or where the user asks for it.
struct RenderRecord {
  std::string scene;  ///< the file's name, without its folder
  std::string integrator;
  int seed = 0;
  int passes = 0;
  std::optional<double> seconds;  ///< of the render
  std::optional<float> clamp;     ///< `Film::Clamp`
  std::optional<double> error;    ///< estimated (error_estimate.h), where the render was to stop by it
  std::string version = Version();
  std::string instructionSet = InstructionSet();
};

/// The record under the names of its members.
ImageMetadata ToMetadata(const RenderRecord& record);

/// ".exr" of "Picture.EXR": what tells formats.
std::string LowerCaseExtension(const std::string& path);

/// Throws `Error` where no file can be written to `path`: its folder is missing or not writable or takes no file of
/// that name, or it is a folder itself; or, where it is a device or a pipe, that may not be written to.
void CheckFolder(const std::string& path);

/// Throws `Error` where an image cannot be written to `path`: the extension is neither .exr nor .png (in any case of
/// letters), the folder is missing or not writable, or `path` is a folder.
void CheckOutput(const std::string& path);

/// Writes a linear image by the extension of `path`: .exr keeps all of it, with the metadata; .png has values in [0, 1]
/// in sRGB, 8 bits a channel, and no metadata. The file is whole or not there. Throws `Error` for
/// other extensions and where writing fails.
void WriteOutput(const std::string& path, const Image& image, const ImageMetadata& metadata);

}  // namespace dapple
