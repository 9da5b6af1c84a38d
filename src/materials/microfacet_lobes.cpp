#include "src/materials/microfacet_lobes.h"

#include "src/materials/diffuse_lobes.h"
#include "src/materials/fresnel.h"

namespace dapple {

namespace {

Vec3 HalfVector(const Vec3& wo, const Vec3& wi) { return Normalize(wo + wi); }
Vec3 ReflectAbout(const Vec3& w, const Vec3& n) { return n * (2 * Dot(w, n)) - w; }

/// Density of reflection at a visible normal: VisiblePdf / (4 |wo.wm|).
float ReflectionPdf(const Ggx& ggx, const Vec3& wo, const Vec3& wm) { return ggx.D(wm) * ggx.VisiblePdfOverD(wo) / 4; }

/// D G / (4 |cos wo| |cos wi|).
float ReflectionValue(const Ggx& ggx, const Vec3& wo, const Vec3& wi, const Vec3& wm) {
  return ggx.D(wm) * ggx.GOverCosines(wo, wi) / 2;
}

float ReflectionPdfSameSide(const Ggx& ggx, const Vec3& wo, const Vec3& wi) {
  return SameHemisphere(wo, wi) ? ReflectionPdf(ggx, wo, HalfVector(wo, wi)) : 0;
}

/// The mirror direction at a visible normal; nothing where it points below the surface.
std::optional<LobeSample> SampleReflection(const Ggx& ggx, const Vec3& wo, const Vec2d& u) {
  const Vec3 wi = Normalize(ReflectAbout(wo, ggx.SampleVisible(wo, u)));
  if (!SameHemisphere(wo, wi)) return std::nullopt;
  LobeSample sample;
  sample.wi = wi;
  sample.pdf = ReflectionPdfSameSide(ggx, wo, wi);
  sample.flags = LobeFlags::kGlossyReflection;
  return sample;
}

/// The microfacet that scatters wo to wi: `wm` with z > 0, and what belongs to it.
struct Facet {
  Vec3 wm;
  float fresnel;
  bool isReflection;
  float etaRatio;           ///< n_wi / n_wo
  float halfLengthSquared;  ///< of wo + etaRatio wi
};

/// Nothing where no microfacet seen from both sides does that.
std::optional<Facet> FindFacet(const Vec3& wo, const Vec3& wi, float eta) {
  const bool isReflection = SameHemisphere(wo, wi);
  const float etaRatio = isReflection ? 1 : (wo.z > 0 ? eta : 1 / eta);
  const Vec3 half = wo + wi * etaRatio;
  const float lengthSquared = LengthSquared(half);
  if (!(lengthSquared > 0)) return std::nullopt;
  const Vec3 wm = FaceForward(half * (1 / std::sqrt(lengthSquared)), Vec3(0, 0, 1));
  const float cosO = Dot(wo, wm);
  if (cosO * wo.z <= 0 || Dot(wi, wm) * wi.z <= 0) return std::nullopt;
  return Facet{wm, FresnelDielectric(cosO, eta), isReflection, etaRatio, lengthSquared};
}

}  // namespace

Color RoughConductor::Value(const Vec3& wo, const Vec3& wi, TransportMode) const {
  if (!SameHemisphere(wo, wi)) return Color();
  const Vec3 wm = HalfVector(wo, wi);
  return FresnelConductor(Dot(wi, wm), eta, k) * ReflectionValue(ggx, wo, wi, wm);
}

float RoughConductor::Pdf(const Vec3& wo, const Vec3& wi) const { return ReflectionPdfSameSide(ggx, wo, wi); }

std::optional<LobeSample> RoughConductor::Sample(const Vec3& wo, double, const Vec2d& u, TransportMode) const {
  return SampleReflection(ggx, wo, u);
}

Color RoughConductor::Albedo(const Vec3& wo) const { return FresnelConductor(CosTheta(wo), eta, k); }

Color RoughDielectricReflection::Value(const Vec3& wo, const Vec3& wi, TransportMode) const {
  if (!SameHemisphere(wo, wi)) return Color();
  const Vec3 wm = HalfVector(wo, wi);
  const float fresnel = FresnelDielectric(AbsDot(wi, wm), wo.z > 0 ? etaAbove : etaBelow);
  return reflectance * (fresnel * ReflectionValue(ggx, wo, wi, wm));
}

float RoughDielectricReflection::Pdf(const Vec3& wo, const Vec3& wi) const {
  return ReflectionPdfSameSide(ggx, wo, wi);
}

std::optional<LobeSample> RoughDielectricReflection::Sample(const Vec3& wo, double, const Vec2d& u,
                                                            TransportMode) const {
  return SampleReflection(ggx, wo, u);
}

Color RoughDielectricReflection::Albedo(const Vec3& wo) const {
  return reflectance * FresnelDielectric(AbsCosTheta(wo), wo.z > 0 ? etaAbove : etaBelow);
}

LobeFlags RoughDielectric::Flags() const {
  LobeFlags flags;
  if (!reflectance.IsBlack()) flags |= LobeFlags::kGlossyReflection;
  if (!transmittance.IsBlack()) flags |= LobeFlags::kGlossyTransmission;
  return flags;
}

float RoughDielectric::ReflectionProbability(float fresnel) const {
  const float r = fresnel * reflectance.MaxComponent(), t = (1 - fresnel) * transmittance.MaxComponent();
  return r > 0 ? r / (r + t) : 0;
}

Color RoughDielectric::Value(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
  const std::optional<Facet> facet = FindFacet(wo, wi, eta);
  if (!facet) return Color();
  if (facet->isReflection) return reflectance * (facet->fresnel * ReflectionValue(ggx, wo, wi, facet->wm));
  // Walter et al. 2007, equation 21: |wi.wm| etaRatio^2 / |wo + etaRatio wi|^2 is d wm / d wi.
  const float cosines = AbsDot(wo, facet->wm) * AbsDot(wi, facet->wm) / facet->halfLengthSquared;
  const float value = (1 - facet->fresnel) * ggx.D(facet->wm) * 2 * ggx.GOverCosines(wo, wi) * cosines;
  return transmittance * (mode == TransportMode::Radiance ? value : value * Sqr(facet->etaRatio));
}

float RoughDielectric::Pdf(const Vec3& wo, const Vec3& wi) const {
  const std::optional<Facet> facet = FindFacet(wo, wi, eta);
  if (!facet) return 0;
  const float probability = ReflectionProbability(facet->fresnel);
  if (facet->isReflection) return ReflectionPdf(ggx, wo, facet->wm) * probability;
  const float dwmDwi = AbsDot(wi, facet->wm) * Sqr(facet->etaRatio) / facet->halfLengthSquared;
  return ggx.VisiblePdf(wo, facet->wm) * dwmDwi * (1 - probability);
}

std::optional<LobeSample> RoughDielectric::Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode) const {
  const Vec3 wm = FaceForward(ggx.SampleVisible(wo, u), Vec3(0, 0, 1));
  const float fresnel = FresnelDielectric(Dot(wo, wm), eta);
  LobeSample sample;
  if (uc < static_cast<double>(ReflectionProbability(fresnel))) {
    sample.wi = Normalize(ReflectAbout(wo, wm));
    if (!SameHemisphere(wo, sample.wi)) return std::nullopt;
    sample.flags = LobeFlags::kGlossyReflection;
  } else {
    const std::optional<Refraction> refraction = Refract(wo, wm, eta);
    if (!refraction || !(refraction->w.z * wo.z < 0)) return std::nullopt;
    sample.wi = refraction->w;
    sample.eta = refraction->eta;
    sample.flags = LobeFlags::kGlossyTransmission;
  }
  sample.pdf = Pdf(wo, sample.wi);
  if (!(sample.pdf > 0)) return std::nullopt;
  return sample;
}

