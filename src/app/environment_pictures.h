// Pictures of how an environment map is sampled, in the layout of its own image.
#pragma once

#include "lights/environment_map.h"

namespace dapple {

/// The density of directions per solid angle, over the even one of 1 / (4 pi), on a scale from black (2^-6 and less) by
/// purple, red and yellow to white (2^10 and more); beside it, for each row, a bar as long as its marginal density, on
/// a scale of its own, and a line where the bar of a sphere sampled evenly would end. The map must not be black.
Image DensityPicture(const EnvironmentMap& map);

/// The map, its brightness compressed, and `count` directions drawn from it as red dots. The map must not be black.
Image SamplesPicture(const EnvironmentMap& map, int count, int seed);

}  // namespace dapple
