#include "lights/environment_strategy.h"

#include "lights/irradiance_strategy.h"
#include "lights/light_math.h"
#include "lights/product_strategy.h"
#include "lights/structured_strategy.h"
#include "src/base/frame.h"
#include "src/sampling/warps.h"

namespace dapple {

namespace {

class UniformStrategy final : public EnvironmentStrategy {
 public:
  Vec3 Sample(const LightContext&, const LiRandom& u) const override { return ToFloat(SampleSphere(u.direction)); }
  double Pdf(const LightContext&, const Vec3&, const EnvironmentPlace&) const override { return kSpherePdf; }
  LiRandom Invert(const LightContext&, const Vec3& wi) const override {
    LiRandom u;
    u.direction = InvertSphere(ToDouble(wi));
    return u;
  }
};

/// Even over the sphere where there is no surface.
class CosineStrategy final : public EnvironmentStrategy {
 public:
  Vec3 Sample(const LightContext& at, const LiRandom& u) const override {
    if (!HasSurface(at)) return UniformStrategy().Sample(at, u);
    // Both hemispheres share u.x, half of it each.
    Vec2d numbers = u.direction;
    const bool isBelow = at.transmissive && numbers.x >= 0.5;
    if (at.transmissive) numbers.x = 2 * numbers.x - (isBelow ? 1 : 0);
    Vec3 local = ToFloat(SampleCosineHemisphere(numbers));
    if (isBelow) local.z = -local.z;
    return Normalize(Frame::FromZ(at.n).ToWorld(local));
  }

  double Pdf(const LightContext& at, const Vec3& wi, const EnvironmentPlace&) const override {
    if (!HasSurface(at)) return kSpherePdf;
    const double cosTheta = Dot(ToDouble(at.n), ToDouble(wi));
    return at.transmissive ? CosineHemispherePdf(std::abs(cosTheta)) / 2 : CosineHemispherePdf(cosTheta);
  }

  LiRandom Invert(const LightContext& at, const Vec3& wi) const override {
    if (!HasSurface(at)) return UniformStrategy().Invert(at, wi);
    Vec3 local = Frame::FromZ(at.n).ToLocal(wi);
    const bool isBelow = at.transmissive && local.z < 0;
    if (isBelow) local.z = -local.z;
    LiRandom u;
    u.direction = InvertCosineHemisphere(ToDouble(local));
    if (at.transmissive) u.direction.x = (u.direction.x + (isBelow ? 1 : 0)) / 2;
    return u;
  }

 private:
  static bool HasSurface(const LightContext& at) { return LengthSquared(at.n) > 0; }
};

/// Radiance less a threshold (Karlik et al. 2019, "MIS compensation: optimizing sampling techniques in multiple
/// importance sampling"): where the map is dimmer the density is zero, and BSDF sampling alone finds its light. The
/// threshold is 2 (1 - c) times the mean, with c the light's share of all samples: for one of the BSDF there are n P of
/// the light, its own count times the probability that it is picked. Beside BSDF sampling the estimate is unbiased with
/// any other threshold. Without BSDF sampling the light below would be lost, so then the map's own density is used; so
/// it is where nothing exceeds the threshold.
class CompensatedStrategy final : public EnvironmentStrategy {
 public:
  explicit CompensatedStrategy(const EnvironmentSpace& space) : space_(space), compensated_(MadeFor(space, 1)) {}

  void PrepareChoice(double probability) override { compensated_ = MadeFor(space_, probability); }

  Vec3 Sample(const LightContext& at, const LiRandom& u) const override { return space_.Sample(DensityFor(at), u); }
  double Pdf(const LightContext& at, const Vec3&, const EnvironmentPlace& place) const override {
    return space_.Pdf(DensityFor(at), place);
  }
  LiRandom Invert(const LightContext& at, const Vec3& wi) const override { return space_.Invert(DensityFor(at), wi); }
  TableUse Tables() const override { return TableUse::Of(compensated_.table.MemoryBytes()); }

 private:
  static EnvironmentDensity MadeFor(const EnvironmentSpace& space, double probability) {
    const double bsdfShare = 1 / (space.light->SampleCount() * probability + 1);
    return space.map.MakeDensity(2 * bsdfShare * space.map.MeanImportance());
  }

  const EnvironmentDensity& DensityFor(const LightContext& at) const {
    return at.bsdfDrawsToo && !compensated_.table.IsZero() ? compensated_ : space_.map.Density();
  }

  EnvironmentSpace space_;
  EnvironmentDensity compensated_;
};

}  // namespace

std::unique_ptr<EnvironmentStrategy> MakeStrategy(EnvironmentSampling sampling, const EnvironmentSpace& space) {
  switch (sampling) {
    case EnvironmentSampling::Uniform:
      return std::make_unique<UniformStrategy>();
    case EnvironmentSampling::Cosine:
      return std::make_unique<CosineStrategy>();
    case EnvironmentSampling::Importance:
      return nullptr;
    case EnvironmentSampling::Irradiance:
      return std::make_unique<IrradianceStrategy>(space);
    case EnvironmentSampling::Compensated:
      return std::make_unique<CompensatedStrategy>(space);
    case EnvironmentSampling::Structured:
      return std::make_unique<StructuredStrategy>(space);
    case EnvironmentSampling::Product:
      return std::make_unique<ProductStrategy>(space);
  }
  return nullptr;
}

}  // namespace dapple
