// BSDFs to be tested: every lobe alone, and the mixtures that materials make, in straight and in bent shading frames.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "src/materials/blend_energy.h"
#include "src/materials/bsdf.h"
#include "src/materials/fresnel.h"

namespace dapple::testing {

struct WeightedLobes {
  std::string name;
  std::vector<std::pair<Lobe, Color>> lobes;
  float etaBelow = 1;  ///< index on the side that ng does not point to, over the other side's
};

/// In messages of failing tests.
inline void PrintTo(const WeightedLobes& lobes, std::ostream* out) { *out << lobes.name; }

/// A BSDF of lobes that are not specular in part at least.
inline std::vector<WeightedLobes> NonSpecularCases() {
  const Color gray(0.6f, 0.5f, 0.4f), eta(0.2f, 0.9f, 1.1f), k(3.9f, 2.45f, 2.14f);
  const float fe = FresnelDiffuseReflectance(1.5f);
  static const CoatTransmittance kRoughCoat(1.5f, 0.1f, 0.5f);
  const Ggx roughest(1.62f, 1.62f);
  const BlendEnergy roughestEnergy(MicrofacetKind::Ggx, roughest);
  return {
      {"LambertianReflection", {{LambertianReflection{gray}, Color(1)}}},
      {"LambertianTransmission", {{LambertianTransmission{gray}, Color(0.5f)}}},
      {"OrenNayar", {{OrenNayarReflection(gray, 40), Color(1)}}},
      {"RoughConductor", {{RoughConductor{Ggx(0.3f, 0.3f), eta, k}, Color(1)}}},
      {"AnisotropicConductor", {{RoughConductor{Ggx(0.15f, 0.5f), eta, k}, Color(0.7f)}}},
      {"SharpConductor", {{RoughConductor{Ggx(0.08f, 0.08f), eta, k}, Color(1)}}},
      {"BeckmannConductor", {{RoughConductor{Beckmann(0.3f, 0.3f), eta, k}, Color(1)}}},
      {"AnisotropicBeckmannConductor", {{RoughConductor{Beckmann(0.15f, 0.5f), eta, k}, Color(1)}}},
      {"SharpBeckmannConductor", {{RoughConductor{Beckmann(0.08f, 0.08f), eta, k}, Color(1)}}},
      {"BlinnConductor", {{RoughConductor{CosinePower(20, 20), eta, k}, Color(1)}}},
      {"SharpBlinnConductor", {{RoughConductor{CosinePower(300, 300), eta, k}, Color(1)}}},
      {"AshikhminShirleyConductor", {{RoughConductor{CosinePower(80, 8), eta, k}, Color(1)}}},
      {"DielectricGloss", {{RoughDielectricReflection{Ggx(0.25f, 0.4f), gray, 1.5f, 1 / 1.5f}, Color(1)}}},
      {"PlasticGloss", {{RoughDielectricReflection{Ggx(0.3f, 0.3f), gray, 1 / 1.5f, 1.5f}, Color(1)}}},
      {"BeckmannGloss", {{RoughDielectricReflection{Beckmann(0.4f, 0.2f), Color(1), 1.5f, 1 / 1.5f}, Color(1)}}},
      {"BlinnGloss", {{RoughDielectricReflection{CosinePower(10, 10), Color(1), 1.5f, 1 / 1.5f}, Color(1)}}},
      {"RoughGlass", {{RoughDielectric{Ggx(0.3f, 0.3f), 1.5f, Color(1), Color(1)}, Color(1)}}, 1.5f},
      {"AnisotropicGlass", {{RoughDielectric{Ggx(0.2f, 0.5f), 1.33f, gray, Color(0.9f)}, Color(1)}}, 1.33f},
      {"AirInGlass", {{RoughDielectric{Ggx(0.4f, 0.4f), 1 / 1.5f, Color(1), Color(1)}, Color(1)}}, 1 / 1.5f},
      {"BeckmannGlass", {{RoughDielectric{Beckmann(0.4f, 0.2f), 1.5f, Color(1), Color(1)}, Color(1)}}, 1.5f},
      {"BlinnGlass", {{RoughDielectric{CosinePower(20, 20), 1.5f, Color(1), Color(1)}, Color(1)}}, 1.5f},
      {"AshikhminShirleyGlass", {{RoughDielectric{CosinePower(50, 6), 1.33f, gray, Color(0.9f)}, Color(1)}}, 1.33f},
      {"FresnelBlend", {{FresnelBlend{Ggx(0.2f, 0.4f), gray, Color(0.3f, 0.2f, 0.1f)}, Color(1)}}},
      {"BeckmannFresnelBlend", {{FresnelBlend{Beckmann(0.3f, 0.3f), gray, Color(0.3f, 0.2f, 0.1f)}, Color(1)}}},
      {"AshikhminShirleyFresnelBlend", {{FresnelBlend{CosinePower(60, 10), gray, Color(0.3f, 0.2f, 0.1f)}, Color(1)}}},
      {"RoughFresnelBlend", {{FresnelBlend{Ggx(1, 1), Color(1), Color(1)}, Color(1)}}},
      {"ScaledFresnelBlend", {{FresnelBlend{roughest, Color(1), Color(1)}, roughestEnergy.Scale(Color(1))}}},
      {"RoughCoatedDiffuseBase", {{CoatedDiffuseBase(gray, 1.5f, 0.3f, kRoughCoat), Color(1)}}},
      {"CoatedDiffuseBase", {{CoatedDiffuseBase(gray, 1.5f, fe), Color(1)}}},
      {"CoatedRoughConductor", {{CoatedRoughConductor{Ggx(0.3f, 0.3f), 1.5f, eta / 1.5f, k / 1.5f}, Color(1)}}},
      {"Plastic",
       {{LambertianReflection{gray}, Color(1)},
        {RoughDielectricReflection{Ggx(0.2f, 0.2f), Color(0.4f), 1 / 1.5f, 1.5f}, Color(1)}}},
      {"Uber",
       {{LambertianReflection{gray}, Color(0.5f)},
        {RoughDielectricReflection{Ggx(0.3f, 0.3f), gray, 1.5f, 1 / 1.5f}, Color(0.5f)},
        {SmoothDielectric(1.5f, gray, gray), Color(0.3f)},
        {PassThrough(Color(0.2f)), Color(1)}}},
      {"Translucent",
       {{LambertianReflection{gray}, Color(0.5f)},
        {LambertianTransmission{gray}, Color(0.3f)},
        {RoughDielectric{Ggx(0.35f, 0.35f), 1.5f, Color(0.5f), Color(0.5f)}, Color(0.5f)}},
       1.5f},
  };
}

/// A specular lobe; `isLossless` where all of the flux goes on, whatever its direction.
struct SpecularCase {
  std::string name;
  Lobe lobe;
  bool isLossless;
};

inline void PrintTo(const SpecularCase& lobe, std::ostream* out) { *out << lobe.name; }

inline std::vector<SpecularCase> SpecularCases() {
  const Color gray(0.6f, 0.5f, 0.4f), eta(0.2f, 0.9f, 1.1f), k(3.9f, 2.45f, 2.14f);
  return {
      {"Mirror", MirrorReflection(Color(1)), true},
      {"GrayMirror", MirrorReflection(gray), false},
      {"SmoothConductor", ConductorReflection(eta, k), false},
      {"SmoothGlass", SmoothDielectric(1.5f), true},
      {"SmoothAirInGlass", SmoothDielectric(1 / 1.33f), true},
      {"NoInterface", SmoothDielectric(1), true},
      {"TintedGlass", SmoothDielectric(1.5f, gray, Color(0.9f, 0.7f, 0.5f)), false},
      {"ThinGlass", ThinDielectric(1.5f), true},
      {"PassThrough", PassThrough(), true},
      {"CoatReflection", CoatReflection(1.5f), false},
      {"CoatedSmoothConductor", CoatedConductorReflection(1.5f, eta / 1.5f, k / 1.5f), false},
  };
}

/// A surface point in the plane z = 0, ng = (0, 0, 1), whose shading normal leans by `tilt` radians.
inline SurfaceInteraction TiltedHit(float tilt) {
  SurfaceInteraction hit;
  hit.ng = Vec3(0, 0, 1);
  hit.ns = tilt == 0 ? hit.ng : Normalize(Vec3(std::sin(tilt) * 0.8f, std::sin(tilt) * 0.6f, std::cos(tilt)));
  hit.dpdu = hit.dpdus = Vec3(0.8f, -0.6f, 0.1f);
  hit.dpdv = hit.dpdvs = Cross(hit.ns, hit.dpdus);
  return hit;
}

inline Bsdf MakeBsdf(const WeightedLobes& lobes, float tilt) {
  Bsdf bsdf(TiltedHit(tilt));
  for (const auto& [lobe, scale] : lobes.lobes) bsdf.Add(lobe, scale);
  return bsdf;
}

inline Vec3 Direction(float cosTheta, float phi) {
  const float s = std::sqrt((1 - cosTheta) * (1 + cosTheta));
  return {s * std::cos(phi), s * std::sin(phi), cosTheta};
}

}  // namespace dapple::testing
