// Balls in a tree of balls around them, to find the one that reaches farthest in whatever sense.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "src/geometry/shape.h"

namespace dapple {

class BallTree {
 public:
  BallTree() = default;
  explicit BallTree(std::span<const HullBall> balls);

  bool IsEmpty() const { return nodes_.empty(); }
  /// A ball around all. The tree must not be empty.
  const HullBall& Around() const { return nodes_.front().ball; }

  /// Calls `visit(ball, its place in the constructor's argument, its reach)` for balls whose reach is above
  /// `*farthest`, which `visit` may raise. `reach(ball)` must not be less than that of any ball inside `ball`.
  template <typename Reach, typename Visit>
  void Search(const Reach& reach, const double* farthest, const Visit& visit) const;

 private:
  struct Item {
    HullBall ball;
    int place = 0;  // in the constructor's argument
  };
  struct Node {
    HullBall ball;
    int begin = 0, end = 0;  // of the items inside
    int second = 0;          // child; the first one is the next node; 0: a leaf
  };

  void Build(int begin, int end);

  std::vector<Node> nodes_;
  std::vector<Item> items_;
};

template <typename Reach, typename Visit>
void BallTree::Search(const Reach& reach, const double* farthest, const Visit& visit) const {
  if (IsEmpty()) return;
  struct Open {
    int node;
    double reach;
  };
  constexpr int kMaxDepth = 64;  // each level halves the number of balls
  Open stack[kMaxDepth];
  int size = 0;
  stack[size++] = {0, reach(nodes_[0].ball)};
  while (size > 0) {
    const Open open = stack[--size];
    if (!(open.reach > *farthest)) continue;
    const Node& node = nodes_[static_cast<size_t>(open.node)];
    if (node.second == 0) {
      for (int i = node.begin; i < node.end; ++i) {
        const Item& item = items_[static_cast<size_t>(i)];
        const double itemReach = reach(item.ball);
        if (itemReach > *farthest) visit(item.ball, item.place, itemReach);
      }
      continue;
    }
    Open near = {open.node + 1, reach(nodes_[static_cast<size_t>(open.node) + 1].ball)};
    Open far = {node.second, reach(nodes_[static_cast<size_t>(node.second)].ball)};
    if (near.reach > far.reach) std::swap(near, far);
    stack[size++] = near;
    stack[size++] = far;
  }
}

}  // namespace dapple
