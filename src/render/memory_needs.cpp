#include "src/render/memory_needs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/base/parallel.h"
#include "src/image/image_io.h"
#include "src/photons/light_path.h"

namespace dapple {

namespace {

/// A photon (position and payload), twice while the arrays grow; what the map takes beside is less than that.
constexpr int64_t kBytesPerPhoton = 2 * (12 + 32);
/// An image, what it is made from, and its file before and after compression.
constexpr int64_t kCopiesOfPicture = 4;

/// Light paths whose rays are drawn from one cell of the random numbers of one light, or from a few of each other's
/// neighbours where there are more than `kGroups`.
constexpr int64_t kGroups = 64, kPathsOfGroup = 64;

struct EmissionCells {
  explicit EmissionCells(int64_t lights)
      : side(std::max<int64_t>(1, static_cast<int64_t>(std::sqrt(static_cast<double>(kGroups / lights))))),
        count(lights * side * side) {}

  int64_t side;   ///< of each light's numbers for directions: how many cells
  int64_t count;  ///< of all lights

  /// One of the rays from a cell; nothing where the light gives none.
  std::optional<EmissionSample> Sample(const Scene& scene, int64_t cell, LeRandom u) const {
    const int64_t light = cell / (side * side);
    u.direction = (Vec2d(static_cast<double>(cell % side), static_cast<double>(cell / side % side)) + u.direction) /
                  static_cast<double>(side);
    const std::optional<LeSample> le = scene.Lights()[static_cast<size_t>(light)]->Sample_Le(u);
    if (!le) return std::nullopt;
    return EmissionSample{.light = static_cast<int>(light), .pdfLight = 1, .le = *le, .own = u, .bend = 1};
  }
};

int64_t CountPhotons(const Scene& scene, const EmissionSample& emitted, const Sampler& sampler, int maxDepth) {
  int64_t photons = 0;
  TraceLightPath(scene, emitted, sampler, maxDepth, [&](const LightVertex& vertex) {
    photons += vertex.scattered > 0 && !vertex.bsdf.IsPurelySpecular() ? 1 : 0;
  });
  return photons;
}

/// From above, for emission may be guided to wherever paths leave the most: the greatest mean of all groups, over the
/// paths that leave any.
double PhotonsOfAPath(const Scene& scene, int maxDepth, uint64_t seed) {
  // Of fewer paths a mean would tell little.
  constexpr int64_t kLeastPaths = kPathsOfGroup / 4;
  const auto lights = static_cast<int64_t>(scene.Lights().size());
  if (lights == 0) return 0;
  const EmissionCells cells(lights);
  const int64_t groups = std::min(kGroups, cells.count);
  std::vector<double> means(static_cast<size_t>(groups));
  ParallelFor(groups, [&](int64_t group) {
    const int64_t begin = group * cells.count / groups, end = (group + 1) * cells.count / groups;
    int64_t photons = 0, paths = 0;
    for (int64_t i = 0; i < kPathsOfGroup; ++i) {
      Sampler sampler = Sampler::ForLightPath(seed, group * kPathsOfGroup + i, 0, groups * kPathsOfGroup);
      const auto emitted = cells.Sample(scene, begin + i % (end - begin), EmissionNumbers(sampler));
      const int64_t ofPath = emitted ? CountPhotons(scene, *emitted, sampler, maxDepth) : 0;
      photons += ofPath;
      paths += ofPath > 0 ? 1 : 0;
    }
    means[static_cast<size_t>(group)] =
        static_cast<double>(photons) / static_cast<double>(std::max(paths, kLeastPaths));
  });
  return *std::ranges::max_element(means);
}

int64_t FilmBytes(const RenderSettings& settings, const AovSet& aovs, bool tracksBlur) {
  const auto extras = static_cast<int64_t>(FilmChannels(aovs).size());
  const int colors = tracksBlur ? 4 : 2;
  return settings.crop.Area() * static_cast<int64_t>(sizeof(FixedPoint)) * (colors * Color::kComponents + extras);
}

std::string Megabytes(int64_t bytes) { return fmt::format("{} MB", (bytes + 999'999) / 1'000'000); }

}  // namespace

void RequireFilm(const RenderSettings& settings, const AovSet& aovs, bool tracksBlur, int64_t available) {
  const int64_t pixels = settings.crop.Area(), bytes = FilmBytes(settings, aovs, tracksBlur);
  const std::string size = fmt::format("a picture of {} x {} pixels", settings.crop.Width(), settings.crop.Height());
  if (pixels > kMaxImagePixels)
    throw Error(settings.resolutionLocation,
                fmt::format("{}, expected at most {} in all: see --resolution and --crop", size, kMaxImagePixels));
  if (bytes > available)
    throw Error(settings.resolutionLocation,
                fmt::format("{}, whose film takes {}, more than the {} that are to be had: see --resolution and --crop",
                            size, Megabytes(bytes), Megabytes(available)));
}

MemoryNeeds EstimateMemory(const Scene& scene, const AovSet& aovs, const Integrator& integrator,
                           const IntegratorOptions& options, uint64_t seed, bool tracksBlur) {
  MemoryNeeds needs;
  const int64_t pixels = scene.Settings().crop.Area();
  const auto extras = static_cast<int64_t>(FilmChannels(aovs).size());
  const int64_t channels = extras + Color::kComponents * (aovs.variance ? 2 : 1);
  needs.film = FilmBytes(scene.Settings(), aovs, tracksBlur);
  const int64_t picture = pixels * channels * static_cast<int64_t>(sizeof(float));
  // The state may be written, or read, while there is a picture.
  needs.files = std::max(needs.film + picture, picture * kCopiesOfPicture);
  const PassForecast forecast = integrator.Forecast(scene, seed);
  needs.pilots = forecast.pilotBytes;
  if (forecast.storesPhotons) {
    // Where Dapple chooses their number, a guide may double it.
    needs.lightPaths = options.photonsPerPass ? *options.photonsPerPass : 2 * forecast.lightPaths;
    const double perPath = PhotonsOfAPath(scene, options.maxDepth, seed);
    needs.photons =
        static_cast<int64_t>(static_cast<double>(needs.lightPaths) * perPath * static_cast<double>(kBytesPerPhoton));
  }
  return needs;
}

void RequireMemory(int64_t limit, int64_t inUse, const MemoryNeeds& needs) {
  const int64_t sum = inUse + needs.Sum();
  if (sum <= limit) return;
  std::string text =
      fmt::format("the render takes about {}, more than {}: the scene {}, the film {}, writing files {}",
                  Megabytes(sum), Megabytes(limit), Megabytes(inUse), Megabytes(needs.film), Megabytes(needs.files));
  if (needs.pilots > 0) text += fmt::format(", pilots {}", Megabytes(needs.pilots));
  if (needs.photons > 0) {
    const int64_t left = limit - (sum - needs.photons);
    text += fmt::format(", photons of {} light paths a pass {}", needs.lightPaths, Megabytes(needs.photons));
    // What is in use differs a little from run to run.
    constexpr double kMargin = 0.95;
    const double share = kMargin * static_cast<double>(left) / static_cast<double>(needs.photons);
    const auto fitting = static_cast<int64_t>(share * static_cast<double>(needs.lightPaths));
    if (fitting >= 1) text += fmt::format("; --photons {} fits", fitting);
  }
  throw Error(text);
}

}  // namespace dapple
