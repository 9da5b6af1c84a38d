#include "src/io/build_materials.h"

#include <algorithm>

#include <fmt/format.h>

#include "src/io/build_material_types.h"
#include "src/io/nearest_name.h"
#include "src/io/text_file.h"
#include "src/materials/coated_materials.h"
#include "src/materials/conductor_materials.h"
#include "src/materials/dielectric_materials.h"
#include "src/materials/diffuse_materials.h"
#include "src/materials/mix_material.h"
#include "src/materials/procedural_textures.h"

namespace dapple {

namespace {

// Of mixes: larger ones have more lobes than a BSDF, or parts that never count.
constexpr size_t kDeepest = 64;
constexpr int kMostMaterials = 1024;

const std::vector<std::string> kMaterialTypes = {
    "matte", "plastic",       "translucent",     "glass",     "mirror",     "metal",          "substrate",
    "uber",  "mix",           "diffuse",         "conductor", "dielectric", "thindielectric", "diffusetransmission",
    "none",  "coateddiffuse", "coatedconductor", "interface"};

bool IsInterfaceType(const std::string& type) { return type.empty() || type == "none" || type == "interface"; }

float ConstantOr(const FloatTexturePtr& texture, float fallback) {
  return texture->IsConstant() ? texture->Evaluate(TextureContext()) : fallback;
}

/// Disney's material by its largest part: metal, glass or a coated diffuse body.
std::unique_ptr<Material> BuildDisneyStandIn(const MaterialInput& in) {
  const ColorTexturePtr color = in.ShareOf("color", 0.5);
  // GGX's alpha is the square of Disney's roughness.
  const FloatTexturePtr disneyRoughness = in.RoughnessOf("roughness", 0.5);
  const Roughness roughness(MakeScale(disneyRoughness, disneyRoughness), RoughnessRemap::None);
  CheckBounds(in.Params(), "eta", kPositive);
  const FloatTexturePtr eta = in.FloatOf("eta", 1.5);
  if (ConstantOr(in.FloatOf("metallic", 0), 0) > 0.5f) return std::make_unique<ConductorMaterial>(color, roughness);
  if (ConstantOr(in.FloatOf("spectrans", 0), 0) > 0.5f) return std::make_unique<DielectricMaterial>(eta, roughness);
  return std::make_unique<CoatedDiffuseMaterial>(color, roughness, ConstantOr(eta, 1.5f));
}

}  // namespace

SurfaceDetailPtr BuildDetail(const MaterialInput& in) {
  FloatTexturePtr displacement = in.values.FindFloat(in.Params(), "displacement");
  if (!displacement) displacement = in.values.FindFloat(in.Params(), "bumpmap");
  const Parameter* normalMap = in.Params().Find("normalmap");
  if (normalMap)
    return std::make_shared<NormalMap>(in.values.GetImage(*normalMap, ColorEncoding::Linear()), normalMap->location);
  if (!displacement || displacement->IsConstant()) return nullptr;
  return std::make_shared<BumpMap>(displacement);
}

Roughness BuildRoughness(const MaterialInput& in, double fallback, RoughnessRemap remap, const std::string& prefix) {
  const FloatTexturePtr both = in.RoughnessOf(prefix + "roughness", fallback);
  const FloatTexturePtr u = in.FindRoughness(prefix + "uroughness");
  const FloatTexturePtr v = in.FindRoughness(prefix + "vroughness");
  return {u ? u : both, v ? v : both, remap};
}

Roughness WithDistribution(const MaterialInput& in, Roughness roughness) {
  static const std::vector<std::pair<std::string, MicrofacetKind>> kKinds = {
      {"ggx", MicrofacetKind::Ggx},
      {"beckmann", MicrofacetKind::Beckmann},
      {"blinn", MicrofacetKind::Blinn},
      {"ashikhminshirley", MicrofacetKind::AshikhminShirley}};
  const std::string name = in.Params().GetString("distribution", "ggx");
  std::vector<std::string> names;
  for (const auto& [known, kind] : kKinds) {
    names.push_back(known);
    if (known != name) continue;
    roughness.SetKind(kind);
    return roughness;
  }
  FailUnknownName(in.Params().LocationOf("distribution", in.material.location), "microfacet distribution", name, names);
}

float GetUniformEta(const MaterialInput& in, std::string_view name, double fallback) {
  const FloatTexturePtr eta = in.values.FindIndexOfRefraction(in.Params(), name);
  if (!eta) return static_cast<float>(fallback);
  if (eta->IsConstant()) return eta->Evaluate(TextureContext());
  in.values.Context().diagnostics.Warn(
      in.Params().LocationOf(name, in.material.location),
      fmt::format("a texture of parameter \"{}\" is not supported; {} is used", name, fallback));
  return static_cast<float>(fallback);
}

std::unique_ptr<Material> BuildStandIn(const MaterialInput& in) {
  const std::string& type = in.material.type;
  std::unique_ptr<Material> result;
  const char* standIn = "a diffuse surface";
  if (type == "disney") {
    standIn = "its largest part";
    result = BuildDisneyStandIn(in);
  } else if (type == "subsurface" || type == "kdsubsurface") {
    const bool hasKd = in.Params().Has("Kd");
    result = std::make_unique<MatteMaterial>(in.ShareOf(hasKd ? "Kd" : "reflectance", 0.5), nullptr, BuildDetail(in));
  } else if (type == "hair") {
    const Color brown(0.2f, 0.1f, 0.05f);
    result = std::make_unique<MatteMaterial>(in.values.GetColor(in.Params(), "color", brown));
  } else if (type == "fourier" || type == "measured") {
    result = std::make_unique<MatteMaterial>(MakeConstant(Color(0.5f)));
  } else {
    FailUnknownName(in.material.location, "material", type, kMaterialTypes);
  }
  in.values.Context().diagnostics.Warn(in.material.location,
                                       fmt::format("material \"{}\" is not supported; {} stands in", type, standIn));
  in.Params().IgnoreAll();
  return result;
}

Materials::Materials(Values& values)
    : values_(values),
      indices_(values.Context().description.materials.size()),
      byName_(values.Context().description.MaterialsByName()) {}

bool Materials::IsInterface(int material) const {
  return IsInterfaceType(values_.Context().description.materials[static_cast<size_t>(material)].type);
}

int Materials::IndexOf(int material) {
  std::optional<int>& index = indices_[static_cast<size_t>(material)];
  if (index) return *index;
  const MaterialDescription& description = values_.Context().description.materials[static_cast<size_t>(material)];
  Size size;
  std::unique_ptr<Material> built = AtLocation(description.location, [&] { return Build(description, &size); });
  index = built ? static_cast<int>(built_.size()) : -1;
  if (!built) return *index;
  built_.push_back(std::move(built));
  const std::string name = Quoted(description.name.empty() ? description.type : description.name, 100);
  names_.push_back(description.IsGiven() ? fmt::format("{} ({})", name, description.location.ToString()) : name);
  return *index;
}

std::unique_ptr<Material> Materials::Build(const MaterialDescription& material, Size* size) {
  if (IsInterfaceType(material.type)) {
    material.params.IgnoreAll();
    return nullptr;
  }
  const MaterialInput in{values_, material};
  unfinished_.push_back({&material, {}});
  std::unique_ptr<Material> result;
  if (material.type == "mix") result = BuildMix(in);
  if (!result) result = BuildV3Material(in);
  if (!result) result = BuildV4Material(in);
  if (!result) result = BuildStandIn(in);
  *size = unfinished_.back().size;
  unfinished_.pop_back();
  material.params.ReportUnused(values_.Context().diagnostics, {"type"});
  return result;
}

std::unique_ptr<Material> Materials::BuildMix(const MaterialInput& in) {
  const ParameterList& params = in.Params();
  const FileLocation& location = in.material.location;
  if (params.Has("materials")) {
    const std::vector<std::string> names = params.GetStringArray("materials", 2);
    const FileLocation at = params.LocationOf("materials", location);
    const auto first = PartOf(names[0], at), second = PartOf(names[1], at);
    WarnOfClampedShare(params, "amount", 1, values_.Context().diagnostics);
    const FloatTexturePtr amount = in.FloatOf("amount", 0.5);
    // In pbrt-v4 the amount is that of the second.
    return std::make_unique<MixMaterial>(second, first, std::make_shared<GrayTexture>(amount));
  }
  std::shared_ptr<const Material> parts[2];
  for (int i = 0; i < 2; ++i) {
    const std::string parameter = i == 0 ? "namedmaterial1" : "namedmaterial2";
    if (!params.Has(parameter))
      throw Error(location, fmt::format("a mix without its materials, expected \"string {}\"",
                                        values_.Context().IsV3() ? parameter : "materials"));
    parts[i] = PartOf(params.GetString(parameter, ""), params.LocationOf(parameter, location));
  }
  return std::make_unique<MixMaterial>(parts[0], parts[1], in.ShareOf("amount", 0.5));
}

std::shared_ptr<const Material> Materials::PartOf(const std::string& name, const FileLocation& namedAt) {
  const MaterialDescription& material = Named(name, namedAt);
  if (std::ranges::find(unfinished_, &material, &Unfinished::description) != unfinished_.end())
    throw Error(namedAt, fmt::format("material \"{}\" is a mix of itself", name));
  const auto checkDepth = [&](size_t depth) {
    if (depth > kDeepest) throw Error(namedAt, fmt::format("mixes name each other more than {} deep", kDeepest));
  };
  const auto [entry, isNew] = parts_.try_emplace(&material);
  Part& part = entry->second;
  if (isNew) {
    checkDepth(unfinished_.size() + 1);
    part.material = Build(material, &part.size);
  }
  Size& whole = unfinished_.back().size;
  whole.materials += part.size.materials;
  whole.depth = std::max(whole.depth, part.size.depth + 1);
  checkDepth(static_cast<size_t>(whole.depth));
  if (whole.materials > kMostMaterials)
    throw Error(namedAt,
                fmt::format("a mix of more than {} materials, each counted as often as it is named", kMostMaterials));
  return part.material;
}

const MaterialDescription& Materials::Named(const std::string& name, const FileLocation& namedAt) const {
  const auto found = byName_.find(name);
  if (found != byName_.end()) return values_.Context().description.materials[static_cast<size_t>(found->second)];
  std::vector<std::string> known;
  for (const auto& entry : byName_) known.emplace_back(entry.first);
  std::ranges::sort(known);
  throw Error(namedAt, fmt::format("no material is named \"{}\"{}", name, DidYouMean(name, known)));
}

}  // namespace dapple
