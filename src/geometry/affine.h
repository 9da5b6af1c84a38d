// An affine transform as the four columns of its matrix: what `Transform` becomes where millions of points go through
// it.
#pragma once

#include "src/base/transform.h"
#include "src/base/vec.h"

namespace dapple {

struct Affine {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< images of the axes
  Vec3d translation{0, 0, 0};

  Affine() = default;
  /// `transform` must be affine: its last row is taken for (0, 0, 0, 1).
  explicit Affine(const Transform& transform)
      : x(Column(transform, 0)), y(Column(transform, 1)), z(Column(transform, 2)), translation(Column(transform, 3)) {}

  Vec3d Vector(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
  Vec3d Point(const Vec3d& p) const { return Vector(p) + translation; }
  /// `n` times the transpose. Of the inverse of a transform, that is how the transform moves a normal (but its length).
  Vec3d Transposed(const Vec3d& n) const { return {Dot(x, n), Dot(y, n), Dot(z, n)}; }
  /// How much larger volumes become; negative where the transform mirrors.
  double Determinant() const { return Dot(x, Cross(y, z)); }
  /// Square of the Frobenius norm of the linear part.
  double NormSquared() const { return LengthSquared(x) + LengthSquared(y) + LengthSquared(z); }
  /// Entry of the linear part.
  double At(int row, int column) const { return (column == 0 ? x : column == 1 ? y : z)[row]; }

 private:
  static Vec3d Column(const Transform& transform, int column) {
    return {transform.At(0, column), transform.At(1, column), transform.At(2, column)};
  }
};

}  // namespace dapple
