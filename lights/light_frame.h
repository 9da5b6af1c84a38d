// The axes of a light whose emission depends on direction by an image, in render space.
#pragma once

#include "src/base/transform.h"

namespace dapple {

/// Turns directions between the light's own space and render space.
class LightFrame {
 public:
  /// Of `lightToRender` the nearest rotation (or rotation with reflection) counts, for emission by direction does not
  /// depend on lengths. Throws `Error` where it cannot be inverted.
  explicit LightFrame(const Transform& lightToRender);

  Vec3 ToRender(const Vec3d& w) const { return ToFloat(axes_[0] * w.x + axes_[1] * w.y + axes_[2] * w.z); }
  Vec3d ToLight(const Vec3& w) const {
    const Vec3d d = ToDouble(w);
    return {Dot(d, axes_[0]), Dot(d, axes_[1]), Dot(d, axes_[2])};
  }

 private:
  Vec3d axes_[3];  // the light's x, y and z
};

}  // namespace dapple
