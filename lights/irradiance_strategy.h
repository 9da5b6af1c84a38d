// Directions by the map's radiance times the cosine at the receiver: what they bring to a matte surface.
//
// The map's cells are gathered in groups, a few hundred rectangles of some degrees; and normals in as many bins. Of
// each bin there is a table over the groups: the light of the group times the cosine between the two, a bound of it
// near the horizon, so that the density is positive wherever light counts. Within a group directions are drawn by
// radiance, from the map's own table. So the density is the map's, times the share of the group in the bin's table over
// that in the map: exact, though the product is coarse. A draw takes four short searches where the map's own takes two
// long ones, in an order that keeps the random numbers stratified. Hardly any goes behind an opaque surface.
//
// Where there is no surface, or where light comes through it too, the map's own density is used.
#pragma once

#include <algorithm>
#include <vector>

#include "lights/environment_strategy.h"

namespace dapple {

class IrradianceStrategy final : public EnvironmentStrategy {
 public:
  explicit IrradianceStrategy(const EnvironmentSpace& space);

  Vec3 Sample(const LightContext& at, const LiRandom& u) const override;
  double Pdf(const LightContext& at, const Vec3& wi, const EnvironmentPlace& place) const override;
  LiRandom Invert(const LightContext& at, const Vec3& wi) const override;

  TableUse Tables() const override;

 private:
  /// A cone around all directions of something.
  struct Cone {
    Vec3d axis;
    double radius = 0;  ///< radians
  };

  void FillRows();
  void FillBins();
  /// Around the light of a group; its axis is the mean direction.
  Cone ConeOf(const Vec2i& group, const std::vector<double>& cellWeights) const;
  /// The table for the surface at `at`; null where the map's own density is to be used.
  const Distribution2D* TableFor(const LightContext& at) const;

  Vec2i GroupOf(const Vec2i& cell) const { return {cell.x / groupSize_.x, cell.y / groupSize_.y}; }
  /// Of a group, as a share of the map's; zero only where the map's table has nothing to draw there.
  double LightOf(const Vec2i& group) const { return rows_[IndexOf(group)].Sum(); }
  size_t IndexOf(const Vec2i& group) const {
    return static_cast<size_t>(group.y) * static_cast<size_t>(groups_.x) + static_cast<size_t>(group.x);
  }
  /// The first column of a group, and the one behind its last.
  Vec2i ColumnsOf(const Vec2i& group) const {
    return {group.x * groupSize_.x, std::min((group.x + 1) * groupSize_.x, space_.map.Cells().x)};
  }

  EnvironmentSpace space_;
  Vec2i groups_, groupSize_;          // their columns and rows; their cells
  std::vector<Distribution1D> rows_;  // of each group: its rows by their light
  std::vector<Distribution2D> bins_;  // of each bin of normals: the groups
};

}  // namespace dapple
