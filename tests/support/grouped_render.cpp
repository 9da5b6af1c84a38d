#include "tests/support/grouped_render.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace dapple::testing_support {

Image GroupedImages::Mean() const {
  Image mean = groups.front();
  for (int y = 0; y < mean.Height(); ++y)
    for (int x = 0; x < mean.Width(); ++x)
      for (int c = 0; c < mean.Channels(); ++c) {
        double sum = 0;
        for (const Image& group : groups) sum += group.At(x, y, c);
        mean.At(x, y, c) = static_cast<float>(sum / static_cast<double>(groups.size()));
      }
  return mean;
}

namespace {

/// Renders the films of all groups, one after another, and calls `take(film)` for each.
template <typename F>
void ForEachGroup(const Scene& scene, const std::string& integrator, const IntegratorOptions& options, int passes,
                  int groups, uint64_t seed, bool tracksBlur, F take) {
  const RenderSettings& settings = scene.Settings();
  for (int group = 0; group < groups; ++group) {
    const auto algorithm = MakeIntegrator(integrator, options);
    algorithm->Prepare(scene, seed * 1000 + static_cast<uint64_t>(group));
    Film film(settings.resolution, settings.crop, settings.filter);
    if (tracksBlur) film.TrackBlur();
    for (int pair = group; 2 * pair < passes; pair += groups)
      for (int pass : {2 * pair, 2 * pair + 1}) algorithm->RenderPass(pass, film);
    take(film);
  }
}

/// The image less twice its blur. Both halves of the film hold as many passes.
Image AtRadiusZero(const Film& film) {
  Image image = film.ToImage();
  const Image even = film.BlurImage(0), odd = film.BlurImage(1);
  for (int y = 0; y < image.Height(); ++y)
    for (int x = 0; x < image.Width(); ++x)
      for (int c = 0; c < image.Channels(); ++c) image.At(x, y, c) -= even.At(x, y, c) + odd.At(x, y, c);
  return image;
}

}  // namespace

GroupedImages RenderGroups(const Scene& scene, const std::string& integrator, const IntegratorOptions& options,
                           int passes, int groups, uint64_t seed, int blockSize) {
  GroupedImages result;
  ForEachGroup(scene, integrator, options, passes, groups, seed, false,
               [&](const Film& film) { result.groups.push_back(BlockMeans(film.ToImage(), blockSize)); });
  return result;
}

GroupedImages RenderGroupsAtRadiusZero(const Scene& scene, const std::string& integrator,
                                       const IntegratorOptions& options, int passes, int groups, uint64_t seed) {
  GroupedImages result;
  ForEachGroup(scene, integrator, options, passes, groups, seed, true,
               [&](const Film& film) { result.groups.push_back(AtRadiusZero(film)); });
  return result;
}

namespace {

struct BlockStatistics {
  Image mean;                    // of all groups
  std::vector<double> variance;  // of that mean, one a block and channel
};

BlockStatistics Statistics(const GroupedImages& images, int blockSize) {
  std::vector<Image> blocks;
  for (const Image& group : images.groups) blocks.push_back(BlockMeans(group, blockSize));
  BlockStatistics statistics{GroupedImages{blocks}.Mean(), {}};
  const double n = static_cast<double>(blocks.size());
  for (int y = 0; y < statistics.mean.Height(); ++y)
    for (int x = 0; x < statistics.mean.Width(); ++x)
      for (int c = 0; c < Color::kComponents; ++c) {
        double sum = 0;
        for (const Image& block : blocks) sum += std::pow(block.At(x, y, c) - statistics.mean.At(x, y, c), 2);
        statistics.variance.push_back(n > 1 ? sum / (n - 1) / n : 0);
      }
  return statistics;
}

bool AnySkipped(const std::vector<bool>& skip, int width, int height, int blockX, int blockY, int blockSize) {
  if (skip.empty()) return false;
  for (int y = blockY * blockSize; y < std::min(height, (blockY + 1) * blockSize); ++y)
    for (int x = blockX * blockSize; x < std::min(width, (blockX + 1) * blockSize); ++x)
      if (skip[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)]) return true;
  return false;
}

}  // namespace

