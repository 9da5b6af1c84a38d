// What can be hit, seen from outside: enough of its convex hull to fit circles around it in any direction.
//
// Made of the shapes' hulls (`Shape::AppendHull`), instances included, in trees of balls; much smaller than the
// accelerator, and of use only while lights are prepared.
#pragma once

#include <span>
#include <vector>

#include "src/geometry/accelerator.h"
#include "src/geometry/affine.h"
#include "src/geometry/ball_tree.h"

namespace dapple {

/// All that is within `radius` of the line through `center` along some direction.
struct EnclosingCylinder {
  Vec3d center{0, 0, 0};
  double radius = 0;
};

class Outline {
 public:
  /// As `Accelerator` takes them; nothing is kept.
  Outline(std::span<const GeometryEntry> shapes, std::span<const GeometryGroup> groups,
          std::span<const GeometryInstance> instances);

  /// Nothing can be hit.
  bool IsEmpty() const { return standing_.IsEmpty() && placed_.IsEmpty(); }

  /// The narrowest cylinder along the unit vector `w` around everything, or one wider by at most the share `tolerance`
  /// of its radius: the smallest circle around what is seen from there. Holds all hulls whatever the rounding, but for
  /// that of doubles. The outline must not be empty.
  EnclosingCylinder CylinderAlong(const Vec3d& w, double tolerance) const;

 private:
  struct Instance {
    Affine groupToRender;
    double stretch = 1;   ///< bound on how much longer it makes vectors
    double rounding = 0;  ///< of hits, which are floats in the group's space
    int group = 0;
  };
  struct FarthestPoint {
    Vec3d p{0, 0, 0};
    double distance = 0;  ///< from the line
  };

  void Place(const GeometryInstance& instance, std::vector<HullBall>* around);
  /// Of what is farther than `distance` from the line; where nothing is, the distance is that.
  FarthestPoint FarthestFromLine(const Vec3d& center, const Vec3d& w, double distance) const;

  BallTree standing_;                // what belongs to no group
  BallTree placed_;                  // balls around instances
  std::vector<Instance> instances_;  // by their places in `placed_`
  std::vector<BallTree> groups_;
};

}  // namespace dapple
