#include "src/image/image_io.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "src/image/image_formats.h"

namespace dapple {

namespace {

namespace fs = std::filesystem;

// Larger files are no images that this program could hold: 2^28 pixels of four floats are 2^32 bytes.
constexpr uintmax_t kMaxFileBytes = uintmax_t{1} << 33;

std::string ReadFile(const std::string& path, const FileLocation& location) {
  std::error_code failure;
  if (!fs::exists(path, failure)) throw Error(location, fmt::format("image file \"{}\" not found", path));
  if (!fs::is_regular_file(path, failure))
    throw Error(location, fmt::format("\"{}\" is no file: expected an image", path));
  const uintmax_t size = fs::file_size(path, failure);
  if (failure) throw Error(location, fmt::format("cannot read image file \"{}\": {}", path, failure.message()));
  if (size > kMaxFileBytes) throw Error(location, fmt::format("image file \"{}\" is too large: {} bytes", path, size));
  std::string bytes(static_cast<size_t>(size), '\0');
  std::ifstream stream(path, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw Error(location, fmt::format("cannot read image file \"{}\"", path));
  return bytes;
}

bool HasExtension(const std::string& path, std::string_view lowerCase) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == lowerCase;
}

}  // namespace

void CheckImageSize(int64_t width, int64_t height, const FileLocation& location) {
  if (width < 1 || height < 1)
    throw Error(location, fmt::format("image of {} x {} pixels: expected at least one", width, height));
  if (width > kMaxImageSide || height > kMaxImageSide || width * height > kMaxImagePixels)
    throw Error(location, fmt::format("image of {} x {} pixels is too large: expected at most {} a side and {} in all",
                                      width, height, kMaxImageSide, kMaxImagePixels));
}

float ColorEncoding::Decode(float encoded) const {
  switch (kind_) {
    case Kind::kLinear:
      return encoded;
    case Kind::kGamma:
      return std::pow(encoded, gamma_);
    case Kind::kSRgb:
      break;
  }
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float EncodeSRgb(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

Image DecodeImage(std::string_view bytes, const std::string& path, ColorEncoding encoding,
                  const FileLocation& location) {
  if (bytes.starts_with("\x76\x2f\x31\x01")) return ReadExr(bytes, location);
  if (bytes.starts_with("PF") || bytes.starts_with("Pf")) return ReadPfm(bytes, location);
  if (bytes.starts_with("#?")) return ReadHdr(bytes, location);
  const bool isStb = bytes.starts_with("\x89PNG") || bytes.starts_with("\xff\xd8");
  if (isStb || HasExtension(path, ".tga")) return ReadStb(bytes, encoding, location);
  throw Error(location, "unknown image format: expected OpenEXR, PNG, JPEG, TGA, Radiance HDR or PFM");
}

Image ReadImage(const std::string& path, ColorEncoding encoding, const FileLocation& location) {
  // Messages of the decoders name the file by their place; where the scene is that place, the name goes into the text.
  const FileLocation file(path);
  try {
    return DecodeImage(ReadFile(path, location.file ? location : file), path, encoding, file);
  } catch (const Error& error) {
    if (!location.file || error.Location().file == location.file) throw;
    const std::string prefix = path + ": error: ";
    const std::string_view message = error.what();
    throw Error(location, fmt::format("image file \"{}\": {}", path,
                                      message.starts_with(prefix) ? message.substr(prefix.size()) : message));
  } catch (const std::bad_alloc&) {
    throw Error(location.file ? location : file, fmt::format("not enough memory for image file \"{}\"", path));
  }
}

}  // namespace dapple
