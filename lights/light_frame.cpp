#include "lights/light_frame.h"

#include "src/base/error.h"

namespace dapple {

namespace {

/// The orthogonal matrix nearest to `m`, whose columns are given: the limit of averaging it with its inverse transpose
/// (Higham 1986, "Computing the polar decomposition").
void Orthogonalize(Vec3d (&m)[3]) {
  for (int iteration = 0; iteration < 64; ++iteration) {
    // The inverse transpose has the cross products of the columns, divided by the determinant, as its columns.
    const double determinant = Dot(m[0], Cross(m[1], m[2]));
    const Vec3d dual[3] = {Cross(m[1], m[2]) / determinant, Cross(m[2], m[0]) / determinant,
                           Cross(m[0], m[1]) / determinant};
    double change = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3d next = (m[i] + dual[i]) * 0.5;
      change = std::max(change, MaxAbsComponent(next - m[i]));
      m[i] = next;
    }
    if (change < 1e-15) break;
  }
}

}  // namespace

LightFrame::LightFrame(const Transform& lightToRender) : axes_{Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)} {
  if (lightToRender.IsSingular()) throw Error("transform of a light cannot be inverted: expected a rotation");
  double longest = 0;
  for (Vec3d& axis : axes_) longest = std::max(longest, Length(axis = lightToRender.Vector(axis)));
  for (Vec3d& axis : axes_) axis /= longest;
  Orthogonalize(axes_);
}

}  // namespace dapple
