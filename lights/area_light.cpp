#include "lights/area_light.h"

#include <cmath>

#include "lights/light_math.h"
#include "src/base/frame.h"
#include "src/sampling/warps.h"

namespace dapple {

namespace {

constexpr double kJustBelowOne = 1 - 1e-9;

Vec3 BoxCorner(const Bounds3& box, int i) {
  return {(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
          (i & 4) != 0 ? box.max.z : box.min.z};
}

bool IsBelowHorizon(const Bounds3& box, const LightContext& at) {
  if (!HasHorizon(at)) return false;
  for (int i = 0; i < 8; ++i) {
    if (!(Dot(BoxCorner(box, i) - at.p, at.n) < 0)) return false;
  }
  return true;
}

double DistanceSquaredTo(const Bounds3& box, const Vec3& p) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    sum += Sqr(static_cast<double>(std::max({box.min[axis] - p[axis], p[axis] - box.max[axis], 0.f})));
  }
  return sum;
}

TextureContext ContextOf(const ShapeSample& point) {
  TextureContext context(point.uv);
  context.p = point.p;
  context.n = point.n;
  return context;
}

}  // namespace

AreaLight::AreaLight(const Shape* shape, const Color& radiance, bool twoSided)
    : AreaLight(shape, std::make_shared<ConstantTexture<Color>>(radiance), twoSided) {}

AreaLight::AreaLight(const Shape* shape, ColorTexturePtr radiance, bool twoSided, FloatTexturePtr alpha)
    : shape_(shape), radiance_(std::move(radiance)), alpha_(std::move(alpha)), twoSided_(twoSided) {
  const int count = shape_->PrimitiveCount();
  std::vector<double> areas;
  for (int i = 0; i < count; ++i) {
    areas.push_back(shape_->PrimitiveArea(i));
    bounds_.extendBy(shape_->PrimitiveBounds(i));
    if (areas.back() > 0 && isUniform_) {
      const double density = shape_->SampleArea(i, Vec2d(0.25, 0.75)).pdf * areas.back();
      const double other = shape_->SampleArea(i, Vec2d(0.75, 0.75)).pdf * areas.back();
      isUniform_ = std::abs(density - 1) < 1e-6 && std::abs(other - 1) < 1e-6;
    }
  }
  const Distribution1D byArea{std::span<const double>(areas)};
  area_ = byArea.Sum();
  // A black light is asked for nothing.
  if (IsEvenlyBright() && EmittedAt(TextureContext()).IsBlack()) return;
  if (count > 1) byArea_ = byArea;
  meanRadiance_ = MeanRadiance();
  plane_ = FindPlane();
  if (!twoSided_ && IsEvenlyBright()) ball_ = shape_->AsBall();
}

Color AreaLight::EmittedAt(const TextureContext& at) const {
  const float coverage = alpha_ ? Coverage(*alpha_, at) : 1;
  return coverage > 0 ? radiance_->Evaluate(at) * coverage : Color();
}

Color AreaLight::MeanRadiance() const {
  if (area_ == 0) return Color();
  if (IsEvenlyBright()) return EmittedAt(TextureContext());
  // Points of a rank-one lattice (Roberts's generalised golden ratio) over each stratum of the choice of primitive.
  constexpr int kPoints = 1 << 14;
  Vec3d sum(0);
  for (int i = 0; i < kPoints; ++i) {
    const Primitive primitive = ChoosePrimitive((i + 0.5) / kPoints);
    const double x = i * 0.7548776662466927, y = i * 0.5698402909980532;
    const ShapeSample point = shape_->SampleArea(primitive.index, Vec2d(x - std::floor(x), y - std::floor(y)));
    const double pdf = primitive.probability * point.pdf;
    if (!(pdf > 0)) continue;
    const Color L = EmittedAt(ContextOf(point));
    sum += Vec3d(L.r, L.g, L.b) / (pdf * area_);
  }
  const Vec3 mean = ToFloat(sum / kPoints);
  return {mean.x, mean.y, mean.z};
}

