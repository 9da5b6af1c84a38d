#include "tests/lights/mutants.h"

#include <array>
#include <cmath>

#include "lights/area_light.h"
#include "lights/distant_light.h"
#include "lights/environment_light.h"
#include "lights/spot_light.h"
#include "src/base/numerics.h"
#include "src/geometry/disk.h"
#include "src/geometry/sphere.h"
#include "src/geometry/triangle_mesh.h"
#include "src/sampling/warps.h"

namespace dapple {

namespace {

/// A light under test, with the shape that it shines from.
struct Mutant {
  std::unique_ptr<Shape> shape;
  std::unique_ptr<Light> light;
};

/// Emitted rays and directions toward the light go through one fault: `Bend` moves what was drawn, `Unbend` is its
/// inverse. A faulty sampler returns the moved draw with the density that the light has there; a faulty density is the
/// light's own at the place that would have been moved here: both together are consistent with each other.
class BentEnvironment : public LightDecorator {
 public:
  using LightDecorator::LightDecorator;

  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const override {
    std::optional<LiSample> sample = light_->Sample_Li(at, u);
    if (!sample) return std::nullopt;
    if (SamplerIsFaulty()) sample->wi = Bend(sample->wi);
    sample->L = light_->Le(Ray{at.p, sample->wi});
    sample->pdf = Pdf_Li(at, sample->wi, nullptr);
    return sample;
  }
  double Pdf_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction*) const override {
    return light_->Pdf_Li(at, DensityIsFaulty() ? Unbend(wi) : wi, nullptr);
  }
  std::optional<LeSample> Sample_Le(const LeRandom& u) const override {
    std::optional<LeSample> sample = light_->Sample_Le(u);
    if (!sample) return std::nullopt;
    if (SamplerIsFaulty()) {
      const Vec3 wi = Bend(-sample->ray.d);
      sample->ray = Ray{DiskAcross(wi).Sample(u.position), -wi};
    }
    sample->Le = light_->Le(Ray{Vec3(0), -sample->ray.d});
    const LePdf pdf = Pdf_Le(sample->ray, sample->From());
    sample->pdfPos = pdf.position, sample->pdfDir = pdf.direction;
    return sample;
  }
  LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const override {
    LePdf pdf = light_->Pdf_Le(ray, from);
    if (DensityIsFaulty()) pdf.direction = light_->Pdf_Li(LightContext(Vec3(0)), Unbend(-ray.d), nullptr);
    return pdf;
  }

 protected:
  virtual Vec3 Bend(const Vec3& wi) const = 0;
  virtual Vec3 Unbend(const Vec3& wi) const = 0;
};

/// Half a texel of a map of 8 columns around its axis.
class HalfTexelShift final : public BentEnvironment {
 public:
  using BentEnvironment::BentEnvironment;

 protected:
  static Vec3 Turn(const Vec3& w, double angle) {
    const double c = std::cos(angle), s = std::sin(angle), x = w.x, y = w.y;
    return ToFloat(Vec3d(c * x - s * y, s * x + c * y, w.z));
  }
  Vec3 Bend(const Vec3& wi) const override { return Turn(wi, kPiD / 8); }
  Vec3 Unbend(const Vec3& wi) const override { return Turn(wi, -kPiD / 8); }
};

/// Rows of the map counted from the other pole.
class FlippedRows final : public BentEnvironment {
 public:
  using BentEnvironment::BentEnvironment;

 protected:
  Vec3 Bend(const Vec3& wi) const override { return {wi.x, wi.y, -wi.z}; }
  Vec3 Unbend(const Vec3& wi) const override { return {wi.x, wi.y, -wi.z}; }
};

/// Two axes of the map swapped.
class SwappedAxes final : public BentEnvironment {
 public:
  using BentEnvironment::BentEnvironment;

