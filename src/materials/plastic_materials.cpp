#include "src/materials/plastic_materials.h"

#include "src/materials/material_parts.h"

namespace dapple {

namespace {

/// A gloss `ks` beside whatever else the BSDF holds; pbrt-v3's smallest alpha, 1e-3, where it is smooth.
void AddGloss(const Roughness& roughness, const TextureContext& at, const Color& ks, float etaAbove, Bsdf* bsdf) {
  if (ks.IsBlack()) return;
  const Ggx ggx = roughness.Evaluate(at).value_or(Ggx(1e-3f, 1e-3f));
  WithMicrofacets(roughness.Kind(), ggx, [&](const auto& microfacets) {
    bsdf->Add(RoughDielectricReflection{microfacets, ks, etaAbove, 1 / etaAbove});
  });
}

float GlossAlpha(const Roughness& roughness) { return roughness.IsAlwaysSmooth() ? 1e-3f : roughness.MinAlpha(); }

}  // namespace

PlasticMaterial::PlasticMaterial(ColorTexturePtr kd, ColorTexturePtr ks, Roughness roughness, SurfaceDetailPtr detail)
    : kd_(std::move(kd)), ks_(std::move(ks)), roughness_(std::move(roughness)), detail_(std::move(detail)) {}

Bsdf PlasticMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  const TextureContext at(hit);
  bsdf.Add(LambertianReflection{EvaluateShare(kd_, at, Color())});
  // pbrt-v3 gives its Fresnel term (1.5, 1) for (index of incidence, of transmission): from inside, total reflection
  // and all.
  AddGloss(roughness_, at, EvaluateShare(ks_, at, Color()), 1 / 1.5f, &bsdf);
  return bsdf;
}

MaterialFacts PlasticMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  if (!IsAlwaysBlack(kd_, true)) AddFact(LobeFlags::kDiffuseReflection, 1, &facts);
  if (!IsAlwaysBlack(ks_, true)) AddFact(LobeFlags::kGlossyReflection, GlossAlpha(roughness_), &facts);
  return facts;
}

SubstrateMaterial::SubstrateMaterial(ColorTexturePtr kd, ColorTexturePtr ks, Roughness roughness,
                                     SurfaceDetailPtr detail)
    : kd_(std::move(kd)), ks_(std::move(ks)), roughness_(std::move(roughness)), detail_(std::move(detail)) {
  if (const std::optional<Ggx> constant = roughness_.Constant()) energy_ = BlendEnergy(roughness_.Kind(), *constant);
}

Bsdf SubstrateMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  const TextureContext at(hit);
  const Color kd = EvaluateShare(kd_, at, Color()), ks = EvaluateShare(ks_, at, Color());
  if (kd.IsBlack() && ks.IsBlack()) return bsdf;
  const Ggx ggx = roughness_.Evaluate(at).value_or(Ggx(1e-3f, 1e-3f));
  const BlendEnergy energy = energy_ ? *energy_ : BlendEnergy(roughness_.Kind(), ggx);
  WithMicrofacets(roughness_.Kind(), ggx, [&](const auto& microfacets) {
    bsdf.Add(FresnelBlend{microfacets, kd, ks}, energy.Scale(ks));
  });
  return bsdf;
}

std::optional<float> SubstrateMaterial::LargestUnscaledReflectance() const {
  if (!energy_) return std::nullopt;
  const Color ks = ks_ && ks_->IsConstant() ? EvaluateShare(ks_, TextureContext(), Color()) : Color(ks_ ? 1 : 0);
  return energy_->LargestReflectance(ks).MaxComponent();
}

MaterialFacts SubstrateMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  if (IsAlwaysBlack(kd_, true) && IsAlwaysBlack(ks_, true)) return facts;
  AddFact(LobeFlags::kDiffuseReflection | LobeFlags::kGlossyReflection, GlossAlpha(roughness_), &facts);
  return facts;
}

UberMaterial::UberMaterial(Parameters parameters, SurfaceDetailPtr detail)
    : parameters_(std::move(parameters)), detail_(std::move(detail)) {}

Bsdf UberMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  const TextureContext at(hit);
  const Color opacity = EvaluateShare(parameters_.opacity, at, Color(1));
  const float eta = parameters_.eta ? EvaluateEta(parameters_.eta, at) : 1.5f;
  const auto share = [&](const ColorTexturePtr& texture) { return opacity * EvaluateShare(texture, at, Color()); };
  bsdf.Add(LambertianReflection{share(parameters_.kd)});
  AddGloss(parameters_.roughness, at, share(parameters_.ks), eta, &bsdf);
  bsdf.Add(SmoothDielectric(eta, share(parameters_.kr), share(parameters_.kt)));
  bsdf.Add(PassThrough(Color(1) - opacity));
  return bsdf;
}

MaterialFacts UberMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  const ColorTexturePtr& opacity = parameters_.opacity;
  if (opacity && !(opacity->IsConstant() && EvaluateShare(opacity, TextureContext(), Color()) == Color(1))) {
    AddFact(LobeFlags::kSpecularTransmission, 0, &facts);
  }
  if (IsAlwaysBlack(opacity)) return facts;
  if (!IsAlwaysBlack(parameters_.kd, true)) AddFact(LobeFlags::kDiffuseReflection, 1, &facts);
  if (!IsAlwaysBlack(parameters_.ks, true)) {
    AddFact(LobeFlags::kGlossyReflection, GlossAlpha(parameters_.roughness), &facts);
  }
  LobeFlags smooth;
  if (!IsAlwaysBlack(parameters_.kr, true)) smooth |= LobeFlags::kSpecularReflection;
  if (!IsAlwaysBlack(parameters_.kt, true)) smooth |= LobeFlags::kSpecularTransmission;
  AddFact(smooth, 0, &facts);
  return facts;
}

}  // namespace dapple
