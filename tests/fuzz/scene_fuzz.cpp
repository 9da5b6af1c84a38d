// Scene text up to the scene that can be traced: all builders, light tables and the Embree scene.
#include "src/io/build_scene.h"
#include "src/io/pbrt_parser.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace dapple;
  return Fuzz(data, size, [](std::string_view text) {
    Diagnostics diagnostics = NoDiagnostics();
    const SceneDescription description = ParsePbrtString(text, kFuzzInput, "/nonexistent", {}, diagnostics);
    const std::unique_ptr<Scene> scene = BuildScene(description, {}, diagnostics);
    const RenderSettings& settings = scene->Settings();
    Require(settings.resolution.x >= 1 && settings.resolution.y >= 1 && !settings.crop.IsEmpty(),
            "a picture has a pixel");
  });
}
