// Where a final gather looks: the directions that photons come from, place by place (Jensen 1995, "Importance driven
// path tracing using the photon map").
//
//   const DirectionTable* table = guide.At(hit.p, n);       // null: nothing is known
//   const Frame frame = GatherGuide::FrameAround(n);
//   const Vec3 wi = frame.ToWorld(table->Sample(u));        // for the share `table->Share()` of all
//   pdf = share * table->Pdf(frame.ToLocal(wi)) + (1 - share) * bsdf.Pdf(hit.wo, wi, mode);
//
// A pilot of light paths leaves photons in cubes of space as wide as a few pixels and, level by level, twice as wide;
// a place is told by the smallest cube around it that holds enough of them. Learned before the first pass.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "src/base/frame.h"
#include "src/photons/emission_sampler.h"
#include "src/photons/view_grid.h"
#include "src/sampling/table_use.h"

namespace dapple {

/// A density over the hemisphere around (0, 0, 1): the cosine's, times a factor for each of a few cells, which all hold
/// the same part of it.
class DirectionTable {
 public:
  static constexpr int kRings = 4, kSectors = 8, kCells = kRings * kSectors;

  DirectionTable() = default;
  /// The density of directions, their `flux` summed cell by cell; some of it is not zero. `squares`: the sum of its
  /// squares over all of them.
  DirectionTable(const std::array<double, kCells>& flux, double squares);

  /// How many of the directions at a place are best drawn from here, in [0, 1/2]: none where light comes from all
  /// sides alike, as far as so few photons can tell.
  float Share() const { return share_; }
  /// A direction with that density; u in [0, 1)^2.
  Vec3 Sample(const Vec2d& u) const;
  /// Per solid angle; `w` of unit length, 0 below the horizon.
  float Pdf(const Vec3& w) const;

  static size_t CellOf(const Vec3& w);

 private:
  std::array<float, kCells> cells_{};  // sums to 1; ring by ring
  std::array<float, kRings> rings_{};
  float share_ = 0;
};

class GatherGuide {
 public:
  /// Knows nothing of any place.
  GatherGuide() = default;
  /// Learns by a pilot. Photons that met nothing but specular surfaces are left out: what finds them is another map.
  /// Depends on the arguments alone.
  GatherGuide(const Scene& scene, const EmissionSampler& emission, int maxDepth, uint64_t seed);

  /// Around the unit vector `n`, by its longest component: nearly the same for nearly the same normals that share a
  /// table.
  static Frame FrameAround(const Vec3& n);
  /// `n`: of unit length, on the side on which light arrives. Null where too few photons are near.
  const DirectionTable* At(const Vec3& p, const Vec3& n) const;

  int64_t MemoryBytes() const;
  const PilotUse& Pilot() const { return pilot_; }

 private:
  struct Photon {
    Vec3 p, n;
    uint32_t cell;
    float flux;
  };
  struct Place {
    uint64_t key = 0;  ///< 0: none
    uint32_t table = 0;
  };
  /// Of the smallest cubes.
  static constexpr double kPixels = 6;
  static constexpr int kLevels = 7;
  /// In a cube that tells of its place, at least.
  static constexpr int64_t kPhotons = 64;

  uint64_t KeyOf(const Vec3& p, const Vec3& n, int level) const;
  void Learn(const std::vector<Photon>& photons);

  ViewGrid grid_;
  PilotUse pilot_;
  std::vector<Place> places_ = std::vector<Place>(1);  // a hash table with open addressing, a power of two long
  std::vector<DirectionTable> tables_;
};

}  // namespace dapple
