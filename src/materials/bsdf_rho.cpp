// Reflectances of a whole BSDF: sums of its lobes' shares, in closed form where there is one.
#include "src/materials/bsdf.h"
#include "src/sampling/sampler.h"
#include "src/sampling/warps.h"

namespace dapple {

namespace {

constexpr uint64_t kSeed = 0;

template <typename L>
constexpr bool kIsSpecular = std::is_base_of_v<SpecularLobe, L>;
/// `Albedo` is the integral itself.
template <typename L>
constexpr bool kHasExactAlbedo = std::is_same_v<L, LambertianReflection> || std::is_same_v<L, LambertianTransmission> ||
                                 std::is_same_v<L, OrenNayarReflection>;

bool IsExact(const Lobe& lobe) {
  return std::visit([]<typename L>(const L&) { return kIsSpecular<L> || kHasExactAlbedo<L>; }, lobe);
}

ScatteredShares ToSide(bool isReflection, const Color& share) {
  return isReflection ? ScatteredShares{share, Color()} : ScatteredShares{Color(), share};
}

/// All branches of a specular lobe: the first number gives one, the last the other where there are two.
template <typename L>
ScatteredShares SpecularShares(const L& lobe, const Vec3& wo) {
  ScatteredShares sum;
  LobeFlags seen;
  for (const double uc : {0.0, 0x1.fffffffffffffp-1}) {
    const std::optional<LobeSample> branch = lobe.Sample(wo, uc, Vec2d(0), TransportMode::Importance);
    if (!branch || branch->flags == seen) continue;
    seen = branch->flags;
    sum += ToSide(branch->flags.HasReflection(), branch->value);
  }
  return sum;
}

/// The shares of one lobe: exactly, or what one sample makes of them.
ScatteredShares SharesOf(const Lobe& anyLobe, const Vec3& wo, double uc, const Vec2d& u) {
  return std::visit(
      [&]<typename L>(const L& lobe) {
        if constexpr (kIsSpecular<L>) return SpecularShares(lobe, wo);
        if constexpr (kHasExactAlbedo<L>) return ToSide(lobe.Flags().HasReflection(), lobe.Albedo(wo));
        const std::optional<LobeSample> drawn = lobe.Sample(wo, uc, u, TransportMode::Importance);
        if (!drawn || !(drawn->pdf > 0)) return ScatteredShares();
        const Color value = lobe.Value(wo, drawn->wi, TransportMode::Importance);
        return ToSide(SameHemisphere(wo, drawn->wi), value * (AbsCosTheta(drawn->wi) / drawn->pdf));
      },
      anyLobe);
}

}  // namespace

ScatteredShares Bsdf::Rho(const Vec3& wo, int samples) const {
  const Sided o = ToSided(wo);
  ScatteredShares sum;
  if (!o.IsValid()) return sum;
  for (int i = 0; i < count_; ++i) {
    const int count = IsExact(lobes_[i].lobe) ? 1 : samples;
    ScatteredShares ofLobe;
    for (int j = 0; j < count; ++j) {
      Sampler sampler = Sampler::ForLightPath(kSeed, j, 0, count);
      const double uc = sampler.Get1D();
      ofLobe += SharesOf(lobes_[i].lobe, o.local, uc, sampler.Get2D());
    }
    sum += ofLobe * (lobes_[i].scale / static_cast<float>(count));
  }
  return sum;
}

ScatteredShares Bsdf::Rho(SurfaceSide from, int samples) const {
  ScatteredShares sum;
  for (int j = 0; j < samples; ++j) {
    Sampler sampler = Sampler::ForLightPath(kSeed, j, 0, samples);
    const double uc = sampler.Get1D();
    const Vec2d u = sampler.Get2D();
    const Vec3 above = ToFloat(SampleCosineHemisphere(sampler.Get2D()));
    const Vec3 wo(above.x, above.y, from == SurfaceSide::Outside ? above.z : -above.z);
    if (wo.z == 0) continue;
    for (int i = 0; i < count_; ++i) sum += SharesOf(lobes_[i].lobe, wo, uc, u) * lobes_[i].scale;
  }
  return sum * Color(1 / static_cast<float>(samples));
}

}  // namespace dapple
