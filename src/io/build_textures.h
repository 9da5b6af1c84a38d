// Texture statements as textures.
#pragma once

#include "src/io/build_values.h"

namespace dapple {

/// Throws `Error` at the place of what is wrong. A kind that Dapple lacks gives a warning and a constant.
ColorTexturePtr BuildColorTexture(Values& values, const TextureDescription& texture);
FloatTexturePtr BuildFloatTexture(Values& values, const TextureDescription& texture);

}  // namespace dapple
