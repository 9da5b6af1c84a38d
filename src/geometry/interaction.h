// A point on a surface as shading, textures and lights see it, and rays that leave it without meeting it again.
#pragma once

#include "src/geometry/ray.h"

namespace dapple {

/// A point on a surface. All vectors are in render space.
///
/// `ng` is the geometric normal on the side that pbrt calls outside (orientation, handedness and the mesh's own normals
/// taken into account); `ns` is the shading normal, in the hemisphere of `ng`. Neither is turned toward the viewer.
struct SurfaceInteraction {
  Vec3 p{0};
  float pError = 0;   ///< bound on the distance between p and the true surface
  Vec3 ng{0}, ns{0};  ///< unit length
  Vec3 wo{0};         ///< unit length, back along the ray that found the point
  Vec2 uv{0};
  Vec3 dpdu{0}, dpdv{0};    ///< of the surface's parametrisation
  Vec3 dpdus{0}, dpdvs{0};  ///< of the shading surface: dpdus x dpdvs is along +-ns
  Vec3 dndu{0}, dndv{0};    ///< derivatives of the shading normal, zero on flat surfaces
  float t = 0;              ///< distance along the ray that found the point, in units of |d|
  int shape = -1;           ///< index in the scene
  int primitive = 0;        ///< index within the shape
  int instance = -1;        ///< index of the instance, or -1
  PathState state{};
};

/// `p`, moved off its surface (of unit normal `ng`) toward the side of `w`, beyond the error bound `pError`: a ray from
/// there along `w` does not meet the surface again. The idea of Waechter and Binder 2019 with a bound that knows the
/// scale of what was hit (pbrt-v4, section 6.8.6), so that scenes may be of any size.
inline Vec3 OffsetOrigin(const Vec3& p, float pError, const Vec3& ng, const Vec3& w) {
  const Vec3 offset = ng * (Dot(w, ng) < 0 ? -pError : pError);
  Vec3 moved = p + offset;
  for (int axis = 0; axis < 3; ++axis) {
    if (offset[axis] > 0) moved[axis] = NextFloatUp(moved[axis]);
    if (offset[axis] < 0) moved[axis] = NextFloatDown(moved[axis]);
  }
  return moved;
}

/// The ray that leaves the surface along the unit direction `w`.
inline Ray SpawnRay(const SurfaceInteraction& from, const Vec3& w) {
  return {OffsetOrigin(from.p, from.pError, from.ng, w), w, kInfinity, from.state};
}

/// The ray that joins two points and ends before the second, for visibility: both ends are moved off their surfaces.
/// `toNormal` zero: the end is no surface, and the ray reaches up to it. Direction is not normalised: t runs from 0
/// to 1.
inline Ray SpawnRayTo(const SurfaceInteraction& from, const Vec3& to, float toError, const Vec3& toNormal) {
  const Vec3 origin = OffsetOrigin(from.p, from.pError, from.ng, to - from.p);
  const Vec3 target = OffsetOrigin(to, toError, toNormal, origin - to);
  constexpr float kShadowEnd = 1 - 1e-4f;
  return {origin, target - origin, kShadowEnd, from.state};
}

}  // namespace dapple
