// Points in the cells of a hashed grid: what the photon map's forest is compared with.
//
// Points lie sorted by the hash of their cell (Teschner et al. 2003, "Optimized spatial hashing"), so a cell is one
// stretch of memory, found through a table with an entry a point.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "src/base/parallel.h"
#include "src/base/vec.h"

namespace dapple {

class HashGrid {
 public:
  /// The best size of cells is about twice the radius of the gathers: then a ball meets at most eight.
  HashGrid(const std::vector<Vec3>& positions, float cellSize)
      : inverseCellSize_(1 / cellSize), mask_(std::bit_ceil(static_cast<uint32_t>(positions.size()) + 1) - 1) {
    const size_t count = positions.size();
    std::vector<uint32_t> slots(count);
    ParallelForChunks(static_cast<int64_t>(count), 1 << 15, [&](int64_t begin, int64_t end) {
      for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i)
        slots[i] = SlotOf(CellOf(positions[i]));
    });
    starts_.resize(size_t{mask_} + 2);
    for (uint32_t slot : slots) ++starts_[slot + 1];
    for (size_t slot = 1; slot < starts_.size(); ++slot) starts_[slot] += starts_[slot - 1];
    order_.resize(count);
    positions_.resize(count);
    std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (size_t i = 0; i < count; ++i) order_[next[slots[i]]++] = static_cast<uint32_t>(i);
    ParallelForChunks(static_cast<int64_t>(count), 1 << 15, [&](int64_t begin, int64_t end) {
      for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) positions_[i] = positions[order_[i]];
    });
  }

  /// As PhotonForest::ForEachWithin; the ball meets at most 64 cells.
  template <typename Visitor>
  void ForEachWithin(const Vec3& p, float radius, Visitor&& visit) const {
    const Vec3i low = CellOf(p - Vec3(radius)), high = CellOf(p + Vec3(radius));
    const float radiusSquared = radius * radius;
    uint32_t visited[64];
    int count = 0;
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const uint32_t slot = SlotOf({x, y, z});
          bool isNew = true;  // two cells may have one hash
          for (int i = 0; i < count; ++i) isNew &= visited[i] != slot;
          if (!isNew) continue;
          visited[count++] = slot;
          for (uint32_t i = starts_[slot]; i < starts_[slot + 1]; ++i) {
            const float distanceSquared = DistanceSquared(p, positions_[i]);
            if (distanceSquared < radiusSquared) visit(i, distanceSquared);
          }
        }
  }

  /// Entry i: which of the points given to the constructor now stands at place i.
  const std::vector<uint32_t>& Order() const { return order_; }
  const Vec3& Position(uint32_t i) const { return positions_[i]; }

 private:
  using Vec3i = Imath::V3i;

  Vec3i CellOf(const Vec3& p) const {
    const Vec3 cell = p * inverseCellSize_;
    return {static_cast<int>(std::floor(cell.x)), static_cast<int>(std::floor(cell.y)),
            static_cast<int>(std::floor(cell.z))};
  }
  uint32_t SlotOf(const Vec3i& cell) const {
    return (static_cast<uint32_t>(cell.x) * 73856093u ^ static_cast<uint32_t>(cell.y) * 19349663u ^
            static_cast<uint32_t>(cell.z) * 83492791u) &
           mask_;
  }

  float inverseCellSize_;
  uint32_t mask_;
  std::vector<uint32_t> starts_, order_;
  std::vector<Vec3> positions_;
};

}  // namespace dapple
