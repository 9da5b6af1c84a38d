// Vectors, points and boxes: Imath's types under the renderer's names, with the operations of the field as free
// functions.
//
// A point and a vector share one type; names tell them apart (p, o are points; d, n, wi, wo are vectors).
// `Vec3` is float: what is traced. `Vec3d` is double: parsing, transforms, and random numbers (`Vec2d`).
#pragma once

#include <algorithm>
#include <cmath>

#include <ImathBox.h>
#include <ImathVec.h>

namespace dapple {

using Vec2 = Imath::V2f;
using Vec3 = Imath::V3f;
using Vec2d = Imath::V2d;
using Vec3d = Imath::V3d;
using Vec2i = Imath::V2i;
using Bounds3 = Imath::Box3f;
using Bounds3d = Imath::Box3d;
using Bounds2i = Imath::Box2i;

template <typename T>
T Dot(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
T AbsDot(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
  return std::abs(Dot(a, b));
}

template <typename T>
Imath::Vec3<T> Cross(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
  return a.cross(b);
}

template <typename T>
T LengthSquared(const Imath::Vec3<T>& v) {
  return Dot(v, v);
}

template <typename T>
T Length(const Imath::Vec3<T>& v) {
  return std::sqrt(LengthSquared(v));
}

/// `v` at length one; the zero vector stays zero. Lengths from 1e-18 to 1e18 (float) keep full precision.
template <typename T>
Imath::Vec3<T> Normalize(const Imath::Vec3<T>& v) {
  const T lengthSquared = LengthSquared(v);
  return lengthSquared > 0 ? v * (T(1) / std::sqrt(lengthSquared)) : v;
}

template <typename T>
T DistanceSquared(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
  return LengthSquared(a - b);
}

template <typename T>
T Distance(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
  return Length(a - b);
}

template <typename T>
T MaxAbsComponent(const Imath::Vec3<T>& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// `v`, turned around where needed to lie on the side of `reference`.
inline Vec3 FaceForward(const Vec3& v, const Vec3& reference) { return Dot(v, reference) < 0 ? -v : v; }

inline bool IsFinite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

inline Vec3 ToFloat(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
inline Vec3d ToDouble(const Vec3& v) { return {v.x, v.y, v.z}; }

}  // namespace dapple
