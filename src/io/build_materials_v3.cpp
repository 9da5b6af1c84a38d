#include <fmt/format.h>

#include "src/io/build_material_types.h"
#include "src/materials/conductor_materials.h"
#include "src/materials/dielectric_materials.h"
#include "src/materials/diffuse_materials.h"
#include "src/materials/named_spectra.h"
#include "src/materials/plastic_materials.h"
#include "src/materials/procedural_textures.h"

namespace dapple {

namespace {

RoughnessRemap Remap(const MaterialInput& in) {
  return in.Params().GetBool("remaproughness", true) ? RoughnessRemap::V3 : RoughnessRemap::None;
}

FloatTexturePtr EtaOrIndex(const MaterialInput& in) {
  FloatTexturePtr eta = in.values.FindIndexOfRefraction(in.Params(), "eta");
  FloatTexturePtr index = in.values.FindIndexOfRefraction(in.Params(), "index");
  if (eta) return eta;
  return index ? index : MakeConstant(1.5f);
}

/// As pbrt-v3: of glass and substrate, "roughness" alone says nothing.
Roughness TwoRoughnesses(const MaterialInput& in, double fallback) {
  return WithDistribution(in,
                          {in.RoughnessOf("uroughness", fallback), in.RoughnessOf("vroughness", fallback), Remap(in)});
}

/// As pbrt-v3: of plastic and translucent, the gloss is isotropic.
Roughness OneRoughness(const MaterialInput& in) {
  return WithDistribution(in, {in.RoughnessOf("roughness", 0.1), Remap(in)});
}

std::unique_ptr<Material> BuildMatte(const MaterialInput& in) {
  return std::make_unique<MatteMaterial>(in.ShareOf("Kd", 0.5), in.FloatOf("sigma", 0), BuildDetail(in));
}

std::unique_ptr<Material> BuildPlastic(const MaterialInput& in) {
  return std::make_unique<PlasticMaterial>(in.ShareOf("Kd", 0.25), in.ShareOf("Ks", 0.25), OneRoughness(in),
                                           BuildDetail(in));
}

std::unique_ptr<Material> BuildTranslucent(const MaterialInput& in) {
  return std::make_unique<TranslucentMaterial>(in.ShareOf("Kd", 0.25), in.ShareOf("Ks", 0.25), OneRoughness(in),
                                               in.ShareOf("reflect", 0.5), in.ShareOf("transmit", 0.5),
                                               BuildDetail(in));
}

bool IsZero(const FloatTexturePtr& texture) {
  return !texture || (texture->IsConstant() && texture->Evaluate(TextureContext()) == 0);
}

/// Glass of roughness 0 is smooth; elsewhere pbrt-v3 maps 0 to a GGX alpha of 0.047.
Roughness GlassRoughness(const MaterialInput& in) {
  const Roughness roughness = TwoRoughnesses(in, 0);
  const auto isZero = [&](const char* name) { return IsZero(in.values.FindFloat(in.Params(), name)); };
  return isZero("uroughness") && isZero("vroughness") ? Roughness() : roughness;
}

std::unique_ptr<Material> BuildGlass(const MaterialInput& in) {
  return std::make_unique<DielectricMaterial>(EtaOrIndex(in), GlassRoughness(in), in.ShareOf("Kr", 1),
                                              in.ShareOf("Kt", 1), BuildDetail(in));
}

std::unique_ptr<Material> BuildMirror(const MaterialInput& in) {
  return std::make_unique<MirrorMaterial>(in.ShareOf("Kr", 0.9), BuildDetail(in));
}

std::unique_ptr<Material> BuildMetal(const MaterialInput& in) {
  for (const char* name : {"eta", "k"}) CheckBounds(in.Params(), name, kNotNegative);
  const auto copper = [](const char* name) { return SpectrumToColorV3(NamedSpectrum(name)); };
  ColorTexturePtr eta = in.values.GetColor(in.Params(), "eta", copper("metal-Cu-eta"));
  ColorTexturePtr k = in.values.GetColor(in.Params(), "k", copper("metal-Cu-k"));
  const Roughness roughness = WithDistribution(in, BuildRoughness(in, 0.01, Remap(in)));
  return std::make_unique<ConductorMaterial>(eta, k, roughness, BuildDetail(in));
}

std::unique_ptr<Material> BuildSubstrate(const MaterialInput& in) {
  auto substrate = std::make_unique<SubstrateMaterial>(in.ShareOf("Kd", 0.5), in.ShareOf("Ks", 0.5),
                                                       TwoRoughnesses(in, 0.1), BuildDetail(in));
  if (const float most = substrate->LargestUnscaledReflectance().value_or(1); most > 1) {
    in.values.Context().diagnostics.Warn(
        in.material.location,
        fmt::format("so rough and bright a substrate would reflect up to {:.3g} times the light that arrives: it is "
                    "scaled down by as much",
                    static_cast<double>(most)));
  }
  return substrate;
}

std::unique_ptr<Material> BuildUber(const MaterialInput& in) {
  UberMaterial::Parameters parameters;
  parameters.kd = in.ShareOf("Kd", 0.25);
  parameters.ks = in.ShareOf("Ks", 0.25);
  parameters.kr = in.ShareOf("Kr", 0);
  parameters.kt = in.ShareOf("Kt", 0);
  parameters.opacity = in.ShareOf("opacity", 1);
  parameters.eta = EtaOrIndex(in);
  parameters.roughness = WithDistribution(in, BuildRoughness(in, 0.1, Remap(in)));
  return std::make_unique<UberMaterial>(parameters, BuildDetail(in));
}

}  // namespace

std::unique_ptr<Material> BuildV3Material(const MaterialInput& in) {
  const std::string& type = in.material.type;
  if (type == "matte") return BuildMatte(in);
  if (type == "plastic") return BuildPlastic(in);
  if (type == "translucent") return BuildTranslucent(in);
  if (type == "glass") return BuildGlass(in);
  if (type == "mirror") return BuildMirror(in);
  if (type == "metal") return BuildMetal(in);
  if (type == "substrate") return BuildSubstrate(in);
  if (type == "uber") return BuildUber(in);
  return nullptr;
}

}  // namespace dapple
