// The disk across the scene from which light of infinitely far away sets out.
#pragma once

#include "lights/light.h"
#include "src/base/frame.h"

namespace dapple {

/// Covers all of the scene as seen along `w`, and lies outside it: rays from the disk along -w have the scene ahead.
struct EmissionDisk {
  /// `w`: the unit direction toward the light.
  EmissionDisk(const SceneExtent& extent, const Vec3& w);

  Vec3 center;
  Frame frame;  ///< n = w
  float radius;
  double area;

  /// A point, uniform in the disk: density 1 / area.
  Vec3 Sample(const Vec2d& u) const;
  /// The density at which the line through `p` along w meets the disk. A margin of rounding around the rim belongs to
  /// it.
  double Pdf(const Vec3& p) const;
  /// The random numbers with which `Sample` gives the point where the line through `p` along w meets the disk.
  Vec2d Invert(const Vec3& p) const;

 private:
  /// Where the line through `p` along w meets the disk, in units of the radius.
  Vec2d Project(const Vec3& p) const;
};

}  // namespace dapple
