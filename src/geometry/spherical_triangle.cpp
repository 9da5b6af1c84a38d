#include "src/geometry/spherical_triangle.h"

#include "src/base/numerics.h"

namespace dapple {
namespace {

/// The angle between unit vectors, precise from 0 to pi (Kahan).
double AngleBetween(const Vec3d& a, const Vec3d& b) { return 2 * std::atan2(Length(a - b), Length(a + b)); }

/// Solid angle of the triangle of unit vectors a, b, c with |det| given (Van Oosterom and Strackee 1983).
double SolidAngleOf(double determinant, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return 2 * std::atan2(determinant, 1 + Dot(a, b) + Dot(b, c) + Dot(c, a));
}

}  // namespace

SphericalTriangle::SphericalTriangle(const Vec3d& p0, const Vec3d& e1, const Vec3d& e2, const Vec3d& reference) {
  const Vec3d toFirst = p0 - reference;
  const Vec3d toCorner[3] = {toFirst, toFirst + e1, toFirst + e2};
  for (int i = 0; i < 3; ++i) {
    distance_[i] = Length(toCorner[i]);
    if (!(distance_[i] > 0) || !std::isfinite(distance_[i])) return;
    unit_[i] = toCorner[i] / distance_[i];
  }
  // With one corner and two edges instead of three corners, small triangles keep their relative precision.
  determinant_ = std::abs(Dot(toFirst, Cross(e1, e2))) / (distance_[0] * distance_[1] * distance_[2]);
  if (!(determinant_ > 0) || !std::isfinite(determinant_)) return;
  solidAngle_ = SolidAngleOf(determinant_, unit_[0], unit_[1], unit_[2]);
}

bool SphericalTriangle::IsWellConditioned() const {
  // Below, unit vectors (precise to 1e-16) are too near to each other; above, the reference is all but on the triangle.
  constexpr double kSmallest = 1e-10;
  constexpr double kLargest = 2 * kPiD - 1e-5;
  return solidAngle_ > kSmallest && solidAngle_ < kLargest;
}

// With E the solid angle of the part triangle (a, b, c'), alpha the angle at a, and x = tan(ac' / 2):
//   tan(E/2) = x k sin(alpha) / (1 + x k cos(alpha)),  k = tan(ab / 2),
// so that x = sin(E/2) / (k sin(alpha - E/2)), where no terms of near size are subtracted but the angles themselves.
Vec3d SphericalTriangle::Sample(const Vec2d& u) const {
  const auto& [a, b, c] = unit_;
  const double alpha = std::atan2(determinant_, Dot(Cross(a, b - a), Cross(a, c - a)));
  const double halfPart = u.x * solidAngle_ / 2;
  const double tanHalfAb = Length(a - b) / Length(a + b);
  const double arcAc = AngleBetween(a, c);
  const double sinRest = std::sin(std::max(0.0, alpha - halfPart));
  const double arcPart = std::min(arcAc, 2 * std::atan2(std::sin(halfPart), tanHalfAb * sinRest));

  // c' = (weightA a + weightC c) / its length; the direction = weightB b + weightPart c'.
  const double weightA = std::sin(arcAc - arcPart), weightC = std::sin(arcPart);
  const Vec3d onEdge = a * weightA + c * weightC;
  const double onEdgeLength = Length(onEdge);
  const Vec3d cPart = onEdge / onEdgeLength;
  const double arcMax = AngleBetween(b, cPart);
  const double arc = std::min(arcMax, 2 * std::asin(std::min(1.0, std::sqrt(u.y) * Length(b - cPart) / 2)));
  const double weightB = std::sin(arcMax - arc), weightPart = std::sin(arc) / onEdgeLength;

  const Vec3d weights(weightPart * weightA / distance_[0], weightB / distance_[1], weightPart * weightC / distance_[2]);
  return weights / (weights.x + weights.y + weights.z);
}

Vec2d SphericalTriangle::Invert(const Vec3d& weights) const {
  const auto& [a, b, c] = unit_;
  const double weightA = weights.x * distance_[0], weightB = weights.y * distance_[1],
               weightC = weights.z * distance_[2];
  const Vec3d onEdge = a * weightA + c * weightC;
  const double onEdgeLength = Length(onEdge);
  if (!(onEdgeLength > 0)) return Vec2d(0);  // at b, every u.x with u.y = 0
  const Vec3d cPart = onEdge / onEdgeLength;
  const double part = SolidAngleOf(determinant_ * weightC / onEdgeLength, a, b, cPart);

  const Vec3d direction = Normalize(b * weightB + onEdge);
  const double widthSquared = LengthSquared(b - cPart);
  const double along = widthSquared > 0 ? LengthSquared(direction - b) / widthSquared : 0;
  return {std::clamp(part / solidAngle_, 0.0, 1.0), std::clamp(along, 0.0, 1.0)};
}

}  // namespace dapple
