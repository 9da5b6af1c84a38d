// Kernels of density estimation on a surface, normalised over the disk: the integral of K over |x| < r is one.
#pragma once

#include <algorithm>
#include <cmath>

#include "src/base/numerics.h"
#include "src/base/vec.h"

namespace dapple {

enum class KernelShape {
  /// 2 / (pi r^2) (1 - d^2 / r^2): of all kernels the one of least mean squared error (Epanechnikov 1969; Silverman
  /// 1986, section 3.3.2).
  Epanechnikov,
  /// 3 / (pi r^2) (1 - d / r): more of its weight in the middle (Jensen 2001, section 7.2.1, with k = 1).
  Cone,
};

/// A kernel of radius r > 0.
class Kernel {
 public:
  Kernel(KernelShape shape, float radius) : shape_(shape), radius_(radius), inverseRadiusSquared_(1 / Sqr(radius)) {}

  /// Per unit area, at the squared distance d^2 <= r^2.
  float operator()(float distanceSquared) const {
    const float t = std::min(1.f, distanceSquared * inverseRadiusSquared_);
    const float profile = shape_ == KernelShape::Epanechnikov ? 2 * (1 - t) : 3 * (1 - std::sqrt(t));
    return kInvPi * inverseRadiusSquared_ * profile;
  }

  /// A point of the disk, with the kernel as its density per area.
  Vec2 Sample(const Vec2d& u) const {
    // The share of the kernel within t r is 2 t^2 - t^4 or 3 t^2 - 2 t^3.
    const double t = shape_ == KernelShape::Epanechnikov ? std::sqrt(1 - std::sqrt(1 - u.x))
                                                         : 0.5 - std::sin(std::asin(1 - 2 * u.x) / 3);
    const double distance = t * static_cast<double>(radius_), phi = 2 * kPiD * u.y;
    return {static_cast<float>(distance * std::cos(phi)), static_cast<float>(distance * std::sin(phi))};
  }

  /// 1 / (integral of K^2): an even disk of this area is as noisy.
  static constexpr double EffectiveArea(KernelShape shape, double radius) {
    return (shape == KernelShape::Epanechnikov ? 3.0 / 4 : 2.0 / 3) * kPiD * radius * radius;
  }

 private:
  KernelShape shape_;
  float radius_, inverseRadiusSquared_;
};

}  // namespace dapple
