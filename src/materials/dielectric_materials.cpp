#include "src/materials/dielectric_materials.h"

#include "src/materials/material_parts.h"

namespace dapple {

DielectricMaterial::DielectricMaterial(FloatTexturePtr eta, Roughness roughness, ColorTexturePtr kr, ColorTexturePtr kt,
                                       SurfaceDetailPtr detail)
    : eta_(std::move(eta)),
      roughness_(std::move(roughness)),
      kr_(std::move(kr)),
      kt_(std::move(kt)),
      detail_(std::move(detail)) {}

Bsdf DielectricMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  const TextureContext at(hit);
  const float eta = EvaluateEta(eta_, at);
  const Color kr = EvaluateShare(kr_, at, Color(1)), kt = EvaluateShare(kt_, at, Color(1));
  const std::optional<Ggx> ggx = roughness_.Evaluate(at);
  if (ggx && !NearIndexMatch(eta)) {
    WithMicrofacets(roughness_.Kind(), *ggx, [&](const auto& microfacets) {
      bsdf.Add(RoughDielectric{microfacets, eta, kr, kt});
    });
  } else {
    bsdf.Add(SmoothDielectric(eta, kr, kt));
  }
  return bsdf;
}

MaterialFacts DielectricMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  LobeFlags glossy, smooth;
  if (!IsAlwaysBlack(kr_)) glossy |= LobeFlags::kGlossyReflection, smooth |= LobeFlags::kSpecularReflection;
  if (!IsAlwaysBlack(kt_)) glossy |= LobeFlags::kGlossyTransmission, smooth |= LobeFlags::kSpecularTransmission;
  if (smooth.IsEmpty()) return facts;
  const bool constantEta = eta_->IsConstant();
  if (constantEta && NearIndexMatch(EvaluateEta(eta_, TextureContext()))) {
    AddFact(smooth, 0, &facts);
    return facts;
  }
  AddFact(roughness_, glossy, smooth, &facts);
  if (!constantEta) AddFact(smooth, 0, &facts, 0);
  return facts;
}

ThinDielectricMaterial::ThinDielectricMaterial(FloatTexturePtr eta, SurfaceDetailPtr detail)
    : eta_(std::move(eta)), detail_(std::move(detail)) {}

Bsdf ThinDielectricMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  bsdf.Add(ThinDielectric(EvaluateEta(eta_, TextureContext(hit))));
  return bsdf;
}

MaterialFacts ThinDielectricMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  AddFact(LobeFlags::kSpecularReflection | LobeFlags::kSpecularTransmission, 0, &facts);
  return facts;
}

}  // namespace dapple
