// The film: adds up the samples and splats of passes, so exactly that no order and no split of the work shows.
//
// Sums are fixed point, 128 bits a channel, least bit 2^-64. A value is rounded once to that grid (values below 2^-40
// in magnitude lose bits) and must be below 2^40 in magnitude; then addition is exact and associative, up to sums of
// 2^63. Infinities, NaNs and larger values are counted and never added. Even and odd passes are summed apart: two
// halves that are independent of each other, so that their difference measures the noise.
//
//   film.AddSample(pixel, radiance * weight / samplesPerPass, pass);   // camera: offset and weight from Filter::Sample
//   film.AddSplat(position, contribution / pathsPerPass, pass);        // light tracing
//   film.FinishPass(pass);
//
// Beside the radiance a film may have extra channels, whose means are over all samples of all passes, in exact sums
// too; and, where the error is to be estimated, what gathers with half the radius make of each pixel less.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "src/base/color.h"
#include "src/base/error.h"
#include "src/base/vec.h"
#include "src/image/filter.h"
#include "src/image/image.h"
#include "src/image/pass_ranges.h"

namespace dapple {

/// A number in two's complement: (high 2^64 + low) 2^-64.
struct FixedPoint {
  uint64_t low = 0, high = 0;

  static constexpr int kFractionBits = 64;
  /// Magnitudes from here on are refused.
  static constexpr float kLimit = 0x1p40f;

  /// True where `value` is finite and below the limit.
  static bool IsInRange(float value) {
    return (std::bit_cast<uint32_t>(value) & 0x7fffffffu) < std::bit_cast<uint32_t>(kLimit);
  }
  /// The nearest multiple of 2^-64 (halves away from zero) of a value in range. No branches.
  static FixedPoint FromFloat(float value);
  double ToDouble() const;

  FixedPoint& operator+=(const FixedPoint& other) {
    low += other.low;
    high += other.high + (low < other.low ? 1 : 0);
    return *this;
  }
  friend FixedPoint operator+(FixedPoint a, const FixedPoint& b) { return a += b; }
  friend bool operator==(const FixedPoint&, const FixedPoint&) = default;
};

/// Bounds of a film: pixels along one side, and pixels in the crop.
inline constexpr int kMaxFilmSide = 1 << 24;
inline constexpr int64_t kMaxFilmPixels = int64_t{1} << 28;

class Film {
 public:
  /// A film of the pixels `crop` (not empty, inside the resolution) of a picture of `fullResolution` pixels.
  /// Takes 96 bytes a pixel. Throws `Error` at `location` where the sizes make no sense or the memory does not suffice.
  Film(const Vec2i& fullResolution, const PixelBounds& crop, const Filter& filter, const FileLocation& location = {});

  const Vec2i& FullResolution() const { return fullResolution_; }
  const PixelBounds& Crop() const { return crop_; }
  const Filter& PixelFilter() const { return filter_; }

  /// From here on no single sample or splat adds more than `limit` (> 0) in any channel to a pixel's value of a pass:
  /// it is scaled down as a whole. That loses energy, so nothing is clamped without it.
  void ClampTo(float limit) { clamp_ = limit; }
  std::optional<float> Clamp() const { return clamp_; }

  /// Adds channels that are filled by `AddExtras`; 16 bytes a pixel each. Once, before the first pass. Throws `Error`
  /// where the memory does not suffice.
  void AddExtraChannels(const std::vector<std::string>& names);
  const std::vector<std::string>& ExtraChannels() const { return extraChannels_; }

  /// Splats outside this rectangle (continuous pixel coordinates: the crop grown by the filter's radius) touch no
  /// pixel. Light tracing must send splats to all of it, beyond the edges of the picture too, or its border pixels turn
  /// dark.
  Imath::Box2d SplatBounds() const;

