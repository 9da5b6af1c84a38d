// The equal-area map between the unit square and the sphere of directions (Clarberg 2008, "Fast equal-area mapping of
// the (hemi)sphere using SIMD"), oriented as in pbrt-v4: the centre is +z, the corners are -z, u grows toward +x, v
// toward +y.
#pragma once

#include "src/base/vec.h"

namespace dapple {

/// The unit direction at p in [0, 1]^2. Equal areas of the square are equal solid angles (4 pi in all).
Vec3d EqualAreaSquareToSphere(const Vec2d& p);
/// The inverse; `w` is of unit length.
Vec2d EqualAreaSphereToSquare(const Vec3d& w);

}  // namespace dapple