 protected:
  Vec3 Bend(const Vec3& wi) const override { return {wi.z, wi.y, wi.x}; }
  Vec3 Unbend(const Vec3& wi) const override { return {wi.z, wi.y, wi.x}; }
};

template <typename Faulty>
Mutant OfMap(Place place) {
  auto map = std::make_unique<EnvironmentLight>(RandomEnvironment(8, 4, 1), Transform(), Color(1),
                                                EnvironmentMapping::LatLong);
  return {nullptr, std::make_unique<Faulty>(std::move(map), place)};
}

/// Emitted rays whose draw and densities a fault changes; next-event estimation is left as it is. Each fault says how
/// the draw is changed, by its random numbers or afterwards, and what density that has.
class FaultyEmission : public LightDecorator {
 public:
  using LightDecorator::LightDecorator;

  std::optional<LeSample> Sample_Le(const LeRandom& u) const override {
    std::optional<LeSample> sample = light_->Sample_Le(SamplerIsFaulty() ? ChangedNumbers(u) : u);
    if (!sample) return std::nullopt;
    if (SamplerIsFaulty()) Change(u, &*sample);
    const LePdf pdf = Pdf_Le(sample->ray, sample->From());
    // A draw where the light itself has no density claims that of a proper one.
    if (pdf.position > 0) sample->pdfPos = pdf.position;
    if (pdf.direction > 0) sample->pdfDir = pdf.direction;
    return sample;
  }
  LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const override {
    const LePdf pdf = light_->Pdf_Le(ray, from);
    return DensityIsFaulty() ? FaultyDensity(ray, from, pdf) : pdf;
  }

 protected:
  virtual LeRandom ChangedNumbers(const LeRandom& u) const { return u; }
  virtual void Change(const LeRandom& /*u*/, LeSample* /*sample*/) const {}
  /// `pdf`: of the light without fault.
  virtual LePdf FaultyDensity(const Ray& ray, const LightPoint& from, const LePdf& pdf) const = 0;

  /// A ray of a surface, sent elsewhere.
  static void Redirect(const Vec3& d, LeSample* sample) {
    sample->ray = Ray{sample->ray.o, d};
    sample->cosTheta = AbsDot(sample->n, d);
  }
};

/// Rays of a one-sided lamp leave its back.
class FlippedNormal final : public FaultyEmission {
 public:
  using FaultyEmission::FaultyEmission;

 protected:
  void Change(const LeRandom&, LeSample* sample) const override {
    Redirect(sample->ray.d - sample->n * (2 * Dot(sample->n, sample->ray.d)), sample);
    sample->ray.o = sample->ray.o + sample->ray.d * 1e-4f;
  }
  LePdf FaultyDensity(const Ray& ray, const LightPoint& from, const LePdf&) const override {
    return light_->Pdf_Le(ray, {-from.n, from.primitive});
  }
};

/// Directions uniform over the hemisphere instead of by the cosine.
class MissingCosine final : public FaultyEmission {
 public:
  using FaultyEmission::FaultyEmission;

 protected:
  void Change(const LeRandom& u, LeSample* sample) const override {
    Redirect(Frame::FromZ(sample->n).ToWorld(ToFloat(SampleHemisphere(u.direction))), sample);
  }
  LePdf FaultyDensity(const Ray& ray, const LightPoint& from, const LePdf& pdf) const override {
    return {pdf.position, Dot(ray.d, from.n) > 0 ? kHemispherePdf : 0};
  }
};

/// A two-sided lamp of which only the front is drawn, with twice the density there.
class FactorTwo final : public FaultyEmission {
 public:
  using FaultyEmission::FaultyEmission;

 protected:
  LeRandom ChangedNumbers(const LeRandom& u) const override {
    LeRandom front = u;
    front.direction.x /= 2;
    return front;
  }
  LePdf FaultyDensity(const Ray& ray, const LightPoint& from, const LePdf& pdf) const override {
    return {pdf.position, Dot(ray.d, from.n) > 0 ? 2 * pdf.direction : 0};
  }
};

/// A disk of nine tenths of its radius.
class WrongDiskArea final : public FaultyEmission {
 public:
  using FaultyEmission::FaultyEmission;

