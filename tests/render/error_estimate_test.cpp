#include "src/render/error_estimate.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "src/base/numerics.h"
#include "src/image/metrics.h"
#include "tests/render/scarce_memory.h"
#include "tests/support/random_numbers.h"

namespace dapple {
namespace {

constexpr int kSide = 64;

/// What a synthetic algorithm makes of column x in a pass.
struct ColumnValue {
  double radiance;
  double blur = 0;
};

/// Passes of columns, with even noise of variance `noise`^2 / 3 in each pixel, and of `blurNoise`^2 / 3 in its blur.
Film Render(int passes, double noise, double blurNoise, const std::function<ColumnValue(int x)>& column) {
  Film film({kSide, kSide}, {{0, 0}, {kSide, kSide}}, Filter::Box());
  film.TrackBlur();
  testing::UniformNumbers random(3);
  const auto even = [&](double scale) { return static_cast<float>(scale * (2 * random.Get1D() - 1)); };
  for (int pass = 0; pass < passes; ++pass) {
    for (int i = 0; i < kSide * kSide; ++i) {
      const Vec2i pixel(i % kSide, i / kSide);
      const ColumnValue value = column(pixel.x);
      const auto radiance = static_cast<float>(value.radiance), blur = static_cast<float>(value.blur);
      film.AddSample(pixel, {radiance + even(noise), radiance + even(noise), radiance + even(noise)}, pass);
      film.AddBlur(pixel, {blur + even(blurNoise), blur + even(blurNoise), blur + even(blurNoise)}, pass);
    }
    film.FinishPass(pass);
  }
  return film;
}

double TrueError(const Film& film, const std::function<double(double x)>& truth) {
  Image reference = Image::Rgb(kSide, kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) reference.SetColor(x, y, Color(static_cast<float>(truth(x + 0.5))));
  return std::sqrt(CompareImages(film.ToImage(), reference).relativeMse);
}

/// `truth` as a density estimate with the Epanechnikov kernel of that radius sees it at x: across a line the kernel is
/// (1 - t^2)^(3/2).
double Smoothed(const std::function<double(double x)>& truth, double x, double radius) {
  constexpr int kSteps = 400;
  double sum = 0, weights = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = 2 * (i + 0.5) / kSteps - 1, weight = std::pow(1 - t * t, 1.5);
    sum += weight * truth(x + t * radius);
    weights += weight;
  }
  return sum / weights;
}

TEST(ErrorEstimate, NeedsAPassOfBothHalves) {
  for (const int passes : {0, 1, 2}) {
    const Film film = Render(passes, 0.1, 0, [](int) { return ColumnValue{1}; });
    EXPECT_EQ(EstimateError(film, 1).has_value(), passes == 2) << passes;
  }
}

// 3 x 4096 squares have a relative standard deviation of sqrt(2 / 12288) = 1.3 %, their root half of that; the
// tolerance is five of these. Halves of one size and of two.
TEST(ErrorEstimate, NoiseIsTheDeviationOfTheMean) {
  for (const int passes : {2, 3, 8, 64}) {
    const Film film = Render(passes, 0.1, 0, [](int) { return ColumnValue{10}; });
    const double expected = std::sqrt(0.01 / 3 / passes / 100.01);
    EXPECT_NEAR(EstimateError(film, 1)->noise / expected, 1, 5 * 0.0065) << passes;
    EXPECT_EQ(EstimateError(film, 1)->bias, 0);
  }
}

// Dark pixels count less, as in the relative MSE: the offset of 0.01 is of the picture that is written.
TEST(ErrorEstimate, IsOfTheExposedPicture) {
  const Film film = Render(8, 0.01, 0, [](int) { return ColumnValue{0.05}; });
  const double plain = EstimateError(film, 1)->noise, exposed = EstimateError(film, 10)->noise;
  EXPECT_NEAR(exposed / plain, 10 * std::sqrt((0.05 * 0.05 + 0.01) / (0.5 * 0.5 + 0.01)), 0.03);
}

// One sample in 400 is 100 times as bright as the rest: the error that it makes is told in full, though it dominates
// the pixel that it is relative to. Divided by the picture's own square it would be about eight times less.
TEST(ErrorEstimate, AFireflyCountsInFull) {
  constexpr double kDark = 0.1, kBright = 10, kRate = 1.0 / 400;
  constexpr int kPasses = 8;
  Film film({kSide, kSide}, {{0, 0}, {kSide, kSide}}, Filter::Box());
  testing::UniformNumbers random(5);
  for (int pass = 0; pass < kPasses; ++pass) {
    for (int i = 0; i < kSide * kSide; ++i)
      film.AddSample({i % kSide, i / kSide}, Color(static_cast<float>(random.Get1D() < kRate ? kBright : kDark)), pass);
    film.FinishPass(pass);
  }
  const double error = TrueError(film, [&](double) { return kDark + kRate * (kBright - kDark); });
  EXPECT_NEAR(EstimateError(film, 1)->Total() / error, 1, 0.2);
}

/// The estimate over the true error for a picture that estimates the density `truth` with this radius in pixels, as
/// noisy as `noise` says.
double EstimateOverError(const std::function<double(double x)>& truth, double radius, double noise) {
  std::vector<ColumnValue> columns;
  for (int x = 0; x < kSide; ++x) {
    const double seen = Smoothed(truth, x + 0.5, radius);
    columns.push_back({seen, seen - Smoothed(truth, x + 0.5, radius / 2)});
  }
  const Film film = Render(8, noise, 2 * noise, [&](int x) { return columns[static_cast<size_t>(x)]; });
  return EstimateError(film, 1)->Total() / TrueError(film, truth);
}

// Nothing but bias, of the two kinds between which pictures lie; then as much noise as bias, or more.
TEST(ErrorEstimate, KnowsTheBiasOfWhatIsSmooth) {
  const auto wave = [](double x) { return 2 + std::sin(2 * kPiD * x / 64); };
  EXPECT_NEAR(EstimateOverError(wave, 4, 0), 1.9 / (4. / 3), 0.03);
  for (const double noise : {0., 0.1, 0.3, 1.}) {
    const double ratio = EstimateOverError(wave, 12, noise);
    EXPECT_GT(ratio, 1 / 1.5) << noise;
    EXPECT_LT(ratio, 1.5) << noise;
  }
}

TEST(ErrorEstimate, KnowsTheBiasOfAStep) {
  const auto step = [](double height) { return [height](double x) { return x < 32 ? 1. : height; }; };
  EXPECT_NEAR(EstimateOverError(step(1.2), 12, 0), 1.9 / 2.15, 0.04);
  for (const double noise : {0., 0.1, 0.3, 1.}) {
    const double ratio = EstimateOverError(step(2), 12, noise);
    EXPECT_GT(ratio, 1 / 1.5) << noise;
    EXPECT_LT(ratio, 1.5) << noise;
  }
}

// Without bias, the noise of the blur is not taken for it: products of independent halves cancel.
TEST(ErrorEstimate, NoiseOfTheBlurIsNoBias) {
  const Film film = Render(8, 0.1, 1, [](int) { return ColumnValue{1}; });
  const ErrorEstimate error = *EstimateError(film, 1);
  EXPECT_LT(error.bias, 0.1 * 1.9 * std::sqrt(1. / 3 / 4));
}

TEST(ErrorEstimate, IsLookedAtInStepsOfAnEighthToAQuarter) {
  std::vector<int> due;
  for (int passes = 0; passes <= 80; ++passes)
    if (IsErrorDue(passes)) due.push_back(passes);
  EXPECT_EQ(due, (std::vector<int>{8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 56, 64, 80}));
}

TEST(ErrorEstimate, IsNotThereWhereTheMemoryDoesNotSuffice) {
  Film film({32, 32}, {{0, 0}, {32, 32}}, Filter::Box());
  for (const int pass : {0, 1}) film.FinishPass(pass);
  ASSERT_TRUE(EstimateError(film, 1).has_value());
  const ScarceMemory scarce(32 * 32);
  EXPECT_FALSE(EstimateError(film, 1).has_value());
}

}  // namespace
}  // namespace dapple
