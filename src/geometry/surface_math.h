// Small pieces that the shapes share: densities from area to solid angle, rounding of points, derivatives of unit
// vectors.
#pragma once

#include <vector>

#include "src/base/numerics.h"
#include "src/base/vec.h"
#include "src/geometry/shape.h"

namespace dapple {

/// Half a unit in the last place of one: the relative error of one rounding to float.
inline constexpr double kFloatRounding = 0x1p-24;

/// A density per area at a point, as density per solid angle seen from a distance: `toPoint` leads there, `n` is normal
/// to the surface; neither need be of unit length. 0 where the surface is seen edge-on.
inline double AreaToSolidAngle(double pdfArea, const Vec3d& toPoint, const Vec3d& n) {
  const double distanceSquared = LengthSquared(toPoint);
  const double pdf = pdfArea * distanceSquared * std::sqrt(distanceSquared * LengthSquared(n)) / AbsDot(toPoint, n);
  return std::isfinite(pdf) ? pdf : 0;
}

/// Bound on how far, along the unit vector `n`, float may see a surface from where it is, for rays that start at its
/// point `p`: the rounding of `p` itself, and the rounding of normals, directions and differences of positions, which
/// counts over the surface's `extent` along each axis. Axes across `n` count little: a plane across an axis has next to
/// no error.
inline double RoundingAlong(const Vec3d& n, const Vec3d& p, const Vec3d& extent) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) sum += std::abs(n[axis]) * (1.5 * std::abs(p[axis]) + 3 * extent[axis]);
  return kFloatRounding * sum;
}

/// Makes `bounds` hold `p`; a point that is not finite makes them infinite, where Imath would pass over a NaN.
inline void ExtendBy(Bounds3* bounds, const Vec3& p) {
  bounds->extendBy(p);
  if (!IsFinite(p)) bounds->makeInfinite();
}

/// A float above `x` >= 0, by no more than two units in the last place.
inline float RoundUp(double x) {
  constexpr double kUp = 1 + 0x1p-23;
  return static_cast<float>(x * kUp);
}

/// A hull's ball that holds the ball around `center`, with its numbers rounded to float.
HullBall EnclosingHullBall(const Vec3d& center, double radius);

/// Adds the vertices that `indices` name, each once.
template <typename Position>
void AppendVertices(const std::vector<int>& indices, int vertexCount, const Position& position,
                    std::vector<HullBall>* hull) {
  std::vector<bool> isAdded(static_cast<size_t>(vertexCount));
  for (const int index : indices) {
    if (isAdded[static_cast<size_t>(index)]) continue;
    isAdded[static_cast<size_t>(index)] = true;
    hull->push_back({position(index), 0});
  }
}

/// The corners of a line around the arc of the unit circle from `begin` to `end` (at most a full turn): its ends and
/// where tangents meet, at most 0.2 % outside. The hull of the corners holds the arc.
std::vector<Vec2d> TangentPolygon(double begin, double end);

/// The derivative of Normalize(v) where v changes by `dv`.
inline Vec3d NormalizedDerivative(const Vec3d& v, const Vec3d& dv) {
  const double lengthSquared = LengthSquared(v);
  if (!(lengthSquared > 0)) return Vec3d(0);
  return (dv - v * (Dot(v, dv) / lengthSquared)) * (1 / std::sqrt(lengthSquared));
}

/// The integral of `f` over [a, b] by 8-point Gauss-Legendre rules on `panels` equal parts.
template <typename F>
double Integrate(double a, double b, int panels, F f) {
  constexpr double kNodes[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  constexpr double kWeights[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  const double half = (b - a) / (2 * panels);
  double sum = 0;
  for (int panel = 0; panel < panels; ++panel) {
    const double middle = a + half * (2 * panel + 1);
    for (int i = 0; i < 4; ++i) sum += kWeights[i] * (f(middle - half * kNodes[i]) + f(middle + half * kNodes[i]));
  }
  return sum * half;
}

/// The angle of (x, y) in [0, 2 pi).
inline double Azimuth(double x, double y) {
  const double phi = Atan2(y, x);
  return phi < 0 ? std::min(phi + 2 * kPiD, std::nextafter(2 * kPiD, 0.0)) : phi;
}

inline Vec2 ToFloat(const Vec2d& v) { return {static_cast<float>(v.x), static_cast<float>(v.y)}; }

}  // namespace dapple
