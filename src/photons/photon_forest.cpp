#include "src/photons/photon_forest.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "src/base/error.h"

namespace dapple {

namespace {

constexpr int64_t kChunk = 1 << 15;

Bounds3 BoundsOf(std::span<const Vec3> points) {
  Bounds3 bounds;
  for (const Vec3& p : points) bounds.extendBy(p);
  return bounds;
}

}  // namespace

PhotonForest::PhotonForest(std::vector<Vec3> positions, const Follower& follow, const ForestShape& shape)
    : positions_(std::move(positions)) {
  if (positions_.empty()) return;
  if (positions_.size() >= UINT32_MAX)
    throw Error(fmt::format("a pass left {} photons, expected fewer than {}: ask for fewer photons", positions_.size(),
                            UINT32_MAX));
  int levels = 0;
  while ((positions_.size() >> levels) > shape.bucketSize) ++levels;
  SplitIntoBuckets(levels, follow);
  BuildTrees(shape.leafSize, follow);
}

void PhotonForest::FindNearest(const Vec3& p, float radius, size_t most, std::vector<float>* squared) const {
  squared->clear();
  Nearest nearest{radius * radius, most, *squared};
  Search(p, nearest);
}

void PhotonForest::SplitIntoBuckets(int levels, const Follower& follow) {
  struct Point {
    Vec3 p;
    uint32_t index;
  };
  std::vector<Point> points(positions_.size());
  const int64_t count = static_cast<int64_t>(points.size());
  ParallelForChunks(count, kChunk, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i)
      points[static_cast<size_t>(i)] = {positions_[static_cast<size_t>(i)], static_cast<uint32_t>(i)};
  });
  positions_ = std::vector<Vec3>();  // `= {}` would keep the memory

  // Range k of 2^level ends where the next begins; medians make all of them as long, to within one.
  const auto start = [&](size_t k, int level) { return (points.size() * k) >> level; };
  for (int level = 0; level < levels; ++level) {
    ParallelFor(int64_t{1} << level, [&](int64_t k) {
      const size_t range = static_cast<size_t>(k);
      const auto begin = points.begin() + static_cast<int64_t>(start(range, level));
      const auto middle = points.begin() + static_cast<int64_t>(start(2 * range + 1, level + 1));
      const auto end = points.begin() + static_cast<int64_t>(start(range + 1, level));
      Bounds3 bounds;
      for (auto point = begin; point != end; ++point) bounds.extendBy(point->p);
      const int axis = static_cast<int>(bounds.majorAxis());
      std::nth_element(begin, middle, end, [axis](const Point& a, const Point& b) { return a.p[axis] < b.p[axis]; });
    });
  }

  if (follow) {
    std::vector<uint32_t> order(points.size());
    ParallelForChunks(count, kChunk, [&](int64_t begin, int64_t end) {
      for (int64_t i = begin; i < end; ++i) order[static_cast<size_t>(i)] = points[static_cast<size_t>(i)].index;
    });
    follow(0, order);
  }
  positions_.resize(points.size());
  ParallelForChunks(count, kChunk, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) positions_[static_cast<size_t>(i)] = points[static_cast<size_t>(i)].p;
  });
  buckets_.resize(size_t{1} << levels);
  for (size_t k = 0; k < buckets_.size(); ++k) {
    buckets_[k].first = static_cast<uint32_t>(start(k, levels));
    buckets_[k].points.count = start(k + 1, levels) - start(k, levels);
  }
}

void PhotonForest::BuildTrees(size_t leafSize, const Follower& follow) {
  boxes_.resize(2 * buckets_.size());
  ParallelFor(static_cast<int64_t>(buckets_.size()), [&](int64_t k) {
    Bucket& bucket = buckets_[static_cast<size_t>(k)];
    const size_t first = bucket.first, count = bucket.points.count;
    bucket.points.points = positions_.data() + first;
    bucket.tree = std::make_unique<Tree>(3, bucket.points, nanoflann::KDTreeSingleIndexAdaptorParams(leafSize));

    // Points move to the order of the tree's leaves, so that a leaf is one stretch of memory.
    std::vector<uint32_t>& leafOrder = bucket.tree->vAcc;
    std::vector<Vec3> positions(count);
    for (size_t i = 0; i < count; ++i) positions[i] = positions_[first + leafOrder[i]];
    std::copy(positions.begin(), positions.end(), positions_.begin() + static_cast<int64_t>(first));
    if (follow) follow(first, leafOrder);
    std::iota(leafOrder.begin(), leafOrder.end(), 0u);
    boxes_[buckets_.size() + static_cast<size_t>(k)] = BoundsOf({positions_.data() + first, count});
  });
  for (size_t node = buckets_.size() - 1; node >= 1; --node) {
    boxes_[node] = boxes_[2 * node];
    boxes_[node].extendBy(boxes_[2 * node + 1]);
  }
}

int64_t PhotonForest::MemoryBytes() const {
  int64_t bytes = static_cast<int64_t>(positions_.capacity() * sizeof(Vec3) + boxes_.capacity() * sizeof(Bounds3));
  for (const Bucket& bucket : buckets_)
    bytes += static_cast<int64_t>(sizeof(Bucket) + sizeof(Tree) + bucket.tree->usedMemory(*bucket.tree));
  return bytes;
}

}  // namespace dapple
