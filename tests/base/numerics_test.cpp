#include "src/base/numerics.h"

#include <cmath>

#include <gtest/gtest.h>

#include "src/base/color.h"
#include "src/base/hash.h"

namespace dapple {
namespace {

TEST(Numerics, DifferenceOfProductsSurvivesCancellation) {
  for (uint64_t i = 0; i < 10000; ++i) {
    // Two nearly equal products; in double each product of floats is exact.
    const float a = 1 + static_cast<float>(Hash(i, 1) >> 40) * 0x1p-24f,
                b = 1 + static_cast<float>(Hash(i, 2) >> 40) * 0x1p-24f;
    const float c = NextFloatUp(a), d = NextFloatDown(b);
    const double exact = double{a} * double{b} - double{c} * double{d};
    EXPECT_NEAR(DifferenceOfProducts(a, b, c, d), exact, std::abs(exact) * 1.5 * 0x1p-23) << a << " " << b;
  }
}

TEST(Numerics, OneMinusCosineWithoutCancellation) {
  for (const double theta : {1e-8, 1e-4, 0.01, 0.5, 1.5}) {
    const double sin2 = Sqr(std::sin(theta));
    const double exact = 2 * Sqr(std::sin(theta / 2));
    EXPECT_NEAR(OneMinusSqrtOneMinus(sin2) / exact, 1, 1e-14) << theta;
    EXPECT_NEAR(OneMinusSqrtOneMinus(static_cast<float>(sin2)) / exact, 1, 3e-7) << theta;
  }
  EXPECT_EQ(OneMinusSqrtOneMinus(0.f), 0);
  EXPECT_EQ(OneMinusSqrtOneMinus(1.f), 1);
  EXPECT_EQ(OneMinusSqrtOneMinus(NextFloatUp(1.f)), NextFloatUp(1.f));  // rounding past one gives no NaN
}

TEST(Numerics, SafeFunctionsTakeRoundingForTheBound) {
  EXPECT_EQ(SafeSqrt(-1e-7f), 0);
  EXPECT_EQ(SafeSqrt(4.), 2);
  EXPECT_EQ(SafeAcos(1.0000001f), 0);
  EXPECT_FLOAT_EQ(SafeAcos(-1.0000001f), kPi);
}

TEST(Numerics, LerpHitsBothEnds) {
  EXPECT_EQ(Lerp(0.f, 0.1f, 0.7f), 0.1f);
  EXPECT_EQ(Lerp(1.f, 0.1f, 0.7f), 0.7f);
  EXPECT_EQ(Lerp(0.25, 2., 6.), 3);
  EXPECT_EQ(Lerp(0.5f, Color(1, 2, 3), Color(3, 2, 1)), Color(2));
}

TEST(Numerics, DegreesAndRadians) {
  EXPECT_DOUBLE_EQ(Radians(180), kPiD);
  EXPECT_DOUBLE_EQ(Degrees(Radians(12.5)), 12.5);
}

TEST(Numerics, GammaBoundsAChainOfRoundings) {
  EXPECT_GT(Gamma(1), 0x1p-24f);
  EXPECT_LT(Gamma(1), 0x1.00001p-24f);
  EXPECT_GE(Gamma(10), 10 * 0x1p-24f);
  float product = 1;
  double exact = 1;
  for (int i = 0; i < 20; ++i) {
    product *= 1.1f;
    exact *= double{1.1f};
  }
  EXPECT_LE(std::abs(double{product} - exact), double{Gamma(20)} * exact);
}

TEST(Numerics, NeighboursOfFloats) {
  EXPECT_EQ(NextFloatDown(1.f), kOneMinusEpsilon);
  EXPECT_EQ(NextFloatUp(kOneMinusEpsilon), 1);
  EXPECT_GT(NextFloatUp(0.f), 0);
  EXPECT_LT(NextFloatDown(0.f), 0);
  EXPECT_EQ(NextFloatUp(kInfinity), kInfinity);
  EXPECT_EQ(NextFloatUp(-1.f), -kOneMinusEpsilon);
}

TEST(Numerics, Atan2IsTheLibrarysToRounding) {
  constexpr int kSteps = 100'000;
  double largest = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = (i + 0.5) / kSteps * kPiD;
    for (double r : {1e-200, 1., 1e150})
      for (double sign : {1., -1.}) {
        const double y = sign * r * std::sin(angle), x = r * std::cos(angle);
        const double exact = std::atan2(y, x);
        // The angle is of a quadrant's size where it is taken from a half or a whole turn.
        largest = std::max(largest, std::abs(Atan2(y, x) - exact) / std::max(std::abs(exact), 1e-300));
      }
  }
  EXPECT_LE(largest, 4.5e-16);
  // Small angles keep their relative precision.
  for (double t = 1; t > 1e-300; t /= 3) EXPECT_NEAR(Atan2(t, 1) / std::atan(t), 1, 4.5e-16) << t;
}

TEST(Numerics, Atan2IsExactOnTheAxes) {
  EXPECT_EQ(Atan2(0, 0), 0);
  EXPECT_EQ(Atan2(0, 2), 0);
  EXPECT_EQ(Atan2(3, 0), kPiD / 2);
  EXPECT_EQ(Atan2(-3, 0), -kPiD / 2);
  EXPECT_EQ(Atan2(0, -1), kPiD);
  EXPECT_EQ(Atan2(2, 2), kPiD / 4);
}

TEST(Color, Arithmetic) {
  const Color a(1, 2, 3), b(4, 5, 6);
  EXPECT_EQ(a + b, Color(5, 7, 9));
  EXPECT_EQ(b - a, Color(3));
  EXPECT_EQ(a * b, Color(4, 10, 18));
  EXPECT_EQ(2 * a, a * 2);
  EXPECT_EQ(b / Color(2, 5, 3), Color(2, 1, 2));
  EXPECT_EQ((Color(2, 4, 8) / 2), Color(1, 2, 4));
  EXPECT_EQ(-a, Color(-1, -2, -3));
  EXPECT_EQ(a[0] + a[1] * 10 + a[2] * 100, 321);
}

TEST(Color, QueriesAndMaps) {
  EXPECT_TRUE(Color().IsBlack());
  EXPECT_FALSE(Color(0, 1e-30f, 0).IsBlack());
  EXPECT_FALSE(Color(0, NAN, 0).IsFinite());
  EXPECT_FALSE(Color(INFINITY).IsFinite());
  EXPECT_EQ(Color(1, 5, 3).MaxComponent(), 5);
  EXPECT_EQ(Color(1, 5, 3).Average(), 3);
  EXPECT_FLOAT_EQ(Color(1).Luminance(), 1);
  EXPECT_EQ(Clamp(Color(-1, 0.5f, 2), 0, 1), Color(0, 0.5f, 1));
}

}  // namespace
}  // namespace dapple
