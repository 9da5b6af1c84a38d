// The scattering lobes that a `Bsdf` is put together from, as one closed set.
//
// Each lobe is a small value in the local frame, z along the shading normal, and has
//   Flags()                    what it does
//   Value(wo, wi, mode)        the scattering function without cosines; black for specular lobes. In radiance mode what
//                              refracts is scaled by 1/eta^2; Value(wo, wi, Importance) == Value(wi, wo, Radiance)
//   Pdf(wo, wi)                density per solid angle with which Sample gives wi; 0 for specular lobes
//   Sample(wo, uc, u, mode)    uc in [0, 1) chooses a branch, u in [0, 1)^2 the direction; nothing where light ends
//   Albedo(wo)                 an estimate of the hemispherical-directional albedo, positive where Value may be
//   Roughness()                GGX's alpha or its like (the smaller one), 1 for diffuse lobes
// Directions are unit vectors with z != 0. Lobes are opaque to one another; `Bsdf` adds cosines, normals and choice.
#pragma once

#include <type_traits>
#include <variant>

#include "src/materials/coated_lobes.h"
#include "src/materials/diffuse_lobes.h"
#include "src/materials/lobe_flags.h"
#include "src/materials/microfacet_lobes.h"
#include "src/materials/specular_lobes.h"

namespace dapple {

using Lobe =
    std::variant<LambertianReflection, LambertianTransmission, OrenNayarReflection, MirrorReflection,
                 ConductorReflection, SmoothDielectric, ThinDielectric, PassThrough, CoatReflection, CoatedDiffuseBase,
                 CoatedConductorReflection, CoatedRoughConductor, RoughConductor<Ggx>, RoughConductor<Beckmann>,
                 RoughConductor<CosinePower>, RoughDielectricReflection<Ggx>, RoughDielectricReflection<Beckmann>,
                 RoughDielectricReflection<CosinePower>, RoughDielectric<Ggx>, RoughDielectric<Beckmann>,
                 RoughDielectric<CosinePower>, FresnelBlend<Ggx>, FresnelBlend<Beckmann>, FresnelBlend<CosinePower>>;

static_assert(std::is_trivially_copyable_v<Lobe>, "Bsdf copies lobes as bytes");

}  // namespace dapple
