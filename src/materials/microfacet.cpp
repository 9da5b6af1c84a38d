#include "src/materials/microfacet.h"

namespace dapple {

float RoughnessToAlphaV3(float roughness) {
  const float x = std::log(std::max(roughness, 1e-3f));
  return 1.62142f + x * (0.819955f + x * (0.1734f + x * (0.0171201f + x * 0.000640711f)));
}

float RoughnessToAlphaV4(float roughness) { return std::sqrt(std::max(0.f, roughness)); }

}  // namespace dapple
