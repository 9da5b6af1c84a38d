// An affine or projective transform in double precision, kept together with its inverse.
//
// Points are columns, as in pbrt: `a * b` applies b first. Imath multiplies rows, so the matrices inside are the
// transposes.
#pragma once

#include <ImathMatrix.h>

#include "src/base/vec.h"

namespace dapple {

class Transform {
 public:
  Transform() = default;
  /// From 16 numbers of a matrix that acts on column vectors, row by row: m[0..3] is its first row.
  /// The inverse of a singular matrix is the identity; ask `IsSingular` before use.
  static Transform FromRows(const double (&m)[16]);

  static Transform Translate(const Vec3d& delta);
  static Transform Scale(const Vec3d& s);
  /// By `degrees` around `axis` (any length but zero), counter-clockwise looking against the axis.
  static Transform Rotate(double degrees, const Vec3d& axis);
  /// From the camera's space (x right, y up, z into the scene; left-handed, as in pbrt) to the world.
  /// `up` parallel to the view gives a singular transform.
  static Transform CameraToWorldLookAt(const Vec3d& eye, const Vec3d& target, const Vec3d& up);

  Transform Inverse() const;
  Transform operator*(const Transform& b) const;

  Vec3d Point(const Vec3d& p) const;
  Vec3d Vector(const Vec3d& v) const;
  /// A normal: times the inverse transpose; its length is not kept.
  Vec3d Normal(const Vec3d& n) const;

  bool IsIdentity() const;
  bool IsSingular() const;
  /// True where the transform turns a right-handed system into a left-handed one.
  bool SwapsHandedness() const;
  /// Entry of the matrix that acts on column vectors.
  double At(int row, int column) const { return matrix_[column][row]; }
  friend bool operator==(const Transform& a, const Transform& b) { return a.matrix_ == b.matrix_; }

 private:
  Transform(const Imath::M44d& matrix, const Imath::M44d& inverse) : matrix_(matrix), inverse_(inverse) {}

  Imath::M44d matrix_, inverse_;
};

}  // namespace dapple
