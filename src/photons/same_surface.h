// Which photons belong to the surface that gathers them: those of other surfaces nearby (a wall's other face, the next
// wall at a corner) are left out, so that light does not leak through thin walls or around corners.
//
//   const GatherSite site(hit.p, hit.ng, hit.wo, radius, bsdf.Flags().HasTransmission());
//   if (IsOnSameSurface(site, position, distanceSquared, normal, wi)) ...
#pragma once

#include <cmath>

#include "src/base/numerics.h"
#include "src/base/vec.h"

namespace dapple {

/// A point that gathers photons within a radius.
struct GatherSite {
  /// `normal`: geometric, of unit length and either sign; `wo`: to where the surface is seen from. A surface that
  /// `letsThrough` takes light that came from either side, others from the side of `wo` alone.
  GatherSite(const Vec3& at, const Vec3& normal, const Vec3& wo, float within, bool letsThrough)
      : p(at), n(FaceForward(normal, wo)), radius(within), transmits(letsThrough) {}

  Vec3 p;
  Vec3 n;  ///< on the side from which the surface is seen
  float radius;
  bool transmits;
};

/// Whether a photon at `position`, nearer to the site than its radius, lies on the site's surface, on a side that
/// counts. `normal` is the photon's geometric normal (unit length, either sign), `wi` points to where its light came
/// from.
///
/// Normals that differ by more than 45 degrees are of another surface. On a plane, a sphere and a cylinder the chord
/// between two points is at right angles to the sum of their normals, and at the edge of two facets it leaves that
/// right angle by less than half the angle of the normals. So what is off by more is of another surface, such as the
/// other face of a wall: parallel faces are told apart from a distance of 1/20 of the radius.
inline bool IsOnSameSurface(const GatherSite& site, const Vec3& position, float distanceSquared, const Vec3& normal,
                            const Vec3& wi) {
  constexpr float kMinNormalCosine = 0.70710678f;
  constexpr float kFlatness = 0.05f;
  const Vec3 n = FaceForward(normal, site.transmits ? site.n : wi);
  const float cosine = Dot(n, site.n);
  if (cosine < kMinNormalCosine) return false;
  // With half the angle between the normals: |n + site.n| = 2 cos, and its sine.
  const float offChord = std::abs(Dot(position - site.p, n + site.n));
  const float twiceCosHalf = std::sqrt(2 * (1 + cosine)), sinHalf = SafeSqrt((1 - cosine) / 2);
  return offChord <= twiceCosHalf * (kFlatness * site.radius + sinHalf * std::sqrt(distanceSquared));
}

}  // namespace dapple
