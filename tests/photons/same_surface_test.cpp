#include "src/photons/same_surface.h"

#include <random>

#include <gtest/gtest.h>

namespace dapple {
namespace {

const Vec3 kUp(0, 0, 1);

/// Asks with the photon's light coming along its normal.
bool Belongs(const GatherSite& site, const Vec3& position, const Vec3& normal) {
  return IsOnSameSurface(site, position, DistanceSquared(site.p, position), normal, normal);
}

Vec3 RandomDirection(std::mt19937* random) {
  std::normal_distribution<float> normal;
  return Normalize(Vec3(normal(*random), normal(*random), normal(*random)));
}

TEST(SameSurface, TakesAllPhotonsOfAPlaneHoweverItsNormalPoints) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 n = RandomDirection(&random), along = Normalize(Cross(n, RandomDirection(&random)));
    const Vec3 p = RandomDirection(&random) * 10.f;
    const Vec3 position = p + along * 0.99f;
    for (float sign : {1.f, -1.f})
      EXPECT_TRUE(IsOnSameSurface({p, n * sign, n, 1, false}, position, DistanceSquared(p, position), n * -sign, n));
  }
}

TEST(SameSurface, ParallelFacesATenthOfTheRadiusApartAreTwo) {
  std::mt19937 random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 n = RandomDirection(&random), along = Normalize(Cross(n, RandomDirection(&random)));
    for (bool transmits : {false, true})
      for (float side : {1.f, -1.f})
        for (float distance : {0.f, 0.3f, 0.9f}) {
          const GatherSite site(Vec3(0), n, n * side, 1, transmits);
          EXPECT_FALSE(Belongs(site, along * distance - n * (0.1f * side), n));
          EXPECT_FALSE(Belongs(site, along * distance - n * (0.1f * side), -n));
        }
  }
}

TEST(SameSurface, LightFromTheOtherSideCountsOnlyWhereTheSurfaceTransmits) {
  const Vec3 position(0.5f, 0, 0);
  for (const Vec3& normal : {kUp, -kUp})
    for (float side : {1.f, -1.f}) {
      const Vec3 wi(0.6f, 0, 0.8f * side);
      EXPECT_EQ(IsOnSameSurface({Vec3(0), kUp, kUp, 1, false}, position, 0.25f, normal, wi), side > 0);
      EXPECT_TRUE(IsOnSameSurface({Vec3(0), kUp, kUp, 1, true}, position, 0.25f, normal, wi));
    }
}

TEST(SameSurface, TakesSpheresAndCylindersUpTo45Degrees) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  int taken = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 a = RandomDirection(&random), b = RandomDirection(&random);
    const float cosine = Dot(a, b);
    if (std::abs(cosine - 0.7071f) > 0.001f) {
      // Inside and outside alike.
      EXPECT_EQ(Belongs({a, a, a, 2, false}, b, b), cosine > 0.7071f);
      EXPECT_EQ(Belongs({a, a, -a, 2, false}, b, -b), cosine > 0.7071f);
      taken += cosine > 0.7071f;
    }
    const float angle = uniform(random) * 0.785f;
    const Vec3 n(std::cos(angle), std::sin(angle), 0);
    EXPECT_TRUE(Belongs({Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 0), 2, false}, n + Vec3(0, 0, uniform(random)), n));
  }
  EXPECT_GT(taken, 1000);
}

TEST(SameSurface, TakesTheNextFacetAndLeavesTheNextWall) {
  // Facets that meet at the y axis: the site's lies along -x, the photon's is turned about the axis by `angle`.
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const float a = uniform(random), b = 1 - a;
    for (float degrees : {-40.f, -10.f, -1.f, 1.f, 10.f, 40.f}) {
      const float angle = degrees * kPi / 180;
      const Vec3 n(-std::sin(angle), 0, std::cos(angle));
      EXPECT_TRUE(Belongs({Vec3(-a, 0, 0), kUp, kUp, 1, false}, Vec3(std::cos(angle), 0, std::sin(angle)) * b, n));
    }
    EXPECT_FALSE(Belongs({Vec3(-a, 0, 0), kUp, kUp, 1, false}, Vec3(0, 0, b), Vec3(-1, 0, 0)));
  }
}

}  // namespace
}  // namespace dapple
