#include "src/app/environment_pictures.h"

#include <algorithm>
#include <cmath>

#include "lights/environment_statistics.h"
#include "src/base/numerics.h"
#include "src/base/parallel.h"
#include "src/image/false_color.h"
#include "src/sampling/sampler.h"
#include "src/sampling/seed.h"

namespace dapple {

namespace {

/// The picture of the map alone.
Vec2i PictureSize(EnvironmentMapping mapping) {
  return mapping == EnvironmentMapping::LatLong ? Vec2i(1024, 512) : Vec2i(640, 640);
}

constexpr int kMarginalWidth = 160;
constexpr int kGap = 4;

/// `density` over the even one.
Color DensityColor(double density) {
  constexpr double kLowest = -6, kHighest = 10;
  return RampColor(density > 0 ? (std::log2(density) - kLowest) / (kHighest - kLowest) : 0);
}

/// The mean of f(direction) over a pixel of the picture, by a grid of points in it as fine as the map's pixels.
template <typename F>
auto MeanOverPixel(const EnvironmentMap& map, const Vec2i& size, int x, int y, F f) {
  const int side = (map.Cells().x + size.x - 1) / size.x;
  decltype(f(Vec3d(0))) sum{};
  for (int i = 0; i < side * side; ++i) {
    const Vec2d p((x + (i % side + 0.5) / side) / size.x, (y + (i / side + 0.5) / side) / size.y);
    sum += f(EnvironmentDirectionAt(map.Mapping(), p));
  }
  return sum / static_cast<float>(side * side);
}

/// The densities of the rows, per unit of the square's height.
struct Marginal {
  std::vector<double> drawn;
  std::vector<double> even;  ///< if all directions were drawn alike
};

void DrawMarginal(const Marginal& marginal, int x0, Image* picture) {
  const double longest = std::max(*std::ranges::max_element(marginal.drawn), *std::ranges::max_element(marginal.even));
  for (int y = 0; y < picture->Height(); ++y) {
    const size_t row = static_cast<size_t>(y);
    const int bar = static_cast<int>(std::lround(marginal.drawn[row] / longest * kMarginalWidth));
    const int even = std::min(static_cast<int>(marginal.even[row] / longest * kMarginalWidth), kMarginalWidth - 1);
    for (int x = 0; x < kMarginalWidth; ++x) picture->SetColor(x0 + x, y, Color(x < bar ? 0.5f : 0.03f));
    picture->SetColor(x0 + even, y, Color(1, 0.35f, 0.02f));
  }
}

/// Reinhard et al. 2002, "Photographic tone reproduction for digital images", equations 1 to 3.
void CompressBrightness(Image* picture) {
  double logarithms = 0;
  int64_t count = 0;
  for (int y = 0; y < picture->Height(); ++y) {
    for (int x = 0; x < picture->Width(); ++x) {
      const double luminance = static_cast<double>(picture->ColorAt(x, y).Luminance());
      if (luminance > 0) logarithms += std::log(luminance), ++count;
    }
  }
  const double key = 0.18 / std::exp(logarithms / static_cast<double>(std::max<int64_t>(1, count)));
  for (int y = 0; y < picture->Height(); ++y) {
    for (int x = 0; x < picture->Width(); ++x) {
      const Color c = picture->ColorAt(x, y);
      const double scaled = key * static_cast<double>(c.Luminance());
      picture->SetColor(x, y, c * static_cast<float>(key / (1 + scaled)));
    }
  }
}

void DrawDot(const Vec2d& at, Image* picture) {
  constexpr double kRadius = 1.8;
  for (int y = static_cast<int>(at.y - kRadius); y <= static_cast<int>(at.y + kRadius); ++y) {
    for (int x = static_cast<int>(at.x - kRadius); x <= static_cast<int>(at.x + kRadius); ++x) {
      const bool isInside = x >= 0 && y >= 0 && x < picture->Width() && y < picture->Height();
      const double distance = std::hypot(x + 0.5 - at.x, y + 0.5 - at.y);
      if (isInside && distance <= kRadius) picture->SetColor(x, y, Color(1, 0.02f, 0.01f));
    }
  }
}

}  // namespace

Image DensityPicture(const EnvironmentMap& map) {
  const EnvironmentMapping mapping = map.Mapping();
  const Vec2i size = PictureSize(mapping);
  Image picture = Image::Rgb(size.x + kGap + kMarginalWidth, size.y);
  Marginal marginal{std::vector<double>(static_cast<size_t>(size.y)), std::vector<double>(static_cast<size_t>(size.y))};
  ParallelFor(size.y, [&](int64_t row) {
    const int y = static_cast<int>(row);
    const double solidAngle = EnvironmentPixelSolidAngle(mapping, size.x, size.y, y);
    double sum = 0;
    for (int x = 0; x < size.x; ++x) {
      const double pdf = MeanOverPixel(map, size, x, y, [&](const Vec3d& w) { return map.Evaluate(w).pdf; });
      picture.SetColor(x, y, DensityColor(4 * kPiD * pdf));
      sum += pdf * solidAngle;
    }
    marginal.drawn[static_cast<size_t>(row)] = sum * size.y;
    marginal.even[static_cast<size_t>(row)] = solidAngle * size.x * size.y / (4 * kPiD);
  });
  DrawMarginal(marginal, size.x + kGap, &picture);
  return picture;
}

Image SamplesPicture(const EnvironmentMap& map, int count, int seed) {
  const EnvironmentMapping mapping = map.Mapping();
  const Vec2i size = PictureSize(mapping);
  Image picture = Image::Rgb(size.x, size.y);
  ParallelFor(size.y, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size.x; ++x) {
      picture.SetColor(x, y, MeanOverPixel(map, size, x, y, [&](const Vec3d& w) { return map.Radiance(w); }));
    }
  });
  CompressBrightness(&picture);
  for (int i = 0; i < count; ++i) {
    Sampler sampler = Sampler::ForLightPath(SeedFrom(seed), i, 0, count);
    const Vec2d p = EnvironmentSquareAt(mapping, map.Sample(sampler.Get2D()));
    DrawDot(Vec2d(p.x * size.x, p.y * size.y), &picture);
  }
  return picture;
}

}  // namespace dapple
