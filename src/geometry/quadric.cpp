#include "src/geometry/quadric.h"

#include "src/base/error.h"
#include "src/geometry/surface_math.h"

namespace dapple {
namespace {

bool KeepsShapes(const Affine& transform) {
  const auto& [x, y, z, translation] = transform;
  const double scale = LengthSquared(x);
  constexpr double kTolerance = 1e-9;
  const double worst = std::max({std::abs(LengthSquared(y) - scale), std::abs(LengthSquared(z) - scale),
                                 std::abs(Dot(x, y)), std::abs(Dot(y, z)), std::abs(Dot(z, x))});
  return worst <= kTolerance * scale;
}

}  // namespace

Quadric::Quadric(const Transform& objectToRender, bool reverseOrientation, const Vec3d& flatExtent)
    : objectToRender_(objectToRender),
      renderToObject_(objectToRender.Inverse()),
      reverseOrientation_(reverseOrientation),
      isSimilarity_(KeepsShapes(objectToRender_)),
      absDeterminant_(std::abs(objectToRender_.Determinant())) {
  if (objectToRender.IsSingular() || !(absDeterminant_ > 0) || !std::isfinite(absDeterminant_))
    throw Error("shape: its transform is singular: expected one that can be inverted");
  const double condition = std::sqrt(objectToRender_.NormSquared() * renderToObject_.NormSquared());
  doubleError_ = 0x1p-50 * condition;
  for (int axis = 0; axis < 3; ++axis)
    flatExtent_[axis] = std::abs(objectToRender_.x[axis]) * flatExtent.x +
                        std::abs(objectToRender_.y[axis]) * flatExtent.y +
                        std::abs(objectToRender_.z[axis]) * flatExtent.z;
}

double Quadric::AreaStretch(const Vec3d& n) const { return absDeterminant_ * Length(renderToObject_.Transposed(n)); }

double Quadric::SolidAngleShrink(const Vec3d& w) const {
  const double stretch = Length(objectToRender_.Vector(w)) / Length(w);
  return stretch * stretch * stretch / absDeterminant_;
}

Vec3d Quadric::RenderNormal(const Vec3d& n) const {
  const Vec3d outside = Normalize(renderToObject_.Transposed(n));
  return reverseOrientation_ ? -outside : outside;
}

float Quadric::PointError(const Vec3d& p, const Vec3d& n) const {
  const double inDouble = doubleError_ * (MaxAbsComponent(p) + MaxAbsComponent(objectToRender_.translation));
  return RoundUp(RoundingAlong(n, p, flatExtent_) + inDouble);
}

Bounds3 Quadric::EllipsoidBounds(double radius) const {
  Bounds3 bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3d row(objectToRender_.At(axis, 0), objectToRender_.At(axis, 1), objectToRender_.At(axis, 2));
    const double reach = radius * Length(row);
    bounds.min[axis] = NextFloatDown(static_cast<float>(objectToRender_.translation[axis] - reach));
    bounds.max[axis] = NextFloatUp(static_cast<float>(objectToRender_.translation[axis] + reach));
  }
  return bounds;
}

Bounds3 Quadric::BoundsOf(const Vec3d& low, const Vec3d& high) const {
  Bounds3d box;
  for (int corner = 0; corner < 8; ++corner)
    box.extendBy(
        objectToRender_.Point({corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z}));
  Bounds3 bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.min[axis] = NextFloatDown(static_cast<float>(box.min[axis]));
    bounds.max[axis] = NextFloatUp(static_cast<float>(box.max[axis]));
  }
  return bounds;
}

void Quadric::AppendRevolved(std::span<const Vec2d> profile, double phiMax, std::vector<HullBall>* hull) const {
  for (const Vec2d& corner : TangentPolygon(0, phiMax))
    for (const Vec2d& p : profile)
      hull->push_back(EnclosingHullBall(objectToRender_.Point({p.x * corner.x, p.x * corner.y, p.y}), 0));
}

