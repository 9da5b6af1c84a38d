// One function a family of material types; for build_materials.cpp alone.
#pragma once

#include <memory>

#include "src/io/build_values.h"
#include "src/io/value_bounds.h"
#include "src/materials/bump.h"
#include "src/materials/material.h"
#include "src/materials/roughness.h"

namespace dapple {

/// What the builders of all types need.
struct MaterialInput {
  Values& values;
  const MaterialDescription& material;

  const ParameterList& Params() const { return material.params; }
  /// The material's share of light or number of that name, as a texture; never null. Throws as `Values::GetColor`.
  /// Materials clamp shares, times `scale`, to [0, 1]: warns where that changes a constant one.
  ColorTexturePtr ShareOf(std::string_view name, double fallback, double scale = 1) const {
    WarnOfClampedShare(Params(), name, scale, values.Context().diagnostics);
    return values.GetColor(Params(), name, Color(static_cast<float>(fallback)));
  }
  FloatTexturePtr FloatOf(std::string_view name, double fallback) const {
    return values.GetFloat(Params(), name, fallback);
  }
  /// A roughness; null where there is none of that name. Throws `Error` where a constant one is negative.
  FloatTexturePtr FindRoughness(std::string_view name) const {
    CheckBounds(Params(), name, kNotNegative);
    return values.FindFloat(Params(), name);
  }
  FloatTexturePtr RoughnessOf(std::string_view name, double fallback) const {
    CheckBounds(Params(), name, kNotNegative);
    return FloatOf(name, fallback);
  }
};

/// The bump map or normal map, or null: v3's "bumpmap", v4's "displacement" and "normalmap".
SurfaceDetailPtr BuildDetail(const MaterialInput& in);
/// "uroughness" and "vroughness", each else "roughness", else the fallback; names begin with `prefix`.
Roughness BuildRoughness(const MaterialInput& in, double fallback, RoughnessRemap remap,
                         const std::string& prefix = "");
/// `roughness` with the microfacet distribution that "distribution" names: "ggx" (where it is not given), "beckmann",
/// "blinn" or "ashikhminshirley". Throws `Error` at the place of any other name.
Roughness WithDistribution(const MaterialInput& in, Roughness roughness);
/// An index of refraction that no texture may vary: where one does, a warning, and the fallback.
float GetUniformEta(const MaterialInput& in, std::string_view name, double fallback);

/// A material of v3's types; null where `type` is none of them. Throws `Error` at the place of what is wrong.
std::unique_ptr<Material> BuildV3Material(const MaterialInput& in);
/// A material of v4's types; likewise.
std::unique_ptr<Material> BuildV4Material(const MaterialInput& in);
/// A stand-in, with a warning.
std::unique_ptr<Material> BuildStandIn(const MaterialInput& in);

}  // namespace dapple
