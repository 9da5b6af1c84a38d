#include "src/geometry/smallest_circle.h"

#include <cmath>

#include "src/base/numerics.h"

namespace dapple {

namespace {

bool Holds(const Circle& circle, const Vec2d& p) {
  constexpr double kRounding = 1 + 1e-14;
  return (p - circle.center).length() <= circle.radius * kRounding;
}

Circle Through(const Vec2d& a, const Vec2d& b) { return {(a + b) * 0.5, (b - a).length() / 2}; }

/// The circle through three points; through the two farthest from each other where the three are in line.
Circle Through(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  const Vec2d ab = b - a, ac = c - a;
  const double cross = DifferenceOfProducts(ab.x, ac.y, ab.y, ac.x);
  const double b2 = ab.length2(), c2 = ac.length2();
  const Vec2d center(DifferenceOfProducts(ac.y, b2, ab.y, c2) / (2 * cross),
                     DifferenceOfProducts(ab.x, c2, ac.x, b2) / (2 * cross));
  const double radius = center.length();
  if (std::isfinite(radius)) return {a + center, radius};
  Circle widest = Through(a, b);
  for (const Circle& other : {Through(b, c), Through(c, a)})
    if (other.radius > widest.radius) widest = other;
  return widest;
}

}  // namespace

Circle SmallestCircle(std::span<const Vec2d> points) {
  Circle circle{points[0], 0};
  for (size_t i = 1; i < points.size(); ++i) {
    if (Holds(circle, points[i])) continue;
    circle = {points[i], 0};
    for (size_t j = 0; j < i; ++j) {
      if (Holds(circle, points[j])) continue;
      circle = Through(points[i], points[j]);
      for (size_t k = 0; k < j; ++k)
        if (!Holds(circle, points[k])) circle = Through(points[i], points[j], points[k]);
    }
  }
  return circle;
}

}  // namespace dapple
