// The smallest circle around points of the plane.
#pragma once

#include <span>

#include "src/base/vec.h"

namespace dapple {

struct Circle {
  Vec2d center{0, 0};
  double radius = 0;
};

/// Holds all points but for rounding (Welzl 1991, "Smallest enclosing disks", without recursion: each point outside of
/// the circle so far is on the border of that of the points up to it). For few points, or many in random order.
/// `points` must not be empty.
Circle SmallestCircle(std::span<const Vec2d> points);

}  // namespace dapple
