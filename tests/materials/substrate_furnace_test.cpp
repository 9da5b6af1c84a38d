// Substrates of all roughnesses: what they reflect, and that nothing is changed of those that gain no energy.
#include <gtest/gtest.h>

#include "src/materials/plastic_materials.h"
#include "src/materials/procedural_textures.h"
#include "tests/materials/bsdf_cases.h"
#include "tests/support/quadrature.h"

namespace dapple {
namespace {

using testing::Direction;
using testing::TiltedHit;

constexpr MicrofacetKind kKinds[] = {MicrofacetKind::Ggx, MicrofacetKind::Beckmann, MicrofacetKind::Blinn,
                                     MicrofacetKind::AshikhminShirley};

SubstrateMaterial Substrate(MicrofacetKind kind, const Ggx& ggx, const Color& kd, const Color& ks) {
  Roughness roughness(MakeConstant(ggx.AlphaX()), MakeConstant(ggx.AlphaY()), RoughnessRemap::None);
  roughness.SetKind(kind);
  return {MakeConstant(kd), MakeConstant(ks), roughness};
}

/// pbrt-v3's formula, as it is.
Bsdf Unscaled(MicrofacetKind kind, const Ggx& ggx, const Color& kd, const Color& ks) {
  Bsdf bsdf(TiltedHit(0));
  WithMicrofacets(kind, ggx, [&](const auto& microfacets) { bsdf.Add(FresnelBlend{microfacets, kd, ks}); });
  return bsdf;
}

/// Of all that comes along `wo`: by midpoints over half vectors, d wi = 4 |wo.wm| d wm, where nothing is singular at
/// the horizon.
Color ReflectanceOf(const Bsdf& bsdf, const Vec3& wo) {
  constexpr int kRows = 128, kColumns = 256;
  const float azimuth = std::atan2(wo.y, wo.x);
  Vec3d sum(0);
  for (int row = 0; row < kRows; ++row) {
    const float theta = (static_cast<float>(row) + 0.5f) * (kPi / 2) / kRows;
    for (int column = 0; column < kColumns; ++column) {
      const Vec3 wm = Direction(std::cos(theta), azimuth + (static_cast<float>(column) + 0.5f) * 2 * kPi / kColumns);
      const float cosM = Dot(wo, wm);
      const Vec3 wi = wm * (2 * cosM) - wo;
      if (!(cosM > 0) || !(wi.z > 0)) continue;
      const Color value = bsdf.Eval(wo, wi, TransportMode::Importance) * (4 * cosM * std::sin(theta));
      for (int i = 0; i < 3; ++i) sum[i] += static_cast<double>(value[i]);
    }
  }
  const Vec3 mean = ToFloat(sum * (kPiD * kPiD / (kRows * kColumns)));
  return {mean.x, mean.y, mean.z};
}

TEST(SubstrateFurnace, ReflectsNoMoreThanArrivesHoweverRough) {
  const std::pair<float, float> alphas[] = {{0.15f, 0.15f}, {0.5f, 0.5f}, {1, 1},        {1.2f, 1.2f}, {1.62f, 1.62f},
                                            {3, 3},         {5, 5},       {0.3f, 1.62f}, {1, 3},       {0.3f, 3}};
  const Color ks[] = {Color(0, 0.3f, 0.6f), Color(0.8f, 0.95f, 1)};
  for (const MicrofacetKind kind : kKinds) {
    for (const auto& [alphaX, alphaY] : alphas) {
      for (const Color& specular : ks) {
        for (const float kd : {0.f, 0.5f, 1.f}) {
          const SubstrateMaterial material = Substrate(kind, Ggx(alphaX, alphaY), Color(kd), specular);
          const Bsdf bsdf = material.GetBsdf(TiltedHit(0));
          Color largest;
          for (const float cosO : {0.95f, 0.6f, 0.3f, 0.15f, 0.1f, 0.05f, 0.01f, 0.002f}) {
            for (const float phi : {0.f, 0.8f, kPi / 2}) {
              if (alphaX == alphaY && phi > 0) continue;
              const Color reflectance = ReflectanceOf(bsdf, Direction(cosO, phi));
              EXPECT_LE(reflectance.MaxComponent(), 1 + 1e-3f)
                  << static_cast<int>(kind) << " alpha " << alphaX << " " << alphaY << " Kd " << kd << " cos " << cosO;
              for (int i = 0; i < 3; ++i) largest[i] = std::max(largest[i], reflectance[i]);
            }
          }
          // Where it is scaled, by no more than it must be. (Unequal alphas come near the limit at smaller cosines
          // only.)
          if (alphaX == alphaY && *material.LargestUnscaledReflectance() > 1) {
            EXPECT_GT(largest.MaxComponent(), 0.94f)
                << static_cast<int>(kind) << " alpha " << alphaX << " " << alphaY << " Kd " << kd;
          }
        }
      }
    }
  }
}

// Half of the area of all facets: the mean of sqrt(1 + t^2) over their slopes t, in closed form.
TEST(SubstrateFurnace, UnscaledItWouldReflectHalfOfItsFacetsAtTheHorizon) {
  for (const float alpha : {1.001f, 1.2f, 1.62f, 2.f, 3.f, 5.f}) {
    const auto a = static_cast<double>(alpha), q = std::sqrt(a * a - 1);
    const double ggx = (1 + a * a * std::atan(q) / q) / 2;
    const double beckmann = (1 + a * std::sqrt(kPiD) / 2 * std::exp(1 / (a * a)) * std::erfc(1 / a)) / 2;
    const auto largest = [&](MicrofacetKind kind) {
      return *Substrate(kind, Ggx(alpha, alpha), Color(0), Color(1)).LargestUnscaledReflectance();
    };
    EXPECT_NEAR(largest(MicrofacetKind::Ggx), ggx, 1e-3 * ggx) << alpha;
    EXPECT_NEAR(largest(MicrofacetKind::Beckmann), 1.01 * beckmann, 2e-3 * beckmann) << alpha;
    EXPECT_LE(largest(MicrofacetKind::Blinn), 1);
    EXPECT_LE(largest(MicrofacetKind::AshikhminShirley), 1);
  }
  EXPECT_FALSE(
      SubstrateMaterial(MakeConstant(Color(1)), MakeConstant(Color(1)), Roughness()).LargestUnscaledReflectance());
}

// The figures of pbrt-v3's formula (section 8.5) by a quadrature of its own.
TEST(SubstrateFurnace, PbrtsFormulaGainsEnergyAboveAlphaOne) {
  struct Case {
    float alpha, cosO;
    double reflectance;
  };
  for (const Case& c : {Case{1, 0.01f, 0.9717}, {1.62f, 0.05f, 1.1841}, {1.62f, 0.01f, 1.3625}}) {
    const Bsdf bsdf = Unscaled(MicrofacetKind::Ggx, Ggx(c.alpha, c.alpha), Color(1), Color(1));
    const Vec3 wo = Direction(c.cosO, 0.3f);
    const double reflectance = testing::IntegrateSphere(
        [&](const Vec3& wi) { return static_cast<double>(bsdf.Eval(wo, wi, TransportMode::Importance).g); });
    EXPECT_NEAR(reflectance, c.reflectance, 1e-3) << c.alpha << " " << c.cosO;
  }
}

TEST(SubstrateFurnace, OneFactorScalesAllOfItAndOnlyWhereItGainsEnergy) {
  const Color kd(0.2f, 0.6f, 1), ks(0.05f, 0.6f, 0.9f);
  for (const MicrofacetKind kind : kKinds) {
    for (const float alpha : {0.1f, 1.f, 1.62f}) {
      const Ggx ggx(alpha, alpha);
      const Bsdf bsdf = Substrate(kind, ggx, kd, ks).GetBsdf(TiltedHit(0)), formula = Unscaled(kind, ggx, kd, ks);
      // Of GGX at alpha 1.62 the last channel: 0.9 (1.4326 - 0.1863) + 0.1863.
      const float last = kind == MicrofacetKind::Ggx && alpha > 1 ? 1 / 1.3080f : 1;
      for (const float cosO : {1.f, 0.4f, 0.02f, -0.3f}) {
        for (const Vec3& up : {Direction(0.9f, 1), Direction(0.3f, 4), Direction(0.04f, 2)}) {
          const Vec3 wo = Direction(cosO, 0.2f), wi = cosO < 0 ? -up : up;
          const Color is = bsdf.Eval(wo, wi, TransportMode::Radiance),
                      was = formula.Eval(wo, wi, TransportMode::Radiance);
          EXPECT_EQ(is.r, was.r);
          EXPECT_EQ(is.g, was.g);
          EXPECT_NEAR(is.b, last * was.b, last == 1 ? 0 : 1e-3f * was.b);
          EXPECT_EQ(bsdf.Pdf(wo, wi, TransportMode::Radiance), formula.Pdf(wo, wi, TransportMode::Radiance));
        }
      }
    }
  }
}

TEST(SubstrateFurnace, TexturedRoughnessIsScaledPlaceByPlace) {
  class Varying final : public Texture<float> {
   public:
    float Evaluate(const TextureContext& at) const override { return at.uv.x < 0.5f ? 0.5f : 1.62f; }
  };
  const SubstrateMaterial varying(MakeConstant(Color(0.5f)), MakeConstant(Color(1)),
                                  {std::make_shared<Varying>(), RoughnessRemap::None});
  EXPECT_FALSE(varying.LargestUnscaledReflectance());
  const Vec3 wo = Direction(0.3f, 0), wi = Direction(0.1f, 1);
  for (const float u : {0.25f, 0.75f}) {
    SurfaceInteraction hit = TiltedHit(0);
    hit.uv.x = u;
    const float alpha = u < 0.5f ? 0.5f : 1.62f;
    const SubstrateMaterial same = Substrate(MicrofacetKind::Ggx, Ggx(alpha, alpha), Color(0.5f), Color(1));
    EXPECT_EQ(varying.GetBsdf(hit).Eval(wo, wi, TransportMode::Radiance),
              same.GetBsdf(hit).Eval(wo, wi, TransportMode::Radiance));
  }
}

}  // namespace
}  // namespace dapple
