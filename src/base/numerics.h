// Constants and the small functions that keep floating-point arithmetic exact where it is easily lost.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace dapple {

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kInvPi = std::numbers::inv_pi_v<float>;
inline constexpr double kPiD = std::numbers::pi;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// The largest float below one.
inline constexpr float kOneMinusEpsilon = 0x1.fffffep-1f;

template <typename T>
constexpr T Sqr(T x) {
  return x * x;
}

/// Square root that takes a slightly negative `x`, as rounding leaves it, for zero.
template <typename T>
T SafeSqrt(T x) {
  return std::sqrt(std::max(T(0), x));
}

template <typename T>
T SafeAcos(T x) {
  return std::acos(std::clamp(x, T(-1), T(1)));
}

template <typename T, typename S>
constexpr T Lerp(S t, const T& a, const T& b) {
  return a * (S(1) - t) + b * t;
}

constexpr double Radians(double degrees) { return degrees * (kPiD / 180); }
constexpr double Degrees(double radians) { return radians * (180 / kPiD); }

/// a b - c d, with an error within 1.5 ulp whatever cancels (Kahan; pbrt-v4, section B.2.9).
template <typename T>
T DifferenceOfProducts(T a, T b, T c, T d) {
  const T cd = c * d;
  const T difference = std::fma(a, b, -cd);
  const T error = std::fma(-c, d, cd);
  return difference + error;
}

/// 1 - sqrt(1 - x) for x in [0, 1], without cancellation: for x = sin^2 theta it is 1 - cos theta.
template <typename T>
T OneMinusSqrtOneMinus(T x) {
  return x / (T(1) + SafeSqrt(T(1) - x));
}

/// The angle of the vector (x, y), in [-pi, pi]; 0 for (0, 0). Within 4.5e-16 (relative), and faster than the
/// C library's, which rounds more carefully. `x` and `y` are finite, and so is |x| + |y|.
inline double Atan2(double y, double x) {
  const double high = std::max(std::abs(x), std::abs(y)), low = std::min(std::abs(x), std::abs(y));
  if (high == 0) return 0;
  // The angle in the first octant is atan(low / high), or from pi / 8 on pi / 4 less the angle that is missing; of what
  // is left of it, |t| <= tan(pi / 8), a minimax polynomial (Remez, relative error 4e-17).
  const bool isNearDiagonal = low > 0.41421356237309503 * high;
  const double t = isNearDiagonal ? (low - high) / (low + high) : low / high;
  const double z = t * t, z2 = z * z, z4 = z2 * z2;
  const double p01 = -0.3333333333333014791 + 0.19999999999088225471 * z;
  const double p23 = -0.14285714195197296459 + 0.11111106650855635657 * z;
  const double p45 = -0.090907823469169880873 + 0.07690067355273011544 * z;
  const double p67 = -0.066411128293930449444 + 0.056924945872438523512 * z;
  const double p89 = -0.043589654138285930177 + 0.021258238087206332713 * z;
  const double polynomial = (p01 + p23 * z2) + ((p45 + p67 * z2) + p89 * z4) * z4;
  double angle = (isNearDiagonal ? kPiD / 4 : 0) + (t + t * z * polynomial);
  if (std::abs(y) > std::abs(x)) angle = kPiD / 2 - angle;
  if (x < 0) angle = kPiD - angle;
  return std::copysign(angle, y);
}

/// The bound n eps / (1 - n eps) on the relative error of n chained float operations (Higham 2002).
constexpr float Gamma(int n) {
  constexpr float kHalfUlp = std::numeric_limits<float>::epsilon() * 0.5f;
  return (static_cast<float>(n) * kHalfUlp) / (1 - static_cast<float>(n) * kHalfUlp);
}

inline float NextFloatUp(float x) { return std::nextafter(x, kInfinity); }
inline float NextFloatDown(float x) { return std::nextafter(x, -kInfinity); }

}  // namespace dapple
