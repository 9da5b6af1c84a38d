#include "tests/lights/light_checks.h"

#include <cmath>

#include <fmt/format.h>

#include "src/base/numerics.h"
#include "src/sampling/warps.h"
#include "tests/support/chi_square.h"

namespace dapple {

namespace {

using testing::ChiSquare;
using testing::ConeDomain;
using testing::Coordinates;
using testing::DiskDomain;
using testing::UniformNumbers;

constexpr int kComponent = 1;  // green stands for all in statistics
constexpr int kSamples = 20'000;

const Frame kSkew = Frame::FromZ(Normalize(Vec3(1, 2, 3)));  // no light's own axes

Verdict VerdictOf(const ChiSquare& fit) { return {fit.Passes(), fit.message}; }

Verdict Passed() { return {}; }

/// The points of a shape as (part, u, v) of equal measure in the random numbers of `SampleArea`.
class SurfaceDomain {
 public:
  explicit SurfaceDomain(const Shape& shape) : shape_(shape) {}

  int Parts() const { return shape_.PrimitiveCount(); }

  /// `area`: of the surface, for each unit of the coordinates' volume.
  SurfaceInteraction Point(const Coordinates<3>& x, double* area) const {
    const int part = std::min(static_cast<int>(x[0] * Parts()), Parts() - 1);
    const ShapeSample point = shape_.SampleArea(part, {x[1], x[2]});
    SurfaceInteraction at;
    at.p = point.p, at.pError = point.pError, at.ng = at.ns = point.n, at.uv = point.uv, at.primitive = part;
    *area = point.pdf > 0 ? Parts() / point.pdf : 0;
    return at;
  }

  Coordinates<3> CoordinatesOf(const Vec3& p) const {
    int nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < Parts(); ++i) {
      const Vec3 on = shape_.SampleArea(i, shape_.InvertArea(i, p)).p;
      const double distance = LengthSquared(ToDouble(on) - ToDouble(p));
      if (distance < least) least = distance, nearest = i;
    }
    const Vec2d u = shape_.InvertArea(nearest, p);
    return {(nearest + 0.5) / Parts(), u.x, u.y};
  }

 private:
  const Shape& shape_;
};

/// The rays of a light: origins by SurfaceDomain, or over the disk across the scene, or one; directions in the frame of
/// the surface, or in one of their own.
class RayDomain {
 public:
  explicit RayDomain(const TestedLight& tested) : tested_(tested) {
    RandomNumbers random(31);
    Vec3d sum(0);
    std::vector<Vec3> directions;
    for (int i = 0; i < 1000; ++i) {
      const std::optional<LeSample> sample = tested.light.Sample_Le(random.Le());
      if (!sample) continue;
      one_ = *sample;
      directions.push_back(sample->ray.d);
      sum += ToDouble(sample->ray.d);
    }
    if (!HasDiscreteOrigin()) return;
    // The cone that holds them all, as the light's may be too narrow for cells of the sphere.
    const Frame frame = Frame::FromZ(ToFloat(Normalize(sum)));
    double widest = 0;
    for (const Vec3& d : directions) widest = std::max(widest, (*ConeDomain(2, frame).CoordinatesOf(ToDouble(d)))[0]);
    cone_ = widest > 0.3 ? ConeDomain(2, kSkew) : ConeDomain(4 * widest, frame);
  }

  bool HasDiscreteOrigin() const { return one_.deltaPos; }
  bool HasDiscreteDirection() const { return one_.deltaDir; }
  /// Any ray of the light.
  const LeSample& One() const { return one_; }
  /// Where directions may lie; of lights with a surface, around its normal.
  const ConeDomain& Cone() const { return cone_; }
  int Parts() const { return tested_.shape ? SurfaceDomain(*tested_.shape).Parts() : 1; }

  std::optional<Coordinates<3>> OriginOf(const LeSample& sample) const {
    if (tested_.shape) return SurfaceDomain(*tested_.shape).CoordinatesOf(sample.ray.o);
    const EmissionDisk disk = DiskAcross(-sample.ray.d);
    const Vec3d offset = (ToDouble(sample.ray.o) - disk.center) / disk.radius;
    const auto x = DiskDomain::CoordinatesOf({Dot(offset, disk.s), Dot(offset, disk.t)});
    if (!x) return std::nullopt;
    return Coordinates<3>{0.5, (*x)[0], (*x)[1]};
  }

  std::optional<Coordinates<2>> DirectionOf(const LeSample& sample) const {
    const ConeDomain cone = tested_.shape ? ConeDomain(2, Frame::FromZ(sample.n)) : cone_;
    return cone.CoordinatesOf(ToDouble(sample.ray.d));
  }

