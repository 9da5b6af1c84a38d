#include "integrators/sample_allocation.h"

#include <cmath>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "integrators/pixel_loop.h"
#include "src/base/parallel.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

using testing_support::SceneFromText;

constexpr int kSide = 128;

// What is in the scene does not matter: the tracers of these tests say what camera paths find.
std::unique_ptr<Scene> Empty(int width = kSide, int height = kSide) {
  return SceneFromText("Camera \"perspective\" \"float fov\" [60] Film \"image\" \"integer xresolution\" [" +
                       std::to_string(width) + "] \"integer yresolution\" [" + std::to_string(height) +
                       "] WorldBegin LightSource \"infinite\" WorldEnd");
}

// A picture of two halves, of paths that find `brightness` (1 + `noise` z), z of variance 1, and take `rays`.
struct Half {
  double noise, brightness = 1;
  int rays = 1;
};

SampleAllocation::Tracer TracerOf(const Half& left, const Half& right) {
  return [=](const CameraRay& camera, Sampler& sampler, PassStats& stats) {
    // pbrt's camera looks along +z with +x to the right.
    const Half& half = camera.ray.d.x < 0 ? left : right;
    stats.cameraRays += half.rays;
    sampler.StartBlock(1);
    // Not to be stratified: so the variance of a mean falls as one over the number of paths.
    const double z = std::sqrt(12) * (static_cast<double>(sampler.BlockSeed() >> 11) * 0x1p-53 - 0.5);
    return Color(static_cast<float>(half.brightness * (1 + half.noise * z)));
  };
}

struct Means {
  double left = 0, right = 0, most = 0, least = 1e9;
};

// Of the numbers of paths; without the columns where the halves meet, which smoothing mixes.
Means MeansOf(const SampleAllocation& samples) {
  Means means;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double count = samples.At({x, y});
      means.most = std::max(means.most, count);
      means.least = std::min(means.least, count);
      if (std::abs(x - kSide / 2) < 8) continue;
      (x < kSide / 2 ? means.left : means.right) += count / ((kSide / 2 - 7.5) * kSide);
    }
  return means;
}

Means MeansOf(const Half& left, const Half& right, int mean = 8) {
  return MeansOf(SampleAllocation::ByNoise(*Empty(), 1, mean, TracerOf(left, right)));
}

TEST(SampleAllocation, IsEvenWhereNothingIsNoisyOrNothingIsSeen) {
  const SampleAllocation even(3);
  EXPECT_EQ(even.At({5, 7}), 3);
  EXPECT_EQ(even.Table().count, 0);
  for (const double brightness : {1., 0.}) {
    const Means means = MeansOf({0, brightness}, {0, brightness}, 3);
    EXPECT_EQ(means.least, 3);
    EXPECT_EQ(means.most, 3);
  }
}

// Neyman's rule: in proportion to the standard deviation, to one over the square root of the cost, and to nothing else.
TEST(SampleAllocation, FollowsNoiseAndCost) {
  const auto ratio = [](const Half& left, const Half& right) {
    const Means means = MeansOf(left, right);
    return means.right / means.left;
  };
  // 2,048 probes a half, of one degree of freedom each: 1.6 % on a standard deviation, 2.2 % on a ratio. Three times
  // that.
  const auto expectRatio = [&](const Half& left, const Half& right, double expected) {
    EXPECT_NEAR(ratio(left, right) / expected, 1, 0.066) << expected;
  };
  expectRatio({0.1}, {0.1}, 1);
  expectRatio({0.1}, {0.3}, 3);
  expectRatio({0.1, 1, 1}, {0.1, 1, 4}, 0.5);
  expectRatio({0.1, 1, 1}, {0.2, 1, 4}, 1);
  // Noise counts relative to brightness, but in the dark less: there it is the median of both halves that it is held
  // to.
  expectRatio({0.1, 1}, {0.1, 1.1}, 1);
  // The dark half, whose noise is 1e-5 beside a floor of 0.3 times the median (which is one half's or the other's),
  // gets the least.
  EXPECT_NEAR(MeansOf({0.1, 1}, {0.1, 1e-4}).right, 1, 0.01);  // the mean is over 56 of 56.5 columns
}

