// The disk across the scene from which light of infinitely far away sets out, one for each direction.
//
// Seen from the direction w, the scene is a set of points in a plane; the disk covers their smallest circle, or little
// more. Let r(w) be the radius of that circle, for w of any length times |w|: the least, over lines with direction w
// and moment m, of the largest |p x w - m| over points p of the scene. The largest of norms of linear functions is
// convex, and so is what is left of a convex function when one of its arguments is minimised away: r is convex. So
// where w is a weighted mean of directions w_i, the weighted mean of their r(w_i) is no less than r(w), and a line of
// the weighted mean of their moments is as near to the scene as that. Circles for a grid of directions, interpolated,
// hence cover the scene from all directions, and where r is smooth they are too large by the square of the grid's
// spacing only. As r(-w) = r(w), three sides of a cube carry the grid.
#pragma once

#include <vector>

#include "lights/light.h"

namespace dapple {

/// Covers all of the scene as seen along a direction w, and lies outside it: rays from the disk along -w have the scene
/// ahead.
struct EmissionDisk {
  Vec3d center{0, 0, 0};
  Vec3d s{1, 0, 0}, t{0, 1, 0};  ///< with w, an orthonormal frame
  double radius = 1;
  double rounding = 0;  ///< how far off their lines points of emitted rays may be, beside the rounding of the points

  double Area() const;
  /// A point, uniform in the disk: density 1 / area.
  Vec3 Sample(const Vec2d& u) const;
  /// The density at which the line through `p` along w meets the disk. A margin of rounding around the rim belongs to
  /// it.
  double Pdf(const Vec3& p) const;
  /// The random numbers with which `Sample` gives the point where the line through `p` along w meets the disk.
  Vec2d Invert(const Vec3& p) const;

 private:
  /// Where the line through `p` along w meets the disk.
  Vec2d Project(const Vec3& p) const;
};

class EmissionDisks {
 public:
  EmissionDisks() = default;
  /// For all directions. Where the extent has no outline, the disks are those of its sphere.
  explicit EmissionDisks(const SceneExtent& extent);

  /// The disk for light that arrives from `w`, of unit length but for its rounding to float.
  EmissionDisk Toward(const Vec3& w) const;
  /// The disk's area for the unit vector `w`.
  double Area(const Vec3d& w) const;
  /// The integral of the area over all directions.
  double AreaIntegral() const;

  /// The grid of directions; none where the disks are those of the sphere.
  TableUse Table() const { return TableUse::Of(static_cast<int64_t>(grid_.size() * sizeof(Cylinder))); }

  /// The disk for one direction alone: the smallest.
  static EmissionDisk Smallest(const SceneExtent& extent, const Vec3& w);

 private:
  /// A cylinder along a direction w of any length around the scene.
  struct Cylinder {
    Vec3d moment{0, 0, 0};  ///< of its axis around the extent's centre, c x w
    double radius = 0;      ///< times |w|
  };

  void FillGrid(const Outline& outline);
  /// Interpolated for a unit vector; `radius` without the margin.
  Cylinder Along(const Vec3d& w) const;

  Vec3d center_{0, 0, 0};
  double sphereRadius_ = 1;
  double margin_ = 0;
  std::vector<Cylinder> grid_;  // by side, row, column; empty: the sphere
};

}  // namespace dapple