std::optional<AreaLight::Plane> AreaLight::FindPlane() const {
  constexpr int kMostPrimitives = 256;
  if (twoSided_ || area_ == 0 || shape_->PrimitiveCount() > kMostPrimitives) return std::nullopt;
  std::optional<Plane> plane;
  for (int i = 0; i < shape_->PrimitiveCount(); ++i) {
    if (shape_->PrimitiveArea(i) <= 0) continue;
    for (const Vec2d& u : {Vec2d(0, 0), Vec2d(kJustBelowOne, 0), Vec2d(0, kJustBelowOne),
                           Vec2d(kJustBelowOne, kJustBelowOne), Vec2d(0.4, 0.6)}) {
      const ShapeSample point = shape_->SampleArea(i, u);
      if (!plane) plane = Plane{point.n, kInfinity};
      if (LengthSquared(point.n - plane->normal) > 1e-10f) return std::nullopt;
      plane->offset = std::min(plane->offset, Dot(plane->normal, point.p) - point.pError);
    }
  }
  // Rounding of the points, and what the normals may still differ by.
  if (plane) plane->offset -= 1e-4f * Length(bounds_.size()) + 1e-6f * std::abs(plane->offset);
  return plane;
}

Color AreaLight::Power() const { return FiniteColor(meanRadiance_, kPiD * area_ * (twoSided_ ? 2 : 1)); }

double AreaLight::ImportanceAt(const LightContext& at) const {
  if (area_ == 0 || IsBelowHorizon(bounds_, at)) return 0;
  if (plane_ && Dot(plane_->normal, at.p) < plane_->offset) return 0;
  // The irradiance of a disk of this area that faces the point, at the distance of the nearest point of the box.
  const double disk = area_ / (DistanceSquaredTo(bounds_, at.p) + area_ / kPiD);
  return static_cast<double>(meanRadiance_.MaxComponent()) * disk;
}

AreaLight::Primitive AreaLight::ChoosePrimitive(double u) const {
  if (byArea_.Size() == 0) return {0, 1};
  const DiscreteSample drawn = byArea_.SampleDiscrete(u);
  return {drawn.index, drawn.probability};
}

std::optional<LiSample> AreaLight::Sample_Li(const LightContext& at, const LiRandom& u) const {
  if (area_ == 0) return std::nullopt;
  const Primitive primitive = ChoosePrimitive(u.part);
  const std::optional<ShapeSample> point = shape_->SampleSolidAngle(primitive.index, at.p, u.direction);
  if (!point || !(point->pdf > 0)) return std::nullopt;
  LiSample sample;
  const bool isExact = LengthSquared(point->toPoint) > 0;
  const Vec3d toLight = isExact ? point->toPoint : ToDouble(point->p) - ToDouble(at.p);
  if (LengthSquared(toLight) == 0) return std::nullopt;
  sample.wi = ToFloat(Normalize(toLight));
  if (!twoSided_ && Dot(point->n, sample.wi) >= 0) return std::nullopt;
  sample.L = EmittedAt(ContextOf(*point));
  if (sample.L.IsBlack()) return std::nullopt;
  sample.pdf = primitive.probability * point->pdf;
  sample.p = point->p;
  sample.pError = point->pError;
  sample.n = point->n;
  sample.primitive = primitive.index;
  return sample;
}

double AreaLight::Pdf_Li(const LightContext& at, const Vec3&, const SurfaceInteraction* hit) const {
  if (area_ == 0) return 0;
  return PrimitiveProbability(hit->primitive) * shape_->PdfSolidAngle(hit->primitive, at.p, hit->p, hit->ng);
}

LiRandom AreaLight::Invert_Li(const LightContext& at, const Vec3&, const SurfaceInteraction* hit) const {
  LiRandom u;
  u.part = InvertPrimitive(hit->primitive);
  u.direction = shape_->InvertSolidAngle(hit->primitive, at.p, hit->p);
  return u;
}

std::optional<LeSample> AreaLight::SampleBall(const LeRandom& u) const {
  const Vec3d d = SampleSphere(u.direction);
  Vec3d s, t;
  CoordinateSystem(d, &s, &t);
  const Vec3d local = SampleCosineHemisphere(u.position);
  const Vec3d n = s * local.x + t * local.y + d * local.z;
  // The shape's own point knows its rounding.
  const ShapeSample point = shape_->SampleArea(0, shape_->InvertArea(0, ToFloat(ball_->center + n * ball_->radius)));
  LeSample sample;
  sample.Le = meanRadiance_;
  sample.n = point.n;
  const Vec3 w = ToFloat(d);
  const float cosTheta = Dot(point.n, w);
  sample.pdfPos = 1 / area_;
  sample.pdfDir = DirectionPdf(cosTheta);
  if (sample.Le.IsBlack() || sample.pdfDir == 0) return std::nullopt;
  sample.ray = Ray{OffsetOrigin(point.p, point.pError, point.n, w), w};
  sample.cosTheta = cosTheta;
  return sample;
}

