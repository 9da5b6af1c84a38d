// Within what radius photons are gathered at a place: wide where few land, narrow where many do.
//
// A pilot of light paths tells how dense photons are. The radius at a place is the one within which a pass is expected
// to have `kPhotons` of them, between `kMinPixels` and `kMaxPixels` pixels' widths as seen from the camera: so caustics
// are sharp, dim light is smooth, and no focus is so narrow that a pixel's few camera rays miss it. It is a function of
// the place alone, learned before the first pass: passes share it, and walks from the camera and from the lights agree
// on it. The schedule of radius_schedule.h shrinks it with the passes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "src/photons/emission_sampler.h"

namespace dapple {

/// What a gather at some place may expect before the first shrinking of the radius.
struct GatherForecast {
  float radius = 0;   ///< in scene units
  float photons = 0;  ///< of one pass within the radius
};

class GatherRadius {
 public:
  struct Options {
    int maxDepth = 32;            ///< scattering events on a light path
    double scale = 1;             ///< factor on the radii
    std::optional<double> fixed;  ///< one radius for all places, in scene units
    uint64_t seed = 0;
  };
  /// Learns for passes of `paths` light paths, by `kPilotPaths` of its own; where there are none it learns nothing.
  /// Depends on the arguments alone.
  GatherRadius(const Scene& scene, const EmissionSampler& emission, int64_t paths, const Options& options);

  GatherForecast At(const Vec3& p) const;

  int64_t MemoryBytes() const { return static_cast<int64_t>(cells_.size() * sizeof(Cell)); }

  static constexpr int64_t kPilotPaths = 1 << 16;
  static constexpr double kPhotons = 16;
  static constexpr double kMaxPixels = 2;
  static constexpr double kMinPixels = 1;

 private:
  /// A cube of space in which the pilot left photons.
  struct Cell {
    uint64_t key = 0;  ///< 0: none
    double sum = 0;    ///< of the photons' densities: expected photons of a pass per area
    int64_t count = 0;
  };
  /// Cells are as wide as the widest radius there (fine), or four times as wide (coarse).
  enum class Level { Fine, Coarse };

  /// `kMaxPixels` times the width of a pixel at the distance of `p` from the camera; positive at the camera too.
  float Widest(const Vec3& p) const;
  uint64_t KeyOf(const Vec3& p, Level level) const;
  const Cell* Find(uint64_t key) const;
  void Fill(const std::vector<Vec3>& positions, const std::vector<float>& densities);
  std::vector<float> DensitiesAt(const std::vector<Vec3>& positions, double pathsOfPass) const;

  std::optional<float> fixed_;
  float scale_ = 1;
  Vec3 camera_{0};
  float unit_ = 1;  // the scene's radius: cells are cut in these units from the camera, so that no scale matters
  float widestAtLens_ = 0, widestSpread_ = 0;
  std::vector<Cell> cells_ = std::vector<Cell>(1);  // a hash table with open addressing, a power of two long
};

}  // namespace dapple
