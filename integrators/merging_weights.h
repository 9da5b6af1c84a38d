// The weights of multiple importance sampling where a path may be found in many ways: by scattering into the light, by
// light sampling at its last vertex, or by merging with a photon at any vertex before that.
//
// For a path x1 ... xm of surfaces from the camera, ended by a point of a light, merging at xj (j < m) needs that a
// light path reaches xj and lands within the radius r: a density of
//   eta_j q_j * (light path's densities down to xj) * (camera path's densities up to xj),
// where eta_j is the number of light paths times the effective area of the kernel (scene units squared) and q_j is the
// probability with which the camera path merges there at all (Georgiev et al. 2012; Hachisuka, Pantaleoni and Jensen
// 2012). The balance heuristic divides by the sum over all techniques. Both walks gather the ratios of those densities
// as they go, so that each technique finds the sum in a few numbers, as in Georgiev's report "Implementing vertex
// connection and merging" (2012), of which this is the part with light sampling and merging. Densities of specular
// scattering cancel in all ratios: there eta = 0, and forward and reverse density count as equal.
//
// Solid-angle densities are turned into areas by cosines with the geometric normal; squared distances cancel between
// the two directions of an edge.
#pragma once

#include <algorithm>

namespace dapple {

/// What a walk knows of the techniques that would have found its path otherwise, before its newest vertex: the sum of
/// their densities over its own. Two sums, since the probabilities q of merging belong to the camera's side alone.
class MergingWeights {
 public:
  struct Sums {
    double merging = 0;  ///< at earlier vertices of this walk: the camera's with their q, a light's relative to q here
    double paths = 0;    ///< light sampling and scattering into the light (walks from the lights only)
  };

  /// A walk from a light has left its first surface under `cosOut`, where there is no merging; `paths`: the densities
  /// of the other techniques there over its own.
  void Begin(double paths, double cosOut) { ahead_ = {0, paths * cosOut}; }

  /// The walk has left a vertex by a specular scattering under `cosOut` = |ng . w|.
  void ScatterSpecular(double cosOut) { ahead_ = unmerged_ = {before_.merging * cosOut, before_.paths * cosOut}; }

  /// The walk has left a vertex, where merging has the weight `eta`, with density `pdf` per solid angle. `reversePdf`
  /// is the density with which the other walk would have gone the way that this one came; `reverseMerging` the factor
  /// by which merging becomes less probable if it does.
  void Scatter(double eta, double pdf, double reversePdf, double reverseMerging, double cosOut) {
    const double edge = cosOut / pdf;
    unmerged_ = {reversePdf * reverseMerging * before_.merging * edge, reversePdf * before_.paths * edge};
    ahead_ = {unmerged_.merging + eta * edge, unmerged_.paths};
  }

  /// The walk has reached a surface under `cosIn` = |ng . w|.
  void Arrive(double cosIn) {
    // Grazing to the last bit would be 0 / 0.
    const double scale = 1 / std::max(cosIn, 1e-30);
    before_ = {ahead_.merging * scale, ahead_.paths * scale};
  }

  /// At the vertex reached, but for the factor of the density (per solid angle) with which the other walk goes on from
  /// here along this one.
  const Sums& Before() const { return before_; }

  /// On the way: as `Before`, without merging at the vertex just left, and before the division by the cosine.
  const Sums& Unmerged() const { return unmerged_; }

 private:
  Sums before_, ahead_, unmerged_;
};

}  // namespace dapple