 protected:
  static constexpr float kShare = 0.9f;
  static Vec3 CenterOf(const Ray& ray) { return ToFloat(DiskAcross(-ray.d).center); }

  void Change(const LeRandom&, LeSample* sample) const override {
    const Vec3 center = CenterOf(sample->ray);
    sample->ray.o = center + (sample->ray.o - center) * kShare;
  }
  LePdf FaultyDensity(const Ray& ray, const LightPoint& from, const LePdf&) const override {
    const Vec3 center = CenterOf(ray);
    const LePdf pdf = light_->Pdf_Le(Ray{center + (ray.o - center) * (1 / kShare), ray.d}, from);
    return {pdf.position / static_cast<double>(kShare * kShare), pdf.direction};
  }
};

/// The radius on the disk without its square root: rays crowd in the middle.
class DiskWithoutRoot final : public FaultyEmission {
 public:
  using FaultyEmission::FaultyEmission;

 protected:
  void Change(const LeRandom& u, LeSample* sample) const override {
    const EmissionDisk disk = DiskAcross(-sample->ray.d);
    const double r = disk.radius * u.position.x, phi = 2 * kPiD * u.position.y;
    sample->ray.o = ToFloat(disk.center + (disk.s * std::cos(phi) + disk.t * std::sin(phi)) * r);
  }
  LePdf FaultyDensity(const Ray& ray, const LightPoint&, const LePdf& pdf) const override {
    const EmissionDisk disk = DiskAcross(-ray.d);
    const double share = Length(Cross(ToDouble(ray.o) - disk.center, ToDouble(ray.d))) / disk.radius;
    return {pdf.position / (2 * std::max(share, 1e-6)), pdf.direction};
  }
};

/// Directions even in theta, and a density that forgets the sine.
class MissingSine final : public FaultyEmission {
 public:
  using FaultyEmission::FaultyEmission;

 protected:
  void Change(const LeRandom& u, LeSample* sample) const override {
    const double theta = kPiD * u.direction.x, phi = 2 * kPiD * u.direction.y, s = std::sin(theta);
    const Vec3 wi = ToFloat(Vec3d(s * std::cos(phi), s * std::sin(phi), std::cos(theta)));
    sample->ray = Ray{DiskAcross(wi).Sample(u.position), -wi};
  }
  LePdf FaultyDensity(const Ray&, const LightPoint&, const LePdf& pdf) const override {
    return {pdf.position, 1 / (2 * kPiD * kPiD)};
  }
};

/// The rays of an environment run toward it.
class ReversedRays final : public FaultyEmission {
 public:
  using FaultyEmission::FaultyEmission;

 protected:
  void Change(const LeRandom& u, LeSample* sample) const override {
    const Vec3 w = sample->ray.d;
    sample->ray = Ray{DiskAcross(w).Sample(u.position), -w};
  }
  LePdf FaultyDensity(const Ray& ray, const LightPoint& from, const LePdf&) const override {
    return light_->Pdf_Le(Ray{ray.o, -ray.d}, from);
  }
};

/// A spot light drawn uniformly over its whole cone, rim or not.
class ForgottenRim final : public FaultyEmission {
 public:
  using FaultyEmission::FaultyEmission;
  static constexpr double kWidth = 40;

 protected:
  static double OneMinusCosMax() { return 2 * Sqr(std::sin(Radians(kWidth) / 2)); }
  void Change(const LeRandom& u, LeSample* sample) const override {
    const Vec3d w = SampleCone(u.direction, OneMinusCosMax());
    sample->ray = Ray{sample->ray.o, ToFloat(Vec3d(w.x, -w.y, -w.z))};
    const auto arriving = light_->Sample_Li(LightContext(sample->ray(1)), {});
    sample->Le = arriving ? arriving->L : Color();
  }
  LePdf FaultyDensity(const Ray& ray, const LightPoint&, const LePdf&) const override {
    return {1, 1 + static_cast<double>(ray.d.z) <= OneMinusCosMax() ? ConePdf(OneMinusCosMax()) : 0};
  }
};

/// Triangles chosen by number instead of by area.
class ChosenByNumber final : public FaultyEmission {
 public:
  ChosenByNumber(std::unique_ptr<Light> light, Place place, const Shape* shape)
      : FaultyEmission(std::move(light), place), shape_(shape) {
    for (int i = 0; i < shape->PrimitiveCount(); ++i) area_ += shape->PrimitiveArea(i);
  }

