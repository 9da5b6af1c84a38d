#include "src/base/transform.h"

#include "src/base/numerics.h"

namespace dapple {

Transform Transform::FromRows(const double (&m)[16]) {
  Imath::M44d matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix[column][row] = m[4 * row + column];
  return {matrix, matrix.gjInverse()};
}

Transform Transform::Translate(const Vec3d& delta) {
  Imath::M44d matrix, inverse;
  matrix.setTranslation(delta);
  inverse.setTranslation(-delta);
  return {matrix, inverse};
}

Transform Transform::Scale(const Vec3d& s) {
  Imath::M44d matrix, inverse;
  matrix.setScale(s);
  inverse.setScale(Vec3d(1 / s.x, 1 / s.y, 1 / s.z));
  return {matrix, inverse};
}

Transform Transform::Rotate(double degrees, const Vec3d& axis) {
  Imath::M44d matrix;
  matrix.setAxisAngle(Normalize(axis), Radians(degrees));
  return {matrix, matrix.transposed()};
}

Transform Transform::CameraToWorldLookAt(const Vec3d& eye, const Vec3d& target, const Vec3d& up) {
  const Vec3d z = Normalize(target - eye);
  const Vec3d x = Normalize(Cross(Normalize(up), z));
  const Vec3d y = Cross(z, x);
  const double rows[16] = {x.x, y.x, z.x, eye.x, x.y, y.y, z.y, eye.y, x.z, y.z, z.z, eye.z, 0, 0, 0, 1};
  return FromRows(rows);
}

Transform Transform::Inverse() const { return {inverse_, matrix_}; }

Transform Transform::operator*(const Transform& b) const { return {b.matrix_ * matrix_, inverse_ * b.inverse_}; }

Vec3d Transform::Point(const Vec3d& p) const {
  Vec3d result;
  matrix_.multVecMatrix(p, result);
  return result;
}

Vec3d Transform::Vector(const Vec3d& v) const {
  Vec3d result;
  matrix_.multDirMatrix(v, result);
  return result;
}

Vec3d Transform::Normal(const Vec3d& n) const {
  Vec3d result;
  inverse_.transposed().multDirMatrix(n, result);
  return result;
}

bool Transform::IsIdentity() const { return matrix_ == Imath::M44d(); }

bool Transform::IsSingular() const {
  const double determinant = matrix_.determinant();
  return determinant == 0 || !std::isfinite(determinant);
}

bool Transform::SwapsHandedness() const {
  const auto& m = matrix_;
  return Dot(Vec3d(m[0][0], m[0][1], m[0][2]),
             Cross(Vec3d(m[1][0], m[1][1], m[1][2]), Vec3d(m[2][0], m[2][1], m[2][2]))) < 0;
}

}  // namespace dapple
