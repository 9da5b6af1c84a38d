// Energy, reciprocity and frequencies: what a BSDF may make of the light that reaches it, by quadrature where it can
// be.
#include <random>

#include <gtest/gtest.h>

#include "tests/materials/bsdf_cases.h"
#include "tests/support/chi_square.h"

namespace dapple {
namespace {

using testing::Direction;
using testing::MakeBsdf;
using testing::SpecularCase;
using testing::TiltedHit;
using testing::WeightedLobes;

constexpr double kLastBelowOne = 0x1.fffffffffffffp-1;

/// From above and from below, straight and grazing.
const Vec3 kIncidence[] = {Direction(0.95f, 0.3f), Direction(0.5f, 2),  Direction(0.1f, 3),
                           Direction(-0.9f, 1),    Direction(-0.4f, 4), Direction(-0.05f, 5)};

class NonSpecularFurnace : public ::testing::TestWithParam<WeightedLobes> {};
INSTANTIATE_TEST_SUITE_P(Lobes, NonSpecularFurnace, ::testing::ValuesIn(testing::NonSpecularCases()),
                         [](const auto& instance) { return instance.param.name; });

class SpecularBsdf : public ::testing::TestWithParam<SpecularCase> {};
INSTANTIATE_TEST_SUITE_P(Lobes, SpecularBsdf, ::testing::ValuesIn(testing::SpecularCases()),
                         [](const auto& instance) { return instance.param.name; });

/// The branches of a specular BSDF: the first number gives one, the last the other where there are two.
std::vector<BsdfSample> BranchesOf(const Bsdf& bsdf, const Vec3& wo, TransportMode mode) {
  std::vector<BsdfSample> branches;
  for (const double uc : {0.0, kLastBelowOne}) {
    const auto s = bsdf.Sample(wo, uc, {0.5, 0.5}, mode);
    if (s && (branches.empty() || !(branches.back().flags == s->flags))) branches.push_back(*s);
  }
  return branches;
}

/// What the specular lobes of a mixture scatter: the mean weight over a fine comb of `uc`.
Color SpecularFluxOf(const Bsdf& bsdf, const Vec3& wo) {
  Color sum;
  constexpr int kSteps = 10'000;
  if (!bsdf.Flags().HasSpecular()) return sum;
  for (int i = 0; i < kSteps; ++i) {
    const auto s = bsdf.Sample(wo, (i + 0.5) / kSteps, {0.5, 0.5}, TransportMode::Importance);
    if (s && s->IsSpecular()) sum += s->weight;
  }
  return sum / kSteps;
}

TEST_P(NonSpecularFurnace, ReflectsNoMoreThanArrives) {
  // Flux on the light's side (importance): no more leaves than came, whatever the indices.
  const Bsdf bsdf = MakeBsdf(GetParam(), 0);
  for (const Vec3& wo : kIncidence) {
    const Color specular = SpecularFluxOf(bsdf, wo);
    for (int channel = 0; channel < 3; ++channel) {
      const double scattered = testing::IntegrateSphere(
          [&](const Vec3& wi) { return static_cast<double>(bsdf.Eval(wo, wi, TransportMode::Importance)[channel]); });
      const double total = scattered + static_cast<double>(specular[channel]);
      EXPECT_LE(total, 1 + 1e-3) << "cos " << wo.z << " channel " << channel;
      EXPECT_GT(total, 1e-3) << "cos " << wo.z << " channel " << channel;
    }
  }
}

TEST_P(NonSpecularFurnace, DensityIntegratesToOneButForWhatIsDrawnAndLost) {
  // What `Sample` returns nothing for and the share of specular lobes are what the density lacks. To 1e-3, and five
  // standard errors of the lost share.
  const Bsdf bsdf = MakeBsdf(GetParam(), 0);
  std::mt19937_64 random(20);
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr int kSamples = 20'000;
  for (const Vec3& wo : kIncidence) {
    int lost = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double uc = uniform(random), u0 = uniform(random);
      const auto s = bsdf.Sample(wo, uc, {u0, uniform(random)}, TransportMode::Radiance);
      lost += !s || s->IsSpecular();
    }
    const double share = lost / static_cast<double>(kSamples);
    const double total = testing::IntegrateSphere([&](const Vec3& wi) {
      const bool isNothing = bsdf.Eval(wo, wi, TransportMode::Radiance).IsBlack();  // is not returned
      return isNothing ? 0 : static_cast<double>(bsdf.Pdf(wo, wi, TransportMode::Radiance));
    });
    EXPECT_NEAR(total + share, 1, 1e-3 + 5 * std::sqrt(share * (1 - share) / kSamples)) << "cos " << wo.z;
    if (!bsdf.Flags().HasSpecular() && !bsdf.Flags().HasGlossy()) {
      EXPECT_EQ(lost, 0);
    }
  }
}

TEST_P(SpecularBsdf, ReflectsNoMoreThanArrivesAndLosslessOnesAll) {
  Bsdf bsdf(TiltedHit(0));
  bsdf.Add(GetParam().lobe);
  EXPECT_TRUE(bsdf.IsPurelySpecular());
  for (const Vec3& wo : kIncidence) {
    Color flux;
    for (const BsdfSample& s : BranchesOf(bsdf, wo, TransportMode::Importance)) flux += s.weight * s.pdf;
    EXPECT_LE(flux.MaxComponent(), 1 + 2e-6f) << wo.z;
    EXPECT_GT(flux.MaxComponent(), 0) << wo.z;
    for (int channel = 0; channel < 3 && GetParam().isLossless; ++channel) {
      EXPECT_NEAR(flux[channel], 1, 2e-6f) << wo.z;
    }
  }
}

TEST_P(SpecularBsdf, BranchesComeAsOftenAsTheirProbability) {
  Bsdf bsdf(TiltedHit(0));
  bsdf.Add(GetParam().lobe);
  constexpr int kSteps = 1000;
  for (const TransportMode mode : {TransportMode::Radiance, TransportMode::Importance}) {
    for (const Vec3& wo : kIncidence) {
      double sum = 0;
      for (const BsdfSample& branch : BranchesOf(bsdf, wo, mode)) {
        int count = 0;
        for (int i = 0; i < kSteps; ++i) {
          const auto s = bsdf.Sample(wo, (i + 0.5) / kSteps, {0.3, 0.7}, mode);
          count += s && s->flags == branch.flags;
        }
        EXPECT_NEAR(count / static_cast<double>(kSteps), branch.pdf, 1.0 / kSteps) << wo.z;
        sum += static_cast<double>(branch.pdf);
        // Delta distributions have no value and no density elsewhere.
        EXPECT_TRUE(bsdf.Eval(wo, branch.wi, mode).IsBlack());
        EXPECT_EQ(bsdf.Pdf(wo, branch.wi, mode), 0);
        EXPECT_EQ(branch.flags.HasTransmission(), branch.wi.z * wo.z < 0);
      }
      EXPECT_NEAR(sum, 1, 1e-6);
    }
  }
}

TEST_P(SpecularBsdf, IsReciprocal) {
  // Back along the way light came: the same share of the flux (Stokes), and of radiance that share over eta^2.
  Bsdf bsdf(TiltedHit(0));
  bsdf.Add(GetParam().lobe);
  for (const Vec3& wo : kIncidence) {
    for (const BsdfSample& there : BranchesOf(bsdf, wo, TransportMode::Importance)) {
      bool isFound = false;
      for (const BsdfSample& back : BranchesOf(bsdf, there.wi, TransportMode::Radiance)) {
        if (Distance(back.wi, wo) > 1e-3f) continue;
        isFound = true;
        for (int channel = 0; channel < 3; ++channel) {
          EXPECT_NEAR(back.weight[channel] * back.pdf * Sqr(back.eta), there.weight[channel] * there.pdf, 1e-4f)
              << wo.z;
        }
        EXPECT_NEAR(back.eta * there.eta, 1, 1e-6f);
      }
      EXPECT_TRUE(isFound) << wo.z;
    }
  }
}

}  // namespace
}  // namespace dapple
