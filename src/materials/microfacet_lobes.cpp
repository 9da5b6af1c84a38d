#include "src/materials/microfacet_lobes.h"

#include "src/materials/diffuse_lobes.h"
#include "src/materials/fresnel.h"

namespace dapple {

namespace {

Vec3 HalfVector(const Vec3& wo, const Vec3& wi) { return Normalize(wo + wi); }
Vec3 ReflectAbout(const Vec3& w, const Vec3& n) { return n * (2 * Dot(w, n)) - w; }

/// Density of reflection at a visible normal: VisiblePdf / (4 |wo.wm|).
template <typename Microfacets>
float ReflectionPdf(const Microfacets& microfacets, const Vec3& wo, const Vec3& wm) {
  return microfacets.D(wm) * microfacets.VisiblePdfOverD(wo, wm) / 4;
}

/// D G / (4 |cos wo| |cos wi|).
template <typename Microfacets>
float ReflectionValue(const Microfacets& microfacets, const Vec3& wo, const Vec3& wi, const Vec3& wm) {
  return microfacets.D(wm) * microfacets.GOverCosines(wo, wi, wm) / 2;
}

template <typename Microfacets>
float ReflectionPdfSameSide(const Microfacets& microfacets, const Vec3& wo, const Vec3& wi) {
  return SameHemisphere(wo, wi) ? ReflectionPdf(microfacets, wo, HalfVector(wo, wi)) : 0;
}

/// The mirror direction at a visible normal; nothing where it points below the surface.
template <typename Microfacets>
std::optional<LobeSample> SampleReflection(const Microfacets& microfacets, const Vec3& wo, double uc, const Vec2d& u) {
  const Vec3 wi = Normalize(ReflectAbout(wo, microfacets.SampleVisible(wo, u, &uc)));
  if (!SameHemisphere(wo, wi)) return std::nullopt;
  LobeSample sample;
  sample.wi = wi;
  sample.pdf = ReflectionPdfSameSide(microfacets, wo, wi);
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

template <typename Microfacets>
Color RoughConductor<Microfacets>::Value(const Vec3& wo, const Vec3& wi, TransportMode) const {
  if (!SameHemisphere(wo, wi)) return Color();
  const Vec3 wm = HalfVector(wo, wi);
  return FresnelConductor(Dot(wi, wm), eta, k) * ReflectionValue(microfacets, wo, wi, wm);
}

template <typename Microfacets>
float RoughConductor<Microfacets>::Pdf(const Vec3& wo, const Vec3& wi) const {
  return ReflectionPdfSameSide(microfacets, wo, wi);
}

template <typename Microfacets>
std::optional<LobeSample> RoughConductor<Microfacets>::Sample(const Vec3& wo, double uc, const Vec2d& u,
                                                              TransportMode) const {
  return SampleReflection(microfacets, wo, uc, u);
}

template <typename Microfacets>
Color RoughConductor<Microfacets>::Albedo(const Vec3& wo) const {
  return FresnelConductor(CosTheta(wo), eta, k);
}

template <typename Microfacets>
Color RoughDielectricReflection<Microfacets>::Value(const Vec3& wo, const Vec3& wi, TransportMode) const {
  if (!SameHemisphere(wo, wi)) return Color();
  const Vec3 wm = HalfVector(wo, wi);
  const float fresnel = FresnelDielectric(AbsDot(wi, wm), wo.z > 0 ? etaAbove : etaBelow);
  return reflectance * (fresnel * ReflectionValue(microfacets, wo, wi, wm));
}

template <typename Microfacets>
float RoughDielectricReflection<Microfacets>::Pdf(const Vec3& wo, const Vec3& wi) const {
  return ReflectionPdfSameSide(microfacets, wo, wi);
}

template <typename Microfacets>
std::optional<LobeSample> RoughDielectricReflection<Microfacets>::Sample(const Vec3& wo, double uc, const Vec2d& u,
                                                                         TransportMode) const {
  return SampleReflection(microfacets, wo, uc, u);
}

template <typename Microfacets>
Color RoughDielectricReflection<Microfacets>::Albedo(const Vec3& wo) const {
  return reflectance * FresnelDielectric(AbsCosTheta(wo), wo.z > 0 ? etaAbove : etaBelow);
}

template <typename Microfacets>
LobeFlags RoughDielectric<Microfacets>::Flags() const {
  LobeFlags flags;
  if (!reflectance.IsBlack()) flags |= LobeFlags::kGlossyReflection;
  if (!transmittance.IsBlack()) flags |= LobeFlags::kGlossyTransmission;
  return flags;
}

template <typename Microfacets>
float RoughDielectric<Microfacets>::ReflectionProbability(float fresnel) const {
  const float r = fresnel * reflectance.MaxComponent(), t = (1 - fresnel) * transmittance.MaxComponent();
  return r > 0 ? r / (r + t) : 0;
}

template <typename Microfacets>
Color RoughDielectric<Microfacets>::Value(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
  const std::optional<Facet> facet = FindFacet(wo, wi, eta);
  if (!facet) return Color();
  if (facet->isReflection) return reflectance * (facet->fresnel * ReflectionValue(microfacets, wo, wi, facet->wm));
  // Walter et al. 2007, equation 21: |wi.wm| etaRatio^2 / |wo + etaRatio wi|^2 is d wm / d wi.
  const float cosines = AbsDot(wo, facet->wm) * AbsDot(wi, facet->wm) / facet->halfLengthSquared;
  const float value =
      (1 - facet->fresnel) * microfacets.D(facet->wm) * 2 * microfacets.GOverCosines(wo, wi, facet->wm) * cosines;
  return transmittance * (mode == TransportMode::Radiance ? value : value * Sqr(facet->etaRatio));
}

template <typename Microfacets>
float RoughDielectric<Microfacets>::Pdf(const Vec3& wo, const Vec3& wi) const {
  const std::optional<Facet> facet = FindFacet(wo, wi, eta);
  if (!facet) return 0;
  const float probability = ReflectionProbability(facet->fresnel);
  if (facet->isReflection) return ReflectionPdf(microfacets, wo, facet->wm) * probability;
  const float dwmDwi = AbsDot(wi, facet->wm) * Sqr(facet->etaRatio) / facet->halfLengthSquared;
  return microfacets.VisiblePdf(wo, facet->wm) * dwmDwi * (1 - probability);
}

template <typename Microfacets>
std::optional<LobeSample> RoughDielectric<Microfacets>::Sample(const Vec3& wo, double uc, const Vec2d& u,
                                                               TransportMode) const {
  const Vec3 wm = FaceForward(microfacets.SampleVisible(wo, u, &uc), Vec3(0, 0, 1));
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

template <typename Microfacets>
Color RoughDielectric<Microfacets>::Albedo(const Vec3& wo) const {
  const float fresnel = FresnelDielectric(CosTheta(wo), eta);
  return reflectance * fresnel + transmittance * (1 - fresnel);
}

template <typename Microfacets>
Color FresnelBlend<Microfacets>::Value(const Vec3& wo, const Vec3& wi, TransportMode) const {
  if (!SameHemisphere(wo, wi)) return Color();
  const float cosO = AbsCosTheta(wo), cosI = AbsCosTheta(wi);
  const auto pow5 = [](float x) { return Sqr(Sqr(x)) * x; };
  const float base = 28 / (23 * kPi) * (1 - pow5(1 - cosI / 2)) * (1 - pow5(1 - cosO / 2));
  const Vec3 wm = HalfVector(wo, wi);
  const float cosM = AbsDot(wi, wm);
  const float gloss = microfacets.D(wm) / (4 * cosM * std::max(cosI, cosO));
  return diffuse * (Color(1) - specular) * base + FresnelSchlick(cosM, specular) * gloss;
}

template <typename Microfacets>
float FresnelBlend<Microfacets>::GlossProbability(const Vec3& wo) const {
  const float gloss = FresnelSchlick(AbsCosTheta(wo), specular).MaxComponent();
  return gloss / (gloss + diffuse.MaxComponent());
}

template <typename Microfacets>
float FresnelBlend<Microfacets>::Pdf(const Vec3& wo, const Vec3& wi) const {
  if (!SameHemisphere(wo, wi)) return 0;
  const float gloss = GlossProbability(wo);
  return gloss * ReflectionPdf(microfacets, wo, HalfVector(wo, wi)) + (1 - gloss) * AbsCosTheta(wi) * kInvPi;
}

template <typename Microfacets>
std::optional<LobeSample> FresnelBlend<Microfacets>::Sample(const Vec3& wo, double uc, const Vec2d& u,
                                                            TransportMode) const {
  LobeSample sample;
  const auto glossProbability = static_cast<double>(GlossProbability(wo));
  if (uc < glossProbability) {
    const std::optional<LobeSample> gloss = SampleReflection(microfacets, wo, uc / glossProbability, u);
    if (!gloss) return std::nullopt;
    sample = *gloss;
  } else {
    sample = SampleCosineOn(wo.z, u, LobeFlags::kDiffuseReflection);
  }
  sample.pdf = Pdf(wo, sample.wi);
  return sample;
}

template <typename Microfacets>
Color FresnelBlend<Microfacets>::Albedo(const Vec3& wo) const {
  // The base's integral is exact; the gloss is taken as a mirror.
  const float m = 1 - AbsCosTheta(wo) / 2;
  return diffuse * (Color(1) - specular) * (1 - Sqr(Sqr(m)) * m) + FresnelSchlick(AbsCosTheta(wo), specular);
}

template struct RoughConductor<Ggx>;
template struct RoughConductor<Beckmann>;
template struct RoughConductor<CosinePower>;
template struct RoughDielectricReflection<Ggx>;
template struct RoughDielectricReflection<Beckmann>;
template struct RoughDielectricReflection<CosinePower>;
template struct RoughDielectric<Ggx>;
template struct RoughDielectric<Beckmann>;
template struct RoughDielectric<CosinePower>;
template struct FresnelBlend<Ggx>;
template struct FresnelBlend<Beckmann>;
template struct FresnelBlend<CosinePower>;

}  // namespace dapple
