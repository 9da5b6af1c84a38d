// Which light: a choice among all of a scene's lights, by inverse CDF, in the order of the file: stratified random
// numbers give each light its share.
#pragma once

#include <memory>
#include <vector>

#include "lights/light.h"
#include "src/sampling/distribution.h"

namespace dapple {

/// A light, drawn.
struct PickedLight {
  int index = -1;          ///< in the scene's list
  double probability = 0;  ///< discrete
  double u = 0;            ///< what is left of the random number, again uniform in [0, 1)
};

/// Chooses lights in proportion to their power (the largest component), or evenly where the power says nothing (all
/// zero, or not finite). Made after `Light::Prepare`; the lights must live as long.
class LightPicker {
 public:
  /// None of `lights` is null.
  explicit LightPicker(const std::vector<std::unique_ptr<Light>>& lights);

  /// Nothing where no light emits.
  bool Empty() const { return lightCount_ == 0; }
  /// A light for a photon, u in [0, 1). There must be lights.
  PickedLight PickByPower(double u) const;
  /// The discrete probability with which `PickByPower` gives `light`.
  double ProbabilityByPower(int light) const;
  /// The random number with which `PickByPower` gives `light` and leaves `u`.
  double InvertByPower(int light, double u) const;

  /// For next-event estimation at a point: by what each light could send there (`Light::ImportanceAt`), with a share
  /// of even choice among those that can reach it at all. By power where there are more than `kMostWeighed` lights.
  /// The probability is bit for bit what `ProbabilityFor` gives.
  PickedLight PickFor(const LightContext& at, double u) const;
  /// The discrete probability with which `PickFor` gives `light` at this point.
  double ProbabilityFor(const LightContext& at, int light) const;

  static constexpr int kMostWeighed = 32;

  /// None where there is nothing to choose.
  TableUse Tables() const { return TableUse::Of(byPower_.MemoryBytes()); }

 private:
  /// The lights' probabilities at a point; false where they are to be chosen by power.
  bool Weigh(const LightContext& at, double (&probability)[kMostWeighed]) const;

  int lightCount_ = 0;
  std::vector<const Light*> lights_;  // empty where there are too many to weigh
  Distribution1D byPower_;            // empty for a single light
};

}  // namespace dapple
