// PNG, JPEG and TGA (stb_image behind the project's checks), Radiance HDR and PFM. What bears no mark is read as TGA.
#include "src/image/image_formats.h"
#include "tests/fuzz/image_size.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace dapple;
  return Fuzz(data, size, [](std::string_view bytes) {
    if (bytes.starts_with("\x76\x2f\x31\x01")) return;  // exr_fuzz
    RequireImage(DecodeImage(bytes, "input.tga", ColorEncoding::Linear(), FileLocation(kFuzzInput)));
  });
}
