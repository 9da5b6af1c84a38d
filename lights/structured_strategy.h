// Structured importance sampling (Agarwal, Ramamoorthi, Belongie and Jensen 2003).
//
// The map is cut into layers by thresholds, the multiples of the standard deviation of its radiance; connected parts of
// a layer get samples by L min(w, 0.01)^(1/4), with L their light and w their solid angle in sr: less by light alone,
// for what is wide is partly hidden more often. A part's samples are spread over it as strata, each the directions
// nearest to one of a set of centres far from each other (Hochbaum and Shmoys).
//
// The paper replaces each stratum by one direction of all its light, which is fast and biased. Here the stratum is
// drawn first and then a direction in it by the map's radiance, so the density is that of the map, scaled from stratum
// to stratum. `LiRandom::part` draws the stratum (and the block in it): stratified numbers give stratified directions.
#pragma once

#include "lights/environment_strategy.h"
#include "lights/weight_pyramid.h"

namespace dapple {

class StructuredStrategy final : public EnvironmentStrategy {
 public:
  explicit StructuredStrategy(const EnvironmentSpace& space);

  Vec3 Sample(const LightContext& at, const LiRandom& u) const override;
  double Pdf(const LightContext& at, const Vec3& wi, const EnvironmentPlace& place) const override;
  LiRandom Invert(const LightContext& at, const Vec3& wi) const override;

  TableUse Tables() const override {
    return TableUse::Of(pyramid_.MemoryBytes() + byRank_.MemoryBytes() +
                        static_cast<int64_t>(ranks_.size() * sizeof(int) + blocks_.size() * sizeof(Vec2i)));
  }

 private:
  size_t BlockIndex(const Vec2i& cell) const {
    return static_cast<size_t>(cell.y >> level_) * static_cast<size_t>(size_.x) + static_cast<size_t>(cell.x >> level_);
  }

  EnvironmentSpace space_;
  WeightPyramid pyramid_;
  int level_ = 0;           // of the pyramid: its nodes are the blocks that strata are made of
  Vec2i size_;              // blocks
  std::vector<int> ranks_;  // of the blocks, in the order in which they are drawn
  std::vector<Vec2i> blocks_;
  Distribution1D byRank_;
};

}  // namespace dapple
