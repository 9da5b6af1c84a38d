// Small images whose measures are known.
#pragma once

#include "src/image/image.h"
#include "tests/support/random_numbers.h"

namespace dapple {

inline Image Constant(int width, int height, const Color& color) {
  Image image = Image::Rgb(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.SetColor(x, y, color);
  return image;
}

/// Independent values in [0, most).
inline Image RandomImage(int width, int height, uint64_t seed, float most) {
  testing::UniformNumbers random(seed);
  Image image = Image::Rgb(width, height);
  for (float& value : image.Values()) value = static_cast<float>(random.Get1D()) * most;
  return image;
}

}  // namespace dapple