  /// The densities of the ray at these coordinates, each per unit volume of its own.
  LePdf Density(const Coordinates<3>& origin, const Coordinates<2>& direction) const {
    if (tested_.shape) {
      double area;
      const SurfaceInteraction at = SurfaceDomain(*tested_.shape).Point(origin, &area);
      const ConeDomain sphere(2, Frame::FromZ(at.ng));
      const Vec3 d = ToFloat(sphere.Point(direction[0], direction[1]));
      const LePdf pdf = tested_.light.Pdf_Le(Ray{at.p, d}, {at.ng, at.primitive});
      return {pdf.position * area, pdf.direction * sphere.SolidAngle()};
    }
    const Vec3 d = HasDiscreteDirection() ? one_.ray.d : ToFloat(cone_.Point(direction[0], direction[1]));
    Vec3 o = one_.ray.o;
    double originMeasure = 1;
    if (!HasDiscreteOrigin()) {
      const EmissionDisk disk = DiskAcross(-d);
      const Vec2d p = DiskDomain::Point(origin[1], origin[2]);
      o = ToFloat(disk.center + (disk.s * p.x + disk.t * p.y) * disk.radius);
      originMeasure = disk.Area();
    }
    const LePdf pdf = tested_.light.Pdf_Le(Ray{o, d}, {});
    return {pdf.position * originMeasure, pdf.direction * (HasDiscreteDirection() ? 1 : cone_.SolidAngle())};
  }

 private:
  TestedLight tested_;
  LeSample one_;
  ConeDomain cone_{2, kSkew};
};

Verdict CheckDirectionsToSurface(const TestedLight& tested, const LightContext& at) {
  const SurfaceDomain surface(*tested.shape);
  const auto sample = [&](UniformNumbers& random) -> std::optional<Coordinates<3>> {
    const std::optional<LiSample> drawn = tested.light.Sample_Li(at, DrawLi(random));
    return drawn ? std::optional(surface.CoordinatesOf(drawn->p)) : std::nullopt;
  };
  const auto density = [&](const Coordinates<3>& x) {
    double area;
    const SurfaceInteraction hit = surface.Point(x, &area);
    const Vec3d toLight = ToDouble(hit.p) - ToDouble(at.p);
    const Vec3 wi = ToFloat(Normalize(toLight));
    if (tested.light.L(hit, -wi).IsBlack()) return 0.0;  // draws that bring nothing are left out
    const double cosTheta = AbsDot(ToDouble(hit.ng), Normalize(toLight));
    return tested.light.Pdf_Li(at, wi, &hit) * cosTheta / LengthSquared(toLight) * area;
  };
  return VerdictOf(testing::ChiSquareOnCube<3>(sample, density, {surface.Parts(), 6, 8}, kSamples, 21));
}

/// The integral over the unit square.
template <typename F>
double IntegrateSquare(const F& f, double tolerance) {
  constexpr int kCells = 8, kDepth = 12;
  double sum = 0;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const testing::Box<2> cell = {{static_cast<double>(i) / kCells, static_cast<double>(j) / kCells},
                                    {static_cast<double>(i + 1) / kCells, static_cast<double>(j + 1) / kCells}};
      sum += testing::Integrate<2>(f, cell, tolerance / (kCells * kCells), kDepth);
    }
  }
  return sum;
}

/// The integral over the cone of directions.
template <typename F>
double IntegrateCone(const ConeDomain& cone, const F& f, double tolerance) {
  return IntegrateSquare([&](const Coordinates<2>& x) { return f(cone.Point(x[0], x[1])) * cone.SolidAngle(); },
                         tolerance);
}

