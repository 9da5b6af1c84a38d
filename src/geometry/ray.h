// Rays, and what a path carries along them.
#pragma once

#include "src/base/numerics.h"
#include "src/base/vec.h"

namespace dapple {

/// What stays the same along a path: the moment at which it is, and the wavelength it stands for.
struct PathState {
  float time = 0;        ///< in [0, 1] between the shutter's opening and closing
  float wavelength = 0;  ///< in nm; 0: all three colour components travel together
};

/// The half-open segment o + t d, 0 < t < tMax; t is in units of |d|, and d is of unit length wherever the renderer
/// makes it.
struct Ray {
  Vec3 o{0, 0, 0};
  Vec3 d{0, 0, 1};
  float tMax = kInfinity;
  PathState state{};

  Vec3 operator()(float t) const { return o + d * t; }
};

}  // namespace dapple
