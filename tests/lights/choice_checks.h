// What must be true of a choice among lights, as checks that give a verdict.
//
// `Pick(u)` gives a PickedLight, `Probability(light)` the discrete probability of one.
#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "lights/light_picker.h"
#include "tests/lights/light_cases.h"
#include "tests/support/chi_square.h"
#include "tests/support/verdict.h"

namespace dapple {

/// Chi-square of what is picked against the probabilities of all lights.
template <typename Pick, typename Probability>
Verdict CheckPicks(const Pick& pick, const Probability& probability, int lights) {
  const testing::ChiSquare fit =
      testing::ChiSquareOnInterval([&](double u) { return std::optional(pick(u).index + 0.5); },
                                   [&](double x) { return probability(std::min(static_cast<int>(x), lights - 1)); }, 0,
                                   lights, {.samples = 20'000, .rows = lights, .columns = 1, .seed = 41});
  return {fit.Passes(), fit.message};
}

/// The flux that a ray of a picked light carries, for all the lights.
template <typename Pick, typename F>
void ForPickedRays(const Pick& pick, const std::vector<std::unique_ptr<Light>>& lights, const F& f) {
  RandomNumbers random(42);
  for (int i = 0; i < 20'000; ++i) {
    const PickedLight picked = pick(random.Get1D());
    const std::optional<LeSample> ray = lights[static_cast<size_t>(picked.index)]->Sample_Le(random.Le());
    // What claims never to be drawn can count for nothing.
    f(ray && picked.probability > 0 ? static_cast<double>(ray->Flux().g) / picked.probability : 0);
  }
}

/// The mean flux of rays of picked lights is the power of all together, within five standard errors.
template <typename Pick>
Verdict CheckPickedEnergy(const Pick& pick, const std::vector<std::unique_ptr<Light>>& lights) {
  double power = 0;
  for (const auto& light : lights) power += static_cast<double>(light->Power().g);
  Mean flux;
  ForPickedRays(pick, lights, [&](double carried) { flux.Add(carried); });
  return {std::abs(flux.Value() - power) <= 5 * flux.StandardError() + 1e-5 * power,
          fmt::format("mean flux {} +- {}, power {}", flux.Value(), flux.StandardError(), power)};
}

/// Of lights whose own rays all carry the same, picked by power, so do all rays.
template <typename Pick>
Verdict CheckPickedEvenness(const Pick& pick, const std::vector<std::unique_ptr<Light>>& lights) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  ForPickedRays(pick, lights, [&](double x) { least = std::min(least, x), most = std::max(most, x); });
  return {most - least <= 1e-5 * most, fmt::format("flux from {} to {}", least, most)};
}

}  // namespace dapple