Color RoughDielectric::Albedo(const Vec3& wo) const {
  const float fresnel = FresnelDielectric(CosTheta(wo), eta);
  return reflectance * fresnel + transmittance * (1 - fresnel);
}

Color FresnelBlend::Value(const Vec3& wo, const Vec3& wi, TransportMode) const {
  if (!SameHemisphere(wo, wi)) return Color();
  const float cosO = AbsCosTheta(wo), cosI = AbsCosTheta(wi);
  const auto pow5 = [](float x) { return Sqr(Sqr(x)) * x; };
  const float base = 28 / (23 * kPi) * (1 - pow5(1 - cosI / 2)) * (1 - pow5(1 - cosO / 2));
  const Vec3 wm = HalfVector(wo, wi);
  const float cosM = AbsDot(wi, wm);
  const float gloss = ggx.D(wm) / (4 * cosM * std::max(cosI, cosO));
  return diffuse * (Color(1) - specular) * base + FresnelSchlick(cosM, specular) * gloss;
}

float FresnelBlend::GlossProbability(const Vec3& wo) const {
  const float gloss = FresnelSchlick(AbsCosTheta(wo), specular).MaxComponent();
  return gloss / (gloss + diffuse.MaxComponent());
}

float FresnelBlend::Pdf(const Vec3& wo, const Vec3& wi) const {
  if (!SameHemisphere(wo, wi)) return 0;
  const float gloss = GlossProbability(wo);
  return gloss * ReflectionPdf(ggx, wo, HalfVector(wo, wi)) + (1 - gloss) * AbsCosTheta(wi) * kInvPi;
}

std::optional<LobeSample> FresnelBlend::Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode) const {
  LobeSample sample;
  if (uc < static_cast<double>(GlossProbability(wo))) {
    const std::optional<LobeSample> gloss = SampleReflection(ggx, wo, u);
    if (!gloss) return std::nullopt;
    sample = *gloss;
  } else {
    sample = SampleCosineOn(wo.z, u, LobeFlags::kDiffuseReflection);
  }
  sample.pdf = Pdf(wo, sample.wi);
  return sample;
}

Color FresnelBlend::Albedo(const Vec3& wo) const {
  // The base's integral is exact; the gloss is taken as a mirror.
  const float m = 1 - AbsCosTheta(wo) / 2;
  return diffuse * (Color(1) - specular) * (1 - Sqr(Sqr(m)) * m) + FresnelSchlick(AbsCosTheta(wo), specular);
}

}  // namespace dapple
