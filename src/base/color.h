// Linear RGB colour: radiance, reflectance, power or importance. Nothing outside this file knows that there are three.
#pragma once

#include <algorithm>
#include <cmath>

namespace dapple {

/// Three linear components with Rec. 709 (sRGB) primaries.
struct Color {
  float r = 0, g = 0, b = 0;

  static constexpr int kComponents = 3;

  constexpr Color() = default;
  constexpr explicit Color(float gray) : r(gray), g(gray), b(gray) {}
  constexpr Color(float red, float green, float blue) : r(red), g(green), b(blue) {}

  constexpr float operator[](int i) const { return i == 0 ? r : (i == 1 ? g : b); }
  constexpr float& operator[](int i) { return i == 0 ? r : (i == 1 ? g : b); }

  constexpr Color& operator+=(const Color& c) { return *this = {r + c.r, g + c.g, b + c.b}; }
  constexpr Color& operator-=(const Color& c) { return *this = {r - c.r, g - c.g, b - c.b}; }
  constexpr Color& operator*=(const Color& c) { return *this = {r * c.r, g * c.g, b * c.b}; }
  constexpr Color& operator*=(float s) { return *this = {r * s, g * s, b * s}; }
  constexpr Color& operator/=(float s) { return *this *= 1 / s; }

  friend constexpr Color operator+(Color a, const Color& b) { return a += b; }
  friend constexpr Color operator-(Color a, const Color& b) { return a -= b; }
  friend constexpr Color operator-(const Color& a) { return {-a.r, -a.g, -a.b}; }
  friend constexpr Color operator*(Color a, const Color& b) { return a *= b; }
  friend constexpr Color operator*(Color a, float s) { return a *= s; }
  friend constexpr Color operator*(float s, Color a) { return a *= s; }
  friend constexpr Color operator/(Color a, float s) { return a /= s; }
  friend constexpr Color operator/(const Color& a, const Color& b) { return {a.r / b.r, a.g / b.g, a.b / b.b}; }
  friend constexpr bool operator==(const Color&, const Color&) = default;

  constexpr bool IsBlack() const { return r == 0 && g == 0 && b == 0; }
  bool IsFinite() const { return std::isfinite(r) && std::isfinite(g) && std::isfinite(b); }
  constexpr float MaxComponent() const { return std::max({r, g, b}); }
  constexpr float Average() const { return (r + g + b) / 3; }
  /// Relative luminance Y of linear Rec. 709 components.
  constexpr float Luminance() const { return 0.2126f * r + 0.7152f * g + 0.0722f * b; }
};

/// Each component through `f`.
template <typename F>
Color Map(const Color& c, F f) {
  return {f(c.r), f(c.g), f(c.b)};
}

inline Color Clamp(const Color& c, float low, float high) {
  return Map(c, [=](float x) { return std::clamp(x, low, high); });
}

}  // namespace dapple
