#include "src/image/film.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <new>
#include <thread>

#include <fmt/format.h>

#include "src/base/numerics.h"

namespace dapple {

namespace {

// What stands first in a serialised film; the ranges of its passes follow, the names of the extra channels with a line
// end behind each, what gave values that are not finite (a line "COUNT SOURCE" each), the sums of both halves, those of
// their blurs, and those of the extra channels. All little-endian, as memory is here.
struct FilmHeader {
  char mark[8];
  uint32_t version;
  int32_t filterKind;
  int32_t width, height;
  int32_t cropMinX, cropMinY, cropMaxX, cropMaxY;
  double filterRadiusX, filterRadiusY, filterP, filterQ;
  uint64_t passRanges;
  uint64_t refused;
  uint32_t extraNameBytes;
  float clamp;  // 0: none
  uint32_t tracksBlur;
  uint32_t nonFiniteBytes;
};
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(PassRange) == 16 && std::is_trivially_copyable_v<PassRange>);
static_assert(sizeof(FilmHeader) == 104 && std::is_trivially_copyable_v<FilmHeader>);

constexpr char kMark[8] = {'D', 'A', 'P', 'P', 'L', 'E', 'F', 'M'};
constexpr uint32_t kVersion = 4;

// The most pixels that a filter can touch along one axis: its radius is at most 64.
constexpr int kMaxFootprint = 130;

// The set of passes whose ranges stand at `bytes`, which must be in the order of the set's one form.
PassRanges ReadPasses(std::span<const std::byte> bytes, const FileLocation& location) {
  PassRanges passes;
  int64_t last = -1;
  for (size_t at = 0; at < bytes.size(); at += sizeof(PassRange)) {
    PassRange range;
    std::memcpy(&range, bytes.data() + at, sizeof(range));
    if (range.begin <= last || range.IsEmpty()) throw Error(location, "stored film with passes that make no sense");
    passes.Add(range);
    last = range.end;
  }
  return passes;
}

std::vector<std::string> SplitLines(std::string_view text) {
  std::vector<std::string> lines;
  for (size_t end; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1))
    lines.emplace_back(text.substr(0, end));
  return lines;
}

void CheckSizes(const Vec2i& resolution, const PixelBounds& crop, const FileLocation& location) {
  const bool fits = resolution.x >= 1 && resolution.y >= 1 && resolution.x <= kMaxFilmSide &&
                    resolution.y <= kMaxFilmSide && PixelBounds{{0, 0}, resolution}.Contains(crop);
  if (!fits || crop.IsEmpty() || crop.Area() > kMaxFilmPixels)
    throw Error(location,
                fmt::format("film of {} x {} pixels, crop from ({}, {}) to ({}, {}): expected 1 to {} pixels a "
                            "side, a crop inside that is not empty, and at most {} pixels in it",
                            resolution.x, resolution.y, crop.min.x, crop.min.y, crop.max.x, crop.max.y, kMaxFilmSide,
                            kMaxFilmPixels));
}

// Pixels [first, end) along one axis whose centres are in (p - radius, p + radius], within [min, max): half open, so
// that a box of radius 1/2 touches one pixel wherever the splat falls.
struct Footprint {
  int first, end;

  Footprint(double position, double radius, int min, int max)
      : first(static_cast<int>(std::clamp(std::floor(position - 0.5 - radius) + 1, double(min), double(max)))),
        end(static_cast<int>(std::clamp(std::floor(position - 0.5 + radius) + 1, double(min), double(max)))) {}
};

// Held while a splat adds its few pixels of a tile: one exchange instead of two atomic additions a channel and pixel.
class SpinLock {
 public:
  explicit SpinLock(uint8_t& flag) : flag_(flag) {
    for (int tries = 0; flag_.exchange(1, std::memory_order_acquire) != 0; ++tries) {
      // A thread that the system has put aside may hold it.
      if (tries >= kTriesBeforeYield) std::this_thread::yield();
    }
  }
  ~SpinLock() { flag_.store(0, std::memory_order_release); }
  SpinLock(const SpinLock&) = delete;
  SpinLock& operator=(const SpinLock&) = delete;

 private:
  static constexpr int kTriesBeforeYield = 16;
  std::atomic_ref<uint8_t> flag_;
};

}  // namespace

