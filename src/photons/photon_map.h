// The photon map: photons on surfaces, found by place.
//
// Positions lie apart from what the photons carry, both in the order of a forest of nanoflann kd-trees: space is halved
// into buckets of one or two thousand photons, each with a tree of its own, so that building is parallel and neighbours
// in space are neighbours in memory. The order depends on the photons alone, never on the number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "src/base/vec.h"
#include "src/photons/permute.h"
#include "src/photons/photon_forest.h"

namespace dapple {

/// Photons of any `Payload`.
template <typename Payload>
class PhotonMap {
 public:
  PhotonMap() = default;
  /// `positions[i]` belongs to `payloads[i]`; positions are finite. At most 2^32 - 1 photons. Give both away with
  /// std::move: they are put in order in place.
  PhotonMap(std::vector<Vec3> positions, std::vector<Payload> payloads)
      : payloads_(std::move(payloads)),
        forest_(std::move(positions), [this](size_t first, std::span<const uint32_t> order) {
          PermuteInPlace(std::span(payloads_).subspan(first, order.size()), order);
        }) {}

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
  std::vector<Payload> payloads_;
  PhotonForest forest_;  // puts the payloads in order while it is built
};

}  // namespace dapple
