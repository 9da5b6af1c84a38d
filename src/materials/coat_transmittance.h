// How much light a rough dielectric coat lets through, as tables over the angle and the roughness.
//
// Single scattering, as `RoughDielectric` has it, with that model's loss of energy. With these numbers the closed form
// of `CoatedDiffuseBase` is what a random walk between a rough coat and a Lambertian base converges to.
#pragma once

#include <array>
#include <vector>

namespace dapple {

class CoatTransmittance {
 public:
  /// For a coat of index `eta` over that outside, not near 1, and alphas between `minAlpha` and `maxAlpha` (GGX,
  /// isotropic).
  CoatTransmittance(float eta, float minAlpha, float maxAlpha);

  /// The share of light from outside at `cosTheta` in [0, 1] that enters the coat.
  float Entering(float cosTheta, float alpha) const;
  /// The same for diffuse light: the mean over the hemisphere by cosine.
  float DiffuseEntering(float alpha) const;
  /// The share of diffuse light from inside that returns to the inside.
  float DiffuseReturned(float alpha) const;

 private:
  static constexpr int kCosines = 32;  ///< nodes, even in sqrt(cos theta)
  struct Row {
    std::array<float, kCosines> entering;
    float diffuseEntering, diffuseReturned;
  };

  /// Between which rows `alpha` lies, and how far.
  struct Position {
    int row;
    float t;
  };
  Position Locate(float alpha) const;
  static Row MakeRow(float eta, float alpha);

  float minAlpha_, maxAlpha_;
  std::vector<Row> rows_;  ///< even in alpha
};

}  // namespace dapple