Film::Film(const Vec2i& fullResolution, const PixelBounds& crop, const Filter& filter, const FileLocation& location)
    : fullResolution_(fullResolution), crop_(crop), filter_(filter) {
  CheckSizes(fullResolution, crop, location);
  try {
    for (auto& sums : sums_) sums.resize(static_cast<size_t>(crop.Area()));
    const auto tiles = [](int side) { return static_cast<size_t>((side + kTileSide - 1) / kTileSide); };
    tileLocks_.resize(tiles(crop.Width()) * tiles(crop.Height()));
  } catch (const std::bad_alloc&) {
    throw Error(location, fmt::format("not enough memory for a film of {} pixels", crop.Area()));
  }
}

void Film::AddExtraChannels(const std::vector<std::string>& names) {
  assert(passes_.IsEmpty() && extraChannels_.empty());
  try {
    extras_.resize(static_cast<size_t>(crop_.Area()) * names.size());
  } catch (const std::bad_alloc&) {
    throw Error(fmt::format("not enough memory for {} extra channels of {} pixels", names.size(), crop_.Area()));
  }
  extraChannels_ = names;
}

void Film::TrackBlur() {
  assert(passes_.IsEmpty() && !TracksBlur());
  try {
    for (auto& blurs : blurs_) blurs.resize(sums_[0].size());
  } catch (const std::bad_alloc&) {
    throw Error(fmt::format("not enough memory to estimate the error of {} pixels", crop_.Area()));
  }
}

void Film::AddExtras(const Vec2i& pixel, std::span<const float> values) {
  assert(crop_.Contains(pixel) && values.size() == extraChannels_.size());
  if (!std::ranges::all_of(values, FixedPoint::IsInRange)) return Refuse();
  FixedPoint* const sums = extras_.data() + Index(pixel.x, pixel.y) * values.size();
  for (size_t i = 0; i < values.size(); ++i) sums[i] += FixedPoint::FromFloat(values[i]);
}

Imath::Box2d Film::SplatBounds() const {
  return {Vec2d(crop_.min) + Vec2d(0.5) - filter_.Radius(), Vec2d(crop_.max) - Vec2d(0.5) + filter_.Radius()};
}

// Calls `addToPixels` with the parts of `pixels` (in the crop) that lie in one tile each, while that tile is locked.
template <typename F>
void Film::ForEachLockedTile(const PixelBounds& pixels, F addToPixels) {
  const int columns = (crop_.Width() + kTileSide - 1) / kTileSide;
  const Vec2i first = (pixels.min - crop_.min) / kTileSide, last = (pixels.max - Vec2i(1) - crop_.min) / kTileSide;
  for (int row = first.y; row <= last.y; ++row) {
    for (int column = first.x; column <= last.x; ++column) {
      const Vec2i corner = crop_.min + Vec2i(column, row) * kTileSide;
      const PixelBounds part{
          {std::max(pixels.min.x, corner.x), std::max(pixels.min.y, corner.y)},
          {std::min(pixels.max.x, corner.x + kTileSide), std::min(pixels.max.y, corner.y + kTileSide)}};
      const SpinLock lock(
          tileLocks_[static_cast<size_t>(row) * static_cast<size_t>(columns) + static_cast<size_t>(column)]);
      addToPixels(part);
    }
  }
}

void Film::AddSplat(const Vec2& position, const Color& value, int64_t pass) {
  if (!(value.IsFinite() && std::isfinite(position.x) && std::isfinite(position.y))) return Refuse();
  auto& sums = sums_[HalfOf(pass)];
  const Footprint rows(position.y, filter_.Radius().y, crop_.min.y, crop_.max.y);
  const Footprint columns(position.x, filter_.Radius().x, crop_.min.x, crop_.max.x);
  if (rows.first >= rows.end || columns.first >= columns.end) return;
  const PixelBounds pixels{{columns.first, rows.first}, {columns.end, rows.end}};
  if (filter_.IsUnitBox()) {
    return ForEachLockedTile(pixels,
                             [&](const PixelBounds& one) { Add(sums[Index(one.min.x, one.min.y)], Clamped(value)); });
  }
  std::array<float, kMaxFootprint> weightsX, weightsY;
  for (int x = columns.first; x < columns.end; ++x)
    weightsX[static_cast<size_t>(x - columns.first)] = static_cast<float>(filter_.NormalizedX(x + 0.5 - position.x));
  for (int y = rows.first; y < rows.end; ++y)
    weightsY[static_cast<size_t>(y - rows.first)] = static_cast<float>(filter_.NormalizedY(y + 0.5 - position.y));
  ForEachLockedTile(pixels, [&](const PixelBounds& part) {
    for (int y = part.min.y; y < part.max.y; ++y) {
      const Color rowValue = value * weightsY[static_cast<size_t>(y - rows.first)];
      for (int x = part.min.x; x < part.max.x; ++x)
        Add(sums[Index(x, y)], Clamped(rowValue * weightsX[static_cast<size_t>(x - columns.first)]));
    }
  });
}

