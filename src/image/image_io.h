// Image files: reads OpenEXR, PNG, JPEG, TGA, Radiance HDR and PFM; writes OpenEXR and PNG.
//
// The format is told by the file's content, not its name (only TGA, which has no mark, needs its extension). Every
// failure is an `Error` that names the file. A file that is written is either whole or not there (atomic_file.h).
#pragma once

#include <map>
#include <string>
#include <variant>

#include "src/base/error.h"
#include "src/image/image.h"

namespace dapple {

/// How the integers of a PNG, JPEG or TGA file stand for linear values in [0, 1].
class ColorEncoding {
 public:
  /// IEC 61966-2-1.
  static ColorEncoding SRgb() { return {Kind::kSRgb, 0}; }
  static ColorEncoding Linear() { return {Kind::kLinear, 1}; }
  /// linear = encoded^gamma, gamma > 0.
  static ColorEncoding Gamma(float gamma) { return {Kind::kGamma, gamma}; }

  /// The linear value of an encoded one in [0, 1].
  float Decode(float encoded) const;
  friend bool operator==(const ColorEncoding&, const ColorEncoding&) = default;

 private:
  enum class Kind { kSRgb, kLinear, kGamma };
  ColorEncoding(Kind kind, float gamma) : kind_(kind), gamma_(gamma) {}

  Kind kind_;
  float gamma_;
};

/// The sRGB code in [0, 1] of a linear value; below 0 (and NaN) gives 0, above 1 gives 1.
float EncodeSRgb(float linear);

/// No image of more pixels, or of a wider or higher size, is read.
inline constexpr int64_t kMaxImagePixels = int64_t{1} << 28;
inline constexpr int kMaxImageSide = 1 << 16;

/// Reads the image file at `path` to linear floats.
///
/// Channels: those of an EXR file by its names (R, G, B, A first; half, float and uint; luminance-chroma files become
/// R, G, B), otherwise Y; Y, A; R, G, B or R, G, B, A. Pixels of an EXR file are those of its data window; `origin` and
/// `fullSize` say where they lie in the display window. Infinities and NaNs of a file are kept. `encoding` decodes the
/// colour (not the alpha) of 8- and 16-bit files and is not asked for EXR, HDR and PFM, which are linear.
///
/// Throws `Error` at `location` (where the scene names the image; by default the image file itself) where the file is
/// missing, cut short, of no known format, or too large.
Image ReadImage(const std::string& path, ColorEncoding encoding = ColorEncoding::SRgb(),
                const FileLocation& location = {});

/// Named values stored in an EXR header.
using ImageMetadata = std::map<std::string, std::variant<std::string, double, int>>;

enum class ExrPixelType { kFloat, kHalf };

/// Writes all channels as scanlines with ZIP compression. The data window is the image's place (`origin`) in the
/// display window (`fullSize`), as pbrt writes crops. As half, finite values beyond 65504 become that.
/// The same image gives the same bytes. Throws `Error`.
void WriteExr(const std::string& path, const Image& image, const ImageMetadata& metadata = {},
              ExrPixelType type = ExrPixelType::kFloat);

/// A PNG file of `image.ColorAt` of every pixel, clamped to [0, 1] and sRGB-encoded, 8 bits a channel. The same image
/// gives the same bytes. Throws `Error` at `location`.
std::string EncodePng(const Image& image, const FileLocation& location = {});

/// Writes what `EncodePng` gives. Throws `Error`.
void WritePng(const std::string& path, const Image& image);

/// The metadata of an EXR file that `WriteExr` could have written (strings, doubles, integers; floats become doubles).
ImageMetadata ReadExrMetadata(const std::string& path);

}  // namespace dapple
