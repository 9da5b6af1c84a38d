// Does an algorithm work as well at one roughness as at the next? A metal ring (or a glass ball) under a small lamp,
// smooth and at 24 roughnesses (GGX alpha) log-spaced to 0.5: error at equal time, and how it changes from one to the
// next.
//
//   roughness_sweep [INTEGRATOR] [ring|ball] [PASSES] [REFERENCE_PASSES]
//
// by default hybrid, ring, 32 and 1024. Each picture (96 x 96) is compared with a long reference of its own, made by
// `hybrid` with half the gather radius and another seed. Error falls nearly as 1 / time, so that the processor's
// seconds (of the fastest of three seeds) times the relative MSE (the worst 0.1 % of pixels left out, mean of the
// seeds) tells the error at equal time.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "integrators/integrator.h"
#include "src/image/metrics.h"
#include "src/io/build_scene.h"
#include "src/io/pbrt_parser.h"

namespace dapple {
namespace {

constexpr int kRoughnesses = 25;

double RoughnessOf(int i) {
  constexpr double kSmallest = 0.002, kLargest = 0.5;
  return i == 0 ? 0 : kSmallest * std::pow(kLargest / kSmallest, (i - 1) / (kRoughnesses - 2.));
}

std::unique_ptr<Scene> SceneWith(const std::string& shape, double roughness) {
  constexpr const char* kScene = R"(LookAt 0.6 -3.6 3.0  0 0.05 0.05  0 0 1
Camera "perspective" "float fov" 34
Film "rgb" "integer xresolution" 96 "integer yresolution" 96
WorldBegin
AttributeBegin
  Material "diffuse" "rgb reflectance" [0 0 0]
  AreaLightSource "diffuse" "rgb L" [110 104 96]
  Translate 1.9 1.7 2.2
  Shape "sphere" "float radius" 0.16
AttributeEnd
Material "diffuse" "rgb reflectance" [0.45 0.42 0.40]
Shape "disk" "float radius" 5
)";
  constexpr const char* kRing = R"(Translate 0 0 0.001 Rotate 115 0 0 1
Material "conductor" "rgb reflectance" [0.96 0.80 0.50] "bool remaproughness" false "float roughness" {}
Shape "cylinder" "float radius" 0.9 "float zmin" 0 "float zmax" 0.45 "float phimax" 290
)";
  constexpr const char* kBall = R"(Translate 0 0 0.55
Material "dielectric" "bool remaproughness" false "float roughness" {}
Shape "sphere" "float radius" 0.5
)";
  Diagnostics diagnostics([](const std::string& line) { fmt::print(stderr, "{}\n", line); });
  const std::string text = kScene + fmt::format(fmt::runtime(shape == "ball" ? kBall : kRing), roughness);
  return BuildScene(ParsePbrtString(text, "sweep.pbrt", ".", {4}, diagnostics), {}, diagnostics);
}

struct Render {
  Image image;
  double seconds = 0;  // of all processors together, without the preparation
};

Render RenderPasses(const Scene& scene, const std::string& integratorName, double radiusScale, int passes,
                    uint64_t seed) {
  IntegratorOptions options;
  options.radiusScale = radiusScale;
  const auto integrator = MakeIntegrator(integratorName, options);
  integrator->Prepare(scene, seed);
  Film film(scene.Settings().resolution, scene.Settings().crop, scene.Settings().filter);
  const std::clock_t start = std::clock();
  for (int pass = 0; pass < passes; ++pass) integrator->RenderPass(pass, film);
  return {film.ToImage(), static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC};
}

void Sweep(const std::string& integrator, const std::string& shape, int passes, int referencePasses) {
  constexpr int kSeeds = 3;
  fmt::print("{} of a {}, {} passes; reference: {} passes of hybrid\n", integrator, shape, passes, referencePasses);
  fmt::print("| roughness | seconds | relative MSE | product | to the one before |\n|---|---|---|---|---|\n");
  double previous = 0, largest = 1;
  for (int i = 0; i < kRoughnesses; ++i) {
    const auto scene = SceneWith(shape, RoughnessOf(i));
    const Image reference = RenderPasses(*scene, "hybrid", 0.5, referencePasses, 1000).image;
    double seconds = std::numeric_limits<double>::infinity(), error = 0;
    for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const Render render = RenderPasses(*scene, integrator, 1, passes, seed);
      seconds = std::min(seconds, render.seconds);
      error += CompareImages(render.image, reference).trimmedRelativeMse / kSeeds;
    }
    const double product = seconds * error, ratio = previous > 0 ? product / previous : 1;
    largest = std::max({largest, ratio, 1 / ratio});
    fmt::print("| {:.4f} | {:.2f} | {:.3g} | {:.3g} | {:.2f} |\n", RoughnessOf(i), seconds, error, product, ratio);
    std::fflush(stdout);
    previous = product;
  }
  fmt::print("largest ratio of neighbours: {:.2f}\n", largest);
}

}  // namespace
}  // namespace dapple

int main(int argc, char** argv) {
  const auto argument = [&](int i, const char* otherwise) { return std::string(argc > i ? argv[i] : otherwise); };
  try {
    dapple::Sweep(argument(1, "hybrid"), argument(2, "ring"), std::stoi(argument(3, "32")),
                  std::stoi(argument(4, "1024")));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