template <typename F>
Image Film::MakeImage(int64_t passes, F sumOfPixel) const {
  Image image = Image::Rgb(crop_.Width(), crop_.Height());
  image.origin = crop_.min;
  image.fullSize = fullResolution_;
  if (passes == 0) return image;
  for (int y = 0; y < crop_.Height(); ++y) {
    for (int x = 0; x < crop_.Width(); ++x) {
      const PixelSums sums = sumOfPixel(Index(x + crop_.min.x, y + crop_.min.y));
      for (int c = 0; c < Color::kComponents; ++c)
        image.At(x, y, c) = static_cast<float>(sums[c].ToDouble() / static_cast<double>(passes));
    }
  }
  return image;
}

Image Film::ToImage() const {
  return MakeImage(PassCount(), [&](size_t i) {
    PixelSums sums = sums_[0][i];
    for (int c = 0; c < Color::kComponents; ++c) sums[c] += sums_[1][i][c];
    return sums;
  });
}

Image Film::ExtraImage() const {
  Image image(crop_.Width(), crop_.Height(), extraChannels_);
  image.origin = crop_.min;
  image.fullSize = fullResolution_;
  const double passes = static_cast<double>(std::max<int64_t>(PassCount(), 1));
  const std::span<float> values = image.Values();
  for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(extras_[i].ToDouble() / passes);
  return image;
}

Image Film::HalfImage(int half) const {
  assert(half == 0 || half == 1);
  return MakeImage(PassCount(half), [&](size_t i) { return sums_[half][i]; });
}

Image Film::BlurImage(int half) const {
  assert(TracksBlur() && (half == 0 || half == 1));
  return MakeImage(PassCount(half), [&](size_t i) { return blurs_[half][i]; });
}

void Film::Merge(const Film& other) {
  if (fullResolution_ != other.fullResolution_ || crop_ != other.crop_ || !(filter_ == other.filter_) ||
      clamp_ != other.clamp_ || extraChannels_ != other.extraChannels_ || TracksBlur() != other.TracksBlur())
    throw Error("cannot add films that differ: expected the same resolution, crop, filter, clamp and channels");
  if (const auto common = passes_.FirstCommon(other.passes_))
    throw Error(fmt::format("cannot add films that both hold {}", common->ToString()));
  for (const PassRange& range : other.passes_.All()) passes_.Add(range);
  const auto add = [](std::vector<PixelSums>& to, const std::vector<PixelSums>& from) {
    for (size_t i = 0; i < to.size(); ++i)
      for (int c = 0; c < Color::kComponents; ++c) to[i][c] += from[i][c];
  };
  for (size_t half = 0; half < sums_.size(); ++half) {
    add(sums_[half], other.sums_[half]);
    add(blurs_[half], other.blurs_[half]);
  }
  for (size_t i = 0; i < extras_.size(); ++i) extras_[i] += other.extras_[i];
  refused_ += other.refused_;
  for (const auto& [source, count] : other.nonFiniteBySource_) CountNonFinite(source, count);
}

std::string Film::ExtraNames() const {
  std::string names;
  for (const std::string& name : extraChannels_) names += name + '\n';
  return names;
}

std::string Film::NonFiniteLines() const {
  std::string lines;
  for (const auto& [source, count] : nonFiniteBySource_) lines += fmt::format("{} {}\n", count, source);
  return lines;
}

int64_t Film::NonFiniteCount() const {
  int64_t count = RefusedCount();
  for (const auto& [source, ofSource] : nonFiniteBySource_) count += ofSource;
  return count;
}

