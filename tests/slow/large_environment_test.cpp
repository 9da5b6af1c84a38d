// An environment of 16384 x 8192 pixels of which a single one shines: directions are not starved by random numbers of
// few bits, and the densities are the closed form's. Takes about 6 GB of memory.
#include <cmath>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "lights/environment_light.h"
#include "src/base/numerics.h"
#include "src/sampling/sampler.h"

namespace dapple {
namespace {

constexpr int kWidth = 16384, kHeight = 8192, kX = 5000, kY = 3000;

/// The middle of the texel.
constexpr double kTheta = kPiD * (kY + 0.5) / kHeight, kPhi = 2 * kPiD * (kX + 0.5) / kWidth;

struct Draw {
  Vec3 wi;
  double pdf = 0;
};

/// `draw` takes numbers of 32 bits each, as the renderer has them.
void ExpectSun(const std::string& name, const EnvironmentMap& map, const std::function<Draw(const LiRandom&)>& draw) {
  // The lookup is a tent of two texels' width: L (1 - |x|) (1 - |y|) in units of a texel, of the integral L w.
  const double texel = 2 * kPiD / kWidth * (kPiD / kHeight) * std::sin(kTheta);
  constexpr int kDraws = 1 << 12;
  std::set<std::pair<float, float>> directions;
  double sum = 0, x = 0, y = 0;
  for (int i = 0; i < kDraws; ++i) {
    Sampler sampler = Sampler::ForPixel(1, {0, 0}, 2 * i);
    LiRandom u;
    u.direction = sampler.Get2D();
    u.part = sampler.Get1D();
    const Draw drawn = draw(u);
    if (!(drawn.pdf > 0)) continue;  // rounded over the rim of the tent
    const Vec3d w = ToDouble(drawn.wi);
    directions.emplace(drawn.wi.x, drawn.wi.z);
    sum += static_cast<double>(map.Radiance(w).g) / drawn.pdf / kDraws;
    x += (std::atan2(w.y, w.x) / (2 * kPiD) * kWidth - (kX + 0.5)) / kDraws;
    y += (std::acos(w.z) / kPiD * kHeight - (kY + 0.5)) / kDraws;
  }
  EXPECT_NEAR(sum / (7 * texel), 1, 5e-3) << name;
  // The mean of the draws is the middle of the texel; a tent's standard deviation is 0.41 texels.
  EXPECT_NEAR(x, 0, 5 * 0.41 / 64) << name;
  EXPECT_NEAR(y, 0, 5 * 0.41 / 64) << name;
  // Of 24 bits a cell's share would leave none for the place in it: here draws differ, but for the grid of float
  // directions.
  EXPECT_GT(directions.size(), kDraws * 9 / 10u) << name;
}

/// Power, directions and densities of emission in closed form; `light` is prepared for a ball of radius 1.
void ExpectClosedForm(const EnvironmentLight& light) {
  constexpr double kRelativeError = 1e-5;
  // The integral of (1 - |t| / h) sin(theta + t) over t from -h to h is 2 (1 - cos h) / h sin theta; in azimuth the
  // tent's is its half width.
  const double h = kPiD / kHeight, width = 2 * kPiD / kWidth;
  const double integral = 4 * Sqr(std::sin(h / 2)) / h * std::sin(kTheta) * width;
  EXPECT_NEAR(static_cast<double>(light.Map().Integral().g) / (7 * integral), 1, kRelativeError);
  EXPECT_NEAR(static_cast<double>(light.Power().g) / (7 * integral * kPiD), 1, kRelativeError);
  // Below the middle lies `below` of that integral, in two cells; there the density is a tent in cos theta, which is
  // four times its mean in the corner, and so 4 (3/4) (1/2) times at a quarter of the cell's width and half its height.
  const double below = (std::cos(kTheta) - std::cos(kTheta + h / 2) * std::sin(h / 2) / (h / 2)) * width / integral;
  const double height = std::cos(kTheta) - std::cos(kTheta + h);
  const double theta = std::acos(std::cos(kTheta) - height / 2), phi = kPhi + width / 4;
  const RadianceWithPdf value =
      light.Map().Evaluate({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
  EXPECT_NEAR(static_cast<double>(value.L.g) / (7 * 0.75 * (1 - (theta - kTheta) / h)), 1, kRelativeError);
  EXPECT_NEAR(value.pdf / (below / 2 * 1.5 / (width * height)), 1, kRelativeError);
  int drawn = 0;
  for (int i = 0; i < 1000; ++i) {
    Sampler sampler = Sampler::ForPixel(2, {0, 0}, 2 * i);
    LeRandom u;
    u.position = sampler.Get2D(), u.direction = sampler.Get2D();
    const std::optional<LeSample> sample = light.Sample_Le(u);
    if (!sample) continue;  // rounded over the rim of the tent
    ++drawn;
    const Vec3d wi = -ToDouble(sample->ray.d);
    ASSERT_LE(std::abs(std::acos(wi.z) - kTheta), h * 1.001);
    ASSERT_LE(std::abs(std::atan2(wi.y, wi.x) - kPhi), width * 1.001);
    ASSERT_NEAR(sample->pdfPos * kPiD, 1, kRelativeError);
    ASSERT_EQ(light.Pdf_Le(sample->ray, sample->From()).direction, sample->pdfDir);
  }
  EXPECT_GT(drawn, 990);
}

TEST(LargeEnvironment, OneBrightTexelIsDrawnAllOver) {
  Image image = Image::Rgb(kWidth, kHeight);
  image.SetColor(kX, kY, Color(5, 7, 3));
  EnvironmentLight light(image, Transform(), Color(1), EnvironmentMapping::LatLong,
                         {.sampling = EnvironmentSampling::Structured});
  light.Prepare({Vec3(0), 1});
  ExpectClosedForm(light);
  const EnvironmentMap& map = light.Map();
  ExpectSun("importance", map, [&](const LiRandom& u) {
    const Vec3 wi = ToFloat(map.Sample(u.direction));
    return Draw{wi, map.Evaluate(ToDouble(wi)).pdf};
  });
  ExpectSun("structured", map, [&](const LiRandom& u) {
    const auto sample = light.Sample_Li(LightContext(Vec3(0)), u);
    return sample ? Draw{sample->wi, sample->pdf} : Draw{};
  });
}

}  // namespace
}  // namespace dapple
