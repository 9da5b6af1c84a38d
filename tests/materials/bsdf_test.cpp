#include "src/materials/bsdf.h"

#include <array>
#include <random>

#include <gtest/gtest.h>

#include "tests/materials/bsdf_cases.h"
#include "tests/materials/bsdf_checks.h"
#include "tests/support/chi_square.h"

namespace dapple {
namespace {

using testing::Direction;
using testing::MakeBsdf;
using testing::TiltedHit;
using testing::WeightedLobes;

constexpr TransportMode kModes[] = {TransportMode::Radiance, TransportMode::Importance};
constexpr float kTilts[] = {0, 0.4f};
/// Above and below the surface, down to grazing; numbers 3 and 4 a tilted shading normal sees from the other side.
const Vec3 kOutgoing[] = {Direction(0.9f, 0.3f),  Direction(0.4f, 2),     Direction(-0.6f, 4),
                          Direction(0.15f, 3.9f), Direction(-0.2f, 0.5f), Direction(0.04f, 1.2f)};

std::mt19937_64 Random(uint64_t seed) { return std::mt19937_64(seed); }
double Uniform(std::mt19937_64& random) { return std::uniform_real_distribution<double>(0, 1)(random); }
Vec3 UniformDirection(std::mt19937_64& random) {
  const double z = 2 * Uniform(random) - 1, phi = 2 * kPiD * Uniform(random);
  return Direction(static_cast<float>(z), static_cast<float>(phi));
}

class NonSpecularBsdf : public ::testing::TestWithParam<WeightedLobes> {};

INSTANTIATE_TEST_SUITE_P(Lobes, NonSpecularBsdf, ::testing::ValuesIn(testing::NonSpecularCases()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(NonSpecularBsdf, SamplesFollowThePdf) {
  uint64_t seed = 100;
  for (const float tilt : kTilts) {
    const Bsdf bsdf = MakeBsdf(GetParam(), tilt);
    for (const TransportMode mode : kModes) {
      for (const int i : mode == TransportMode::Radiance ? std::vector{0, 2, 3, 5} : std::vector{1, 2, 4}) {
        const Vec3 wo = kOutgoing[i];
        const auto sample = [&](double uc, const Vec2d& u) -> std::optional<Vec3> {
          const auto s = bsdf.Sample(wo, uc, u, mode);
          if (!s || s->IsSpecular()) return std::nullopt;
          return s->wi;
        };
        const auto pdf = [&](const Vec3& wi) {
          // Directions that scatter nothing are not returned.
          return bsdf.Eval(wo, wi, mode).IsBlack() ? 0 : bsdf.Pdf(wo, wi, mode);
        };
        const auto fit =
            testing::ChiSquareOnSphere(sample, pdf, {.samples = 30'000, .rows = 16, .columns = 24, .seed = seed++});
        EXPECT_TRUE(fit.Passes()) << fit.message << ", tilt " << tilt << ", wo " << wo.x << " " << wo.y << " " << wo.z
                                  << ", mode " << static_cast<int>(mode);
      }
    }
  }
}

TEST_P(NonSpecularBsdf, SampleAgreesWithEvalAndPdf) {
  for (const float tilt : kTilts) {
    const Bsdf bsdf = MakeBsdf(GetParam(), tilt);
    for (const TransportMode mode : kModes) {
      const Verdict verdict = testing::CheckSampleAgainstEval(bsdf, mode);
      EXPECT_TRUE(verdict.passes) << verdict.message << ", tilt " << tilt << ", mode " << static_cast<int>(mode);
    }
  }
}

TEST_P(NonSpecularBsdf, ModesAreAdjoint) {
  // Eval(wo, wi, Importance) = f(wi, wo) |ns.wo| |ng.wi| / |ng.wo| (Veach 1997, equation 5.19), where f(wi, wo) |ns.wo|
  // is Eval(wi, wo, Radiance).
  auto random = Random(6);
  for (const float tilt : kTilts) {
    const Bsdf bsdf = MakeBsdf(GetParam(), tilt);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 wo = UniformDirection(random), wi = UniformDirection(random);
      const float importance = bsdf.Eval(wo, wi, TransportMode::Importance).g * std::abs(wo.z);
      const float radiance = bsdf.Eval(wi, wo, TransportMode::Radiance).g * std::abs(wi.z);
      EXPECT_NEAR(importance, radiance, 2e-3f * radiance + 2e-6f);
    }
  }
}

TEST_P(NonSpecularBsdf, IsReciprocal) {
  // Lobes of transmission that do not refract keep to n = 1: only pure interfaces have an index of their own.
  const bool isMixed = GetParam().lobes.size() > 1;
  for (const float tilt : kTilts) {
    const Verdict verdict = testing::CheckReciprocity(MakeBsdf(GetParam(), tilt), GetParam().etaBelow, isMixed);
    EXPECT_TRUE(verdict.passes) << verdict.message << ", tilt " << tilt;
  }
}

TEST_P(NonSpecularBsdf, SamplingAndQuadratureAgree) {
  const Bsdf bsdf = MakeBsdf(GetParam(), 0.4f);
  auto random = Random(9);
  for (const TransportMode mode : kModes) {
    const Vec3 wo = kOutgoing[1];
    constexpr int kSamples = 40'000;
    double sum = 0, sumOfSquares = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double uc = Uniform(random);
      const auto s = bsdf.Sample(wo, uc, {Uniform(random), Uniform(random)}, mode);
      const double x = s && !s->IsSpecular() ? static_cast<double>(s->weight.g) : 0;
      sum += x;
      sumOfSquares += x * x;
    }
    const double mean = sum / kSamples, sigma = std::sqrt((sumOfSquares / kSamples - mean * mean) / kSamples);
    const double expected =
        testing::IntegrateSphere([&](const Vec3& wi) { return static_cast<double>(bsdf.Eval(wo, wi, mode).g); });
    // Under thirty BSDFs, two modes: five sigma is one in twenty-five thousand for all of them.
    EXPECT_NEAR(mean, expected, 5 * sigma + 1e-3 * expected);
  }
}

TEST(Bsdf, LambertianAlbedoIsKeptByAnyShadingNormal) {
  for (const float tilt : {0.f, 0.3f, 1.2f}) {
    Bsdf bsdf(TiltedHit(tilt));
    bsdf.Add(LambertianReflection{Color(0.7f)});
    for (const Vec3& wo : kOutgoing) {
      const double albedo = testing::IntegrateSphere(
          [&](const Vec3& wi) { return static_cast<double>(bsdf.Eval(wo, wi, TransportMode::Radiance).g); });
      EXPECT_NEAR(albedo, 0.7, 1e-3);
    }
  }
}

TEST(Bsdf, NothingLeaksThroughAnOpaqueSurface) {
  auto random = Random(10);
  for (const WeightedLobes& lobes : testing::NonSpecularCases()) {
    const Bsdf bsdf = MakeBsdf(lobes, 1);
    if (bsdf.Flags().HasTransmission()) continue;
    for (int i = 0; i < 500; ++i) {
      const Vec3 wo = UniformDirection(random), wi = UniformDirection(random);
      if (wo.z * wi.z < 0) {
        EXPECT_TRUE(bsdf.Eval(wo, wi, TransportMode::Radiance).IsBlack());
      }
      const double uc = Uniform(random);
      const auto s = bsdf.Sample(wo, uc, {Uniform(random), Uniform(random)}, TransportMode::Radiance);
      if (s) {
        EXPECT_GT(s->wi.z * wo.z, 0);
      }
    }
  }
}

TEST(Bsdf, GlassDividesLightByFresnel) {
  Bsdf bsdf(TiltedHit(0));
  bsdf.Add(SmoothDielectric(1.5f));
  const Vec3 wo = Direction(0.3f, 1);
  const float fresnel = FresnelDielectric(0.3f, 1.5f);
  const auto reflected = bsdf.Sample(wo, 0.99 * static_cast<double>(fresnel), {0, 0}, TransportMode::Radiance);
  const auto refracted = bsdf.Sample(wo, 1.01 * static_cast<double>(fresnel), {0, 0}, TransportMode::Radiance);
  EXPECT_NEAR(reflected->pdf, fresnel, 1e-6f);
  EXPECT_LT(Distance(reflected->wi, Vec3(-wo.x, -wo.y, wo.z)), 1e-6f);
  EXPECT_NEAR(refracted->pdf, 1 - fresnel, 1e-6f);
  EXPECT_NEAR(std::hypot(refracted->wi.x, refracted->wi.y) * 1.5f, std::hypot(wo.x, wo.y), 1e-6f);
  EXPECT_EQ(refracted->eta, 1.5f);
}

// Both ways of a smooth interface together are what sampling it gives in the mean.
TEST(Bsdf, ASpecularPairIsAllThatSamplingFinds) {
  const Lobe lobes[] = {SmoothDielectric(1.5f), SmoothDielectric(1 / 1.5f, Color(0.9f, 0.5f, 0.2f), Color(0.3f)),
                        ThinDielectric(1.5f)};
  for (const Lobe& lobe : lobes)
    for (const float tilt : {0.0f, 0.1f})
      for (const Vec3& wo : {Direction(0.9f, 0.3f), Direction(-0.9f, 1)}) {
        const Bsdf bsdf = MakeBsdf({"pair", {{lobe, Color(0.5f, 1, 0.7f)}}}, tilt);
        const auto pair = bsdf.BothWays(wo);
        ASSERT_TRUE(pair);
        EXPECT_NEAR(pair->reflected.pdf + pair->transmitted.pdf, 1, 1e-6f);
        Color reflected, transmitted;
        constexpr int kDraws = 4096;
        for (int i = 0; i < kDraws; ++i) {
          const auto drawn = bsdf.Sample(wo, (i + 0.5) / kDraws, {0, 0}, TransportMode::Radiance);
          ASSERT_TRUE(drawn);
          const bool isReflected = drawn->flags.HasReflection();
          const BsdfSample& way = isReflected ? pair->reflected : pair->transmitted;
          EXPECT_EQ(drawn->wi, way.wi);
          EXPECT_EQ(drawn->eta, way.eta);
          (isReflected ? reflected : transmitted) += drawn->weight / kDraws;
        }
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(pair->reflected.weight[c], reflected[c], 2.0f / kDraws);
          EXPECT_NEAR(pair->transmitted.weight[c], transmitted[c], 2.0f / kDraws);
        }
      }
}

TEST(Bsdf, OneWayOrManyAreNoSpecularPair) {
  const auto hasPair = [](const std::vector<Lobe>& lobes, const Vec3& wo) {
    Bsdf bsdf(TiltedHit(0));
    for (const Lobe& lobe : lobes) bsdf.Add(lobe, Color(0.5f));
    return bsdf.BothWays(wo).has_value();
  };
  const Vec3 above = Direction(0.9f, 0.3f), grazingBelow = Direction(-0.3f, 0.3f);
  EXPECT_TRUE(hasPair({SmoothDielectric(1.5f)}, above));
  EXPECT_FALSE(hasPair({SmoothDielectric(1.5f)}, grazingBelow)) << "total reflection";
  EXPECT_FALSE(hasPair({MirrorReflection(Color(1))}, above));
  EXPECT_FALSE(hasPair({PassThrough()}, above));
  EXPECT_FALSE(hasPair({SmoothDielectric(1.5f), PassThrough()}, above)) << "three ways";
  EXPECT_FALSE(hasPair({SmoothDielectric(1.5f), LambertianReflection(Color(1))}, above));
  EXPECT_FALSE(hasPair({LambertianReflection(Color(1))}, above));
  EXPECT_FALSE(hasPair({}, above));
}

TEST(Bsdf, SpecularWalksAreAdjointUnderBentNormals) {
  // The measurement <h, K g> is the same whichever end the walk starts from; g, h smooth functions on both sides.
  // Radiance walks estimate the integral of h(wo) |ng.wo| K g(wo), light walks that of g(wi) |ng.wi| K* h(wi).
  const auto g = [](const Vec3& w) { return 1 + 0.5 * static_cast<double>(w.x) + 0.3 * static_cast<double>(w.z); };
  const auto h = [](const Vec3& w) { return 1 - 0.4 * static_cast<double>(w.y) + 0.2 * static_cast<double>(w.z); };
  for (const Lobe& lobe : {Lobe(MirrorReflection(Color(0.9f))), Lobe(SmoothDielectric(1.5f))}) {
    Bsdf bsdf(TiltedHit(0.5f));
    bsdf.Add(lobe);
    auto random = Random(12);
    constexpr int kSamples = 200'000;
    double mean[2] = {}, square[2] = {};
    for (int i = 0; i < kSamples; ++i) {
      for (const TransportMode mode : kModes) {
        const bool fromEye = mode == TransportMode::Radiance;
        const Vec3 wo = UniformDirection(random);
        const auto s = bsdf.Sample(wo, Uniform(random), {0, 0}, mode);
        if (!s) continue;
        const double here = fromEye ? h(wo) : g(wo), there = fromEye ? g(s->wi) : h(s->wi);
        const double x = here * std::abs(static_cast<double>(wo.z)) * there * static_cast<double>(s->weight.g);
        mean[!fromEye] += x / kSamples;
        square[!fromEye] += x * x / kSamples;
      }
    }
    const double sigma = std::sqrt((square[0] + square[1] - Sqr(mean[0]) - Sqr(mean[1])) / kSamples);
    EXPECT_NEAR(mean[0], mean[1], 4 * sigma);
    EXPECT_LT(sigma, 0.01 * mean[0]);
  }
}

TEST(Bsdf, RoughLobesBecomeSmoothOnes) {
  auto random = Random(13);
  const Color eta(0.2f, 0.9f, 1.1f), k(3.9f, 2.45f, 2.14f);
  Bsdf metal(TiltedHit(0)), glass(TiltedHit(0));
  metal.Add(RoughConductor{Ggx(1e-3f, 1e-3f), eta, k});
  glass.Add(RoughDielectric{Ggx(1e-3f, 1e-3f), 1.5f, Color(1), Color(1)});
  for (const float c : {0.95f, 0.4f, -0.8f}) {
    const Vec3 wo = Direction(c, 1);
    constexpr int kSamples = 4000;
    Color fromMetal;
    float reflected = 0, all = 0;
    for (int i = 0; i < kSamples; ++i) {
      const Vec2d u(Uniform(random), Uniform(random));
      const double uc = (i + Uniform(random)) / kSamples;
      const auto m = metal.Sample(wo, uc, u, TransportMode::Importance);
      if (m) {
        fromMetal += m->weight / kSamples;
      }
      const auto d = glass.Sample(wo, uc, u, TransportMode::Importance);
      if (!d) continue;
      all += d->weight.g / kSamples;
      if (d->flags.HasReflection()) reflected += d->weight.g / kSamples;
    }
    const Color smooth = FresnelConductor(c, eta, k);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(fromMetal[i], smooth[i], 2e-3f);
    EXPECT_NEAR(reflected, FresnelDielectric(c, 1.5f), 2e-3f);
    EXPECT_NEAR(all, 1, 2e-3f);
  }
}

TEST(Bsdf, MixedLambertiansAreOne) {
  Bsdf bsdf(TiltedHit(0));
  bsdf.Add(LambertianReflection{Color(0.5f)}, Color(0.4f));
  bsdf.Add(LambertianReflection{Color(0.2f)}, Color(0.6f));
  const Vec3 wo = Direction(0.5f, 0), wi = Direction(0.7f, 2);
  EXPECT_NEAR(bsdf.Eval(wo, wi, TransportMode::Radiance).g, (0.2f + 0.12f) * kInvPi * 0.7f, 1e-7f);
  EXPECT_NEAR(bsdf.Albedo(wo).g, 0.32f, 1e-7f);
}

TEST(Bsdf, BlackLobesAreLeftOut) {
  Bsdf bsdf(TiltedHit(0));
  bsdf.Add(LambertianReflection{Color()});
  bsdf.Add(MirrorReflection(Color(1)), Color());
  EXPECT_TRUE(bsdf.IsBlack());
  EXPECT_TRUE(bsdf.Flags().IsEmpty());
  EXPECT_FALSE(bsdf.Sample(Direction(0.5f, 0), 0.5, {0.5, 0.5}, TransportMode::Radiance));
  EXPECT_EQ(bsdf.Pdf(Direction(0.5f, 0), Direction(0.5f, 1), TransportMode::Radiance), 0);
}

TEST(Bsdf, SurvivesGrazingAndExtremeInput) {
  auto random = Random(14);
  for (const WeightedLobes& lobes : testing::NonSpecularCases()) {
    for (const float tilt : kTilts) {
      const Bsdf bsdf = MakeBsdf(lobes, tilt);
      for (const float z : {0.f, 1e-30f, -1e-20f, 1e-7f, -1e-4f, 1.f, -1.f}) {
        for (int i = 0; i < 50; ++i) {
          const Vec3 wo = Direction(z, static_cast<float>(6 * Uniform(random)));
          for (const TransportMode mode : kModes) {
            const double uc = Uniform(random);
            const Vec2d u = i == 0 ? Vec2d(0, 0) : i == 1 ? Vec2d(1, 1) : Vec2d(Uniform(random), Uniform(random));
            const auto s = bsdf.Sample(wo, uc, u, mode);
            if (s) {
              EXPECT_TRUE(s->weight.IsFinite() && std::isfinite(s->pdf) && s->pdf > 0 && IsFinite(s->wi)) << lobes.name;
            }
            const Vec3 wi = i % 2 ? UniformDirection(random) : -wo;
            EXPECT_TRUE(bsdf.Eval(wo, wi, mode).IsFinite()) << lobes.name << " z " << z;
            EXPECT_TRUE(std::isfinite(bsdf.Pdf(wo, wi, mode))) << lobes.name << " z " << z;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace dapple