TEST(SampleAllocation, TakesTheRaysThatItsMeanStandsForWithinItsBounds) {
  for (const int rays : {1, 4}) {
    const Half left{0.1, 1, 1}, right{0.5, 1, rays};
    const SampleAllocation samples = SampleAllocation::ByNoise(*Empty(), 1, 4, TracerOf(left, right));
    double taken = 0, even = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const int cost = x < kSide / 2 ? left.rays : right.rays;
        taken += samples.At({x, y}) * cost;
        even += 4 * cost;
      }
    EXPECT_NEAR(taken / even, 1, 0.02) << rays;
  }
  // Quiet places keep one path; where all noise is in a small place, that gets its most and no more.
  const Means means = MeansOf({0}, {1}, 4);
  EXPECT_EQ(means.least, 1);
  const auto spot = [](const CameraRay& camera, Sampler& sampler, PassStats& stats) {
    const Vec3 d = camera.ray.d / camera.ray.d.z;
    return TracerOf({std::abs(d.x) + std::abs(d.y) < 0.05 ? 1. : 0.}, {0})(camera, sampler, stats);
  };
  const Means ofSpot = MeansOf(SampleAllocation::ByNoise(*Empty(), 1, 4, spot));
  EXPECT_EQ(ofSpot.most, 4 * SampleAllocation::kMostOfMean);
  EXPECT_EQ(ofSpot.least, 1);
}

TEST(SampleAllocation, IsOfArgumentsAloneAndFitsAnyPicture) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(3, 2), std::pair(517, 3), std::pair(1031, 767)}) {
    const auto scene = Empty(width, height);
    const auto make = [&](uint64_t seed, int threads) {
      const ThreadLimit limit(threads);
      return SampleAllocation::ByNoise(*scene, seed, 4, TracerOf({0.1}, {0.4}));
    };
    const SampleAllocation one = make(1, 1), again = make(1, 3);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        ASSERT_EQ(one.At({x, y}), again.At({x, y}));
        ASSERT_GE(one.At({x, y}), 1);
      }
  }
}

// The mean of a pixel is the mean of its paths however many they are, though the pilot has the seed of the passes and
// what is found is rare and bright; and the sum of the variances, of as many rays, is
// what the rule says: with noises 0.1 and 0.5 in halves, ((0.1 + 0.5) / 2)^2 to (0.1^2 + 0.5^2) / 2.
TEST(SampleAllocation, LeavesMeansAsTheyAreAndLowersTheirVariance) {
  const auto scene = Empty();
  // What is found is found by one path in so many.
  const auto skewed = [](const CameraRay& camera, Sampler& sampler, PassStats& stats) {
    ++stats.cameraRays;
    sampler.StartBlock(1);
    const double rarity = camera.ray.d.x < 0 ? 1.01 : 1.25;
    const double u = static_cast<double>(sampler.BlockSeed() >> 11) * 0x1p-53;
    return Color(u * rarity < 1 ? static_cast<float>(rarity) : 0.f);
  };
  const auto squareOf = [&](const SampleAllocation& samples, const SampleAllocation::Tracer& trace) {
    Film film(scene->Settings().resolution, {{0, 0}, scene->Settings().resolution}, Filter::Box());
    RenderPixels(*scene, 1, 0, samples, trace, film);
    film.FinishPass(0);
    const Image image = film.ToImage();
    double sum = 0, squares = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const double error = static_cast<double>(image.At(x, y, 0)) - 1;
        sum += error / (kSide * kSide);
        squares += error * error / (kSide * kSide);
      }
    // Four standard errors.
    EXPECT_NEAR(sum, 0, 4 * std::sqrt(squares) / kSide);
    return squares;
  };
  const auto even = TracerOf({0.1}, {0.5});
  const double byNoise = squareOf(SampleAllocation::ByNoise(*scene, 1, 8, even), even);
  EXPECT_NEAR(byNoise / squareOf(SampleAllocation(8), even), 0.09 / 0.13, 0.05);
  EXPECT_LT(squareOf(SampleAllocation::ByNoise(*scene, 1, 8, skewed), skewed),
            0.9 * squareOf(SampleAllocation(8), skewed));
}

}  // namespace
}  // namespace dapple
