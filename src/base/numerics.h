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

/// The bound n eps / (1 - n eps) on the relative error of n chained float operations (Higham 2002).
constexpr float Gamma(int n) {
  constexpr float kHalfUlp = std::numeric_limits<float>::epsilon() * 0.5f;
  return (static_cast<float>(n) * kHalfUlp) / (1 - static_cast<float>(n) * kHalfUlp);
}

inline float NextFloatUp(float x) { return std::nextafter(x, kInfinity); }
inline float NextFloatDown(float x) { return std::nextafter(x, -kInfinity); }

}  // namespace dapple
