// Product importance sampling: directions by the map's radiance times what the receiver scatters of it.
//
// A quadtree over the map, made for each receiver and refined where the product is large (Clarberg and Akenine-Moller
// 2008, "Practical product importance sampling for direct illumination"): the product in a leaf is the map's sum there,
// which the pyramid has, times the BSDF with its cosine toward the centroids of the light in the leaf's quarters: so a
// sun is found however wide the leaf. Directions go down the tree by these products (hierarchical warping: Clarberg et
// al. 2005), then down the pyramid, then into a cell. So within a leaf the density is that of the map, and all of it is
// exact, though the product is not.
//
// A leaf has at least an eighth of the scattering of its parent: what lies between the centroids is not lost, and the
// density is positive wherever the map's radiance is. Behind an opaque surface it falls by eight from level to level,
// and bright leaves are split until they weigh little. Where no table was prepared (no surface, or a light that does
// not know its BSDF) the map's own density is used.
#pragma once

#include "lights/environment_strategy.h"
#include "lights/weight_pyramid.h"

namespace dapple {

class ProductStrategy final : public EnvironmentStrategy {
 public:
  explicit ProductStrategy(const EnvironmentSpace& space);

  Vec3 Sample(const LightContext& at, const LiRandom& u) const override;
  double Pdf(const LightContext& at, const Vec3& wi, const EnvironmentPlace& place) const override;
  LiRandom Invert(const LightContext& at, const Vec3& wi) const override;

  TableUse Tables() const override;

  bool WantsReceiver() const override { return true; }
  std::shared_ptr<const ReceiverTable> PrepareReceiver(const Bsdf& bsdf, const Vec3& wo) const override;

 private:
  struct Node {
    PyramidNode place;
    double scattering = 0;  // mean over the node's light, at least an eighth of the parent's
    double weight = 0;      // times the map's; of an inner node the sum of its children
    int firstChild = -1;    // of four; -1: a leaf
  };
  struct Tree;

  void FillDirections();
  const Tree* TreeOf(const LightContext& at) const;
  /// Of the light below a node, the share that is scattered, by the centroids of its four quarters.
  double MeanScattering(const PyramidNode& node, const Bsdf& bsdf, const Vec3& wo) const;
  void Split(int index, const Bsdf& bsdf, const Vec3& wo, Tree* tree) const;
  void Refine(const Bsdf& bsdf, const Vec3& wo, Tree* tree) const;
  const Vec3& CentroidOf(const PyramidNode& node) const;

  EnvironmentSpace space_;
  WeightPyramid pyramid_;
  int coarse_ = 0;                             // every receiver's leaves are of this level or below
  int finest_ = 0;                             // no leaf is below this level
  std::vector<std::vector<Vec3>> directions_;  // of the centroids of the nodes' light, for the levels from finest_ on
};

}  // namespace dapple