 protected:
  double AreaBefore(int end) const {
    double sum = 0;
    for (int i = 0; i < end; ++i) sum += shape_->PrimitiveArea(i);
    return sum;
  }
  LeRandom ChangedNumbers(const LeRandom& u) const override {
    LeRandom own = u;
    const int count = shape_->PrimitiveCount(), chosen = std::min(static_cast<int>(u.part * count), count - 1);
    own.part = (AreaBefore(chosen) + shape_->PrimitiveArea(chosen) / 2) / area_;
    return own;
  }
  LePdf FaultyDensity(const Ray& ray, const LightPoint& from, const LePdf& pdf) const override {
    const double part = light_->Invert_Le(ray, from).part * area_;
    int chosen = 0;
    while (chosen + 1 < shape_->PrimitiveCount() && AreaBefore(chosen + 1) <= part) ++chosen;
    return {1 / (shape_->PrimitiveCount() * shape_->PrimitiveArea(chosen)), pdf.direction};
  }

 private:
  const Shape* shape_;
  double area_ = 0;
};

/// A sphere lamp of whose cone, as seen from a point, only nine tenths of the solid angle are drawn.
class WrongCone final : public LightDecorator {
 public:
  using LightDecorator::LightDecorator;

  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const override {
    LiRandom own = u;
    if (SamplerIsFaulty()) own.direction.x *= kShare;
    std::optional<LiSample> sample = light_->Sample_Li(at, own);
    if (sample && DensityIsFaulty()) sample->pdf /= kShare;
    return sample;
  }
  double Pdf_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const override {
    const double pdf = light_->Pdf_Li(at, wi, hit);
    if (!DensityIsFaulty()) return pdf;
    return light_->Invert_Li(at, wi, hit).direction.x < kShare ? pdf / kShare : 0;
  }

