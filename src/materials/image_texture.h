// Textures from image files, the lookup they share with normal maps, and the cache that opens each file once.
//
// (s, t) = (0, 0) is the lower left corner of the image: t goes up, rows go down. Texel centres lie at half-integers.
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "src/image/image.h"
#include "src/image/image_io.h"
#include "src/materials/texture.h"
#include "src/materials/texture_mapping.h"

namespace dapple {

/// What an image is outside [0, 1]^2.
enum class WrapMode {
  kRepeat,
  kBlack,
  kClamp,
  kOctahedralSphere  ///< a neighbouring texel is the one across the fold of the square equal-area map (Clarberg 2008)
};

/// pbrt's "trilinear" and "EWA" count as bilinear: a ray here knows no footprint.
enum class ImageFilter { kPoint, kBilinear };

/// Parameters of pbrt's "imagemap" beyond file, encoding and mapping.
struct ImageTextureOptions {
  WrapMode wrap = WrapMode::kRepeat;
  ImageFilter filter = ImageFilter::kBilinear;
  float scale = 1;
  bool invert = false;  ///< pbrt-v4: max(0, 1 - scale * texel)
};

/// The colour of an image (`Image::ColorAt`) at the mapped point.
class ImageColorTexture final : public ColorTexture {
 public:
  /// Throws `Error` at `location` where the image is empty.
  ImageColorTexture(std::shared_ptr<const Image> image, TextureMappingPtr mapping,
                    const ImageTextureOptions& options = {}, const FileLocation& location = {});
  Color Evaluate(const TextureContext& at) const override;

 private:
  std::shared_ptr<const Image> image_;
  TextureMappingPtr mapping_;
  ImageTextureOptions options_;
};

/// The number that pbrt reads from a pixel of several channels; a gray pixel is that number in all.
enum class PixelScalar {
  kLuminance,       ///< pbrt-v3; alpha is ignored
  kAlphaOrAverage,  ///< pbrt-v4: alpha where the image has one that is not 1 everywhere, otherwise (R + G + B) / 3
};

/// One number of each pixel of an image at the mapped point.
class ImageFloatTexture final : public FloatTexture {
 public:
  /// Throws `Error` at `location` where the image is empty.
  ImageFloatTexture(std::shared_ptr<const Image> image, TextureMappingPtr mapping, PixelScalar scalar,
                    const ImageTextureOptions& options = {}, const FileLocation& location = {});
  float Evaluate(const TextureContext& at) const override;

 private:
  float TexelAt(int x, int y) const;

  std::shared_ptr<const Image> image_;
  TextureMappingPtr mapping_;
  ImageTextureOptions options_;
  PixelScalar scalar_;
  int alphaChannel_ = -1;
};

/// Opens image files for textures, each once per encoding. Not for several threads at a time.
class ImageCache {
 public:
  /// `diagnostics` (or null) hears of images that needed mending; it must outlive the cache.
  explicit ImageCache(Diagnostics* diagnostics) : diagnostics_(diagnostics) {}

  /// The image at `path`. Infinities and NaNs in it become zero, with a warning. Throws what `ReadImage` throws.
  std::shared_ptr<const Image> Get(const std::string& path, ColorEncoding encoding, const FileLocation& location = {});
  /// How many files have been opened.
  int OpenedCount() const { return openedCount_; }
  /// Of the images that it gave.
  int64_t MemoryBytes() const;

 private:
  struct Entry {
    ColorEncoding encoding;
    std::shared_ptr<const Image> image;
  };

  Diagnostics* diagnostics_;
  std::map<std::string, std::vector<Entry>> entries_;
  int openedCount_ = 0;
};

// ---- The lookup

namespace texture_internal {

/// `s`, brought into a range where it can become an int, without a change to what the wrap mode shows there. NaN
/// becomes 0 or the lower end.
inline float LimitCoordinate(float s, WrapMode wrap) {
  if (wrap == WrapMode::kRepeat) {
    const float fraction = s - std::floor(s);
    return fraction >= 0 && fraction < 1 ? fraction : 0;  // 1 where a tiny negative s is rounded
  }
  return s > -1 ? (s < 2 ? s : 2) : -1;
}

/// Puts (x, y) back into the image; false where it is black there. Expects what `LimitCoordinate` leaves.
inline bool WrapTexel(int* x, int* y, int width, int height, WrapMode wrap) {
  if (*x >= 0 && *x < width && *y >= 0 && *y < height) return true;
  const auto repeat = [](int i, int size) { return i < 0 ? i + size : (i >= size ? i - size : i); };
  switch (wrap) {
    case WrapMode::kBlack:
      return false;
    case WrapMode::kRepeat:
      *x = repeat(*x, width);
      *y = repeat(*y, height);
      return true;
    case WrapMode::kOctahedralSphere:
      if (*x < 0 || *x >= width) {
        *x = *x < 0 ? -1 - *x : 2 * width - 1 - *x;
        *y = height - 1 - *y;
      }
      if (*y < 0 || *y >= height) {
        *y = *y < 0 ? -1 - *y : 2 * height - 1 - *y;
        *x = width - 1 - *x;
      }
      [[fallthrough]];
    case WrapMode::kClamp:
      *x = std::clamp(*x, 0, width - 1);
      *y = std::clamp(*y, 0, height - 1);
      return true;
  }
  return false;
}

}  // namespace texture_internal

/// The image at `st`: `texel(x, y)` of one texel or four, where T = decltype(texel(0, 0)) has +, * float and a zero
/// T(0). The image must not be empty; any `st` will do, even infinite.
template <typename Texel>
auto FilterImage(const Image& image, const Vec2& st, WrapMode wrap, ImageFilter filter, Texel texel) {
  using T = decltype(texel(0, 0));
  const int width = image.Width(), height = image.Height();
  const auto fetch = [&](int x, int y) {
    return texture_internal::WrapTexel(&x, &y, width, height, wrap) ? texel(x, y) : T(0);
  };
  const float s = texture_internal::LimitCoordinate(st.x, wrap) * static_cast<float>(width);
  const float t = (1 - texture_internal::LimitCoordinate(st.y, wrap)) * static_cast<float>(height);
  if (filter == ImageFilter::kPoint) {
    return fetch(static_cast<int>(std::floor(s)), static_cast<int>(std::floor(t)));
  }
  const float left = std::floor(s - 0.5f), top = std::floor(t - 0.5f);
  const float ds = s - 0.5f - left, dt = t - 0.5f - top;
  const int x = static_cast<int>(left), y = static_cast<int>(top);
  const auto blend = [ds, dt](const T& a, const T& b, const T& c, const T& d) {
    return (a * (1 - ds) + b * ds) * (1 - dt) + (c * (1 - ds) + d * ds) * dt;
  };
  if (x >= 0 && x + 1 < width && y >= 0 && y + 1 < height) {  // nearly always: no wrapping
    return blend(texel(x, y), texel(x + 1, y), texel(x, y + 1), texel(x + 1, y + 1));
  }
  return blend(fetch(x, y), fetch(x + 1, y), fetch(x, y + 1), fetch(x + 1, y + 1));
}

}  // namespace dapple
