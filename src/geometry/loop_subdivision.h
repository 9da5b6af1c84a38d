// Loop subdivision of a triangle mesh, evaluated at its limit surface, as pbrt's `loopsubdiv`.
#pragma once

#include <vector>

#include "src/base/vec.h"

namespace dapple {

/// A refined mesh: its vertices lie on the limit surface, with that surface's normals. These are the cross products of
/// its tangents and not of unit length: as in pbrt, the longer ones weigh more where they are interpolated.
struct SubdividedMesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<int> indices;  ///< three a triangle
};

/// Splits each triangle into four, `levels` times (>= 0), then moves every vertex to the limit surface (Loop 1987;
/// weights of Warren and limit rules of Hoppe et al. 1994 as in pbrt-v3, section 3.8). Open boundaries stay curves.
/// Normals are on the side that pbrt gives them: from there the triangles run clockwise. Throws `Error` where counts do
/// not fit, an index is out of range, an edge belongs to more than two triangles or runs the same way in two, or the
/// triangles that share a vertex do not form one fan.
SubdividedMesh LoopSubdivide(int levels, const std::vector<Vec3>& positions, const std::vector<int>& indices);

}  // namespace dapple
