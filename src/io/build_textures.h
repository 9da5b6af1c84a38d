// Texture statements as textures.
#pragma once

#include "src/io/build_values.h"

namespace dapple {

/// The texture of a statement. Throws `Error` at the place of what is wrong. A kind that Dapple lacks gives a warning
/// and a constant.
ColorTexturePtr BuildColorTexture(Values& values, const TextureDescription& texture);
/// The same for textures of numbers.
FloatTexturePtr BuildFloatTexture(Values& values, const TextureDescription& texture);

}  // namespace dapple
