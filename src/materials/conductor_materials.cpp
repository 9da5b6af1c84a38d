#include "src/materials/conductor_materials.h"

#include "src/materials/fresnel.h"
#include "src/materials/material_parts.h"

namespace dapple {

MirrorMaterial::MirrorMaterial(ColorTexturePtr reflectance, SurfaceDetailPtr detail)
    : reflectance_(std::move(reflectance)), detail_(std::move(detail)) {}

Bsdf MirrorMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  bsdf.Add(MirrorReflection(EvaluateShare(reflectance_, TextureContext(hit), Color())));
  return bsdf;
}

MaterialFacts MirrorMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  if (!IsAlwaysBlack(reflectance_, true)) AddFact(LobeFlags::kSpecularReflection, 0, &facts);
  return facts;
}

ConductorMaterial::ConductorMaterial(ColorTexturePtr eta, ColorTexturePtr k, Roughness roughness,
                                     SurfaceDetailPtr detail)
    : eta_(std::move(eta)), k_(std::move(k)), roughness_(std::move(roughness)), detail_(std::move(detail)) {}

ConductorMaterial::ConductorMaterial(ColorTexturePtr reflectance, Roughness roughness, SurfaceDetailPtr detail)
    : reflectance_(std::move(reflectance)), roughness_(std::move(roughness)), detail_(std::move(detail)) {}

Bsdf ConductorMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  const TextureContext at(hit);
  const Color eta = eta_ ? eta_->Evaluate(at) : Color(1);
  const Color k = k_ ? k_->Evaluate(at) : ConductorKFromReflectance(EvaluateShare(reflectance_, at, Color()));
  if (const std::optional<Ggx> ggx = roughness_.Evaluate(at)) {
    WithMicrofacets(roughness_.Kind(), *ggx, [&](const auto& microfacets) {
      bsdf.Add(RoughConductor{microfacets, eta, k});
    });
  } else {
    bsdf.Add(ConductorReflection(eta, k));
  }
  return bsdf;
}

MaterialFacts ConductorMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  AddFact(roughness_, LobeFlags::kGlossyReflection, LobeFlags::kSpecularReflection, &facts);
  return facts;
}

}  // namespace dapple
