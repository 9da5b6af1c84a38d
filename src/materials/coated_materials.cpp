#include "src/materials/coated_materials.h"

#include "src/materials/fresnel.h"
#include "src/materials/material_parts.h"

namespace dapple {

namespace {

/// What the coat itself reflects; both of its sides are outside.
void AddCoat(const std::optional<Ggx>& ggx, float eta, Bsdf* bsdf) {
  if (ggx) {
    bsdf->Add(RoughDielectricReflection{*ggx, Color(1), eta, eta});
  } else {
    bsdf->Add(CoatReflection(eta));
  }
}

}  // namespace

CoatedDiffuseMaterial::CoatedDiffuseMaterial(ColorTexturePtr reflectance, Roughness roughness, float eta,
                                             SurfaceDetailPtr detail)
    : reflectance_(std::move(reflectance)),
      roughness_(std::move(roughness)),
      eta_(eta),
      diffuseReflectance_(FresnelDiffuseReflectance(eta)),
      detail_(std::move(detail)) {
  if (roughness_.IsAlwaysSmooth() || NearIndexMatch(eta)) return;
  if (const std::optional<Ggx> ggx = roughness_.Constant()) {
    const float alpha = std::sqrt(ggx->AlphaX() * ggx->AlphaY());
    roughCoat_.emplace(eta, alpha, alpha);
  } else {
    roughCoat_.emplace(eta, 1e-3f, 1.f);
  }
}

Bsdf CoatedDiffuseMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  const TextureContext at(hit);
  const Color rho = EvaluateShare(reflectance_, at, Color());
  const std::optional<Ggx> ggx = roughCoat_ ? roughness_.Evaluate(at) : std::nullopt;
  if (ggx) {
    bsdf.Add(CoatedDiffuseBase(rho, eta_, std::sqrt(ggx->AlphaX() * ggx->AlphaY()), *roughCoat_));
  } else {
    bsdf.Add(CoatedDiffuseBase(rho, eta_, diffuseReflectance_));
  }
  AddCoat(ggx, eta_, &bsdf);
  return bsdf;
}

MaterialFacts CoatedDiffuseMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  if (!IsAlwaysBlack(reflectance_, true)) AddFact(LobeFlags::kDiffuseReflection, 1, &facts);
  if (eta_ == 1) return facts;
  if (roughCoat_) {
    AddFact(roughness_, LobeFlags::kGlossyReflection, LobeFlags::kSpecularReflection, &facts);
  } else {
    AddFact(LobeFlags::kSpecularReflection, 0, &facts);
  }
  return facts;
}

CoatedConductorMaterial::CoatedConductorMaterial(Parameters parameters, SurfaceDetailPtr detail)
    : parameters_(std::move(parameters)), detail_(std::move(detail)) {
  parameters_.coatEta = std::max(parameters_.coatEta, 1.f);
}

Bsdf CoatedConductorMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  Bsdf bsdf = BlackBsdf(hit, detail_);
  const TextureContext at(hit);
  const float coatEta = parameters_.coatEta;
  Color eta(1), k;
  if (parameters_.reflectance) {
    k = ConductorKFromReflectance(EvaluateShare(parameters_.reflectance, at, Color()));
  } else {
    eta = parameters_.eta->Evaluate(at);
    k = parameters_.k->Evaluate(at);
  }
  // Relative to the coat; pbrt does so too where the metal is given by its reflectance.
  eta /= coatEta;
  k /= coatEta;
  const std::optional<Ggx> coat = parameters_.coatRoughness.Evaluate(at);
  const std::optional<Ggx> metal = parameters_.conductorRoughness.Evaluate(at);
  if (!coat && !metal) {
    bsdf.Add(CoatedConductorReflection(coatEta, eta, k));
    return bsdf;
  }
  // Rough at either interface: what comes back from the metal is as rough as the rougher of the two.
  const Ggx base = !metal  ? *coat
                   : !coat ? *metal
                           : Ggx(std::max(metal->AlphaX(), coat->AlphaX()), std::max(metal->AlphaY(), coat->AlphaY()));
  AddCoat(coat, coatEta, &bsdf);
  bsdf.Add(CoatedRoughConductor{base, coatEta, eta, k});
  return bsdf;
}

MaterialFacts CoatedConductorMaterial::Facts() const {
  MaterialFacts facts = NoFacts();
  const Roughness& coat = parameters_.coatRoughness;
  const Roughness& metal = parameters_.conductorRoughness;
  if (!coat.IsAlwaysRough()) AddFact(LobeFlags::kSpecularReflection, 0, &facts, 0);
  if (!coat.IsAlwaysSmooth() || !metal.IsAlwaysSmooth()) {
    const float coatAlpha = coat.IsAlwaysSmooth() ? 1 : coat.MinAlpha();
    const float metalAlpha = metal.IsAlwaysSmooth() ? 1 : metal.MinAlpha();
    AddFact(LobeFlags::kGlossyReflection, std::min(coatAlpha, metalAlpha), &facts, 0);
  }
  facts.maxLobes = 2;
  return facts;
}

}  // namespace dapple
