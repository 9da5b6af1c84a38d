#include "integrators/sample_allocation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "integrators/camera_path.h"
#include "src/base/grid.h"
#include "src/base/hash.h"
#include "src/base/numerics.h"
#include "src/base/parallel.h"

namespace dapple {

namespace {

constexpr uint64_t kPilot = 0x5a11;
/// A probe is two means of so many paths through a pixel, stratified each and independent of each other.
constexpr int kPathsOfMean = 4;
constexpr double kPathsAPixel = 2, kMostPaths = 1 << 18;
/// Noise counts relative to the brightness of its place, and to this share of the picture's median where that is more.
constexpr double kDark = 0.3;

/// Of those that are not zero; zero where there is none.
double Median(std::vector<double> values) {
  std::erase(values, 0.0);
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// What the paths of a probe found, and what they took.
struct Probe {
  Vec3d mean{0}, variance{0};
  int64_t rays = 0;
};

Probe ProbeAt(const Scene& scene, uint64_t seed, const Vec2i& pixel, const SampleAllocation::Tracer& trace) {
  PassStats stats;
  Vec3d halves[2] = {Vec3d(0), Vec3d(0)};
  for (int half = 0; half < 2; ++half)
    for (int i = 0; i < kPathsOfMean; ++i) {
      Sampler sampler = Sampler::ForPixel(seed, pixel, half, i, kPathsOfMean);
      const PixelSample sample = SamplePixel(scene, scene.Settings().filter, pixel, sampler);
      const Color found = trace(sample.camera, sampler, stats) * (sample.weight / static_cast<float>(kPathsOfMean));
      if (found.IsFinite()) halves[half] += Vec3d(found.r, found.g, found.b);
    }
  Probe probe;
  probe.mean = (halves[0] + halves[1]) / 2;
  for (int c = 0; c < 3; ++c) probe.variance[c] = Sqr(halves[0][c] - halves[1][c]) / 2;
  probe.rays = stats.Rays();
  return probe;
}

/// In the mean over the channels.
double RelativeVariance(const Probe& probe, double dark) {
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    if (probe.variance[c] > 0) sum += probe.variance[c] / (Sqr(probe.mean[c]) + Sqr(dark));
  return sum / 3;
}

/// Numbers in proportion to `shares`, at least `least` and at most `most`, whose sum weighted with `costs` is `budget`;
/// as near to that as the bounds let them. Not all shares are zero.
std::vector<float> Apportion(const std::vector<double>& shares, const std::vector<double>& costs, double least,
                             double most, double budget) {
  const auto number = [&](size_t i, double scale) { return std::clamp(scale * shares[i], least, most); };
  const auto cost = [&](double scale) {
    double sum = 0;
    for (size_t i = 0; i < shares.size(); ++i) sum += number(i, scale) * costs[i];
    return sum;
  };
  double smallest = std::numeric_limits<double>::max(), largest = 0;
  for (const double share : shares) {
    if (share > 0) smallest = std::min(smallest, share);
    largest = std::max(largest, share);
  }
  // Between where all have the least and where all that have a share have the most; in the logarithm, for shares may be
  // of any size.
  double low = std::log(least / largest), high = std::log(most / smallest);
  for (int i = 0; i < 64; ++i) {
    const double middle = (low + high) / 2;
    (cost(std::exp(middle)) < budget ? low : high) = middle;
  }
  std::vector<float> numbers(shares.size());
  for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(number(i, std::exp(low)));
  return numbers;
}

}  // namespace

SampleAllocation SampleAllocation::ByNoise(const Scene& scene, uint64_t seed, int mean, const Tracer& trace) {
  if (mean == 1) return SampleAllocation(mean);
  const Vec2i& resolution = scene.Settings().resolution;
  const double pixels = static_cast<double>(resolution.x) * resolution.y;
  const double probes = std::min(kPathsAPixel * pixels, kMostPaths) / (2 * kPathsOfMean);
  SampleAllocation result(mean);
  result.cellSize_ = std::max(1, static_cast<int>(std::lround(std::sqrt(pixels / probes))));
  result.columns_ = (resolution.x + result.cellSize_ - 1) / result.cellSize_;
  const int rows = (resolution.y + result.cellSize_ - 1) / result.cellSize_;

  Grid variance(result.columns_, rows), rays(result.columns_, rows);
  std::vector<Probe> found(rays.values.size());
  ParallelFor(static_cast<int64_t>(found.size()), [&](int64_t cell) {
    // Some pixel of the cell; at the border the nearest one.
    const uint64_t place = Hash(seed, kPilot, cell), size = static_cast<uint64_t>(result.cellSize_);
    const Vec2i corner =
        Vec2i(static_cast<int>(cell % result.columns_), static_cast<int>(cell / result.columns_)) * result.cellSize_;
    const Vec2i pixel(std::min(corner.x + static_cast<int>(place % size), resolution.x - 1),
                      std::min(corner.y + static_cast<int>((place >> 32) % size), resolution.y - 1));
    found[static_cast<size_t>(cell)] = ProbeAt(scene, Hash(seed, kPilot), pixel, trace);
  });

  std::vector<double> brightness;
  for (const Probe& probe : found) brightness.push_back((probe.mean.x + probe.mean.y + probe.mean.z) / 3);
  const double dark = kDark * Median(std::move(brightness));
  for (size_t i = 0; i < found.size(); ++i) {
    variance.values[i] = RelativeVariance(found[i], dark);
    rays.values[i] = static_cast<double>(found[i].rays);
    result.pilotRays_ += found[i].rays;
  }
  // Of so few paths a variance is known badly: from all within two cells it is known well enough.
  variance = Smoothed(Smoothed(variance));
  rays = Smoothed(Smoothed(rays));
  std::vector<double> shares;
  double budget = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    shares.push_back(std::sqrt(variance.values[i] / rays.values[i]));
    budget += mean * rays.values[i];
  }
  if (*std::max_element(shares.begin(), shares.end()) > 0)
    result.samples_ = Apportion(shares, rays.values, 1, kMostOfMean * mean, budget);
  return result;
}

int SampleAllocation::At(const Vec2i& pixel) const {
  if (samples_.empty()) return mean_;
  const auto cell = static_cast<size_t>(pixel.y / cellSize_) * static_cast<size_t>(columns_) +
                    static_cast<size_t>(pixel.x / cellSize_);
  // Rounded up as often as makes the mean right.
  const double u = static_cast<double>(Hash(kPilot, pixel.x, pixel.y) >> 32) * 0x1p-32;
  return static_cast<int>(static_cast<double>(samples_[cell]) + u);
}

}  // namespace dapple
