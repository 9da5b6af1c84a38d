// What is asked of every image that was read.
#pragma once

#include "src/image/image_io.h"
#include "tests/fuzz/fuzz.h"

namespace dapple {

inline void RequireImage(const Image& image) {
  Require(image.Width() >= 1 && image.Height() >= 1 && image.Channels() >= 1, "an image has a pixel");
  const auto values =
      static_cast<size_t>(image.Width()) * static_cast<size_t>(image.Height()) * static_cast<size_t>(image.Channels());
  Require(image.Values().size() == values, "an image has all its pixels");
}

}  // namespace dapple
