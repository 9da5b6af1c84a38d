// The photon map: photons on surfaces, found by place.
//
// Positions lie apart from what the photons carry, both in the order of a forest of nanoflann kd-trees: space is halved
// into buckets of a few thousand photons, each with a tree of its own, so that building is parallel and neighbours in
// space are neighbours in memory. The order depends on the photons alone, never on the number of threads.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "src/base/vec.h"
#include "src/photons/photon_forest.h"

namespace dapple {

/// Photons of any `Payload`.
template <typename Payload>
class PhotonMap {
 public:
  PhotonMap() = default;
  /// `positions[i]` belongs to `payloads[i]`; positions are finite. At most 2^32 - 1 photons.
  PhotonMap(std::vector<Vec3> positions, const std::vector<Payload>& payloads) : forest_(std::move(positions)) {
    payloads_.resize(payloads.size());
    ParallelForChunks(static_cast<int64_t>(payloads.size()), 1 << 15, [&](int64_t begin, int64_t end) {
      for (int64_t i = begin; i < end; ++i)
        payloads_[static_cast<size_t>(i)] = payloads[forest_.Order()[static_cast<size_t>(i)]];
    });
    forest_.ForgetOrder();
  }

  size_t Size() const { return payloads_.size(); }

  /// Calls `visit(const Vec3& position, const Payload&, float distanceSquared)` for each photon nearer to `p` than
  /// `radius`.
  template <typename Visitor>
  void ForEachWithin(const Vec3& p, float radius, Visitor&& visit) const {
    forest_.ForEachWithin(p, radius, [&](uint32_t i, float distanceSquared) {
      visit(forest_.Position(i), payloads_[i], distanceSquared);
    });
  }

  int64_t MemoryBytes() const {
    return forest_.MemoryBytes() + static_cast<int64_t>(payloads_.capacity() * sizeof(Payload));
  }

 private:
  PhotonForest forest_;
  std::vector<Payload> payloads_;
};

}  // namespace dapple