  /// Has integrators that estimate densities add their blur (`AddBlur`); 96 bytes a pixel. Once, before the first pass.
  /// Throws `Error` where the memory does not suffice.
  void TrackBlur();
  bool TracksBlur() const { return !blurs_[0].empty(); }

  /// Adds to `pixel` (inside the crop) in the sum of `pass`. One sample of n in a pass carries the weight 1/n.
  /// Not atomic: one thread owns a pixel at a time, and no splats are added meanwhile.
  void AddSample(const Vec2i& pixel, const Color& value, int64_t pass);

  /// Adds to the pixel's extra channels, one value each. As `AddSample`, but all passes have one sum.
  void AddExtras(const Vec2i& pixel, std::span<const float> values);

  /// Adds by how much the value of a sample exceeds that of the same sample whose gathers have half the radius: in
  /// expectation a share of what their width spoils (see error_estimate.h). As `AddSample`, but never clamped. What is
  /// not in range is left out, and not counted: the sample was. Only where blur is tracked.
  void AddBlur(const Vec2i& pixel, const Color& value, int64_t pass);

  /// Spreads `value` over the pixels around `position` (pixel (x, y) covers [x, x+1) x [y, y+1)) with the filter's
  /// normalised weights f(centre - position) / integral, per unit of image area in pixels. Any thread may call it at
  /// any time, except while samples are added.
  void AddSplat(const Vec2& position, const Color& value, int64_t pass);

  /// Counts `pass` as complete. Call it once a pass, by one thread, after all its samples and splats.
  void FinishPass(int64_t pass) { passes_.Add({pass, pass + 1}); }
  /// The finished passes, and how many they are; of the even (0) or odd (1) ones.
  const PassRanges& Passes() const { return passes_; }
  int64_t PassCount() const { return passes_.Count(); }
  int64_t PassCount(int half) const { return passes_.Count(half); }
  /// Counts contributions that were left out before they came here, infinite or NaN, and what gave them (a text of one
  /// line).
  void CountNonFinite(const std::string& source, int64_t count) { nonFiniteBySource_[source] += count; }
  /// How many these are, of all passes in the film.
  const std::map<std::string, int64_t>& NonFiniteBySource() const { return nonFiniteBySource_; }
  /// How many samples and splats were refused here: a channel infinite, NaN, or at least 2^40 in magnitude.
  int64_t RefusedCount() const { return static_cast<int64_t>(refused_); }
  /// Both together.
  int64_t NonFiniteCount() const;

  /// The mean of all passes: R, G, B of the crop, with its place in the picture. Black before the first pass.
  Image ToImage() const;
  /// The means of the extra channels, under their names.
  Image ExtraImage() const;
  /// The mean of the even (0) or odd (1) passes alone.
  Image HalfImage(int half) const;
  /// The mean blur of the even (0) or odd (1) passes; only where it is tracked.
  Image BlurImage(int half) const;

  /// Adds the sums and passes of another film of the same resolution, crop, filter, clamp and channels, exactly.
  /// Throws `Error` where they differ, or where a pass is in both.
  void Merge(const Film& other);

  /// The whole state as bytes, and back. `Deserialize` throws `Error` at `location` where the bytes are not a film of
  /// this version or not of the length they claim.
  std::vector<std::byte> Serialize() const;
  static Film Deserialize(std::span<const std::byte> bytes, const FileLocation& location = {});

  friend bool operator==(const Film&, const Film&) = default;

 private:
  using PixelSums = std::array<FixedPoint, Color::kComponents>;
  static constexpr int kTileSide = 16;

