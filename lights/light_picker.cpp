#include "lights/light_picker.h"

#include <algorithm>
#include <cmath>

namespace dapple {

LightPicker::LightPicker(const std::vector<std::unique_ptr<Light>>& lights)
    : lightCount_(static_cast<int>(lights.size())) {
  if (lightCount_ < 2) return;
  std::vector<double> powers;
  powers.reserve(lights.size());
  double sum = 0;
  for (const std::unique_ptr<Light>& light : lights) {
    powers.push_back(std::max(0.0, static_cast<double>(light->Power().MaxComponent())));
    sum += powers.back();
    if (lightCount_ <= kMostWeighed) lights_.push_back(light.get());
  }
  if (!(sum > 0) || !std::isfinite(sum)) std::fill(powers.begin(), powers.end(), 1.0);
  byPower_ = Distribution1D(std::span<const double>(powers));
}

PickedLight LightPicker::PickByPower(double u) const {
  if (lightCount_ < 2) return {lightCount_ - 1, static_cast<double>(lightCount_), u};
  const DiscreteSample drawn = byPower_.SampleDiscrete(u);
  return {drawn.index, drawn.probability, drawn.u};
}

double LightPicker::ProbabilityByPower(int light) const { return lightCount_ < 2 ? 1 : byPower_.Probability(light); }

double LightPicker::InvertByPower(int light, double u) const {
  return lightCount_ < 2 ? u : byPower_.InvertDiscrete(light, u);
}

bool LightPicker::Weigh(const LightContext& at, double (&probability)[kMostWeighed]) const {
  if (lights_.size() < 2) return false;
  double sum = 0;
  int reaching = 0;
  for (size_t i = 0; i < lights_.size(); ++i) {
    probability[i] = lights_[i]->ImportanceAt(at);
    sum += probability[i];
    if (probability[i] > 0) ++reaching;
  }
  if (!(sum > 0) || !std::isfinite(sum)) return false;
  // The importance is a guess (of the distance to the nearest part, with no thought of what stands between).
  constexpr double kEvenShare = 0.1;
  const double even = kEvenShare / reaching, scale = (1 - kEvenShare) / sum;
  for (size_t i = 0; i < lights_.size(); ++i) {
    if (probability[i] > 0) probability[i] = probability[i] * scale + even;
  }
  return true;
}

PickedLight LightPicker::PickFor(const LightContext& at, double u) const {
  double probability[kMostWeighed];
  if (!Weigh(at, probability)) return PickByPower(u);
  constexpr double kBelowOne = 0x1.fffffffffffffp-1;
  PickedLight picked;
  double before = 0;
  // Rounding may leave the sum below u: then the last light that reaches the point stays picked.
  for (int i = 0; i < lightCount_; ++i) {
    if (probability[i] == 0) continue;
    const double within = (u - before) / probability[i];
    picked = {i, probability[i], std::clamp(within, 0.0, kBelowOne)};
    if (within < 1) break;
    before += probability[i];
  }
  return picked;
}

double LightPicker::ProbabilityFor(const LightContext& at, int light) const {
  double probability[kMostWeighed];
  return Weigh(at, probability) ? probability[light] : ProbabilityByPower(light);
}

}  // namespace dapple
