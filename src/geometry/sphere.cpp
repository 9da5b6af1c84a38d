#include "src/geometry/sphere.h"

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/base/frame.h"
#include "src/geometry/surface_math.h"
#include "src/sampling/warps.h"

namespace dapple {
namespace {

/// The unit vector `n` as a point of the octahedron's unfolded square, and back: no trigonometry, and an error of a
/// float's rounding (Meyer et al. 2010).
Vec2 OctahedronEncode(const Vec3d& n) {
  const double norm = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  const double x = n.x / norm, y = n.y / norm;
  if (n.z >= 0) return ToFloat(Vec2d(x, y));
  return ToFloat(Vec2d(std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y)));
}

Vec3d OctahedronDecode(const Vec2& code) {
  const double x = code.x, y = code.y;
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z >= 0) return Normalize(Vec3d(x, y, z));
  return Normalize(Vec3d(std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y), z));
}

/// The cone in which a sphere of radius `r` around the origin is seen from `reference` outside.
struct Cone {
  Cone(const Vec3d& reference, double r) : radius(r), distance(Length(reference)), axis(reference / distance) {
    const double sin2Max = Sqr(r / distance);
    oneMinusCosMax = sin2Max / (1 + std::sqrt((distance - r) * (distance + r)) / distance);
    CoordinateSystem(axis, &s, &t);
  }
  double SolidAngle() const { return 2 * kPiD * oneMinusCosMax; }

  /// The visible point of the sphere for `u`. Angles: theta at the reference, alpha at the centre, gamma = alpha +
  /// theta at the point; sin^2 and cos^2 of gamma are written in u so that neither the limb nor distance costs digits.
  Vec3d Sample(const Vec2d& u) const {
    const double oneMinusCos = u.x * oneMinusCosMax;
    const double cosTheta = 1 - oneMinusCos, sinTheta = std::sqrt(oneMinusCos * (2 - oneMinusCos));
    const double sinGamma = std::sqrt(u.x * (2 - oneMinusCos) / (2 - oneMinusCosMax));
    const double cosGamma = std::sqrt((1 - u.x) * (2 - oneMinusCosMax - oneMinusCos) / (2 - oneMinusCosMax));
    const double cosAlpha = cosGamma * cosTheta + sinGamma * sinTheta;
    const double sinAlpha = sinGamma * cosTheta - cosGamma * sinTheta;
    const double phi = 2 * kPiD * u.y;
    return (axis * cosAlpha + s * (sinAlpha * std::cos(phi)) + t * (sinAlpha * std::sin(phi))) * radius;
  }

  /// The inverse of `Sample` for the point `p` of the sphere.
  Vec2d Invert(const Vec3d& p) const {
    const double x = Dot(p, s), y = Dot(p, t);
    const double across = std::hypot(x, y);
    const double theta = std::atan2(across, distance - Dot(p, axis));
    const double oneMinusCos = 2 * Sqr(std::sin(theta / 2));
    return {std::clamp(oneMinusCos / oneMinusCosMax, 0.0, 1.0), Azimuth(x, y) / (2 * kPiD)};
  }

  /// False on the far side of the limb, with a grain of salt for the rounding of `p`.
  bool Sees(const Vec3d& p) const {
    constexpr double kSlack = 1e-6;
    return Dot(p, axis) * distance >= radius * (radius - kSlack * distance);
  }

  double radius, distance, oneMinusCosMax;
  Vec3d axis, s, t;
};

/// The distance from `from`, not outside a sphere of radius `r` around the origin, to it along the unit vector `w`:
/// without cancellation, however near it is.
double DistanceFromInside(const Vec3d& from, const Vec3d& w, double r) {
  const double distance = Length(from), along = Dot(from, w);
  const double product = (r - distance) * (r + distance);  // of the distances both ways
  const double root = std::sqrt(along * along + product);
  return along > 0 ? product / (along + root) : root - along;
}

}  // namespace

Sphere::Sphere(const Transform& objectToRender, bool reverseOrientation, double radius, double zMin, double zMax,
               double phiMaxDegrees)
    : Quadric(objectToRender, reverseOrientation, Vec3d(0)),
      radius_(radius),
      zMin_(std::clamp(std::min(zMin, zMax), -radius, std::max(radius, -radius))),
      zMax_(std::clamp(std::max(zMin, zMax), -radius, std::max(radius, -radius))),
      phiMax_(Radians(std::clamp(phiMaxDegrees, 0.0, 360.0))) {
  if (!(radius > 0) || !std::isfinite(radius))
    throw Error(fmt::format("sphere: radius {}: expected a number above zero", radius));
  thetaZMin_ = SafeAcos(zMin_ / radius);
  thetaZMax_ = SafeAcos(zMax_ / radius);
  isWhole_ = zMin_ == -radius && zMax_ == radius && phiMax_ >= 2 * kPiD;
  area_ = IsSimilarity() ? LocalArea() * AreaStretch({0, 0, 1}) : IntegrateArea();
}

