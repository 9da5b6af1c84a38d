// Points in space, in buckets with a nanoflann kd-tree each; see photon_map.h.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <nanoflann.hpp>

#include "src/base/parallel.h"
#include "src/base/vec.h"

namespace dapple {

/// How points are cut: into buckets and, within a bucket, into leaves of its kd-tree, of at most so many points. These
/// sizes gather fastest of those that bench/photon_map_bench tries, and take least memory.
struct ForestShape {
  size_t bucketSize = 2048;
  size_t leafSize = 24;
};

class PhotonForest {
 public:
  /// What moves along with the points while they are put in order: the place `first` + i receives what stood at the
  /// place `first` + order[i]. Called for all places at once and then, in parallel, for stretches of them.
  using Follower = std::function<void(size_t first, std::span<const uint32_t> order)>;

  PhotonForest() = default;
  /// Throws `Error` for 2^32 - 1 points or more: they are numbered in 32 bits.
  explicit PhotonForest(std::vector<Vec3> positions, const Follower& follow = {}, const ForestShape& shape = {});

  size_t Size() const { return positions_.size(); }
  const Vec3& Position(uint32_t i) const { return positions_[i]; }

  /// Calls `visit(uint32_t i, float distanceSquared)` for each point nearer to `p` than `radius`.
  template <typename Visitor>
  void ForEachWithin(const Vec3& p, float radius, Visitor&& visit) const;

  /// The squared distances from `p` to its nearest points, at most `most` of them and all within `radius`, in
  /// `squared`, in no order; the first is the largest.
  void FindNearest(const Vec3& p, float radius, size_t most, std::vector<float>* squared) const;

  int64_t MemoryBytes() const;

 private:
  /// The points of one bucket as nanoflann reads them.
  struct BucketPoints {
    const Vec3* points = nullptr;
    size_t count = 0;
    size_t kdtree_get_point_count() const { return count; }
    float kdtree_get_pt(uint32_t i, int axis) const { return points[i][axis]; }
    template <typename Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, BucketPoints, float, uint32_t>,
                                                   BucketPoints, 3, uint32_t>;

  /// A nanoflann result set that hands points on and stores none.
  template <typename Visitor>
  struct PassOn {
    float radiusSquared;
    uint32_t first;
    Visitor& visit;

    float worstDist() const { return radiusSquared; }
    bool full() const { return true; }
    bool addPoint(float distanceSquared, uint32_t i) {
      visit(first + i, distanceSquared);
      return true;
    }
  };

  /// Keeps the distances of the nearest points in a heap.
  struct Nearest {
    float radiusSquared;
    size_t most;
    std::vector<float>& squared;
    uint32_t first = 0;

    float worstDist() const { return squared.size() < most ? radiusSquared : squared.front(); }
    bool full() const { return true; }
    bool addPoint(float distanceSquared, uint32_t) {
      // nanoflann asks for `worstDist` once a leaf.
      if (!(distanceSquared < worstDist())) return true;
      if (squared.size() == most) {
        std::pop_heap(squared.begin(), squared.end());
        squared.pop_back();
      }
      squared.push_back(distanceSquared);
      std::push_heap(squared.begin(), squared.end());
      return true;
    }
  };

  struct Bucket {
    BucketPoints points;
    uint32_t first = 0;
    std::unique_ptr<Tree> tree;
  };

  /// Hands a nanoflann result set all points nearer to `p` than its `worstDist()`, which may shrink.
  template <typename Results>
  void Search(const Vec3& p, Results& results) const;

  size_t BucketCount() const { return buckets_.size(); }
  void SplitIntoBuckets(int levels, const Follower& follow);
  void BuildTrees(size_t leafSize, const Follower& follow);

  std::vector<Vec3> positions_;
  std::vector<Bucket> buckets_;  // a power of two of them, in the order of the splits
  std::vector<Bounds3>
      boxes_;  // implicit binary tree over the buckets: node i has children 2i and 2i + 1, the root is 1
};

template <typename Visitor>
void PhotonForest::ForEachWithin(const Vec3& p, float radius, Visitor&& visit) const {
  PassOn<Visitor> passOn{radius * radius, 0, visit};
  Search(p, passOn);
}

template <typename Results>
void PhotonForest::Search(const Vec3& p, Results& results) const {
  if (positions_.empty()) return;
  const auto distanceTo = [&](uint32_t node) {
    const Bounds3& box = boxes_[node];
    const Vec3 nearest(std::clamp(p.x, box.min.x, box.max.x), std::clamp(p.y, box.min.y, box.max.y),
                       std::clamp(p.z, box.min.z, box.max.z));
    return DistanceSquared(p, nearest);
  };
  struct Node {
    uint32_t index;
    float distanceSquared;
  };
  Node stack[64];
  int size = 0;
  stack[size++] = {1, distanceTo(1)};
  while (size > 0) {
    const Node node = stack[--size];
    if (!(node.distanceSquared < results.worstDist())) continue;
    if (node.index >= BucketCount()) {
      const Bucket& bucket = buckets_[node.index - BucketCount()];
      results.first = bucket.first;
      bucket.tree->findNeighbors(results, &p.x, {});
      continue;
    }
    // The nearer child is searched first.
    const Node left{2 * node.index, distanceTo(2 * node.index)};
    const Node right{2 * node.index + 1, distanceTo(2 * node.index + 1)};
    const bool isLeftNearer = left.distanceSquared <= right.distanceSquared;
    stack[size++] = isLeftNearer ? right : left;
    stack[size++] = isLeftNearer ? left : right;
  }
}

}  // namespace dapple
