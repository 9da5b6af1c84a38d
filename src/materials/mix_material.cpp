#include "src/materials/mix_material.h"

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/materials/material_parts.h"

namespace dapple {

namespace {

MaterialFacts FactsOf(const Material* material) {
  if (material) return material->Facts();
  MaterialFacts facts = NoFacts();
  AddFact(LobeFlags::kSpecularTransmission, 0, &facts);
  return facts;
}

Bsdf BsdfOf(const Material* material, const SurfaceInteraction& hit) {
  if (material) return material->GetBsdf(hit);
  Bsdf bsdf(hit);
  bsdf.Add(PassThrough());
  return bsdf;
}

}  // namespace

MixMaterial::MixMaterial(std::shared_ptr<const Material> first, std::shared_ptr<const Material> second,
                         ColorTexturePtr amount)
    : first_(std::move(first)), second_(std::move(second)), amount_(std::move(amount)), facts_(FindFacts()) {
  const int lobes = facts_.maxLobes;
  if (lobes > Bsdf::kMaxLobes) {
    throw Error(fmt::format("the mixed materials have {} lobes in all; expected at most {}: mix fewer materials", lobes,
                            Bsdf::kMaxLobes));
  }
}

Bsdf MixMaterial::GetBsdf(const SurfaceInteraction& hit) const {
  const Color ofFirst = EvaluateShare(amount_, TextureContext(hit), Color());
  const Color ofSecond = Color(1) - ofFirst;
  if (ofSecond.IsBlack()) return BsdfOf(first_.get(), hit);
  if (ofFirst.IsBlack()) return BsdfOf(second_.get(), hit);
  const Bsdf first = BsdfOf(first_.get(), hit), second = BsdfOf(second_.get(), hit);
  Bsdf blend(hit, (ofFirst.Average() >= 0.5f ? first : second).ShadingFrame());
  blend.Add(first, ofFirst);
  blend.Add(second, ofSecond);
  return blend;
}

MaterialFacts MixMaterial::FindFacts() const {
  const MaterialFacts first = FactsOf(first_.get()), second = FactsOf(second_.get());
  if (amount_->IsConstant()) {
    const Color amount = EvaluateShare(amount_, TextureContext(), Color());
    if (amount == Color(1)) return first;
    if (amount.IsBlack()) return second;
  }
  MaterialFacts facts = first;
  facts.hasSpecular |= second.hasSpecular;
  facts.hasNonSpecular |= second.hasNonSpecular;
  facts.hasTransmission |= second.hasTransmission;
  facts.isBlack = first.isBlack && second.isBlack;
  facts.minRoughness = std::min(first.minRoughness, second.minRoughness);
  facts.maxLobes = first.maxLobes + second.maxLobes;
  return facts;
}

}  // namespace dapple
