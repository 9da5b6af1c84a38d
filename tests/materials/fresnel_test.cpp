#include "src/materials/fresnel.h"

#include <complex>
#include <random>

#include <gtest/gtest.h>

#include "src/base/frame.h"
#include "src/base/numerics.h"

namespace dapple {
namespace {

/// Fresnel's equations as they stand in the books, in long double; `cosTheta` >= 0.
long double ReferenceDielectric(long double cosTheta, long double eta) {
  const long double sin2 = (1 - cosTheta * cosTheta) / (eta * eta);
  if (sin2 >= 1) return 1;
  const long double cosT = std::sqrt(1 - sin2);
  const long double parallel = (eta * cosTheta - cosT) / (eta * cosTheta + cosT);
  const long double senkrecht = (cosTheta - eta * cosT) / (cosTheta + eta * cosT);
  return (parallel * parallel + senkrecht * senkrecht) / 2;
}

long double ReferenceConductor(long double cosTheta, long double eta, long double k) {
  const std::complex<long double> index(eta, k);
  const std::complex<long double> cosT = std::sqrt(1.0L - (1 - cosTheta * cosTheta) / (index * index));
  const auto parallel = (index * cosTheta - cosT) / (index * cosTheta + cosT);
  const auto senkrecht = (cosTheta - index * cosT) / (cosTheta + index * cosT);
  return (std::norm(parallel) + std::norm(senkrecht)) / 2;
}

TEST(FresnelDielectric, MatchesSnellInLongDouble) {
  for (const float eta : {1 + 1e-6f, 1.0001f, 1.33f, 1.5f, 2.4f, 10.f, 1 - 1e-6f, 0.999f, 1 / 1.5f, 0.3f}) {
    for (int i = 0; i <= 1000; ++i) {
      const float c = static_cast<float>(i) / 1000;
      const long double g2 = 1 - (1 - static_cast<long double>(c) * c) / (static_cast<long double>(eta) * eta);
      if (std::abs(g2) < 1e-4L) continue;  // around the critical angle the rounding of the product counts, see below
      const double expected = static_cast<double>(ReferenceDielectric(c, eta));
      EXPECT_NEAR(FresnelDielectric(c, eta), expected, 1e-6 * expected + 1e-5 * expected / std::sqrt(1e-4))
          << "eta " << eta << " cos " << c;
    }
  }
}

TEST(FresnelDielectric, RelativePrecisionWhereIndicesAreNear) {
  // F = ((eta - 1) / (eta + 1))^2 at normal incidence, 1e-14 and less for eta - 1 = 2e-7: nothing cancels.
  for (const float eta : {1 + 0x1p-22f, 1 + 0x1p-15f, 1 + 0x1p-8f}) {
    for (const float c : {1.f, 0.9f, 0.5f, 0.3f}) {
      const double expected = static_cast<double>(ReferenceDielectric(c, eta));
      EXPECT_NEAR(FresnelDielectric(c, eta) / expected, 1, 2e-5) << eta << " " << c;
    }
  }
  EXPECT_EQ(FresnelDielectric(0.5f, 1), 0);
  EXPECT_EQ(FresnelDielectric(0, 1), 0);
}

TEST(FresnelDielectric, KnownAngles) {
  EXPECT_NEAR(FresnelDielectric(1, 1.5f), 0.04f, 1e-7f);
  EXPECT_NEAR(FresnelDielectric(-1, 1.5f), 0.04f, 1e-7f);
  EXPECT_EQ(FresnelDielectric(0, 1.5f), 1);
  // Brewster: half of what is reflected elsewhere, the senkrecht share ((eta^2 - 1) / (eta^2 + 1))^2 / 2.
  const float brewster = 1 / std::sqrt(1 + 1.5f * 1.5f);
  EXPECT_NEAR(FresnelDielectric(brewster, 1.5f), 0.5f * Sqr(1.25f / 3.25f), 1e-6f);
}

TEST(FresnelDielectric, TotalReflectionBeginsAtTheCriticalAngle) {
  const float eta = 1.5f;  // from inside: sin > 1 / 1.5
  const float critical = static_cast<float>(std::sqrt(1 - 1 / (1.5 * 1.5)));
  EXPECT_EQ(FresnelDielectric(-critical * 0.99999f, eta), 1);
  EXPECT_LT(FresnelDielectric(-critical * 1.00001f, eta), 1);
  // Continuous there, with the slope of a square root.
  EXPECT_GT(FresnelDielectric(-critical * 1.00001f, eta), 0.97f);
  for (float c = critical, i = 0; i < 100; ++i, c = NextFloatUp(c)) {
    const float f = FresnelDielectric(-c, eta);
    EXPECT_TRUE(f >= 0.97f && f <= 1) << f;
  }
}

TEST(FresnelDielectric, SameFromBothSidesOfARefractedPath) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0.02f, 1);
  for (int i = 0; i < 1000; ++i) {
    const float eta = 1 + uniform(random), c = uniform(random);
    const float s = std::sqrt((1 - c) * (1 + c));
    const auto refraction = Refract(Vec3(s, 0, c), Vec3(0, 0, 1), eta);
    ASSERT_TRUE(refraction);
    EXPECT_NEAR(FresnelDielectric(c, eta), FresnelDielectric(refraction->w.z, eta), 1e-4f);
  }
}

