// An orthonormal frame: local coordinates in which the normal is (0, 0, 1), as BSDFs are written.
#pragma once

#include <cmath>

#include "src/base/vec.h"

namespace dapple {

/// Two vectors that make an orthonormal basis with the unit vector `n` (Duff et al. 2017, listing 3).
template <typename T>
void CoordinateSystem(const Imath::Vec3<T>& n, Imath::Vec3<T>* s, Imath::Vec3<T>* t) {
  const T sign = std::copysign(T(1), n.z);
  const T a = T(-1) / (sign + n.z);
  const T b = n.x * n.y * a;
  *s = {T(1) + sign * n.x * n.x * a, sign * b, -sign * n.x};
  *t = {b, sign + n.y * n.y * a, -n.y};
}

/// An orthonormal, right-handed frame (s, t, n).
struct Frame {
  Vec3 s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

  Frame() = default;
  Frame(const Vec3& s_, const Vec3& t_, const Vec3& n_) : s(s_), t(t_), n(n_) {}

  /// Around the unit vector `normal`, with tangents of no particular direction.
  static Frame FromZ(const Vec3& normal) {
    Frame frame;
    frame.n = normal;
    CoordinateSystem(normal, &frame.s, &frame.t);
    return frame;
  }

  /// Around the unit vector `normal`, with s as near to `tangent` as can be; any s where `tangent` is zero or parallel.
  static Frame FromZX(const Vec3& normal, const Vec3& tangent) {
    const Vec3 projected = tangent - normal * Dot(normal, tangent);
    const float lengthSquared = LengthSquared(projected);
    if (!(lengthSquared > 1e-12f * LengthSquared(tangent))) return FromZ(normal);
    // What is left of a tangent near the normal is mostly rounding; projected once more it is perpendicular.
    const Vec3 unit = projected * (1 / std::sqrt(lengthSquared));
    const Vec3 s = Normalize(unit - normal * Dot(normal, unit));
    return {s, Cross(normal, s), normal};
  }

  Vec3 ToLocal(const Vec3& v) const { return {Dot(v, s), Dot(v, t), Dot(v, n)}; }
  Vec3 ToWorld(const Vec3& v) const { return s * v.x + t * v.y + n * v.z; }
};

// Trigonometry of a local direction w around the normal (0, 0, 1).
inline float CosTheta(const Vec3& w) { return w.z; }
inline float AbsCosTheta(const Vec3& w) { return std::abs(w.z); }
inline float Cos2Theta(const Vec3& w) { return w.z * w.z; }
inline float Sin2Theta(const Vec3& w) { return w.x * w.x + w.y * w.y; }
inline float SinTheta(const Vec3& w) { return std::sqrt(Sin2Theta(w)); }
inline float Tan2Theta(const Vec3& w) { return Sin2Theta(w) / Cos2Theta(w); }
inline bool SameHemisphere(const Vec3& a, const Vec3& b) { return a.z * b.z > 0; }

}  // namespace dapple