/// What the light emits by its own account of radiance.
double EmissionByQuadrature(const TestedLight& tested, double tolerance) {
  const RayDomain rays(tested);
  if (tested.shape) {
    // Area lights are diffuse: pi times the radiance of each side.
    const SurfaceDomain surface(*tested.shape);
    double sum = 0;
    for (int part = 0; part < surface.Parts(); ++part) {
      const auto emitted = [&](const Coordinates<2>& x) {
        double area;
        const SurfaceInteraction at = surface.Point({(part + 0.5) / surface.Parts(), x[0], x[1]}, &area);
        const Color L = tested.light.L(at, at.ng) + tested.light.L(at, -at.ng);
        return kPiD * static_cast<double>(L[kComponent]) * area / surface.Parts();
      };
      sum += IntegrateSquare(emitted, tolerance / surface.Parts());
    }
    return sum;
  }
  // Light that arrives at `p`.
  const auto arriving = [&](const Vec3& p) {
    const std::optional<LiSample> sample = tested.light.Sample_Li(LightContext(p), {});
    return sample ? static_cast<double>(sample->L[kComponent]) : 0;
  };
  if (rays.HasDiscreteOrigin()) {
    // Intensity, by the irradiance on a sphere around the light.
    constexpr double kDistance = 16;
    const Vec3d origin = ToDouble(rays.One().ray.o);
    const auto intensity = [&](const Vec3d& w) { return arriving(ToFloat(origin + w * kDistance)) * Sqr(kDistance); };
    return IntegrateCone(rays.Cone(), intensity, tolerance);
  }
  const auto area = [](const Vec3& w) { return DiskAcross(w).Area(); };
  if (rays.HasDiscreteDirection()) return arriving(kTestExtent.center) * area(-rays.One().ray.d);
  const auto throughDisk = [&](const Vec3d& w) {
    const Vec3 direction = ToFloat(w);
    return static_cast<double>(tested.light.Le(Ray{kTestExtent.center, direction})[kComponent]) * area(direction);
  };
  return IntegrateCone(rays.Cone(), throughDisk, tolerance);
}

/// 5 standard errors, and what float arithmetic may add. With some hundred comparisons a false alarm has a probability
/// below 1e-4, and the seeds are fixed.
double Margin(double standardError, double value) { return 5 * standardError + 2e-5 * std::abs(value); }

constexpr int kPatchSamples = 12'000;

Mean FluxByRays(const TestedLight& tested, const Patch& patch) {
  RandomNumbers random(18);
  Mean flux;
  for (int i = 0; i < kPatchSamples; ++i) {
    const std::optional<LeSample> sample = tested.light.Sample_Le(random.Le());
    double received = 0;
    if (sample && Dot(sample->ray.d, patch.frame.n) < 0) {
      const float t = Dot(patch.center - sample->ray.o, patch.frame.n) / Dot(sample->ray.d, patch.frame.n);
      const bool hits = t > 0 && Distance(sample->ray(t), patch.center) < patch.radius;
      // Convex or not: the light's own shape may stand in the way.
      const bool isOpen = !tested.shape || !FirstHit(*tested.shape, Ray{sample->ray.o, sample->ray.d, t});
      if (hits && isOpen) received = static_cast<double>(sample->Flux()[kComponent]);
    }
    flux.Add(received);
  }
  return flux;
}

Mean FluxByDirections(const TestedLight& tested, const Patch& patch, const LightContext& receiver) {
  RandomNumbers random(19);
  LightContext at = receiver;
  at.n = patch.frame.n;
  Mean flux;
  const double area = kPiD * Sqr(static_cast<double>(patch.radius));
  for (int i = 0; i < kPatchSamples; ++i) {
    const Vec2d d = SampleDiskConcentric(random.Get2D()) * static_cast<double>(patch.radius);
    const Vec3 p = patch.center + patch.frame.s * static_cast<float>(d.x) + patch.frame.t * static_cast<float>(d.y);
    at.p = p;
    const std::optional<LiSample> sample = tested.light.Sample_Li(at, random.Li());
    double irradiance = 0;
    if (sample) {
      const double cosTheta = std::max(0.0, Dot(ToDouble(sample->wi), ToDouble(patch.frame.n)));
      const bool isOpen =
          !tested.shape || !FirstHit(*tested.shape, Ray{p, sample->wi, Distance(p, sample->p) * 0.999f});
      if (isOpen) irradiance = static_cast<double>(sample->L[kComponent]) * cosTheta / sample->pdf;
    }
    flux.Add(irradiance * area);
  }
  return flux;
}

/// Draws toward the light against `Pdf_Li` and the radiance looked up.
Verdict LookUpDirections(const TestedLight& tested, const LightContext& at, bool isTextured) {
  RandomNumbers random(16);
  for (int i = 0; i < 300 && !tested.light.IsDelta(); ++i) {
    const std::optional<LiSample> sample = tested.light.Sample_Li(at, random.Li());
    if (!sample) continue;
    std::optional<SurfaceInteraction> hit;
    if (tested.shape) {
      // The ray may meet another part of the same shape first, or pass its rim.
      hit = FirstHit(*tested.shape, Ray{at.p, sample->wi});
      if (!hit || Distance(hit->p, sample->p) > 1e-3f || AbsDot(sample->n, sample->wi) < 0.02f) continue;
    }
    const double pdf = tested.light.Pdf_Li(at, sample->wi, hit ? &*hit : nullptr);
    if (!(std::abs(pdf / sample->pdf - 1) <= (hit ? 2e-3 : 0)))
      return {false, fmt::format("toward the light: density {} drawn, {} asked", sample->pdf, pdf)};
    const Color L = hit ? tested.light.L(*hit, -sample->wi) : tested.light.Le(Ray{at.p, sample->wi});
    if (!isTextured && L != sample->L)
      return {false, fmt::format("toward the light: radiance {} drawn, {} looked up", sample->L.g, L.g)};
  }
  return Passed();
}

}  // namespace