BlockReport CompareBlocks(const GroupedImages& test, const GroupedImages& reference, int blockSize, double tolerance,
                          const std::vector<bool>& skip, double floor, double referenceVariance) {
  BlockReport report;
  std::string failures;
  std::vector<double> sigmas;
  const BlockStatistics t = Statistics(test, blockSize), r = Statistics(reference, blockSize);
  const int width = test.groups.front().Width(), height = test.groups.front().Height();
  double gotSum = 0, expectedSum = 0;
  size_t entry = 0;
  for (int y = 0; y < t.mean.Height(); ++y)
    for (int x = 0; x < t.mean.Width(); ++x) {
      const bool skipped = AnySkipped(skip, width, height, x, y, blockSize);
      bool blockFailed = false;
      for (int c = 0; c < Color::kComponents; ++c, ++entry) {
        if (skipped) continue;
        const double expected = r.mean.At(x, y, c), got = t.mean.At(x, y, c);
        expectedSum += expected;
        gotSum += got;
        const double sigma = std::sqrt(t.variance[entry] * (1 + referenceVariance) + r.variance[entry]);
        const double excess = std::abs(got - expected) - std::max(tolerance * expected, floor) - 3 * sigma;
        if (expected > 0) sigmas.push_back(sigma / expected);
        blockFailed |= excess > 0;
        constexpr int kListed = 12;
        if (excess > 0 && std::count(failures.begin(), failures.end(), '\n') < kListed)
          failures += fmt::format("\n  block ({}, {}) channel {}: {:.6g}, expected {:.6g} ({:+.2f} %), sigma {:.2f} %",
                                  x, y, c, got, expected, 100 * (got / expected - 1), 100 * sigma / expected);
        const double relative = excess / (expected + 1e-6);
        if (relative <= report.worstExcess) continue;
        report.worstExcess = relative;
        report.worstBlock = {x, y};
        report.text = fmt::format("block ({}, {}) channel {}: {:.6g}, expected {:.6g} ({:+.2f} %), sigma {:.2f} %", x,
                                  y, c, got, expected, 100 * (got / expected - 1), 100 * sigma / expected);
      }
      if (skipped) continue;
      ++report.blocks;
      report.failed += blockFailed;
    }
  if (expectedSum > 0) report.meanRatio = gotSum / expectedSum;
  if (!sigmas.empty()) {
    std::nth_element(sigmas.begin(), sigmas.begin() + static_cast<int64_t>(sigmas.size() / 2), sigmas.end());
    report.medianSigma = sigmas[sigmas.size() / 2];
  }
  report.text =
      fmt::format("mean ratio {:.5f}, {} of {} blocks fail, median sigma {:.2f} %; worst {}{}", report.meanRatio,
                  report.failed, report.blocks, 100 * report.medianSigma, report.text, failures);
  return report;
}

std::vector<bool> PixelsOnSpecularSurfaces(const Scene& scene, float minRoughness) {
  const PixelBounds& crop = scene.Settings().crop;
  std::vector<bool> flags;
  for (int y = crop.min.y; y < crop.max.y; ++y)
    for (int x = crop.min.x; x < crop.max.x; ++x) {
      bool specular = false;
      for (const Vec2& offset : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1), Vec2(0.5f, 0.5f)}) {
        const Vec2 film(static_cast<float>(x) + offset.x, static_cast<float>(y) + offset.y);
        const auto hit = scene.Intersect(scene.GetCamera().GenerateRay(film, Vec2d(0.5), 0).ray);
        const Material* material = hit ? scene.MaterialAt(*hit) : nullptr;
        if (!material) continue;
        const MaterialFacts facts = material->Facts();
        specular |= facts.hasSpecular || facts.minRoughness < minRoughness;
      }
      flags.push_back(specular);
    }
  return flags;
}

}  // namespace dapple::testing_support