TEST(FresnelConductor, MatchesComplexLongDouble) {
  for (const float eta : {0.05f, 0.2f, 1.f, 1.1f, 3.f}) {
    for (const float k : {0.f, 0.01f, 1.f, 3.9f, 10.f}) {
      for (int i = 1; i <= 200; ++i) {
        const float c = static_cast<float>(i) / 200;
        const float f = FresnelConductor(c, Color(eta), Color(k)).g;
        EXPECT_NEAR(f, static_cast<double>(ReferenceConductor(c, eta, k)), 1e-5) << eta << " " << k << " " << c;
      }
    }
  }
}

TEST(FresnelConductor, WithoutAbsorptionItIsADielectric) {
  for (int i = 0; i <= 100; ++i) {
    const float c = static_cast<float>(i) / 100;
    for (const float eta : {1.5f, 0.7f}) {
      EXPECT_NEAR(FresnelConductor(c, Color(eta), Color()).r, FresnelDielectric(c, eta), 2e-6f) << c << " " << eta;
    }
  }
}

TEST(FresnelConductor, ReflectanceGivesItsNormalIncidence) {
  const Color reflectance(0.95f, 0.3f, 0);
  const Color k = ConductorKFromReflectance(reflectance);
  const Color f = FresnelConductor(1, Color(1), k);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(f[c], reflectance[c], 1e-6f);
  EXPECT_TRUE(FresnelConductor(1, Color(1), ConductorKFromReflectance(Color(1))).IsFinite());
}

TEST(Refract, ObeysSnellInThePlaneOfIncidence) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 n = Normalize(Vec3(uniform(random), uniform(random), uniform(random)));
    const Vec3 w = Normalize(Vec3(uniform(random), uniform(random), uniform(random)));
    const float eta = 1 + 0.5f * (uniform(random) + 1) + 1e-3f;
    const auto refraction = Refract(w, n, eta);
    const float ratio = Dot(w, n) > 0 ? eta : 1 / eta;
    const float sinI = Length(Cross(w, n));
    if (!refraction) {
      EXPECT_GE(sinI, ratio * (1 - 1e-5f));
      continue;
    }
    EXPECT_NEAR(refraction->eta, ratio, 1e-6f);
    EXPECT_LE(Dot(refraction->w, n) * Dot(w, n), 0);
    EXPECT_NEAR(Length(refraction->w), 1, 1e-6f);
    EXPECT_LT(Length(Cross(w, n) + Cross(refraction->w, n) * ratio), 3e-6f);
    // Light may be turned around.
    const auto back = Refract(refraction->w, n, eta);
    if (back) {
      EXPECT_LT(Distance(back->w, w), 1e-4f / (std::abs(Dot(w, n)) + 0.05f));
    }
  }
}

TEST(FresnelDiffuse, MatchesTheClosedForm) {
  // Egan and Hilgeman 1973, for eta > 1.
  for (const double n : {1.1, 1.33, 1.5, 2.0}) {
    const double n2 = n * n, n4 = n2 * n2;
    const double expected = 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
                            n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
                            2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
                            8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
    EXPECT_NEAR(FresnelDiffuseReflectance(static_cast<float>(n)), expected, 2e-5) << n;
  }
  // Reciprocity: what enters from outside and leaves from inside fill the same cone.
  EXPECT_NEAR((1 - FresnelDiffuseReflectance(1 / 1.5f)) * 1.5f * 1.5f, 1 - FresnelDiffuseReflectance(1.5f), 2e-4);
}

}  // namespace
}  // namespace dapple