PrimitiveHits Quadric::IntersectAll(const Ray& ray, int primitive) const {
  const LocalHits local = IntersectLocal({ToObject(ray.o), renderToObject_.Vector(ToDouble(ray.d)), ray.tMax});
  PrimitiveHits hits;
  for (int i = 0; i < local.count; ++i) {
    const Vec2 code = Encode(local.p[i]);
    hits.hits[hits.count++] = {static_cast<float>(local.t[i]), code.x, code.y, primitive};
  }
  return hits;
}

SurfaceInteraction Quadric::Interact(const Ray& ray, const PrimitiveHit& hit) const {
  const Vec3d localPoint = Decode({hit.b1, hit.b2});
  const LocalDerivatives local = DerivativesAt(localPoint);
  const Vec3d p = objectToRender_.Point(localPoint);
  const Vec3d scaledNormal = renderToObject_.Transposed(NormalAt(localPoint));
  const double sign = reverseOrientation_ ? -1 : 1;
  const Vec3d n = Normalize(scaledNormal) * sign;

  SurfaceInteraction interaction;
  interaction.p = ToFloat(p);
  interaction.pError = PointError(p, n);
  interaction.ng = interaction.ns = ToFloat(n);
  interaction.wo = -Normalize(ray.d);
  interaction.uv = ToFloat(UvAt(localPoint));
  interaction.dpdu = interaction.dpdus = ToFloat(objectToRender_.Vector(local.dpdu));
  interaction.dpdv = interaction.dpdvs = ToFloat(objectToRender_.Vector(local.dpdv));
  interaction.dndu = ToFloat(NormalizedDerivative(scaledNormal, renderToObject_.Transposed(local.dndu)) * sign);
  interaction.dndv = ToFloat(NormalizedDerivative(scaledNormal, renderToObject_.Transposed(local.dndv)) * sign);
  interaction.t = hit.t;
  interaction.primitive = hit.primitive;
  return interaction;
}

ShapeSample Quadric::SampleAt(const Vec3d& local, double pdf) const {
  const Vec3d p = objectToRender_.Point(local), n = RenderNormal(NormalAt(local));
  return {ToFloat(p), PointError(p, n), ToFloat(n), ToFloat(UvAt(local)), pdf};
}

ShapeSample Quadric::SampleArea(int, const Vec2d& u) const {
  const Vec3d p = SampleLocal(u);
  const double area = LocalArea();
  return SampleAt(p, area > 0 ? 1 / (area * AreaStretch(NormalAt(p))) : 0);
}

double Quadric::PdfArea(int, const Vec3& p) const {
  const double area = LocalArea();
  return area > 0 ? 1 / (area * AreaStretch(NormalAt(Project(ToObject(p))))) : 0;
}

Vec2d Quadric::InvertArea(int, const Vec3& p) const { return InvertLocal(Project(ToObject(p))); }

std::optional<ShapeSample> Quadric::SampleSolidAngle(int primitive, const Vec3& reference, const Vec2d& u) const {
  ShapeSample sample = SampleArea(primitive, u);
  sample.pdf = Quadric::PdfSolidAngle(primitive, reference, sample.p, sample.n);
  return sample.pdf > 0 ? std::optional(sample) : std::nullopt;
}

double Quadric::PdfSolidAngle(int primitive, const Vec3& reference, const Vec3& p, const Vec3&) const {
  // The surface's own normal: the caller's, rounded to float, would not do where the surface is seen edge-on.
  const Vec3d n = renderToObject_.Transposed(NormalAt(Project(ToObject(p))));
  return AreaToSolidAngle(PdfArea(primitive, p), ToDouble(p) - ToDouble(reference), n);
}

Vec2d Quadric::InvertSolidAngle(int primitive, const Vec3&, const Vec3& p) const { return InvertArea(primitive, p); }

}  // namespace dapple
