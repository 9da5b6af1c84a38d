#include "src/scene/scene_facts.h"

#include "lights/light.h"
#include "src/base/numerics.h"

namespace dapple {

double LightShare(const Light& light, const Vec3& point) {
  if (light.IsDelta()) return 0;
  constexpr int kSide = 32;
  constexpr double kGoldenRatio = 0.6180339887498949;
  double sum = 0, sumOfSquares = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    LiRandom u;
    const double turns = i * kGoldenRatio;
    u.part = turns - std::floor(turns);
    u.direction = {(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide};
    const std::optional<LiSample> sample = light.Sample_Li(LightContext(point), u);
    if (!sample || !(sample->pdf > 0)) continue;
    const auto L = static_cast<double>(sample->L.Average());
    sum += L / sample->pdf;
    sumOfSquares += L * L / sample->pdf;
  }
  if (!(sumOfSquares > 0)) return 0;
  return std::min(1.0, sum * sum / sumOfSquares / (kSide * kSide) / (4 * kPiD));
}

}  // namespace dapple
