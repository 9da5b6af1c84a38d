// Kernels of density estimation on a surface, normalised over the disk: the integral of K over |x| < r is one.
#pragma once

#include "src/base/numerics.h"

namespace dapple {

/// 2 / (pi r^2) (1 - d^2 / r^2): of all kernels the one of least mean squared error (Epanechnikov 1969; Silverman 1986,
/// section 3.3.2).
class EpanechnikovKernel {
 public:
  explicit EpanechnikovKernel(float radius)
      : inverseRadiusSquared_(1 / Sqr(radius)), scale_(2 * kInvPi * inverseRadiusSquared_) {}

  /// Per unit area, at the squared distance d^2 <= r^2.
  float operator()(float distanceSquared) const { return scale_ * (1 - distanceSquared * inverseRadiusSquared_); }

 private:
  float inverseRadiusSquared_, scale_;
};

}  // namespace dapple