EmissionDisk DiskAcross(const Vec3& w) {
  static const EmissionDisks disks(kTestExtent);
  return disks.Toward(w);
}

std::vector<LightContext> TestContexts() {
  return {LightContext({0, 0, 0}), LightContext({0.1f, 0.2f, 0}, {0, 0, 1}, false), LightContext({0.6f, 0.3f, 1.9f}),
          LightContext({0.2f, 0.2f, 3.5f}, {0, 0, -1}, true),
          LightContext({-3, 1, 1.75f}, Normalize(Vec3(1, 0, 0.5f)), false)};
}

Verdict CheckDirectionsToLight(const TestedLight& tested, const LightContext& at) {
  if (tested.light.IsDelta()) return Passed();
  if (tested.shape) return CheckDirectionsToSurface(tested, at);
  const auto sample = [&](UniformNumbers& random) -> std::optional<Vec3d> {
    const std::optional<LiSample> drawn = tested.light.Sample_Li(at, DrawLi(random));
    return drawn ? std::optional(ToDouble(drawn->wi)) : std::nullopt;
  };
  const auto pdf = [&](const Vec3d& w) {
    const Vec3 wi = ToFloat(w);
    return tested.light.Le(Ray{at.p, wi}).IsBlack() ? 0 : tested.light.Pdf_Li(at, wi, nullptr);
  };
  const testing::ChiSquareOptions options{.samples = kSamples, .rows = 8, .columns = 12, .seed = 22};
  return VerdictOf(testing::ChiSquareOnCone(sample, pdf, ConeDomain(2, kSkew), options));
}

Verdict CheckRayOrigins(const TestedLight& tested) {
  const RayDomain rays(tested);
  if (rays.HasDiscreteOrigin()) return Passed();
  const auto sample = [&](UniformNumbers& random) -> std::optional<Coordinates<3>> {
    const std::optional<LeSample> drawn = tested.light.Sample_Le(DrawLe(random));
    return drawn ? rays.OriginOf(*drawn) : std::nullopt;
  };
  const auto density = [&](const Coordinates<3>& x) { return rays.Density(x, {0.25, 0.25}).position; };
  return VerdictOf(testing::ChiSquareOnCube<3>(sample, density, {rays.Parts(), 6, 8}, kSamples, 23));
}

Verdict CheckRayDirections(const TestedLight& tested) {
  const RayDomain rays(tested);
  if (rays.HasDiscreteDirection()) return Passed();
  const auto sample = [&](UniformNumbers& random) -> std::optional<Coordinates<2>> {
    const std::optional<LeSample> drawn = tested.light.Sample_Le(DrawLe(random));
    return drawn ? rays.DirectionOf(*drawn) : std::nullopt;
  };
  const auto density = [&](const Coordinates<2>& x) { return rays.Density({0.5, 0.5, 0.5}, x).direction; };
  return VerdictOf(testing::ChiSquareOnCube<2>(sample, density, {8, 12}, kSamples, 24));
}

Verdict CheckRays(const TestedLight& tested) {
  const RayDomain rays(tested);
  if (rays.HasDiscreteOrigin() || rays.HasDiscreteDirection()) return Passed();  // one half is all there is
  const auto sample = [&](UniformNumbers& random) -> std::optional<Coordinates<4>> {
    const std::optional<LeSample> drawn = tested.light.Sample_Le(DrawLe(random));
    if (!drawn) return std::nullopt;
    const auto origin = rays.OriginOf(*drawn);
    const auto direction = rays.DirectionOf(*drawn);
    if (!origin || !direction) return std::nullopt;
    return Coordinates<4>{(*origin)[1], (*origin)[2], (*direction)[0], (*direction)[1]};
  };
  const auto density = [&](const Coordinates<4>& x) {
    double sum = 0;
    for (int part = 0; part < rays.Parts(); ++part) {
      const LePdf pdf = rays.Density({(part + 0.5) / rays.Parts(), x[0], x[1]}, {x[2], x[3]});
      sum += pdf.position * pdf.direction / rays.Parts();
    }
    return sum;
  };
  return VerdictOf(testing::ChiSquareOnProduct(sample, density, {2, 2, 6, 10}, kSamples, 25));
}

