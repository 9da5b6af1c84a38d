#include "src/materials/material.h"

#include <random>

#include <gtest/gtest.h>

#include "src/base/error.h"
#include "src/materials/coated_materials.h"
#include "src/materials/conductor_materials.h"
#include "src/materials/dielectric_materials.h"
#include "src/materials/diffuse_materials.h"
#include "src/materials/fresnel.h"
#include "src/materials/mix_material.h"
#include "src/materials/plastic_materials.h"
#include "tests/materials/bsdf_cases.h"

namespace dapple {
namespace {

using testing::Direction;
using testing::TiltedHit;

ColorTexturePtr Constant(const Color& color) { return std::make_shared<ConstantTexture<Color>>(color); }
ColorTexturePtr Gray(float value) { return Constant(Color(value)); }
FloatTexturePtr Value(float value) { return std::make_shared<ConstantTexture<float>>(value); }

/// `low` for u < 1/2, else `high`.
template <typename T>
class Halves final : public Texture<T> {
 public:
  Halves(const T& low, const T& high) : low_(low), high_(high) {}
  T Evaluate(const TextureContext& at) const override { return at.uv.x < 0.5f ? low_ : high_; }

 private:
  T low_, high_;
};

SurfaceInteraction HitAt(float u, float tilt = 0) {
  SurfaceInteraction hit = TiltedHit(tilt);
  hit.uv = Vec2(u, 0.5f);
  return hit;
}

Roughness Alpha(float alpha) { return {Value(alpha), RoughnessRemap::None}; }

struct Estimate {
  Color mean;
  float sigma;  ///< of the mean, of the green component
};

/// The flux that leaves for each that arrives along `wo`.
Estimate AlbedoOf(const Bsdf& bsdf, const Vec3& wo, int samples, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  Color sum;
  double squares = 0;
  for (int i = 0; i < samples; ++i) {
    const double uc = uniform(random), u0 = uniform(random), u1 = uniform(random);
    const auto s = bsdf.Sample(wo, uc, {u0, u1}, TransportMode::Importance);
    if (!s) continue;
    sum += s->weight;
    squares += Sqr(static_cast<double>(s->weight.g));
  }
  const Color mean = sum / static_cast<float>(samples);
  return {mean, static_cast<float>(std::sqrt(std::max(0.0, squares / samples - Sqr(static_cast<double>(mean.g)))) /
                                   std::sqrt(samples))};
}

struct NamedMaterial {
  std::string name;
  std::shared_ptr<const Material> material;
};

std::vector<NamedMaterial> AllMaterials() {
  const auto halfBlack = std::make_shared<Halves<Color>>(Color(), Color(0.5f));
  const auto roughness = std::make_shared<Halves<float>>(0.f, 0.3f);
  const auto matte = std::make_shared<MatteMaterial>(Gray(0.5f));
  UberMaterial::Parameters uber{.kd = Gray(0.3f),
                                .ks = Gray(0.2f),
                                .kr = Gray(0.1f),
                                .kt = Gray(0.1f),
                                .opacity = Gray(0.8f),
                                .roughness = Alpha(0.2f)};
  const auto uberMaterial = std::make_shared<UberMaterial>(uber);
  const auto glass = std::make_shared<DielectricMaterial>(Value(1.5f));
  const Color eta(0.2f, 0.9f, 1.1f), k(3.9f, 2.45f, 2.14f);
  CoatedConductorMaterial::Parameters coated{.conductorRoughness = Alpha(0.2f), .eta = Constant(eta), .k = Constant(k)};
  CoatedConductorMaterial::Parameters coatedSmooth{.eta = Constant(eta), .k = Constant(k)};
  return {
      {"matte", matte},
      {"black", std::make_shared<MatteMaterial>(Gray(0))},
      {"oren-nayar", std::make_shared<MatteMaterial>(halfBlack, Value(30))},
      {"sheet", std::make_shared<DiffuseTransmissionMaterial>(Gray(0.3f), halfBlack)},
      {"black sheet", std::make_shared<DiffuseTransmissionMaterial>(Gray(0.3f), Gray(0.3f), 0.f)},
      {"translucent", std::make_shared<TranslucentMaterial>(
                          Gray(0.3f), Gray(0.2f), Roughness(roughness, RoughnessRemap::None), Gray(0.5f), Gray(0.5f))},
      {"mirror", std::make_shared<MirrorMaterial>(Gray(0.9f))},
      {"metal", std::make_shared<ConductorMaterial>(Constant(eta), Constant(k), Alpha(0.1f))},
      {"smooth metal", std::make_shared<ConductorMaterial>(Gray(0.9f), Alpha(0))},
      {"half rough metal", std::make_shared<ConductorMaterial>(Gray(0.9f), Roughness(roughness, RoughnessRemap::V4))},
      {"glass", glass},
      {"rough glass", std::make_shared<DielectricMaterial>(Value(1.5f), Alpha(0.2f))},
      {"rough nothing", std::make_shared<DielectricMaterial>(Value(1), Alpha(0.2f))},
      {"black glass", std::make_shared<DielectricMaterial>(Value(1.5f), Roughness(), Gray(0), Gray(0))},
      {"thin glass", std::make_shared<ThinDielectricMaterial>(Value(1.5f))},
      {"plastic", std::make_shared<PlasticMaterial>(Gray(0.3f), Gray(0.3f), Alpha(0.1f))},
      {"substrate", std::make_shared<SubstrateMaterial>(Gray(0.3f), Gray(0.3f), Alpha(0.1f))},
      {"uber", uberMaterial},
      {"coated diffuse", std::make_shared<CoatedDiffuseMaterial>(Gray(0.5f), Alpha(0))},
      {"rough coated diffuse", std::make_shared<CoatedDiffuseMaterial>(Gray(0.5f), Alpha(0.3f))},
      {"coated metal", std::make_shared<CoatedConductorMaterial>(coated)},
      {"smooth coated metal", std::make_shared<CoatedConductorMaterial>(coatedSmooth)},
      {"mix", std::make_shared<MixMaterial>(matte, glass, std::make_shared<Halves<Color>>(Color(0.3f), Color(1)))},
      {"ubers", std::make_shared<MixMaterial>(uberMaterial, uberMaterial, Gray(0.5f))},
      {"holes", std::make_shared<MixMaterial>(matte, nullptr, Gray(0.5f))},
      {"only matte", std::make_shared<MixMaterial>(matte, glass, Gray(1))},
  };
}

TEST(MaterialFacts, AreTheUnionOverTheSurface) {
  for (const auto& [name, material] : AllMaterials()) {
    const MaterialFacts facts = material->Facts();
    LobeFlags flags;
    float minRoughness = 1;
    for (const float u : {0.25f, 0.75f}) {
      const Bsdf bsdf = material->GetBsdf(HitAt(u));
      flags |= bsdf.Flags();
      minRoughness = std::min(minRoughness, bsdf.MinRoughness());
    }
    EXPECT_EQ(facts.isBlack, flags.IsEmpty()) << name;
    EXPECT_EQ(facts.hasSpecular, flags.HasSpecular()) << name;
    EXPECT_EQ(facts.hasNonSpecular, flags.HasNonSpecular()) << name;
    EXPECT_EQ(facts.hasTransmission, flags.HasTransmission()) << name;
    EXPECT_LE(facts.minRoughness, minRoughness) << name;
    EXPECT_LE(facts.maxLobes, Bsdf::kMaxLobes) << name;
  }
}

TEST(MaterialFacts, KnowConstantRoughness) {
  EXPECT_EQ(ConductorMaterial(Gray(0.9f), Alpha(0.1f)).Facts().minRoughness, 0.1f);
  EXPECT_EQ(PlasticMaterial(Gray(0.9f), Gray(0), Alpha(0.1f)).Facts().minRoughness, 1);
  EXPECT_EQ(
      SubstrateMaterial(Gray(0.9f), Gray(0.1f), {Value(0.5f), Value(0.2f), RoughnessRemap::None}).Facts().minRoughness,
      0.2f);
}

TEST(Materials, NeverCreateLight) {
  for (const auto& [name, material] : AllMaterials()) {
    for (const float c : {1.f, 0.5f, 0.1f, -0.7f}) {
      const Estimate albedo = AlbedoOf(material->GetBsdf(HitAt(0.75f)), Direction(c, 1), 4000, 3);
      EXPECT_LE(albedo.mean.MaxComponent(), 1 + 5 * albedo.sigma + 1e-5f) << name << " cos " << c;
    }
  }
}

TEST(Roughness, RemapsAndFallsBackToSmooth) {
  const TextureContext at(HitAt(0));
  EXPECT_FALSE(Roughness().Evaluate(at));
  EXPECT_FALSE(Alpha(0).Evaluate(at));
  EXPECT_FALSE(Alpha(9e-4f).Evaluate(at));
  EXPECT_NEAR(Roughness(Value(0.25f), RoughnessRemap::V4).Evaluate(at)->AlphaX(), 0.5f, 1e-6f);
  EXPECT_NEAR(Roughness(Value(0.1f), RoughnessRemap::V3).Evaluate(at)->AlphaY(), RoughnessToAlphaV3(0.1f), 1e-6f);
  EXPECT_TRUE(Roughness(Value(0), RoughnessRemap::V3).Evaluate(at));  // pbrt-v3's polynomial is 0.047 at zero
  const auto anisotropic = Roughness(Value(0.1f), Value(0.4f), RoughnessRemap::None).Evaluate(at);
  EXPECT_EQ(anisotropic->AlphaX(), 0.1f);
  EXPECT_EQ(anisotropic->AlphaY(), 0.4f);
}

TEST(Materials, AnisotropyFollowsTheTangent) {
  // Streaks lie across the smooth direction: with alpha small along dpdu, light spreads along dpdv.
  const ConductorMaterial metal(Gray(0.9f), {Value(0.05f), Value(0.4f), RoughnessRemap::None});
  SurfaceInteraction hit = HitAt(0);
  hit.dpdus = Vec3(0, 2, 0);
  const Bsdf bsdf = metal.GetBsdf(hit);
  const Vec3 up(0, 0, 1);
  const auto value = [&](const Vec3& wi) { return bsdf.Eval(up, Normalize(wi), TransportMode::Radiance).g; };
  EXPECT_GT(value(Vec3(0.3f, 0, 1)), 10 * value(Vec3(0, 0.3f, 1)));
}

TEST(CoatedDiffuse, WhiteBaseUnderASmoothCoatReturnsEverything) {
  for (const float eta : {1.01f, 1.33f, 1.5f, 2.5f}) {
    const Bsdf bsdf = CoatedDiffuseMaterial(Gray(1), Roughness(), eta).GetBsdf(HitAt(0));
    for (const float c : {1.f, 0.6f, 0.2f, -0.5f}) {
      const Estimate albedo = AlbedoOf(bsdf, Direction(c, 0), 40'000, 5);
      EXPECT_NEAR(albedo.mean.g, 1, 5 * albedo.sigma + 2e-4f) << eta << " " << c;
    }
  }
}

/// What pbrt-v4's layered random walk converges to: a rough interface over a Lambertian base, depth without limit.
Estimate LayeredAlbedo(float alpha, float eta, float rho, const Vec3& wo, int walks) {
  Bsdf interface(HitAt(0));
  if (alpha > 0) {
    interface.Add(RoughDielectric{Ggx(alpha, alpha), eta, Color(1), Color(1)});
  } else {
    interface.Add(SmoothDielectric(eta));
  }
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  double sum = 0, squares = 0;
  for (int i = 0; i < walks; ++i) {
    Vec3 from = wo;  // as seen from the interface
    double weight = 1;
    while (true) {
      const double uc = uniform(random), u0 = uniform(random), u1 = uniform(random);
      const auto s = interface.Sample(from, uc, {u0, u1}, TransportMode::Importance);
      if (!s) {
        weight = 0;
        break;
      }
      weight *= static_cast<double>(s->weight.g);
      if (s->wi.z > 0) break;
      weight *= static_cast<double>(rho);
      const double v0 = uniform(random), v1 = uniform(random);
      from = -ToFloat(SampleCosineHemisphere({v0, v1}));
      if (weight < 0.01) {
        weight = uniform(random) < 0.5 ? 2 * weight : 0;
        if (weight == 0) break;
      }
    }
    sum += weight;
    squares += weight * weight;
  }
  const double mean = sum / walks;
  return {Color(static_cast<float>(mean)), static_cast<float>(std::sqrt((squares / walks - mean * mean) / walks))};
}

TEST(CoatedDiffuse, ClosedFormMatchesTheRandomWalk) {
  constexpr int kWalks = 20'000;
  for (const float rho : {0.2f, 0.8f}) {
    for (const float c : {0.9f, 0.3f}) {
      const Vec3 wo = Direction(c, 0);
      // Exact for a smooth coat, five sigma.
      const Estimate smooth = LayeredAlbedo(0, 1.5f, rho, wo, kWalks);
      const Estimate closed = AlbedoOf(CoatedDiffuseMaterial(Gray(rho), Roughness()).GetBsdf(HitAt(0)), wo, kWalks, 9);
      EXPECT_NEAR(closed.mean.g, smooth.mean.g, 5 * std::hypot(smooth.sigma, closed.sigma)) << rho << " " << c;
      // And for a rough one, but for the tables.
      const Estimate rough = LayeredAlbedo(0.2f, 1.5f, rho, wo, kWalks);
      const Estimate near = AlbedoOf(CoatedDiffuseMaterial(Gray(rho), Alpha(0.2f)).GetBsdf(HitAt(0)), wo, kWalks, 9);
      EXPECT_NEAR(near.mean.g, rough.mean.g, 2e-3f + 5 * std::hypot(rough.sigma, near.sigma)) << rho << " " << c;
    }
  }
}

TEST(CoatedConductor, RoughLimitIsTheSmoothOne) {
  const Color eta(0.2f, 0.9f, 1.1f), k(3.9f, 2.45f, 2.14f);
  CoatedConductorMaterial::Parameters smooth{.eta = Constant(eta), .k = Constant(k)};
  CoatedConductorMaterial::Parameters rough = smooth;
  rough.conductorRoughness = Alpha(1e-3f);
  for (const float c : {0.95f, 0.6f, 0.4f}) {
    const Vec3 wo = Direction(c, 2);
    const Estimate a = AlbedoOf(CoatedConductorMaterial(smooth).GetBsdf(HitAt(0)), wo, 100, 1);
    const Estimate b = AlbedoOf(CoatedConductorMaterial(rough).GetBsdf(HitAt(0)), wo, 20'000, 1);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a.mean[i], b.mean[i], 4e-3f + 5 * b.sigma) << c;
  }
}

TEST(Plastic, LooksFromInsideAsPbrtV3Does) {
  // From index 1.5 to 1 everything is reflected where the half angle is above 41.8 degrees.
  const Bsdf bsdf = PlasticMaterial(Gray(0), Gray(1), Alpha(0.1f)).GetBsdf(HitAt(0));
  const RoughConductor mirror{Ggx(0.1f, 0.1f), Color(1), Color(1e6f)};
  const auto ratio = [&](float c) {
    const Vec3 wo = Direction(c, 0), wi(-wo.x, -wo.y, wo.z);
    return bsdf.Eval(wo, wi, TransportMode::Radiance).g / (mirror.Value(wo, wi, TransportMode::Radiance).g * wi.z);
  };
  EXPECT_NEAR(ratio(0.7f), 1, 1e-4f);
  EXPECT_NEAR(ratio(1.f), 0.04f, 1e-4f);
}

TEST(Uber, OpacityLetsTheRestGoStraightOn) {
  UberMaterial::Parameters parameters{.kd = Gray(0.5f), .opacity = Constant(Color(1, 0.5f, 0))};
  const Bsdf bsdf = UberMaterial(parameters).GetBsdf(HitAt(0, 0.4f));
  const Vec3 wo = Direction(0.6f, 1);
  const Estimate all = AlbedoOf(bsdf, wo, 20'000, 2);
  Color straight;
  constexpr int kSamples = 1000;
  for (int i = 0; i < kSamples; ++i) {
    const auto s = bsdf.Sample(wo, (i + 0.5) / kSamples, {0.3, 0.3}, TransportMode::Radiance);
    if (!s || !s->IsSpecular()) continue;
    EXPECT_EQ(s->wi, -wo);
    straight += s->weight / static_cast<float>(kSamples);
  }
  EXPECT_NEAR(straight.r, 0, 1e-3f);
  EXPECT_NEAR(straight.g, 0.5f, 3e-3f);
  EXPECT_NEAR(straight.b, 1, 3e-3f);
  EXPECT_NEAR(all.mean.b, 1, 5 * all.sigma);
}

TEST(Mix, IsTheWeightedMeanOfBoth) {
  const auto matte = std::make_shared<MatteMaterial>(Gray(0.6f));
  const auto metal = std::make_shared<ConductorMaterial>(Gray(0.9f), Alpha(0.3f));
  const MixMaterial mix(matte, metal, Constant(Color(0.25f, 0.5f, 1)));
  const SurfaceInteraction hit = HitAt(0.2f);
  const Vec3 wo = Direction(0.7f, 0), wi = Direction(0.6f, 2.8f);
  const Color a = matte->GetBsdf(hit).Eval(wo, wi, TransportMode::Radiance);
  const Color b = metal->GetBsdf(hit).Eval(wo, wi, TransportMode::Radiance);
  const Color both = mix.GetBsdf(hit).Eval(wo, wi, TransportMode::Radiance);
  EXPECT_NEAR(both.r, 0.25f * a.r + 0.75f * b.r, 1e-6f);
  EXPECT_NEAR(both.g, 0.5f * a.g + 0.5f * b.g, 1e-6f);
  EXPECT_NEAR(both.b, a.b, 1e-6f);
}

TEST(Mix, RefusesMoreLobesThanABsdfHolds) {
  UberMaterial::Parameters uber{.kd = Gray(0.3f),
                                .ks = Gray(0.2f),
                                .kr = Gray(0.1f),
                                .kt = Gray(0.1f),
                                .opacity = Gray(0.8f),
                                .roughness = Alpha(0.2f)};
  std::shared_ptr<const Material> material = std::make_shared<UberMaterial>(uber);
  material = std::make_shared<MixMaterial>(material, material, Gray(0.5f));
  EXPECT_THROW(MixMaterial(material, material, Gray(0.5f)), Error);
}

}  // namespace
}  // namespace dapple