std::optional<LeSample> AreaLight::Sample_Le(const LeRandom& u) const {
  if (area_ == 0) return std::nullopt;
  if (ball_) return SampleBall(u);
  const Primitive primitive = ChoosePrimitive(u.part);
  const ShapeSample point = shape_->SampleArea(primitive.index, u.position);
  if (!(point.pdf > 0)) return std::nullopt;
  // The halves of the first random number of a two-sided light are its sides.
  Vec2d direction = u.direction;
  const bool isBack = twoSided_ && direction.x >= 0.5;
  if (twoSided_) direction.x = 2 * direction.x - (isBack ? 1 : 0);
  Vec3d local = SampleCosineHemisphere(direction);
  if (isBack) local.z = -local.z;
  const Vec3 d = Normalize(Frame::FromZ(point.n).ToWorld(ToFloat(local)));

  LeSample sample;
  sample.Le = EmittedAt(ContextOf(point));
  const float cosTheta = Dot(point.n, d);
  sample.pdfPos = isUniform_ ? 1 / area_ : primitive.probability * point.pdf;
  sample.pdfDir = DirectionPdf(cosTheta);
  if (sample.Le.IsBlack() || sample.pdfDir == 0) return std::nullopt;
  sample.ray = Ray{OffsetOrigin(point.p, point.pError, point.n, d), d};
  sample.n = point.n;
  sample.cosTheta = std::abs(cosTheta);
  sample.primitive = primitive.index;
  return sample;
}

double AreaLight::DirectionPdf(float cosTheta) const {
  const double c = static_cast<double>(cosTheta);
  return twoSided_ ? std::abs(c) * (kDiskPdf / 2) : CosineHemispherePdf(c);
}

LePdf AreaLight::Pdf_Le(const Ray& ray, const LightPoint& from) const {
  if (area_ == 0) return {};
  double position = 1 / area_;
  if (!isUniform_) {
    const int primitive = PrimitiveOf(from, ray.o);
    position = PrimitiveProbability(primitive) * shape_->PdfArea(primitive, ray.o);
  }
  return {position, DirectionPdf(Dot(from.n, ray.d))};
}

LeRandom AreaLight::Invert_Le(const Ray& ray, const LightPoint& from) const {
  const int primitive = PrimitiveOf(from, ray.o);
  LeRandom u;
  u.part = InvertPrimitive(primitive);
  if (ball_) {
    const Vec3d d = ToDouble(ray.d), normal = ToDouble(from.n);
    Vec3d s, t;
    CoordinateSystem(d, &s, &t);
    u.direction = InvertSphere(d);
    u.position = InvertCosineHemisphere(Vec3d(Dot(normal, s), Dot(normal, t), Dot(normal, d)));
    return u;
  }
  u.position = shape_->InvertArea(primitive, ray.o);
  const Vec3 local = Frame::FromZ(from.n).ToLocal(ray.d);
  u.direction = InvertCosineHemisphere(ToDouble(local));
  if (twoSided_) u.direction.x = (u.direction.x + (local.z < 0 ? 1 : 0)) / 2;
  return u;
}

int AreaLight::PrimitiveOf(const LightPoint& from, const Vec3& p) const {
  if (from.primitive >= 0) return from.primitive;
  int nearest = 0;
  double nearestDistance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < byArea_.Size(); ++i) {
    if (byArea_.Probability(i) == 0 || DistanceSquaredTo(shape_->PrimitiveBounds(i), p) >= nearestDistance) continue;
    const Vec3 onPrimitive = shape_->SampleArea(i, shape_->InvertArea(i, p)).p;
    const double distance = LengthSquared(ToDouble(onPrimitive) - ToDouble(p));
    if (distance < nearestDistance) {
      nearest = i;
      nearestDistance = distance;
    }
  }
  return nearest;
}

Color AreaLight::L(const SurfaceInteraction& hit, const Vec3& w) const {
  if (!twoSided_ && !(Dot(hit.ng, w) > 0)) return Color();
  TextureContext context(hit.uv);
  context.p = hit.p;
  context.n = hit.ng;
  return !alpha_ || Coverage(*alpha_, context) > 0 ? radiance_->Evaluate(context) : Color();
}

}  // namespace dapple