double Sphere::IntegrateArea() const {
  constexpr int kPanels = 16;
  return Integrate(thetaZMax_, thetaZMin_, kPanels, [&](double theta) {
    const double sinTheta = std::sin(theta), cosTheta = std::cos(theta);
    return sinTheta * radius_ * radius_ * Integrate(0, phiMax_, kPanels, [&](double phi) {
             return AreaStretch({sinTheta * std::cos(phi), sinTheta * std::sin(phi), cosTheta});
           });
  });
}

double Sphere::LocalArea() const { return phiMax_ * radius_ * (zMax_ - zMin_); }

std::optional<Ball> Sphere::AsBall() const {
  if (!isWhole_ || !IsSimilarity()) return std::nullopt;
  const ShapeSample pole = SampleAt(Vec3d(0, 0, radius_), 0), antipole = SampleAt(Vec3d(0, 0, -radius_), 0);
  if (Dot(pole.n, pole.p - antipole.p) < 0) return std::nullopt;
  return Ball{ToRender(Vec3d(0)), std::sqrt(area_ / (4 * kPiD))};
}

void Sphere::AppendHull(std::vector<HullBall>* hull) const {
  if (isWhole_ && IsSimilarity()) {
    hull->push_back(EnclosingHullBall(ToRender(Vec3d(0)), std::sqrt(area_ / (4 * kPiD))));
    return;
  }
  // From the north end of the meridian to the south: (sin theta, cos theta) is (y, x) of the unit circle.
  std::vector<Vec2d> profile;
  for (const Vec2d& corner : TangentPolygon(SafeAcos(zMax_ / radius_), SafeAcos(zMin_ / radius_)))
    profile.emplace_back(radius_ * std::max(0.0, corner.y), radius_ * corner.x);
  AppendRevolved(profile, phiMax_, hull);
}

Bounds3 Sphere::PrimitiveBounds(int) const {
  // The box of the cut sphere, transformed, within the box of the whole transformed sphere, which is exact.
  Bounds3 bounds = BoundsOf({-radius_, -radius_, zMin_}, {radius_, radius_, zMax_});
  const Bounds3 whole = EllipsoidBounds(radius_);
  for (int axis = 0; axis < 3; ++axis) {
    bounds.min[axis] = std::max(bounds.min[axis], whole.min[axis]);
    bounds.max[axis] = std::min(bounds.max[axis], whole.max[axis]);
  }
  return bounds;
}

bool Sphere::Contains(const Vec3d& p) const {
  return isWhole_ || (p.z >= zMin_ && p.z <= zMax_ && (phiMax_ >= 2 * kPiD || Azimuth(p.x, p.y) <= phiMax_));
}

Quadric::LocalHits Sphere::IntersectLocal(const LocalRay& ray) const {
  // With the point of the line nearest to the centre, the discriminant keeps its digits from afar (pbrt-v4, 6.8.3).
  const double a = LengthSquared(ray.d), b = Dot(ray.o, ray.d);
  const double discriminant = radius_ * radius_ - LengthSquared(ray.o - ray.d * (b / a));
  if (!(discriminant > 0)) return {};
  const double c = LengthSquared(ray.o) - radius_ * radius_;
  const double q = -(b + std::copysign(std::sqrt(a * discriminant), b));
  const double t0 = q / a, t1 = c / q;

  LocalHits hits;
  for (const double t : {std::min(t0, t1), std::max(t0, t1)}) {
    if (!(t > 0 && t < ray.tMax)) continue;
    const Vec3d p = ray.o + ray.d * t;
    if (Contains(p)) hits.Add(t, p);
  }
  return hits;
}

Vec2 Sphere::Encode(const Vec3d& p) const { return OctahedronEncode(p); }
Vec3d Sphere::Decode(const Vec2& code) const { return OctahedronDecode(code) * radius_; }
Vec3d Sphere::Project(const Vec3d& p) const {
  const double length = Length(p);
  return length > 0 ? p * (radius_ / length) : Vec3d(0, 0, radius_);
}

