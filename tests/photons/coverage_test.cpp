// How much of a disk a surface fills, where it is known: in the middle of a plane, at its edge, in the corner of a
// room, on a sphere, and on a plate smaller than the disk.
#include "src/photons/coverage.h"

#include <cmath>

#include <gtest/gtest.h>

#include "src/base/numerics.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

std::unique_ptr<Scene> SceneOf(const std::string& shapes) {
  return testing_support::SceneFromText(
      "LookAt 0 -9 0  0 0 0  0 0 1 Camera \"perspective\" Film \"image\" WorldBegin LightSource \"point\" Material "
      "\"matte\" " +
      shapes + " WorldEnd");
}

/// x >= 0, y >= 0 of the plane z = 0, the wall x = 0, and the wall y = 0, each of side 4.
const std::string kCorner =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3  4 5 6 4 6 7  8 9 10 8 10 11] \"point P\" "
    "[0 0 0 4 0 0 4 4 0 0 4 0  0 0 0 0 4 0 0 4 4 0 0 4  0 0 0 4 0 0 4 0 4 0 0 4]";

struct Estimate {
  double mean = 0, error = 0;  ///< one standard deviation of the mean
  double raysEach = 0;
};

/// Of a site of the file's world.
Estimate InverseCoverageAt(const Scene& scene, const Vec3& p, const Vec3& n, float radius,
                           KernelShape shape = KernelShape::Epanechnikov) {
  constexpr int kSamples = 20000;
  const GatherSite site(scene.RenderToWorld().Inverse().Point(p), n, n, radius, false);
  SurfaceInteraction hit;  // of no shape: all that it finds must show what it is
  hit.shape = -1;
  double sum = 0, squares = 0;
  int64_t rays = 0;
  for (uint64_t seed = 0; seed < kSamples; ++seed) {
    const auto x = static_cast<double>(InverseCoverage(scene, hit, site, shape, seed, &rays));
    sum += x;
    squares += x * x;
  }
  const double mean = sum / kSamples;
  return {mean, std::sqrt(std::max(0.0, squares / kSamples - Sqr(mean)) / kSamples),
          static_cast<double>(rays) / kSamples};
}

/// Within five standard deviations: a right estimate fails less than once in a million.
void ExpectInverseCoverage(const Estimate& estimate, double expected) {
  EXPECT_NEAR(estimate.mean, expected, 5 * estimate.error);
}

TEST(Coverage, IsWholeInTheMiddleOfAPlaneAndCostsOneRay) {
  const Estimate estimate = InverseCoverageAt(*SceneOf(kCorner), {2, 2, 0}, {0, 0, 1}, 0.5f);
  EXPECT_EQ(estimate.mean, 1);
  EXPECT_EQ(estimate.raysEach, 1);
}

TEST(Coverage, IsHalfAtAnEdgeAndAQuarterInACorner) {
  const auto scene = SceneOf(kCorner);
  ExpectInverseCoverage(InverseCoverageAt(*scene, {4, 2, 0}, {0, 0, 1}, 0.5f), 2);  // the air beside
  ExpectInverseCoverage(InverseCoverageAt(*scene, {0, 2, 0}, {0, 0, 1}, 0.5f), 2);  // a wall beside
  ExpectInverseCoverage(InverseCoverageAt(*scene, {0, 0, 0}, {0, 0, 1}, 0.5f), 4);
  ExpectInverseCoverage(InverseCoverageAt(*scene, {0, 0, 0}, {0, 1, 0}, 0.5f), 4);
}

TEST(Coverage, IsWholeOnASphereUpToAQuarterOfItsRadius) {
  const auto scene = SceneOf("Shape \"sphere\" \"float radius\" [2]");
  // The tangent disk's rim, where the kernel is next to nothing, hangs just beyond what is near enough.
  EXPECT_NEAR(InverseCoverageAt(*scene, {0, 0, 2}, {0, 0, 1}, 0.5f).mean, 1, 1e-3);
}

TEST(Coverage, OfAPlateSmallerThanTheDiskIsItsShareOfTheKernel) {
  constexpr double kPlate = 0.4, kRadius = 0.5;
  const auto scene = SceneOf("Shape \"disk\" \"float radius\" [0.4]");
  // The kernel's integral over the disk of radius a is 2 t - t^2, t = (a / r)^2.
  const double t = Sqr(kPlate / kRadius);
  ExpectInverseCoverage(InverseCoverageAt(*scene, {0, 0, 0}, {0, 0, 1}, kRadius), 1 / (2 * t - t * t));
}

TEST(Coverage, StopsWhereAMirrorOrABlackFloorBegins) {
  const std::string half =
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [0 0 0 4 0 0 4 4 0 0 4 0] ";
  for (const char* other : {"Material \"mirror\" ", "Material \"matte\" \"rgb Kd\" [0 0 0] "}) {
    const auto scene = SceneOf(half + other + "Translate -4 0 0 " + half);
    ExpectInverseCoverage(InverseCoverageAt(*scene, {0, 2, 0}, {0, 0, 1}, 0.5f), 2);
  }
}

TEST(Coverage, FollowsTheKernelAndEndsAtSixtyFour) {
  const auto scene = SceneOf("Shape \"disk\" \"float radius\" [0.05]");
  // Shares of the kernels within t = a / r: 2 t^2 - t^4, and 3 t^2 - 2 t^3.
  const double t = 0.1;
  for (const auto& [shape, c] : {std::pair(KernelShape::Epanechnikov, 2 * t * t - t * t * t * t),
                                 std::pair(KernelShape::Cone, 3 * t * t - 2 * t * t * t)}) {
    ExpectInverseCoverage(InverseCoverageAt(*scene, {0, 0, 0}, {0, 0, 1}, 0.5f, shape), (1 - std::pow(1 - c, 64)) / c);
  }
}

TEST(Coverage, SeesThroughWhatHangsAbove) {
  // A ball of another material resting on the plane hides nothing of it: its photons may lie under the ball too.
  const auto scene = SceneOf(kCorner + " Translate 2 2 0.3 Shape \"sphere\" \"float radius\" [0.29]");
  EXPECT_EQ(InverseCoverageAt(*scene, {2.1f, 2, 0}, {0, 0, 1}, 0.5f).mean, 1);
}

}  // namespace
}  // namespace dapple
