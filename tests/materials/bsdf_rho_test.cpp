// `Bsdf::Rho` against closed forms and quadrature.
#include <gtest/gtest.h>

#include "tests/materials/bsdf_cases.h"
#include "tests/support/chi_square.h"

namespace dapple {
namespace {

using testing::Direction;
using testing::IntegrateSphere;
using testing::TiltedHit;
using testing::WeightedLobes;

Bsdf Of(const Lobe& lobe) {
  Bsdf bsdf(TiltedHit(0));
  bsdf.Add(lobe);
  return bsdf;
}

void ExpectNear(const Color& value, const Color& expected, float error) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(value[i], expected[i], error) << "channel " << i;
}

class BsdfRho : public ::testing::TestWithParam<WeightedLobes> {};
INSTANTIATE_TEST_SUITE_P(Lobes, BsdfRho, ::testing::ValuesIn(testing::NonSpecularCases()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(BsdfRho, IsTheIntegralOfEval) {
  Bsdf bsdf(TiltedHit(0));
  for (const auto& [lobe, scale] : GetParam().lobes) {
    // Specular lobes are no part of the integral.
    if (std::visit([](const auto& l) { return l.Flags().HasNonSpecular(); }, lobe)) bsdf.Add(lobe, scale);
  }
  for (const Vec3& wo : {Direction(0.8f, 1), Direction(0.2f, 3), Direction(-0.5f, 2)}) {
    const ScatteredShares rho = bsdf.Rho(wo, 4096);
    double sides[2] = {};
    for (int side = 0; side < 2; ++side) {
      sides[side] = IntegrateSphere([&](const Vec3& wi) {
        const bool isReflection = wi.z * wo.z > 0;
        return isReflection == (side == 0) ? static_cast<double>(bsdf.Eval(wo, wi, TransportMode::Importance).g) : 0;
      });
    }
    EXPECT_NEAR(rho.reflected.g, sides[0], 3e-3) << wo.z;
    EXPECT_NEAR(rho.transmitted.g, sides[1], 3e-3) << wo.z;
  }
}

TEST_P(BsdfRho, HemisphericalIsTheMeanOfDirectional) {
  Bsdf bsdf(TiltedHit(0));
  for (const auto& [lobe, scale] : GetParam().lobes) bsdf.Add(lobe, scale);
  for (const SurfaceSide side : {SurfaceSide::Outside, SurfaceSide::Inside}) {
    // By midpoints in cos^2, which is uniform in cosine-weighted directions, and in phi.
    ScatteredShares mean;
    constexpr int kCosines = 16, kPhis = 6;
    for (int i = 0; i < kCosines; ++i) {
      const float cosine = std::sqrt((static_cast<float>(i) + 0.5f) / kCosines);
      for (int j = 0; j < kPhis; ++j) {
        const float phi = (static_cast<float>(j) + 0.5f) * kPi / kPhis;
        mean += bsdf.Rho(Direction(side == SurfaceSide::Outside ? cosine : -cosine, phi), 256) *
                Color(1.f / (kCosines * kPhis));
      }
    }
    const ScatteredShares rho = bsdf.Rho(side);
    ExpectNear(rho.reflected, mean.reflected, 5e-3f);
    ExpectNear(rho.transmitted, mean.transmitted, 5e-3f);
    EXPECT_LE(rho.Sum().MaxComponent(), 1.001f);
  }
}

TEST(Rho, LambertianIsItsAlbedo) {
  const Color gray(0.6f, 0.5f, 0.4f);
  const Bsdf reflection = Of(LambertianReflection{gray}), transmission = Of(LambertianTransmission{gray});
  EXPECT_EQ(reflection.Rho(Direction(0.3f, 1)).reflected, gray);
  EXPECT_TRUE(reflection.Rho(Direction(0.3f, 1)).transmitted.IsBlack());
  EXPECT_EQ(transmission.Rho(Direction(-0.3f, 1)).transmitted, gray);
  ExpectNear(reflection.Rho().reflected, gray, 2e-5f);
  ExpectNear(transmission.Rho(SurfaceSide::Inside).transmitted, gray, 2e-5f);
}

TEST(Rho, OrenNayarInClosedForm) {
  // A, and B times the mean of max(0, cos dphi) sin(alpha) tan(beta) over two cosine-weighted directions: over both
  // azimuths max(0, cos dphi) integrates to 4 pi; over both elevations the rest, by midpoints.
  const float sigma = 40;
  const OrenNayarReflection lobe(Color(1), sigma);
  double second = 0;
  constexpr int kSteps = 1000;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double a = (i + 0.5) * kPiD / 2 / kSteps, b = (j + 0.5) * kPiD / 2 / kSteps;
      second +=
          std::sin(std::max(a, b)) * std::tan(std::min(a, b)) * std::cos(a) * std::sin(a) * std::cos(b) * std::sin(b);
    }
  }
  second *= Sqr(kPiD / 2 / kSteps) * 4 * kPiD / Sqr(kPiD);
  const double expected = static_cast<double>(lobe.a) + static_cast<double>(lobe.b) * second;
  EXPECT_NEAR(Of(lobe).Rho().reflected.g, expected, 2e-4);
}

TEST(Rho, SmoothInterfacesByFresnel) {
  for (const float c : {0.9f, 0.3f, -0.7f, -0.2f}) {
    const Vec3 wo = Direction(c, 1);
    const ScatteredShares glass = Of(SmoothDielectric(1.5f)).Rho(wo), thin = Of(ThinDielectric(1.5f)).Rho(wo);
    ExpectNear(glass.reflected, Color(FresnelDielectric(c, 1.5f)), 1e-6f);
    ExpectNear(glass.Sum(), Color(1), 1e-6f);
    const float once = FresnelDielectric(std::abs(c), 1.5f);
    ExpectNear(thin.reflected, Color(2 * once / (1 + once)), 1e-6f);
    ExpectNear(thin.Sum(), Color(1), 1e-6f);
    ExpectNear(Of(MirrorReflection(Color(0.8f))).Rho(wo).reflected, Color(0.8f), 0);
    ExpectNear(Of(PassThrough(Color(0.7f))).Rho(wo).transmitted, Color(0.7f), 0);
    const Color eta(0.2f, 0.9f, 1.1f), k(3.9f, 2.45f, 2.14f);
    ExpectNear(Of(ConductorReflection(eta, k)).Rho(wo).reflected, FresnelConductor(c, eta, k), 1e-6f);
  }
}

TEST(Rho, CoatsByFresnel) {
  const Color eta(0.2f, 0.9f, 1.1f), k(3.9f, 2.45f, 2.14f);
  for (const float c : {0.9f, 0.3f, -0.7f}) {
    const Vec3 wo = Direction(c, 1);
    const float coat = FresnelDielectric(std::abs(c), 1.5f);
    ExpectNear(Of(CoatReflection(1.5f)).Rho(wo).reflected, Color(coat), 1e-6f);
    // R = F + (1 - F)^2 Rc / (1 - F Rc), the metal seen at the refracted angle.
    const float inside = std::sqrt(1 - (1 - c * c) / 2.25f);
    const Color metal = FresnelConductor(inside, eta, k);
    const Color expected = Map(metal, [coat](float m) { return coat + Sqr(1 - coat) * m / (1 - coat * m); });
    ExpectNear(Of(CoatedConductorReflection(1.5f, eta, k)).Rho(wo).reflected, expected, 1e-5f);
  }
}

TEST(Rho, DiffuseLightAtASmoothInterface) {
  // Inside, all but 1 / eta^2 of the hemisphere is reflected totally: what enters and what leaves are as etendues are,
  // 1 - Ri = (1 - Re) / eta^2. Stratified samples of a step err by N^(-3/4), 2e-3 for 4096; of a smooth function by
  // less.
  const Bsdf glass = Of(SmoothDielectric(1.5f));
  const float outside = FresnelDiffuseReflectance(1.5f);
  ExpectNear(glass.Rho().reflected, Color(outside), 3e-4f);
  ExpectNear(glass.Rho(SurfaceSide::Inside).reflected, Color(1 - (1 - outside) / 2.25f), 2e-3f);
  ExpectNear(glass.Rho(SurfaceSide::Inside).Sum(), Color(1), 2e-5f);
}

TEST(Rho, IsZeroWhereNothingIs) {
  const Bsdf black{TiltedHit(0)};
  EXPECT_TRUE(black.Rho(Direction(0.5f, 0)).Sum().IsBlack());
  EXPECT_TRUE(black.Rho().Sum().IsBlack());
}

}  // namespace
}  // namespace dapple
