#include "src/render/memory_needs.h"

#include <algorithm>

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/image/image_io.h"
#include "src/photons/light_path.h"

namespace dapple {

namespace {

/// A photon (position and payload) stands in its chunk, whose arrays may be half empty while they grow, and in the map.
constexpr int64_t kBytesPerPhoton = 3 * (12 + 32);
/// An image, what it is made from, and its file before and after compression.
constexpr int64_t kCopiesOfPicture = 4;

/// The mean over the light paths that leave any: emission may be guided to these.
double PhotonsOfAPath(const Scene& scene, int maxDepth, uint64_t seed) {
  struct Chunk {
    int64_t photons = 0, paths = 0;
  };
  constexpr int64_t kPaths = 4096;
  const EmissionSampler emission(scene);
  const std::vector<Chunk> chunks = ForEachLightPath<Chunk>(
      emission, seed, 0, kPaths, [&](const EmissionSample& emitted, const Sampler& sampler, Chunk& chunk) {
        int64_t photons = 0;
        TraceLightPath(scene, emitted, sampler, maxDepth, [&](const LightVertex& vertex) {
          photons += vertex.scattered > 0 && !vertex.bsdf.IsPurelySpecular() ? 1 : 0;
        });
        chunk.photons += photons;
        chunk.paths += photons > 0 ? 1 : 0;
      });
  Chunk sum;
  for (const Chunk& chunk : chunks) sum.photons += chunk.photons, sum.paths += chunk.paths;
  return sum.paths > 0 ? static_cast<double>(sum.photons) / static_cast<double>(sum.paths) : 0;
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
                fmt::format("{}, whose film takes {}, more than the {} of this machine: see --resolution and --crop",
                            size, Megabytes(bytes), Megabytes(available)));
}

MemoryNeeds EstimateMemory(const Scene& scene, const AovSet& aovs, const Integrator& integrator,
                           const IntegratorOptions& options, uint64_t seed, bool tracksBlur) {
  MemoryNeeds needs;
  const int64_t pixels = scene.Settings().crop.Area();
  const auto extras = static_cast<int64_t>(FilmChannels(aovs).size());
  const int64_t channels = extras + Color::kComponents * (aovs.variance ? 2 : 1);
  needs.film = FilmBytes(scene.Settings(), aovs, tracksBlur);
  needs.files = std::max(needs.film, pixels * channels * static_cast<int64_t>(sizeof(float)) * kCopiesOfPicture);
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
