#include "src/materials/coated_lobes.h"

#include "src/materials/diffuse_lobes.h"
#include "src/materials/fresnel.h"
#include "src/materials/microfacet_lobes.h"

namespace dapple {

namespace {

/// A direction outside seen from within a coat of index `eta` >= 1, on the same side of the surface.
Vec3 IntoCoat(const Vec3& w, float eta) {
  const float z = std::sqrt((eta - 1) * (eta + 1) + w.z * w.z);
  return Vec3(w.x, w.y, std::copysign(z, w.z)) * (1 / eta);
}

/// The reverse; nothing at total reflection.
std::optional<Vec3> OutOfCoat(const Vec3& w, float eta) {
  const float z2 = Sqr(eta * w.z) - (eta - 1) * (eta + 1);
  if (!(z2 > 0)) return std::nullopt;
  return Normalize(Vec3(eta * w.x, eta * w.y, std::copysign(std::sqrt(z2), w.z)));
}

}  // namespace

std::optional<LobeSample> CoatReflection::Sample(const Vec3& wo, double, const Vec2d&, TransportMode) const {
  const Color reflected = Albedo(wo);
  if (reflected.IsBlack()) return std::nullopt;
  return Reflected(wo, reflected, 1);
}

Color CoatReflection::Albedo(const Vec3& wo) const { return Color(FresnelDielectric(AbsCosTheta(wo), eta)); }

CoatedDiffuseBase::CoatedDiffuseBase(const Color& rho, float eta_, float diffuseReflectance)
    : eta(eta_), entering(1 - diffuseReflectance) {
  const float leaving = std::min(1.f, entering / Sqr(eta));  // 1 - Ri, by reciprocity
  albedo = Map(rho, [leaving](float r) { return r * leaving / ((1 - r) + r * leaving); });
}

CoatedDiffuseBase::CoatedDiffuseBase(const Color& rho, float eta_, float alpha_, const CoatTransmittance& table)
    : eta(eta_), entering(table.DiffuseEntering(alpha_)), alpha(alpha_), rough(&table) {
  const float leaving = entering / Sqr(eta), returned = table.DiffuseReturned(alpha);
  albedo = Map(rho, [=](float r) { return r * leaving / (1 - r * returned); });
}

float CoatedDiffuseBase::Transmittance(const Vec3& w) const {
  return rough ? rough->Entering(AbsCosTheta(w), alpha) : 1 - FresnelDielectric(AbsCosTheta(w), eta);
}

Color CoatedDiffuseBase::Value(const Vec3& wo, const Vec3& wi, TransportMode) const {
  if (!SameHemisphere(wo, wi)) return Color();
  return albedo * (Transmittance(wo) * Transmittance(wi) / entering * kInvPi);
}

float CoatedDiffuseBase::Pdf(const Vec3& wo, const Vec3& wi) const {
  return SameHemisphere(wo, wi) ? AbsCosTheta(wi) * kInvPi : 0;
}

std::optional<LobeSample> CoatedDiffuseBase::Sample(const Vec3& wo, double, const Vec2d& u, TransportMode) const {
  return SampleCosineOn(wo.z, u, Flags());
}

Color CoatedDiffuseBase::Albedo(const Vec3& wo) const { return albedo * Transmittance(wo); }

std::optional<LobeSample> CoatedConductorReflection::Sample(const Vec3& wo, double, const Vec2d&, TransportMode) const {
  return Reflected(wo, Albedo(wo), 1);
}

Color CoatedConductorReflection::Albedo(const Vec3& wo) const {
  const float coat = FresnelDielectric(AbsCosTheta(wo), coatEta);
  if (coat == 1) return Color(1);
  const Color metal = FresnelConductor(IntoCoat(wo, coatEta).z, eta, k);
  return Map(metal, [coat](float rc) { return coat + Sqr(1 - coat) * rc / ((1 - coat) + coat * (1 - rc)); });
}

Color CoatedRoughConductor::Value(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
  if (!SameHemisphere(wo, wi)) return Color();
  const float coatO = FresnelDielectric(AbsCosTheta(wo), coatEta);
  const float coatI = FresnelDielectric(AbsCosTheta(wi), coatEta);
  if (coatO == 1 || coatI == 1) return Color();
  const Vec3 insideO = IntoCoat(wo, coatEta), insideI = IntoCoat(wi, coatEta);
  const Color back = Color(coatO) * FresnelConductor(insideO.z, eta, k);
  const Color forth = Color(coatI) * FresnelConductor(insideI.z, eta, k);
  const Color remaining{1 - std::min(back.r, forth.r), 1 - std::min(back.g, forth.g), 1 - std::min(back.b, forth.b)};
  const Color metal = RoughConductor{ggx, eta, k}.Value(insideO, insideI, mode);
  return metal * ((1 - coatO) * (1 - coatI) / Sqr(coatEta)) / remaining;
}

float CoatedRoughConductor::Pdf(const Vec3& wo, const Vec3& wi) const {
  if (!SameHemisphere(wo, wi)) return 0;
  const Vec3 insideI = IntoCoat(wi, coatEta);
  const float solidAngleRatio = AbsCosTheta(wi) / (Sqr(coatEta) * AbsCosTheta(insideI));
  return RoughConductor{ggx, eta, k}.Pdf(IntoCoat(wo, coatEta), insideI) * solidAngleRatio;
}

std::optional<LobeSample> CoatedRoughConductor::Sample(const Vec3& wo, double uc, const Vec2d& u,
                                                       TransportMode mode) const {
  std::optional<LobeSample> sample = RoughConductor{ggx, eta, k}.Sample(IntoCoat(wo, coatEta), uc, u, mode);
  if (!sample) return std::nullopt;
  const std::optional<Vec3> wi = OutOfCoat(sample->wi, coatEta);
  if (!wi) return std::nullopt;
  sample->wi = *wi;
  sample->pdf = Pdf(wo, *wi);
  if (!(sample->pdf > 0)) return std::nullopt;
  return sample;
}

Color CoatedRoughConductor::Albedo(const Vec3& wo) const {
  const float coat = FresnelDielectric(AbsCosTheta(wo), coatEta);
  return FresnelConductor(IntoCoat(wo, coatEta).z, eta, k) * (1 - coat);
}

}  // namespace dapple