Verdict CheckEnergy(const TestedLight& tested, double quadratureError) {
  RandomNumbers random(11);
  Mean flux;
  for (int i = 0; i < kSamples; ++i) {
    const std::optional<LeSample> sample = tested.light.Sample_Le(random.Le());
    flux.Add(sample ? static_cast<double>(sample->Flux()[kComponent]) : 0);
  }
  const double power = static_cast<double>(tested.light.Power()[kComponent]);
  const double quadrature = EmissionByQuadrature(tested, 5e-5 * power);
  const std::string message =
      fmt::format("mean flux {} +- {}, power {}, quadrature {}", flux.Value(), flux.StandardError(), power, quadrature);
  const double error = quadratureError * power;
  const bool isPower = std::abs(flux.Value() - power) <= Margin(flux.StandardError(), power) + error;
  return {power > 0 && isPower && std::abs(quadrature - power) <= error, message};
}

std::vector<Patch> TestPatches(const TestedLight& tested) {
  std::vector<Patch> patches = {{Vec3(0.25f, 0, 0), Frame::FromZ(Normalize(Vec3(0.1f, 0, 1))), 1.5f},
                                {Vec3(0.5f, 0, 3.25f), Frame::FromZ(Normalize(Vec3(0, 0.2f, -1))), 1.f}};
  // In the plane z = 0, around the mean of where rays fall, as wide as they scatter.
  RandomNumbers random(17);
  Mean x, y;
  for (int i = 0; i < 1000; ++i) {
    const std::optional<LeSample> sample = tested.light.Sample_Le(random.Le());
    if (!sample || !(sample->ray.d.z < 0) || !(sample->ray.o.z > 0)) continue;
    const Vec3 p = sample->ray(sample->ray.o.z / -sample->ray.d.z);
    if (Length(p) > kTestExtent.radius) continue;
    x.Add(static_cast<double>(p.x)), y.Add(static_cast<double>(p.y));
  }
  if (x.Count() < 10) return patches;
  const double scatter = std::hypot(x.StandardDeviation(), y.StandardDeviation());
  if (scatter < 0.01) patches.clear();  // so narrow that points drawn on the others would not find it
  patches.push_back({ToFloat(Vec3d(x.Value(), y.Value(), 0)), Frame(), static_cast<float>(std::min(1.5, 2 * scatter))});
  return patches;
}

Verdict CheckBothSides(const TestedLight& tested, const Patch& patch, const LightContext& receiver) {
  const Mean rays = FluxByRays(tested, patch), directions = FluxByDirections(tested, patch, receiver);
  const double margin = Margin(std::hypot(rays.StandardError(), directions.StandardError()), rays.Value());
  return {std::abs(rays.Value() - directions.Value()) <= margin,
          fmt::format("flux by rays {}, by directions {}, margin {}", rays.Value(), directions.Value(), margin)};
}

Verdict CheckLookup(const TestedLight& tested, double spread, bool isTextured) {
  for (const LightContext& at : TestContexts()) {
    const Verdict directions = LookUpDirections(tested, at, isTextured);
    if (!directions.passes) return directions;
  }
  RandomNumbers random(12);
  Mean flux;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::optional<LeSample> sample = tested.light.Sample_Le(random.Le());
    if (!sample) continue;
    const LePdf pdf = tested.light.Pdf_Le(sample->ray, sample->From());
    // Where the density varies over a surface it is taken at the ray's origin, which lies off it.
    const double tolerance = tested.shape ? 1e-4 : 0;
    if (pdf.direction != sample->pdfDir || !(std::abs(pdf.position / sample->pdfPos - 1) <= tolerance)) {
      return {false, fmt::format("of a ray: densities {}, {} drawn, {}, {} asked", sample->pdfPos, sample->pdfDir,
                                 pdf.position, pdf.direction)};
    }
    if (tested.light.IsInfinite() && tested.light.Le(Ray{Vec3(0), -sample->ray.d}) != sample->Le)
      return {false, "of a ray: radiance that looking back along it does not show"};
    const double carried = static_cast<double>(sample->Flux().MaxComponent());
    flux.Add(carried);
    least = std::min(least, carried), most = std::max(most, carried);
  }
  const bool isEven = most <= spread * flux.Value() && least >= flux.Value() / spread;
  return {isEven, fmt::format("flux from {} to {} with mean {}", least, most, flux.Value())};
}

}  // namespace dapple
