// The triangle as seen from a point: its solid angle, and directions drawn uniformly from it (Arvo 1995).
//
// All is written on the corners' unit vectors and the weights with which they make a direction, so that nothing cancels
// for triangles that are small, far, needle-like or seen edge-on.
#pragma once

#include <array>

#include "src/base/vec.h"

namespace dapple {

class SphericalTriangle {
 public:
  /// Of the triangle with corners p0, p0 + e1, p0 + e2 as seen from `reference`.
  SphericalTriangle(const Vec3d& p0, const Vec3d& e1, const Vec3d& e2, const Vec3d& reference);

  /// In steradians, [0, 2 pi]: 2 atan2(|det|, ...) (Van Oosterom and Strackee 1983). 0 where the triangle is seen
  /// edge-on, or the reference is on it.
  double SolidAngle() const { return solidAngle_; }

  /// True where `Sample` and `Invert` keep their accuracy; elsewhere sample by area.
  bool IsWellConditioned() const;

  /// Barycentric weights of the corners (on the flat triangle) of the direction for `u`, of density 1 / SolidAngle().
  Vec3d Sample(const Vec2d& u) const;
  /// The numbers with which `Sample` gives the weights `b`.
  Vec2d Invert(const Vec3d& b) const;

 private:
  std::array<Vec3d, 3> unit_;         ///< toward the corners
  std::array<double, 3> distance_{};  ///< of the corners
  double determinant_ = 0;            ///< |a . (b x c)| of the unit vectors
  double solidAngle_ = 0;
};

}  // namespace dapple
