#include "src/geometry/outline.h"

#include "src/base/frame.h"
#include "src/geometry/smallest_circle.h"
#include "src/geometry/surface_math.h"

namespace dapple {

namespace {

/// A bound on the spectral norm, exact for rotations with a uniform scale: the root of the largest row sum of A^T A.
double StretchOf(const Affine& a) {
  const Vec3d axes[3] = {a.x, a.y, a.z};
  double largest = 0;
  for (const Vec3d& v : axes) largest = std::max(largest, AbsDot(v, a.x) + AbsDot(v, a.y) + AbsDot(v, a.z));
  return std::sqrt(largest);
}

}  // namespace

Outline::Outline(std::span<const GeometryEntry> shapes, std::span<const GeometryGroup> groups,
                 std::span<const GeometryInstance> instances) {
  std::vector<char> isInGroup(shapes.size(), 0);
  std::vector<HullBall> hull;
  for (const GeometryGroup& group : groups) {
    hull.clear();
    for (const int index : group.shapes) {
      isInGroup[static_cast<size_t>(index)] = 1;
      shapes[static_cast<size_t>(index)].shape->AppendHull(&hull);
    }
    groups_.emplace_back(hull);
  }
  hull.clear();
  for (size_t i = 0; i < shapes.size(); ++i)
    if (!isInGroup[i]) shapes[i].shape->AppendHull(&hull);
  standing_ = BallTree(hull);
  hull.clear();
  for (const GeometryInstance& instance : instances) Place(instance, &hull);
  placed_ = BallTree(hull);
}

void Outline::Place(const GeometryInstance& instance, std::vector<HullBall>* around) {
  const BallTree& group = groups_[static_cast<size_t>(instance.group)];
  if (group.IsEmpty()) return;
  Instance placed{Affine(instance.groupToRender), 1, 0, instance.group};
  placed.stretch = StretchOf(placed.groupToRender);
  const HullBall& ball = group.Around();
  constexpr double kRoundings = 8;
  placed.rounding =
      kRoundings * kFloatRounding * placed.stretch * (Length(ToDouble(ball.center)) + static_cast<double>(ball.radius));
  around->push_back(EnclosingHullBall(placed.groupToRender.Point(ToDouble(ball.center)),
                                      placed.stretch * static_cast<double>(ball.radius) + placed.rounding));
  instances_.push_back(placed);
}

Outline::FarthestPoint Outline::FarthestFromLine(const Vec3d& center, const Vec3d& w, double distance) const {
  FarthestPoint farthest{center, distance};
  const auto reach = [&](const Vec3d& p, double radius) { return Length(Cross(p - center, w)) + radius; };
  const auto visit = [&](const Vec3d& p, double radius, double reached) {
    const Vec3d offset = p - center, across = offset - w * Dot(offset, w);
    const double length = Length(across);
    Vec3d s(0), t(0);
    CoordinateSystem(w, &s, &t);
    farthest = {p + (length > 0 ? across / length : s) * radius, reached};
  };
  const auto plainReach = [&](const HullBall& ball) {
    return reach(ToDouble(ball.center), static_cast<double>(ball.radius));
  };
  standing_.Search(plainReach, &farthest.distance, [&](const HullBall& ball, int, double reached) {
    visit(ToDouble(ball.center), static_cast<double>(ball.radius), reached);
  });
  placed_.Search(plainReach, &farthest.distance, [&](const HullBall&, int index, double) {
    const Instance& instance = instances_[static_cast<size_t>(index)];
    const auto radiusOf = [&](const HullBall& ball) {
      return instance.stretch * static_cast<double>(ball.radius) + instance.rounding;
    };
    const auto placedReach = [&](const HullBall& ball) {
      return reach(instance.groupToRender.Point(ToDouble(ball.center)), radiusOf(ball));
    };
    groups_[static_cast<size_t>(instance.group)].Search(
        placedReach, &farthest.distance, [&](const HullBall& ball, int, double reached) {
          visit(instance.groupToRender.Point(ToDouble(ball.center)), radiusOf(ball), reached);
        });
  });
  return farthest;
}

// The circle is that of a few points which determine it: as long as anything lies outside, the farthest point of that
// joins them. The balls' borders enter by as many of their points as it takes.
EnclosingCylinder Outline::CylinderAlong(const Vec3d& w, double tolerance) const {
  constexpr size_t kMaxPoints = 64;
  const Vec3d origin = ToDouble(standing_.IsEmpty() ? placed_.Around().center : standing_.Around().center);
  Vec3d s(0), t(0);
  CoordinateSystem(w, &s, &t);
  std::vector<Vec2d> points;
  EnclosingCylinder cylinder{origin, 0};
  for (;;) {
    const double enough = cylinder.radius * (1 + tolerance);
    const FarthestPoint farthest = FarthestFromLine(cylinder.center, w, enough);
    if (farthest.distance == enough || points.size() == kMaxPoints) return {cylinder.center, farthest.distance};
    const Vec3d offset = farthest.p - origin;
    points.emplace_back(Dot(offset, s), Dot(offset, t));
    const Circle circle = SmallestCircle(points);
    cylinder = {origin + s * circle.center.x + t * circle.center.y, circle.radius};
  }
}

}  // namespace dapple
