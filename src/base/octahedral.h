// Unit vectors in 32 bits: the sphere folded onto a square (Cigolle et al. 2014, "A survey of efficient representations
// for independent unit vectors"), 16 bits a coordinate; the error stays below 6.5e-5
// radians (half a step of 1 / 32767 in both, stretched by sqrt(6) sqrt(3) in the middle of a face).
#pragma once

#include <cstdint>

#include "src/base/numerics.h"
#include "src/base/vec.h"

namespace dapple {

/// The sphere folded onto the square [-1, 1]^2; `v` of any length but zero.
inline Vec2 OctahedralSquare(const Vec3& v) {
  const float scale = 1 / (std::abs(v.x) + std::abs(v.y) + std::abs(v.z));
  const Vec2 p(v.x * scale, v.y * scale);
  if (v.z >= 0) return p;
  return {(1 - std::abs(p.y)) * std::copysign(1.f, p.x), (1 - std::abs(p.x)) * std::copysign(1.f, p.y)};
}

/// The unit vector at a point of the square.
inline Vec3 OctahedralDirection(const Vec2& p) {
  const float z = 1 - (std::abs(p.x) + std::abs(p.y));
  if (z >= 0) return Normalize(Vec3(p.x, p.y, z));
  return Normalize(
      Vec3((1 - std::abs(p.y)) * std::copysign(1.f, p.x), (1 - std::abs(p.x)) * std::copysign(1.f, p.y), z));
}

class OctahedralVector {
 public:
  OctahedralVector() = default;
  /// `v` is of unit length.
  explicit OctahedralVector(const Vec3& v) {
    const Vec2 p = OctahedralSquare(v);
    x_ = Encode(p.x);
    y_ = Encode(p.y);
  }

  Vec3 Decode() const { return OctahedralDirection({DecodeCoordinate(x_), DecodeCoordinate(y_)}); }

 private:
  static constexpr float kSteps = 32767;  // an even number of steps over [-1, 1] keeps 0 and the axes exact
  static int16_t Encode(float x) { return static_cast<int16_t>(std::lrint(std::clamp(x, -1.f, 1.f) * kSteps)); }
  static float DecodeCoordinate(int16_t x) { return static_cast<float>(x) * (1 / kSteps); }

  int16_t x_ = 0, y_ = 0;
};

}  // namespace dapple
