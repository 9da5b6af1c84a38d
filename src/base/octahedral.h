// Unit vectors in 32 bits: the sphere folded onto a square (Cigolle et al. 2014, "A survey of efficient representations
// for independent unit vectors"), 16 bits a coordinate; the error stays below 6.5e-5
// radians (half a step of 1 / 32767 in both, stretched by sqrt(6) sqrt(3) in the middle of a face).
#pragma once

#include <cstdint>

#include "src/base/numerics.h"
#include "src/base/vec.h"

namespace dapple {

class OctahedralVector {
 public:
  OctahedralVector() = default;
  /// `v` is of unit length.
  explicit OctahedralVector(const Vec3& v) {
    const float scale = 1 / (std::abs(v.x) + std::abs(v.y) + std::abs(v.z));
    float x = v.x * scale, y = v.y * scale;
    if (v.z < 0) {
      const float folded = (1 - std::abs(y)) * std::copysign(1.f, x);
      y = (1 - std::abs(x)) * std::copysign(1.f, y);
      x = folded;
    }
    x_ = Encode(x);
    y_ = Encode(y);
  }

  Vec3 Decode() const {
    float x = DecodeCoordinate(x_), y = DecodeCoordinate(y_);
    const float z = 1 - (std::abs(x) + std::abs(y));
    if (z < 0) {
      const float folded = (1 - std::abs(y)) * std::copysign(1.f, x);
      y = (1 - std::abs(x)) * std::copysign(1.f, y);
      x = folded;
    }
    return Normalize(Vec3(x, y, z));
  }

 private:
  static constexpr float kSteps = 32767;  // an even number of steps over [-1, 1] keeps 0 and the axes exact
  static int16_t Encode(float x) { return static_cast<int16_t>(std::lrint(std::clamp(x, -1.f, 1.f) * kSteps)); }
  static float DecodeCoordinate(int16_t x) { return static_cast<float>(x) * (1 / kSteps); }

  int16_t x_ = 0, y_ = 0;
};

}  // namespace dapple
