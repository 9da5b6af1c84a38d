// Errors of direct light under an environment, strategy by strategy, alone and with multiple importance sampling.
//
//   environment_study SCENE [SAMPLES]
//
// SCENE has one infinite light, with an image. Direct light only (depth 1), 4 camera samples a pixel and SAMPLES (64)
// next-event samples at each, against a reference of its own (256 camera samples of 16, "product", MIS). Relative MSE
// over all pixels, and over those from which the brightest direction of the map cannot be seen (those on a rim left
// out).
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "integrators/integrator.h"
#include "src/image/metrics.h"
#include "src/io/build_scene.h"
#include "src/io/pbrt_parser.h"

namespace dapple {
namespace {

const std::string kStrategies[] = {"uniform",     "cosine",     "importance", "irradiance",
                                   "compensated", "structured", "product"};

std::unique_ptr<Scene> SceneWith(const std::string& file, const std::string& sampling, int samples) {
  Diagnostics diagnostics([](const std::string& line) { fmt::print(stderr, "{}\n", line); });
  SceneDescription description = ParsePbrtFile(file, {}, diagnostics);
  Parameter strategy, count;
  strategy.type = ParameterType::String;
  strategy.name = "sampling";
  strategy.strings = {sampling};
  count.type = ParameterType::Integer;
  count.name = "samples";
  count.integers = {samples};
  SetOnInfiniteLights(&description, strategy);
  SetOnInfiniteLights(&description, count);
  return BuildScene(description, {}, diagnostics);
}

struct Render {
  Image image;
  double seconds = 0;
};

Render RenderDirect(const Scene& scene, DirectTechnique technique, int passes, uint64_t seed) {
  IntegratorOptions options;
  options.maxDepth = 1;
  options.direct.technique = technique;
  const auto integrator = MakeIntegrator("path", options);
  integrator->Prepare(scene, seed);
  Film film(scene.Settings().resolution, scene.Settings().crop, scene.Settings().filter);
  const auto start = std::chrono::steady_clock::now();
  for (int pass = 0; pass < passes; ++pass) integrator->RenderPass(pass, film);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  return {film.ToImage(), time.count()};
}

/// The brightest direction among many draws.
Vec3 SunOf(const Scene& scene) {
  const Light& light = *scene.Lights()[static_cast<size_t>(scene.InfiniteLights().at(0))];
  std::optional<LiSample> brightest;
  constexpr int kSide = 128;
  for (int i = 0; i < kSide * kSide; ++i) {
    const LiRandom u{0.5, {(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide}};
    const auto sample = light.Sample_Li(LightContext(scene.Extent().center), u);
    if (sample && (!brightest || sample->L.Luminance() > brightest->L.Luminance())) brightest = sample;
  }
  return brightest->wi;
}

/// The pixels of which four corners see one surface, from which the sun is hidden.
std::vector<bool> PixelsInShadow(const Scene& scene) {
  const Vec3 sun = SunOf(scene);
  const PixelBounds& crop = scene.Settings().crop;
  std::vector<bool> flags;
  for (int y = crop.min.y; y < crop.max.y; ++y)
    for (int x = crop.min.x; x < crop.max.x; ++x) {
      bool isHidden = true;
      int shape = -1;
      for (const Vec2& offset : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
        const Vec2 film(static_cast<float>(x) + offset.x, static_cast<float>(y) + offset.y);
        const auto hit = scene.Intersect(scene.GetCamera().GenerateRay(film, Vec2d(0.5), 0).ray);
        isHidden = isHidden && hit && (shape < 0 || hit->shape == shape);
        if (!isHidden) break;
        shape = hit->shape;
        const bool isBehind = Dot(FaceForward(hit->ng, hit->wo), sun) <= 0;
        isHidden = isBehind || !scene.Unoccluded(SpawnRay(*hit, sun));
      }
      flags.push_back(isHidden);
    }
  return flags;
}

/// Mean over the flagged pixels of (t - r)^2 / (r^2 + 0.01), as `ImageDifference::relativeMse`.
double ErrorIn(const Image& test, const Image& reference, const std::vector<bool>& flags) {
  double sum = 0, count = 0;
  for (int y = 0; y < test.Height(); ++y)
    for (int x = 0; x < test.Width(); ++x) {
      if (!flags[static_cast<size_t>(y) * static_cast<size_t>(test.Width()) + static_cast<size_t>(x)]) continue;
      const Color t = test.ColorAt(x, y), r = reference.ColorAt(x, y);
      for (int c = 0; c < Color::kComponents; ++c) {
        const double expected = r[c], difference = t[c] - r[c];
        sum += difference * difference / (expected * expected + 0.01);
      }
      count += Color::kComponents;
    }
  return count > 0 ? sum / count : 0;
}

void Study(const std::string& file, int samples) {
  constexpr int kPasses = 4;
  const auto best = SceneWith(file, "product", 16);
  const Image reference = RenderDirect(*best, DirectTechnique::Mis, 256, 1).image;
  const std::vector<bool> shadow = PixelsInShadow(*best);
  const auto pixels = std::count(shadow.begin(), shadow.end(), true);
  fmt::print("{}: {} of {} pixels in shadow\n", file, pixels, shadow.size());
  fmt::print("| strategy | alone | in shadow | s | with MIS | in shadow | s |\n|---|---|---|---|---|---|---|\n");
  const auto columns = [&](const Scene& scene, DirectTechnique technique) {
    const Render render = RenderDirect(scene, technique, kPasses, 2);
    return fmt::format(" {:.2g} | {:.2g} | {:.1f} |", CompareImages(render.image, reference).relativeMse,
                       ErrorIn(render.image, reference, shadow), render.seconds);
  };
  for (const std::string& strategy : kStrategies) {
    const auto scene = SceneWith(file, strategy, samples);
    fmt::print("| `{}` |{}{}\n", strategy, columns(*scene, DirectTechnique::Light),
               columns(*scene, DirectTechnique::Mis));
    std::fflush(stdout);
  }
  fmt::print("| BSDF alone |{} | | |\n", columns(*best, DirectTechnique::Bsdf));
}

}  // namespace
}  // namespace dapple

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: environment_study SCENE [SAMPLES]\n");
    return 2;
  }
  try {
    dapple::Study(argv[1], argc > 2 ? std::stoi(argv[2]) : 64);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
