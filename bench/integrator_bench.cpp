// Passes of whole renders: rays and photons per second, and how well two threads share the work.
//
// Each case renders passes of a scene of scenes/ with 1 or 2 threads; the ratio of the times of one and of two threads,
// halved, is the parallel efficiency.
#include <filesystem>
#include <map>

#include <benchmark/benchmark.h>

#include "integrators/integrator.h"
#include "src/base/parallel.h"
#include "src/io/build_scene.h"

namespace dapple {
namespace {

const Scene& SceneNamed(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Scene>> scenes;
  std::unique_ptr<Scene>& scene = scenes[name];
  if (!scene) {
    Diagnostics diagnostics([](const std::string&) {});
    const auto file = std::filesystem::path(DAPPLE_SOURCE_DIR) / "scenes" / (name + ".pbrt");
    scene = LoadScene(file, {}, diagnostics);
  }
  return *scene;
}

void RenderPasses(benchmark::State& state, const std::string& sceneName, const std::string& integratorName) {
  const Scene& scene = SceneNamed(sceneName);
  const ThreadLimit threads(static_cast<int>(state.range(0)));
  IntegratorOptions options;
  options.photonsPerPass = 200000;
  const auto integrator = MakeIntegrator(integratorName, options);
  integrator->Prepare(scene, 1);
  Film film(scene.Settings().resolution, scene.Settings().crop, scene.Settings().filter);
  PassStats stats;
  int pass = 0;
  for (auto _ : state) stats += integrator->RenderPass(pass++, film);
  const auto rate = [](int64_t count) {
    return benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsRate);
  };
  state.counters["rays/s"] = rate(stats.Rays());
  state.counters["photons/s"] = rate(stats.photonsEmitted);
}

#define DAPPLE_RENDER_BENCHMARK(scene, integrator)                           \
  BENCHMARK_CAPTURE(RenderPasses, scene##_##integrator, #scene, #integrator) \
      ->ArgName("threads")                                                   \
      ->Arg(1)                                                               \
      ->Arg(2)                                                               \
      ->UseRealTime()                                                        \
      ->Unit(benchmark::kMillisecond)

DAPPLE_RENDER_BENCHMARK(box, path);
DAPPLE_RENDER_BENCHMARK(box, light_tracing);
DAPPLE_RENDER_BENCHMARK(box, photon_mapping);
DAPPLE_RENDER_BENCHMARK(box, sppm);
DAPPLE_RENDER_BENCHMARK(box, hybrid);
DAPPLE_RENDER_BENCHMARK(ring, path);
DAPPLE_RENDER_BENCHMARK(ring, light_tracing);
DAPPLE_RENDER_BENCHMARK(ring, photon_mapping);
DAPPLE_RENDER_BENCHMARK(ring, sppm);
DAPPLE_RENDER_BENCHMARK(ring, hybrid);

}  // namespace
}  // namespace dapple
