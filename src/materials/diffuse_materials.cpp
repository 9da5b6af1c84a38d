#include "src/materials/diffuse_materials.h"

#include "src/materials/material_parts.h"

namespace dapple {

namespace {
/// Of pbrt-v3's translucent sheets.
constexpr float kTranslucentEta = 1.5f;
}  // namespace

MatteMaterial::MatteMaterial(ColorTexturePtr reflectance, FloatTexturePtr sigma, SurfaceDetailPtr detail)
    : reflectance_(std::move(reflectance)), sigma_(std::move(sigma)), detail_(std::move(detail)) {}

Bsdf MatteMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  const TextureContext at(hit);
  const Color reflectance = EvaluateShare(reflectance_, at, Color());
  const float sigma = sigma_ ? sigma_->Evaluate(at) : 0;
  if (sigma > 0) {
    bsdf.Add(OrenNayarReflection(reflectance, std::min(sigma, 90.f)));
  } else {
    bsdf.Add(LambertianReflection{reflectance});
  }
  return bsdf;
}

MaterialFacts MatteMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  if (!IsAlwaysBlack(reflectance_, true)) AddFact(LobeFlags::kDiffuseReflection, 1, &facts);
  return facts;
}

DiffuseTransmissionMaterial::DiffuseTransmissionMaterial(ColorTexturePtr reflectance, ColorTexturePtr transmittance,
                                                         float scale, SurfaceDetailPtr detail)
    : reflectance_(std::move(reflectance)),
      transmittance_(std::move(transmittance)),
      scale_(scale),
      detail_(std::move(detail)) {}

Bsdf DiffuseTransmissionMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  const TextureContext at(hit);
  bsdf.Add(LambertianReflection{EvaluateShare(reflectance_, at, Color(), scale_)});
  bsdf.Add(LambertianTransmission{EvaluateShare(transmittance_, at, Color(), scale_)});
  return bsdf;
}

MaterialFacts DiffuseTransmissionMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  if (!(scale_ > 0)) return facts;
  if (!IsAlwaysBlack(reflectance_, true)) AddFact(LobeFlags::kDiffuseReflection, 1, &facts);
  if (!IsAlwaysBlack(transmittance_, true)) AddFact(LobeFlags::kDiffuseTransmission, 1, &facts);
  return facts;
}

TranslucentMaterial::TranslucentMaterial(ColorTexturePtr kd, ColorTexturePtr ks, Roughness roughness,
                                         ColorTexturePtr reflect, ColorTexturePtr transmit, SurfaceDetailPtr detail)
    : kd_(std::move(kd)),
      ks_(std::move(ks)),
      reflect_(std::move(reflect)),
      transmit_(std::move(transmit)),
      roughness_(std::move(roughness)),
      detail_(std::move(detail)) {}

Bsdf TranslucentMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  const TextureContext at(hit);
  const Color reflect = EvaluateShare(reflect_, at, Color()), transmit = EvaluateShare(transmit_, at, Color());
  const Color kd = EvaluateShare(kd_, at, Color()), ks = EvaluateShare(ks_, at, Color());
  bsdf.Add(LambertianReflection{kd * reflect});
  bsdf.Add(LambertianTransmission{kd * transmit});
  if (const std::optional<Ggx> ggx = roughness_.Evaluate(at)) {
    WithMicrofacets(roughness_.Kind(), *ggx, [&](const auto& microfacets) {
      bsdf.Add(RoughDielectric{microfacets, kTranslucentEta, ks * reflect, ks * transmit});
    });
  } else {
    bsdf.Add(SmoothDielectric(kTranslucentEta, ks * reflect, ks * transmit));
  }
  return bsdf;
}

MaterialFacts TranslucentMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  const bool reflects = !IsAlwaysBlack(reflect_, true), transmits = !IsAlwaysBlack(transmit_, true);
  if (!IsAlwaysBlack(kd_, true)) {
    if (reflects) AddFact(LobeFlags::kDiffuseReflection, 1, &facts);
    if (transmits) AddFact(LobeFlags::kDiffuseTransmission, 1, &facts);
  }
  if (!IsAlwaysBlack(ks_, true) && (reflects || transmits)) {
    LobeFlags glossy, smooth;
    if (reflects) glossy |= LobeFlags::kGlossyReflection, smooth |= LobeFlags::kSpecularReflection;
    if (transmits) glossy |= LobeFlags::kGlossyTransmission, smooth |= LobeFlags::kSpecularTransmission;
    AddFact(roughness_, glossy, smooth, &facts);
  }
  return facts;
}

}  // namespace dapple
