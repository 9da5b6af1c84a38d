// An image: float pixels in rows from the top, channels interleaved and named as OpenEXR names them (R, G, B, A, Y
// ...).
//
// It may be a window of a larger picture: `origin` is where its first pixel lies in the whole of size `fullSize`.
// Values are linear; what they measure is the caller's knowledge. Files are read and written by image_io.h.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/color.h"
#include "src/base/vec.h"

namespace dapple {

/// A rectangle of pixels: `min` inclusive, `max` exclusive (an Imath box includes both ends). Empty where max <= min.
struct PixelBounds {
  Vec2i min{0, 0}, max{0, 0};

  int Width() const { return std::max(0, max.x - min.x); }
  int Height() const { return std::max(0, max.y - min.y); }
  int64_t Area() const { return int64_t{Width()} * Height(); }
  bool IsEmpty() const { return Area() == 0; }
  bool Contains(const Vec2i& p) const { return p.x >= min.x && p.x < max.x && p.y >= min.y && p.y < max.y; }
  /// True where all of `inner` lies inside.
  bool Contains(const PixelBounds& inner) const {
    return inner.min.x >= min.x && inner.min.y >= min.y && inner.max.x <= max.x && inner.max.y <= max.y;
  }
  friend bool operator==(const PixelBounds&, const PixelBounds&) = default;
};

class Image {
 public:
  Image() = default;
  /// Zero in all pixels; `width`, `height` >= 0. `origin` is (0, 0) and `fullSize` the image's own size.
  Image(int width, int height, std::vector<std::string> channelNames);
  /// With these values: rows from the top, channels interleaved, width * height * channels of them.
  Image(int width, int height, std::vector<std::string> channelNames, std::vector<float> values);
  /// Three channels R, G, B.
  static Image Rgb(int width, int height) { return {width, height, {"R", "G", "B"}}; }

  int Width() const { return width_; }
  int Height() const { return height_; }
  int Channels() const { return static_cast<int>(channelNames_.size()); }
  const std::vector<std::string>& ChannelNames() const { return channelNames_; }
  /// The index of the channel of that name, or -1.
  int FindChannel(std::string_view name) const;

  /// x in [0, Width), y in [0, Height) from the top, c in [0, Channels).
  float At(int x, int y, int c) const { return pixels_[Index(x, y, c)]; }
  float& At(int x, int y, int c) { return pixels_[Index(x, y, c)]; }

  /// The pixel as a colour: channels R, G, B where any two of them exist (a missing one is zero); otherwise gray from
  /// Y, or from the first channel. Extra channels (alpha, depth) are left out.
  Color ColorAt(int x, int y) const {
    const float* pixel = pixels_.data() + Index(x, y, 0);
    const auto component = [&](int i) { return colorChannels_[i] < 0 ? 0.f : pixel[colorChannels_[i]]; };
    return {component(0), component(1), component(2)};
  }
  /// Sets R, G and B; the image must have the three.
  void SetColor(int x, int y, const Color& color) {
    float* pixel = pixels_.data() + Index(x, y, 0);
    for (int i = 0; i < Color::kComponents; ++i) pixel[colorChannels_[i]] = color[i];
  }
  /// True where `ColorAt` is gray for want of more than one colour channel.
  bool IsGray() const { return colorChannels_[0] == colorChannels_[1]; }

  /// All values, rows from the top, channels interleaved.
  std::span<float> Values() { return pixels_; }
  std::span<const float> Values() const { return pixels_; }

  /// Place of this image in the whole picture.
  Vec2i origin{0, 0};
  Vec2i fullSize{0, 0};

 private:
  size_t Index(int x, int y, int c) const {
    assert(x >= 0 && x < width_ && y >= 0 && y < height_ && c >= 0 && c < Channels());
    return (static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)) * channelNames_.size() +
           static_cast<size_t>(c);
  }

  int width_ = 0, height_ = 0;
  std::vector<std::string> channelNames_;
  std::array<int, Color::kComponents> colorChannels_{};
  std::vector<float> pixels_;
};

}  // namespace dapple
