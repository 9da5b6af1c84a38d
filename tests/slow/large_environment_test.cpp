// An environment of 16384 x 8192 pixels of which a single one shines: directions are not starved by random numbers of
// few bits, and each strategy's density is the closed form's. Takes about 5 GB of memory.
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "lights/environment_light.h"
#include "src/base/numerics.h"
#include "src/sampling/sampler.h"

namespace dapple {
namespace {

constexpr int kWidth = 16384, kHeight = 8192, kX = 5000, kY = 3000;

void ExpectSun(const EnvironmentLight& light, const std::string& name) {
  // The lookup is a tent of two texels' width: L (1 - |x|) (1 - |y|) in units of a texel, of the integral L w.
  const double theta = kPiD * (kY + 0.5) / kHeight;
  const double texel = 2 * kPiD / kWidth * (kPiD / kHeight) * std::sin(theta);
  const LightContext at(Vec3(0));
  constexpr int kDraws = 1 << 12;
  std::set<std::pair<float, float>> directions;
  double sum = 0, x = 0, y = 0;
  for (int i = 0; i < kDraws; ++i) {
    Sampler sampler = Sampler::ForPixel(1, {0, 0}, 2 * i);
    const Vec2d direction = sampler.Get2D();
    const auto sample = light.Sample_Li(at, {sampler.Get1D(), direction});
    if (!sample) continue;  // rounded over the rim of the tent
    directions.emplace(sample->wi.x, sample->wi.z);
    sum += static_cast<double>(sample->L.g) / sample->pdf / kDraws;
    const Vec3d w = ToDouble(sample->wi);
    x += (std::atan2(w.y, w.x) / (2 * kPiD) * kWidth - (kX + 0.5)) / kDraws;
    y += (std::acos(w.z) / kPiD * kHeight - (kY + 0.5)) / kDraws;
  }
  EXPECT_NEAR(sum / (7 * texel), 1, 5e-3) << name;
  // The mean of the draws is the middle of the texel; a tent's standard deviation is 0.41 texels.
  EXPECT_NEAR(x, 0, 5 * 0.41 / 64) << name;
  EXPECT_NEAR(y, 0, 5 * 0.41 / 64) << name;
  // With 24 bits a u of this texel's share of all cells would take few values: here all draws differ, but for the grid
  // of float directions.
  EXPECT_GT(directions.size(), kDraws * 9 / 10u) << name;
  const Vec3d middle(std::sin(theta) * std::cos(2 * kPiD * (kX + 0.5) / kWidth),
                     std::sin(theta) * std::sin(2 * kPiD * (kX + 0.5) / kWidth), std::cos(theta));
  EXPECT_NEAR(light.Pdf_Li(at, ToFloat(middle), nullptr) * texel, 1, 2e-3) << name;
}

TEST(LargeEnvironment, OneBrightTexelIsDrawnByEveryStrategy) {
  Image image = Image::Rgb(kWidth, kHeight);
  image.SetColor(kX, kY, Color(5, 7, 3));
  const std::pair<const char*, EnvironmentSampling> strategies[] = {{"importance", EnvironmentSampling::Importance},
                                                                    {"structured", EnvironmentSampling::Structured},
                                                                    {"product", EnvironmentSampling::Product}};
  for (const auto& [name, sampling] : strategies) {
    EnvironmentLight light(image, Transform(), Color(1), EnvironmentMapping::LatLong, {.sampling = sampling});
    light.Prepare({Vec3(0), 1});
    ExpectSun(light, name);
  }
}

}  // namespace
}  // namespace dapple
