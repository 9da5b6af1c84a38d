// The reader of tables of wavelengths and values, and the colours that become of them.
#include <cmath>

#include "src/materials/spectrum.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace dapple;
  return Fuzz(data, size, [](std::string_view text) {
    const Spectrum spectrum = ParseSpectrum(text, kFuzzInput, Spectrum::Outside::kConstant);
    for (const double nm : {1e-300, 360., 555.5, 830., 1e300})
      Require(std::isfinite(spectrum(nm)), "a spectrum is finite everywhere");
  });
}