  static int HalfOf(int64_t pass) { return static_cast<int>(pass & 1); }
  size_t Index(int x, int y) const {
    return static_cast<size_t>(y - crop_.min.y) * static_cast<size_t>(crop_.Width()) +
           static_cast<size_t>(x - crop_.min.x);
  }
  /// `value`, scaled down where it is beyond the clamp.
  Color Clamped(const Color& value) const;
  static bool IsInRange(const Color& value) {
    return FixedPoint::IsInRange(value.r) && FixedPoint::IsInRange(value.g) && FixedPoint::IsInRange(value.b);
  }
  static void AddInRange(PixelSums& sums, const Color& value) {
    for (int c = 0; c < Color::kComponents; ++c) sums[c] += FixedPoint::FromFloat(value[c]);
  }
  void Add(PixelSums& sums, const Color& value);
  template <typename F>
  void ForEachLockedTile(const PixelBounds& pixels, F addToPixels);
  void Refuse() { std::atomic_ref(refused_).fetch_add(1, std::memory_order_relaxed); }
  template <typename F>
  Image MakeImage(int64_t passes, F sumOfPixel) const;
  std::string ExtraNames() const;
  std::string NonFiniteLines() const;

  Vec2i fullResolution_;
  PixelBounds crop_;
  Filter filter_;
  std::optional<float> clamp_;
  std::vector<std::string> extraChannels_;
  std::array<std::vector<PixelSums>, 2> sums_, blurs_;  // blurs: empty where they are not tracked
  std::vector<FixedPoint> extras_;                      // pixels in rows, channels interleaved
  PassRanges passes_;
  uint64_t refused_ = 0;
  std::map<std::string, int64_t> nonFiniteBySource_;
  std::vector<uint8_t> tileLocks_;  // one for each kTileSide x kTileSide pixels; 1 while a splat is added there
};

inline FixedPoint FixedPoint::FromFloat(float value) {
  const uint32_t bits = std::bit_cast<uint32_t>(value);
  const int exponent = static_cast<int>((bits >> 23) & 0xff);
  const uint32_t mantissa = (bits & 0x7fffff) | (exponent != 0 ? 0x800000u : 0u);
  // The value is mantissa * 2^(exponent - 150), that is mantissa * 2^shift of the least bits.
  const int shift = exponent - 150 + kFractionBits;
  const int down = std::clamp(-shift, 0, 26);  // 26 shifts out all 24 bits and the carry of rounding
  const uint64_t rounded = (mantissa + ((1u << down) >> 1)) >> down;
  const int up = std::max(shift, 0);  // at most 80, for values in range
  // rounded * 2^up over two words: shifts by up to 104 bits, in two halves since 63 is the most that one may do.
  const int down104 = 104 - up;
  const uint64_t low = (rounded << (up / 2)) << (up - up / 2);
  const uint64_t high = ((rounded << 40) >> (down104 / 2)) >> (down104 - down104 / 2);
  const uint64_t sign = -static_cast<uint64_t>(bits >> 31);
  // Negation: all bits turned around, plus one, which carries where the low word is zero.
  return {(low ^ sign) - sign, (high ^ sign) + (sign & (low == 0 ? 1 : 0))};
}

inline double FixedPoint::ToDouble() const {
  const auto value = static_cast<__int128>((static_cast<unsigned __int128>(high) << 64) | low);
  return static_cast<double>(value) * 0x1p-64;
}

inline Color Film::Clamped(const Color& value) const {
  if (!clamp_) return value;
  const float largest = std::max({std::abs(value.r), std::abs(value.g), std::abs(value.b)});
  return largest > *clamp_ ? value * (*clamp_ / largest) : value;
}

inline void Film::Add(PixelSums& sums, const Color& value) {
  if (!IsInRange(value)) return Refuse();
  AddInRange(sums, value);
}

inline void Film::AddSample(const Vec2i& pixel, const Color& value, int64_t pass) {
  assert(crop_.Contains(pixel));
  Add(sums_[HalfOf(pass)][Index(pixel.x, pixel.y)], Clamped(value));
}

inline void Film::AddBlur(const Vec2i& pixel, const Color& value, int64_t pass) {
  assert(crop_.Contains(pixel) && TracksBlur());
  if (!IsInRange(value)) return;
  AddInRange(blurs_[HalfOf(pass)][Index(pixel.x, pixel.y)], value);
}

}  // namespace dapple
