#include <fmt/format.h>

#include "src/io/build_material_types.h"
#include "src/materials/coated_materials.h"
#include "src/materials/conductor_materials.h"
#include "src/materials/dielectric_materials.h"
#include "src/materials/diffuse_materials.h"
#include "src/materials/named_spectra.h"
#include "src/materials/procedural_textures.h"

namespace dapple {

namespace {

RoughnessRemap Remap(const MaterialInput& in) {
  return in.Params().GetBool("remaproughness", true) ? RoughnessRemap::V4 : RoughnessRemap::None;
}

FloatTexturePtr Eta(const MaterialInput& in) {
  FloatTexturePtr eta = in.values.FindIndexOfRefraction(in.Params(), "eta");
  return eta ? eta : MakeConstant(1.5f);
}

/// A metal's index by eta and k, or by its reflectance; copper where the file says nothing.
struct Metal {
  ColorTexturePtr eta, k, reflectance;
};

Metal BuildMetal(const MaterialInput& in, const std::string& prefix, const std::string& reflectanceName) {
  Metal metal;
  const std::string etaName = prefix + "eta", kName = prefix + "k";
  for (const std::string& name : {etaName, kName}) CheckBounds(in.Params(), name, kNotNegative);
  WarnOfClampedShare(in.Params(), reflectanceName, 1, in.values.Context().diagnostics);
  metal.eta = in.values.FindColor(in.Params(), etaName);
  metal.k = in.values.FindColor(in.Params(), kName);
  metal.reflectance = in.values.FindColor(in.Params(), reflectanceName);
  if (metal.reflectance) {
    if (metal.eta || metal.k)
      throw Error(in.Params().LocationOf(reflectanceName, in.material.location),
                  fmt::format("both \"{}\" and \"{}\" or \"{}\" are given, expected one way to say what the metal is",
                              reflectanceName, etaName, kName));
    return metal;
  }
  if (!metal.eta) metal.eta = MakeConstant(SpectrumToColorV4(NamedSpectrum("metal-Cu-eta")));
  if (!metal.k) metal.k = MakeConstant(SpectrumToColorV4(NamedSpectrum("metal-Cu-k")));
  return metal;
}

/// What pbrt's random walk inside a coat needs; the closed form here has no medium and no limits.
void LookUpLayerParameters(const MaterialInput& in) {
  in.Params().Find("twosided");
  CheckBounds(in.Params(), "maxdepth", kNotNegative);
  CheckBounds(in.Params(), "nsamples", kPositive);
  CheckBounds(in.Params(), "thickness", kNotNegative);
  CheckBounds(in.Params(), "g", {.least = -1, .most = 1});
  const ColorTexturePtr albedo = in.values.FindColor(in.Params(), "albedo");
  if (albedo && !(albedo->IsConstant() && albedo->Evaluate(TextureContext()).IsBlack()))
    WarnUnsupported(in.values.Context(), in.Params(), "albedo");
}

std::unique_ptr<Material> BuildDiffuse(const MaterialInput& in) {
  return std::make_unique<MatteMaterial>(in.ShareOf("reflectance", 0.5), in.FloatOf("sigma", 0), BuildDetail(in));
}

std::unique_ptr<Material> BuildConductor(const MaterialInput& in) {
  const Metal metal = BuildMetal(in, "", "reflectance");
  const Roughness roughness = WithDistribution(in, BuildRoughness(in, 0, Remap(in)));
  if (metal.reflectance) return std::make_unique<ConductorMaterial>(metal.reflectance, roughness, BuildDetail(in));
  return std::make_unique<ConductorMaterial>(metal.eta, metal.k, roughness, BuildDetail(in));
}

std::unique_ptr<Material> BuildDielectric(const MaterialInput& in) {
  const Roughness roughness = WithDistribution(in, BuildRoughness(in, 0, Remap(in)));
  return std::make_unique<DielectricMaterial>(Eta(in), roughness, nullptr, nullptr, BuildDetail(in));
}

std::unique_ptr<Material> BuildThinDielectric(const MaterialInput& in) {
  return std::make_unique<ThinDielectricMaterial>(Eta(in), BuildDetail(in));
}

std::unique_ptr<Material> BuildDiffuseTransmission(const MaterialInput& in) {
  CheckBounds(in.Params(), "scale", kNotNegative);
  const double scale = in.Params().GetFloat("scale", 1);
  return std::make_unique<DiffuseTransmissionMaterial>(in.ShareOf("reflectance", 0.25, scale),
                                                       in.ShareOf("transmittance", 0.25, scale),
                                                       static_cast<float>(scale), BuildDetail(in));
}

std::unique_ptr<Material> BuildCoatedDiffuse(const MaterialInput& in) {
  LookUpLayerParameters(in);
  return std::make_unique<CoatedDiffuseMaterial>(in.ShareOf("reflectance", 0.5), BuildRoughness(in, 0, Remap(in)),
                                                 GetUniformEta(in, "eta", 1.5), BuildDetail(in));
}

std::unique_ptr<Material> BuildCoatedConductor(const MaterialInput& in) {
  LookUpLayerParameters(in);
  const Metal metal = BuildMetal(in, "conductor.", "reflectance");
  CoatedConductorMaterial::Parameters parameters;
  parameters.coatRoughness = BuildRoughness(in, 0, Remap(in), "interface.");
  parameters.coatEta = GetUniformEta(in, "interface.eta", 1.5);
  parameters.conductorRoughness = BuildRoughness(in, 0, Remap(in), "conductor.");
  parameters.eta = metal.eta;
  parameters.k = metal.k;
  parameters.reflectance = metal.reflectance;
  return std::make_unique<CoatedConductorMaterial>(parameters, BuildDetail(in));
}

}  // namespace

std::unique_ptr<Material> BuildV4Material(const MaterialInput& in) {
  const std::string& type = in.material.type;
  if (type == "diffuse") return BuildDiffuse(in);
  if (type == "conductor") return BuildConductor(in);
  if (type == "dielectric") return BuildDielectric(in);
  if (type == "thindielectric") return BuildThinDielectric(in);
  if (type == "diffusetransmission") return BuildDiffuseTransmission(in);
  if (type == "coateddiffuse") return BuildCoatedDiffuse(in);
  if (type == "coatedconductor") return BuildCoatedConductor(in);
  return nullptr;
}

}  // namespace dapple