std::vector<std::byte> Film::Serialize() const {
  const Filter::Description filter = filter_.Describe();
  FilmHeader header{};
  std::memcpy(header.mark, kMark, sizeof(kMark));
  header.version = kVersion;
  header.filterKind = filter.kind;
  header.width = fullResolution_.x;
  header.height = fullResolution_.y;
  header.cropMinX = crop_.min.x;
  header.cropMinY = crop_.min.y;
  header.cropMaxX = crop_.max.x;
  header.cropMaxY = crop_.max.y;
  header.filterRadiusX = filter.radiusX;
  header.filterRadiusY = filter.radiusY;
  header.filterP = filter.p;
  header.filterQ = filter.q;
  header.passRanges = passes_.All().size();
  header.refused = refused_;
  const std::string names = ExtraNames(), nonFinite = NonFiniteLines();
  header.extraNameBytes = static_cast<uint32_t>(names.size());
  header.nonFiniteBytes = static_cast<uint32_t>(nonFinite.size());
  header.clamp = clamp_.value_or(0);
  header.tracksBlur = TracksBlur() ? 1 : 0;
  const std::vector<PassRange>& ranges = passes_.All();
  std::vector<std::byte> bytes(sizeof(header) + ranges.size() * sizeof(PassRange) + names.size() + nonFinite.size() +
                               2 * (sums_[0].size() + blurs_[0].size()) * sizeof(PixelSums) +
                               extras_.size() * sizeof(FixedPoint));
  size_t end = 0;
  const auto append = [&](std::span<const std::byte> piece) {
    if (!piece.empty()) std::memcpy(bytes.data() + end, piece.data(), piece.size());
    end += piece.size();
  };
  append(std::as_bytes(std::span(&header, 1)));
  append(std::as_bytes(std::span(ranges)));
  append(std::as_bytes(std::span(names)));
  append(std::as_bytes(std::span(nonFinite)));
  for (const auto& sums : sums_) append(std::as_bytes(std::span(sums)));
  for (const auto& blurs : blurs_) append(std::as_bytes(std::span(blurs)));
  append(std::as_bytes(std::span(extras_)));
  return bytes;
}

Film Film::Deserialize(std::span<const std::byte> bytes, const FileLocation& location) {
  FilmHeader header;
  if (bytes.size() < sizeof(header)) throw Error(location, "not a stored film: it ends early");
  std::memcpy(&header, bytes.data(), sizeof(header));
  if (std::memcmp(header.mark, kMark, sizeof(kMark)) != 0) throw Error(location, "not a stored film");
  if (header.version != kVersion)
    throw Error(location, fmt::format("stored film of version {}, expected {}", header.version, kVersion));
  const Vec2i resolution(header.width, header.height);
  const PixelBounds crop{{header.cropMinX, header.cropMinY}, {header.cropMaxX, header.cropMaxY}};
  CheckSizes(resolution, crop, location);
  std::span<const std::byte> rest = bytes.subspan(sizeof(header));
  const auto take = [&](size_t count) {
    if (count > rest.size()) throw Error(location, "the stored film ends early");
    const std::span<const std::byte> taken = rest.first(count);
    rest = rest.subspan(count);
    return taken;
  };
  const PassRanges passes =
      ReadPasses(take(std::min<size_t>(header.passRanges, rest.size()) * sizeof(PassRange)), location);
  const auto takeLines = [&](size_t count) {
    const std::span<const std::byte> text = take(count);
    return SplitLines({reinterpret_cast<const char*>(text.data()), text.size()});
  };
  const std::vector<std::string> extraChannels = takeLines(header.extraNameBytes);
  const std::vector<std::string> nonFinite = takeLines(header.nonFiniteBytes);
  const auto pixels = static_cast<size_t>(crop.Area());
  const size_t images = header.tracksBlur != 0 ? 4 : 2;
  const size_t sumBytes = pixels * (images * sizeof(PixelSums) + extraChannels.size() * sizeof(FixedPoint));
  if (rest.size() != sumBytes)
    throw Error(location, fmt::format("stored film with {} bytes of sums, expected {}", rest.size(), sumBytes));
  const Filter filter = Filter::FromDescription(
      {header.filterKind, header.filterRadiusX, header.filterRadiusY, header.filterP, header.filterQ}, location);
  Film film(resolution, crop, filter, location);
  if (header.clamp > 0) film.ClampTo(header.clamp);
  if (!extraChannels.empty()) film.AddExtraChannels(extraChannels);
  if (header.tracksBlur != 0) film.TrackBlur();
  const auto read = [&](auto& sums) {
    const std::span<const std::byte> from = take(std::as_bytes(std::span(sums)).size());
    if (!from.empty()) std::memcpy(sums.data(), from.data(), from.size());
  };
  for (auto& sums : film.sums_) read(sums);
  for (auto& blurs : film.blurs_) read(blurs);
  read(film.extras_);
  film.passes_ = passes;
  film.refused_ = header.refused;
  for (const std::string& line : nonFinite) {
    int64_t count = 0;
    const auto [end, status] = std::from_chars(line.data(), line.data() + line.size(), count);
    if (status != std::errc() || !line.substr(static_cast<size_t>(end - line.data())).starts_with(' '))
      throw Error(location, "stored film with counts that make no sense");
    film.CountNonFinite(line.substr(static_cast<size_t>(end - line.data()) + 1), count);
  }
  return film;
}

}  // namespace dapple
