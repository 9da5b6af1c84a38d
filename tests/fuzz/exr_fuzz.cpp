// OpenEXR files: Debian's library, behind the checks of the project's reader.
#include "src/image/image_formats.h"
#include "tests/fuzz/image_size.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace dapple;
  return Fuzz(data, size, [](std::string_view bytes) { RequireImage(ReadExr(bytes, FileLocation(kFuzzInput))); });
}