 private:
  static constexpr double kShare = 0.9;
};

template <typename Faulty>
Mutant OfLight(std::unique_ptr<Light> light, Place place) {
  return {nullptr, std::make_unique<Faulty>(std::move(light), place)};
}

template <typename Faulty>
Mutant OfDistant(Place place) {
  return OfLight<Faulty>(std::make_unique<DistantLight>(Vec3(1, 2, -4), Color(3, 2, 1)), place);
}

template <typename Faulty>
Mutant OfUniformEnvironment(Place place) {
  return OfLight<Faulty>(std::make_unique<UniformEnvironmentLight>(Color(3, 2, 1)), place);
}

template <typename Faulty>
Mutant OfSpot(Place place) {
  return OfLight<Faulty>(std::make_unique<SpotLight>(Vec3(0.5f, 0, 2), Vec3(0, 0, -1), Color(3, 2, 1),
                                                     ForgottenRim::kWidth, 10, SpotFalloff::PbrtV4),
                         place);
}

template <typename Faulty, bool kTwoSided>
Mutant OfDisk(Place place) {
  const Transform transform = Transform::Translate({0.5, 0.25, 2}) * Transform::Rotate(150, {1, 0.2, 0});
  auto shape = std::make_unique<Disk>(transform, false, 0, 0.75, 0, 360);
  auto light = std::make_unique<AreaLight>(shape.get(), Color(3, 2, 1), kTwoSided);
  return {std::move(shape), std::make_unique<Faulty>(std::move(light), place)};
}

Mutant OfSphere(Place place) {
  auto shape = std::make_unique<Sphere>(Transform::Translate({0.5, 0.25, 2}), false, 0.5);
  auto light = std::make_unique<AreaLight>(shape.get(), Color(3, 2, 1), false);
  return {std::move(shape), std::make_unique<WrongCone>(std::move(light), place)};
}

Mutant OfMesh(Place place) {
  auto shape =
      std::make_unique<TriangleMesh>(std::vector<Vec3>{{0, 0, 2}, {0, 1, 2}, {1, 0, 2}, {-2, -2, 2}},
                                     std::vector<Vec3>{}, std::vector<Vec2>{}, std::vector<int>{0, 1, 2, 0, 2, 3});
  auto light = std::make_unique<AreaLight>(shape.get(), Color(3, 2, 1), false);
  auto faulty = std::make_unique<ChosenByNumber>(std::move(light), place, shape.get());
  return {std::move(shape), std::move(faulty)};
}

constexpr const char *kLi = "chi-square of Sample_Li", *kOrigin = "chi-square of origins",
                     *kDirection = "chi-square of directions", *kEnergy = "energy", *kSides = "both sides",
                     *kLookup = "lookup";

/// `spread`: of `CheckLookup`, for the light without fault.
Rejections RejectionsOf(Mutant (*make)(Place place), double spread, Place place) {
  const Mutant mutant = make(place);
  mutant.light->Prepare(kTestExtent);
  const TestedLight tested(*mutant.light, mutant.shape.get());
  Rejections names;
  const auto note = [&](const Verdict& verdict, const char* name) {
    if (!verdict.passes && (names.empty() || names.back() != name)) names.emplace_back(name);
  };
  // An environment is the same from everywhere.
  for (size_t i = 0; i < (mutant.shape ? size_t{2} : size_t{1}); ++i)
    note(CheckDirectionsToLight(tested, TestContexts()[i]), kLi);
  note(CheckRayOrigins(tested), kOrigin);
  note(CheckRayDirections(tested), kDirection);
  note(CheckEnergy(tested), kEnergy);
  for (const Patch& patch : TestPatches(tested)) note(CheckBothSides(tested, patch), kSides);
  note(CheckLookup(tested, spread), kLookup);
  return names;
}

Fault FaultOf(const char* name, Mutant (*make)(Place place), const std::array<const char*, 3>& rejectedBy,
              double spread) {
  return {name,
          [=](Place place) { return RejectionsOf(make, spread, place); },
          {rejectedBy[0], rejectedBy[1], rejectedBy[2]}};
}

}  // namespace

std::vector<Fault> FaultsOfLights() {
  constexpr double kMap = 2.5, kEven = 1 + 1e-4;
  return {
      FaultOf("half-texel shift", OfMap<HalfTexelShift>, {kLi, kLi, kLookup}, kMap),
      FaultOf("map's rows from the other pole", OfMap<FlippedRows>, {kLi, kLi, kLookup}, kMap),
      FaultOf("map's axes swapped", OfMap<SwappedAxes>, {kLi, kLi, kLookup}, kMap),
      FaultOf("environment's rays reversed", OfMap<ReversedRays>, {kDirection, kDirection, kSides}, kMap),
      FaultOf("missing sine", OfUniformEnvironment<MissingSine>, {kDirection, kDirection, kDirection}, kEven),
      FaultOf("wrong cone constant", OfSphere, {kLi, kLi, kSides}, kEven),
      FaultOf("flipped normal", OfDisk<FlippedNormal, false>, {kDirection, kDirection, kSides}, kEven),
      FaultOf("missing cosine", OfDisk<MissingCosine, false>, {kDirection, kDirection, kLookup}, kEven),
      FaultOf("factor 2 on a two-sided light", OfDisk<FactorTwo, true>, {kDirection, kDirection, kEnergy}, kEven),
      FaultOf("wrong disk area", OfDistant<WrongDiskArea>, {kOrigin, kOrigin, kEnergy}, kEven),
      FaultOf("disk without its square root", OfDistant<DiskWithoutRoot>, {kOrigin, kOrigin, kLookup}, kEven),
      FaultOf("spot's rim forgotten", OfSpot<ForgottenRim>, {kDirection, kDirection, kLookup}, kEven),
      FaultOf("triangles chosen by number", OfMesh, {kOrigin, kOrigin, kLookup}, kEven),
  };
}

}  // namespace dapple
