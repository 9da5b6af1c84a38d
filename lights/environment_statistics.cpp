#include "lights/environment_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/base/numerics.h"

namespace dapple {

namespace {

/// The part of the light that comes from the brightest `share` of the sphere; `pixels` are luminance and solid angle.
double LightOfBrightest(std::vector<std::pair<double, double>> pixels, double share) {
  std::ranges::sort(pixels, std::greater<>());
  double left = share * 4 * kPiD, bright = 0, total = 0;
  for (const auto& [luminance, solidAngle] : pixels) {
    const double used = std::min(left, solidAngle);
    bright += luminance * used;
    total += luminance * solidAngle;
    left -= used;
  }
  return total > 0 ? bright / total : 0;
}

}  // namespace

double EnvironmentPixelSolidAngle(EnvironmentMapping mapping, int width, int height, int y) {
  if (mapping == EnvironmentMapping::EqualArea) return 4 * kPiD / width / height;
  // cos a - cos b = 2 sin of half the sum times sin of half the difference.
  const double middle = kPiD * (y + 0.5) / height, half = kPiD / 2 / height;
  return 2 * kPiD / width * 2 * std::sin(middle) * std::sin(half);
}

EnvironmentStatistics MeasureEnvironment(const Image& image, EnvironmentMapping mapping) {
  const int width = image.Width(), height = image.Height();
  EnvironmentStatistics result;
  result.least = result.greatest = image.ColorAt(0, 0);
  double least = std::numeric_limits<double>::infinity(), sum = 0, squares = 0;
  Vec3d colors(0);
  std::vector<std::pair<double, double>> pixels;
  pixels.reserve(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (int y = 0; y < height; ++y) {
    const double solidAngle = EnvironmentPixelSolidAngle(mapping, width, height, y);
    for (int x = 0; x < width; ++x) {
      const Color c = image.ColorAt(x, y);
      const double luminance = static_cast<double>(c.Luminance());
      for (int i = 0; i < Color::kComponents; ++i) {
        result.least[i] = std::min(result.least[i], c[i]);
        result.greatest[i] = std::max(result.greatest[i], c[i]);
        colors[i] += static_cast<double>(c[i]) * solidAngle;
      }
      if (luminance > result.greatestLuminance) {
        result.greatestLuminance = luminance;
        result.brightestPixel = {x, y};
      }
      if (luminance > 0) least = std::min(least, luminance);
      if (luminance == 0) result.blackShare += solidAngle / (4 * kPiD);
      sum += luminance * solidAngle;
      squares += luminance * luminance * solidAngle;
      pixels.emplace_back(luminance, solidAngle);
    }
  }
  result.mean = Color(static_cast<float>(colors.x / (4 * kPiD)), static_cast<float>(colors.y / (4 * kPiD)),
                      static_cast<float>(colors.z / (4 * kPiD)));
  result.leastLuminance = sum > 0 ? least : 0;
  const Vec2i& p = result.brightestPixel;
  result.brightestDirection = EnvironmentDirectionAt(mapping, {(p.x + 0.5) / width, (p.y + 0.5) / height});
  result.lightOfBrightestHundredth = LightOfBrightest(std::move(pixels), 0.01);
  result.effectiveShare = squares > 0 ? sum * sum / (4 * kPiD * squares) : 0;
  return result;
}

}  // namespace dapple
