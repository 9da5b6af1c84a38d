// The reader of scene text, up to the description.
#include "src/io/pbrt_parser.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace dapple;
  return Fuzz(data, size, [](std::string_view text) {
    Diagnostics diagnostics = NoDiagnostics();
    const SceneDescription scene = ParsePbrtString(text, kFuzzInput, "/nonexistent", {}, diagnostics);
    Require(scene.version == 3 || scene.version == 4, "a scene has a version");
    for (const ShapeDescription& shape : scene.shapes)
      Require(shape.material >= 0 && shape.material < static_cast<int>(scene.materials.size()),
              "the material of a shape is one of the scene's");
    for (const InstanceDescription& instance : scene.instances)
      Require(instance.object >= 0 && instance.object < static_cast<int>(scene.objects.size()),
              "an instance is of an object of the scene");
  });
}