Vec2d Sphere::UvAt(const Vec3d& p) const {
  const double theta = Atan2(std::sqrt(p.x * p.x + p.y * p.y), p.z);
  return {phiMax_ > 0 ? std::min(1.0, Azimuth(p.x, p.y) / phiMax_) : 0,
          thetaZMin_ > thetaZMax_ ? std::clamp((theta - thetaZMin_) / (thetaZMax_ - thetaZMin_), 0.0, 1.0) : 0};
}

Vec2 Sphere::Uv(const PrimitiveHit& hit) const { return ToFloat(UvAt(Decode({hit.b1, hit.b2}))); }

Vec3d Sphere::NormalAt(const Vec3d& p) const { return p / radius_; }

Quadric::LocalDerivatives Sphere::DerivativesAt(const Vec3d& p) const {
  LocalDerivatives local;
  const double across = std::sqrt(p.x * p.x + p.y * p.y);
  const double cosPhi = across > 0 ? p.x / across : 1, sinPhi = across > 0 ? p.y / across : 0;
  // At the poles dpdu would vanish; a tiny one keeps its direction.
  constexpr double kPole = 1e-5;
  const double radiusAround = std::max(across, kPole * radius_);
  local.dpdu = Vec3d(-sinPhi, cosPhi, 0) * (radiusAround * phiMax_);
  local.dpdv = Vec3d(p.z * cosPhi, p.z * sinPhi, -across) * (thetaZMax_ - thetaZMin_);
  local.dndu = local.dpdu / radius_;
  local.dndv = local.dpdv / radius_;
  return local;
}

Vec3d Sphere::SampleLocal(const Vec2d& u) const {
  const double z = zMin_ + u.x * (zMax_ - zMin_);
  const double across = SafeSqrt((radius_ - z) * (radius_ + z));
  const double phi = u.y * phiMax_;
  return {across * std::cos(phi), across * std::sin(phi), z};
}

Vec2d Sphere::InvertLocal(const Vec3d& p) const {
  return {zMax_ > zMin_ ? std::clamp((p.z - zMin_) / (zMax_ - zMin_), 0.0, 1.0) : 0,
          phiMax_ > 0 ? std::min(1.0, Azimuth(p.x, p.y) / phiMax_) : 0};
}

std::optional<ShapeSample> Sphere::SampleSolidAngle(int primitive, const Vec3& reference, const Vec2d& u) const {
  if (!isWhole_) return Quadric::SampleSolidAngle(primitive, reference, u);
  const Vec3d from = ToObject(reference);
  if (!(Length(from) > radius_)) return SampleFromInside(reference, u);
  const Cone cone(from, radius_);
  const Vec3d p = cone.Sample(u);
  ShapeSample sample = SampleAt(p, SolidAngleShrink(p - from) / cone.SolidAngle());
  sample.toPoint = ToRender(p) - ToDouble(reference);
  return sample;
}

std::optional<ShapeSample> Sphere::SampleFromInside(const Vec3& reference, const Vec2d& u) const {
  const Vec3d from = ToObject(reference), w = SampleSphere(u);
  const double distance = DistanceFromInside(from, w, radius_);
  if (!(distance > 0)) return std::nullopt;
  ShapeSample sample = SampleAt(Project(from + w * distance), SolidAngleShrink(w) * kSpherePdf);
  sample.toPoint = ToRenderVector(w) * distance;
  return sample;
}

double Sphere::PdfSolidAngle(int primitive, const Vec3& reference, const Vec3& p, const Vec3& n) const {
  if (!isWhole_) return Quadric::PdfSolidAngle(primitive, reference, p, n);
  const Vec3d from = ToObject(reference), on = Project(ToObject(p));
  if (on == from) return 0;
  const double shrink = SolidAngleShrink(on - from);
  if (!(Length(from) > radius_)) return shrink * kSpherePdf;
  const Cone cone(from, radius_);
  return cone.Sees(on) ? shrink / cone.SolidAngle() : 0;
}

Vec2d Sphere::InvertSolidAngle(int primitive, const Vec3& reference, const Vec3& p) const {
  if (!isWhole_) return Quadric::InvertSolidAngle(primitive, reference, p);
  const Vec3d from = ToObject(reference), on = Project(ToObject(p));
  if (Length(from) > radius_) return Cone(from, radius_).Invert(on);
  return on == from ? Vec2d(0) : InvertSphere(Normalize(on - from));
}

}  // namespace dapple
