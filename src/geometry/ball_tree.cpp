#include "src/geometry/ball_tree.h"

#include <algorithm>

#include "src/geometry/surface_math.h"

namespace dapple {

BallTree::BallTree(std::span<const HullBall> balls) {
  items_.reserve(balls.size());
  for (const HullBall& ball : balls) items_.push_back({ball, static_cast<int>(items_.size())});
  if (!items_.empty()) Build(0, static_cast<int>(items_.size()));
}

void BallTree::Build(int begin, int end) {
  constexpr int kLeafSize = 32;
  const auto first = items_.begin() + begin, last = items_.begin() + end;
  Bounds3d box;
  for (auto item = first; item != last; ++item) box.extendBy(ToDouble(item->ball.center));
  const Vec3d center = ToDouble(ToFloat(box.center()));
  double radius = 0;
  for (auto item = first; item != last; ++item)
    radius = std::max(radius, Distance(ToDouble(item->ball.center), center) + static_cast<double>(item->ball.radius));

  const size_t node = nodes_.size();
  nodes_.push_back({{ToFloat(center), RoundUp(radius)}, begin, end});
  if (end - begin <= kLeafSize) return;
  const int axis = static_cast<int>(box.majorAxis());
  const int middle = begin + (end - begin) / 2;
  std::nth_element(first, items_.begin() + middle, last,
                   [axis](const Item& a, const Item& b) { return a.ball.center[axis] < b.ball.center[axis]; });
  Build(begin, middle);
  nodes_[node].second = static_cast<int>(nodes_.size());
  Build(middle, end);
}

}  // namespace dapple
