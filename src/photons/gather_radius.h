// Within what radius photons are gathered at a place: wide where few land, narrow where many do.
//
// A pilot of light paths tells how dense photons are. The radius at a place is the one within which a pass is expected
// to have `kPhotons` of them, between `kMinPixels` and `kMaxPixels` pixels' widths as seen from the camera: so caustics
// are sharp, dim light is smooth, and no focus is so narrow that a pixel's few camera rays miss it. Where the
// pilot left photons beside places of much narrower radius, it is so much narrower that it does not reach them (up to
// the mean over a small cell), so that the dark beside a caustic gathers little of it. It is a function of the place
// alone, learned before the first pass: passes share it, and walks from the camera and from the lights agree on it. The
// schedule of radius_schedule.h shrinks it with the passes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "src/photons/emission_sampler.h"
#include "src/photons/photon_forest.h"
#include "src/photons/view_grid.h"

namespace dapple {

/// What a gather at some place may expect before the first shrinking of the radius.
struct GatherForecast {
  float radius = 0;   ///< in scene units
  float photons = 0;  ///< of one pass within the radius
};

class GatherRadius {
 public:
  struct Options {
    int maxDepth = 32;             ///< scattering events on a light path
    double scale = 1;              ///< factor on the radii
    bool causticsOnly = false;     ///< of the photons that are gathered
    std::optional<double> fixed;   ///< one radius for all places, in scene units
    bool forecastsPhotons = true;  ///< false: radii are all that is asked for
    uint64_t seed = 0;
  };
  GatherRadius() = default;
  /// Learns for passes of `paths` light paths, by a pilot of about as many (8,192 to 32,768). Depends on the arguments
  /// alone.
  GatherRadius(const Scene& scene, const EmissionSampler& emission, int64_t paths, const Options& options);

  /// Where the pilot left no photon near: the widest radius (or the fixed one), and no photons.
  GatherForecast At(const Vec3& p) const;

  int64_t MemoryBytes() const { return static_cast<int64_t>(cells_.size() * sizeof(Cell)); }
  /// None where nothing was learned.
  const PilotUse& Pilot() const { return pilot_; }

  static constexpr double kPhotons = 24;
  static constexpr double kMaxPixels = 6;
  static constexpr double kMinPixels = 1;

 private:
  /// What the pilot says of a place where it left a photon.
  struct Finding {
    Vec3 p;
    float density;  ///< expected photons of a pass per area
    float radius;
  };
  /// A cube of space in which the pilot left photons: the means of what they say.
  struct Cell {
    uint64_t key = 0;  ///< 0: none
    float density = 0, radius = 0;
  };
  /// Cells are about half as wide as the widest radius there; level by level four times as wide.
  static constexpr int kLevels = 3;

  uint64_t KeyOf(const Vec3& p, int level) const { return grid_.KeyOf(p, 2 * level - 1, level); }
  void Fill(std::span<const Finding> findings);
  /// `toPass`: photons of a pass for one of the pilot.
  std::vector<Finding> Learn(std::vector<Vec3> positions, double toPass) const;
  Finding FindingAt(const PhotonForest& forest, const Vec3& p, double toPass, std::vector<float>* squared) const;

  PilotUse pilot_;
  std::optional<float> fixed_;
  float scale_ = 1;
  ViewGrid grid_;                                   // its width is that of the widest radius
  std::vector<Cell> cells_ = std::vector<Cell>(1);  // a hash table with open addressing, a power of two long
};

}  // namespace dapple
