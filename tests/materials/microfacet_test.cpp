// What every distribution of microfacet normals must keep, whatever its shape and its masking.
#include "src/materials/microfacet.h"

#include <gtest/gtest.h>

#include "src/materials/microfacet_kind.h"
#include "tests/support/chi_square.h"

namespace dapple {
namespace {

using testing::IntegrateSphere;

struct GgxKind {
  static constexpr const char* kName = "Ggx";
  using Distribution = Ggx;
  static Ggx Make(float alphaX, float alphaY) { return {alphaX, alphaY}; }
};

struct BeckmannKind {
  static constexpr const char* kName = "Beckmann";
  using Distribution = Beckmann;
  static Beckmann Make(float alphaX, float alphaY) { return {alphaX, alphaY}; }
};

struct BlinnKind {
  static constexpr const char* kName = "Blinn";
  using Distribution = CosinePower;
  static CosinePower Make(float alphaX, float alphaY) {
    const float exponent = CosinePower::ExponentOfAlpha(std::sqrt(alphaX * alphaY));
    return {exponent, exponent};
  }
};

struct AshikhminShirleyKind {
  static constexpr const char* kName = "AshikhminShirley";
  using Distribution = CosinePower;
  static CosinePower Make(float alphaX, float alphaY) {
    return {CosinePower::ExponentOfAlpha(alphaX), CosinePower::ExponentOfAlpha(alphaY)};
  }
};

struct Name {
  template <typename Kind>
  static std::string GetName(int) {
    return Kind::kName;
  }
};

template <typename Kind>
class Microfacets : public ::testing::Test {};
using Kinds = ::testing::Types<GgxKind, BeckmannKind, BlinnKind, AshikhminShirleyKind>;
TYPED_TEST_SUITE(Microfacets, Kinds, Name);

struct Case {
  float alphaX, alphaY;
  float cosTheta, phi;

  Vec3 W() const {
    const float s = std::sqrt(1 - cosTheta * cosTheta);
    return {s * std::cos(phi), s * std::sin(phi), cosTheta};
  }
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << " alpha " << c.alphaX << " " << c.alphaY << " cos " << c.cosTheta << " phi " << c.phi;
}

/// Grids of directions with the pole along x, away from the facets around z.
const Frame kGrid(Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 0, 0));

const Case kCases[] = {
    {0.3f, 0.3f, 0.9f, 0},  {0.3f, 0.3f, 0.05f, 1}, {1, 1, 0.5f, 2},    {0.2f, 0.6f, 0.7f, 0.5f},
    {0.6f, 0.15f, 0.2f, 4}, {0.1f, 0.1f, 0.01f, 3}, {1, 0.4f, 0.1f, 5},
};

/// With the pole along w: the half vectors of its reflections lie on the same meridians as these.
Frame GridAround(const Vec3& w) { return Frame::FromZX(w, Vec3(0, 0, 1)); }

/// The integral of f over normals with z > 0, by midpoints in theta and phi: no kink or peak between them is missed.
template <typename F>
double IntegrateNormals(const F& f) {
  constexpr int kRows = 400, kColumns = 400;
  double sum = 0;
  for (int i = 0; i < kRows; ++i) {
    const double theta = (i + 0.5) * kPiD / 2 / kRows, s = std::sin(theta);
    for (int j = 0; j < kColumns; ++j) {
      const double phi = (j + 0.5) * 2 * kPiD / kColumns;
      sum += static_cast<double>(f(ToFloat(Vec3d(s * std::cos(phi), s * std::sin(phi), std::cos(theta))))) * s;
    }
  }
  return sum * (kPiD / 2 / kRows) * (2 * kPiD / kColumns);
}

TYPED_TEST(Microfacets, ProjectedAreaOfFacetsIsOne) {
  for (const Case& c : kCases) {
    const auto facets = TypeParam::Make(c.alphaX, c.alphaY);
    EXPECT_NEAR(IntegrateSphere([&](const Vec3& m) { return m.z > 0 ? facets.D(m) * m.z : 0; }, kGrid), 1, 1e-4) << c;
  }
}

TYPED_TEST(Microfacets, MaskingKeepsTheProjectedAreaOfVisibleFacets) {
  // The integral of G1(w) max(0, w.m) D(m) over normals is cos theta (Heitz 2014, equation 16).
  for (const Case& c : kCases) {
    const auto facets = TypeParam::Make(c.alphaX, c.alphaY);
    const Vec3 w = c.W();
    const double visible = IntegrateNormals(
        [&](const Vec3& m) { return Dot(w, m) > 0 ? facets.G1(w, m) * Dot(w, m) * facets.D(m) / w.z : 0; });
    EXPECT_NEAR(visible, 1, 5e-4) << c;
  }
}

TYPED_TEST(Microfacets, WeakWhiteFurnace) {
  // Masked but not shadowed, a mirror reflects everything, below the horizon too (Heitz 2014, section 5.4): the
  // integral of G1(w) D(m) / (4 |cos w|) over reflected directions is one. To 5e-4, which is the quadrature's.
  for (const Case& c : kCases) {
    const auto facets = TypeParam::Make(c.alphaX, c.alphaY);
    const Vec3 w = c.W();
    const double furnace = IntegrateSphere(
        [&](const Vec3& wi) {
          const Vec3 h = w + wi;
          if (!(h.z > 0)) return 0.f;
          const Vec3 m = Normalize(h);
          return facets.D(m) * facets.G1(w, m) / (4 * w.z);
        },
        GridAround(w));
    EXPECT_NEAR(furnace, 1, 5e-4) << c;
  }
}

TYPED_TEST(Microfacets, VisibleNormalsFollowTheirDensity) {
  uint64_t seed = 1;
  for (const Case& c : kCases) {
    for (const float side : {1.f, -1.f}) {
      const auto facets = TypeParam::Make(c.alphaX, c.alphaY);
      const Vec3 w = c.W() * side;
      const auto fit = testing::ChiSquareOnSphere(
          [&](double uc, const Vec2d& u) { return facets.SampleVisible(w, u, &uc); },
          [&](const Vec3& m) { return m.z * w.z > 0 && Dot(m, w) > 0 ? facets.VisiblePdf(w, m) : 0; },
          {.samples = 100'000, .seed = seed++, .frame = kGrid});
      EXPECT_TRUE(fit.Passes()) << fit.message << c << " side " << side;
      EXPECT_NEAR(fit.total, 1, 5e-4) << c;
    }
  }
}

TYPED_TEST(Microfacets, SamplingLeavesAUniformNumber) {
  // `uc` goes on to choose between reflection and refraction.
  for (const Case& c : kCases) {
    const auto facets = TypeParam::Make(c.alphaX, c.alphaY);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto fit = testing::ChiSquareOnInterval(
        [&](double uc) -> std::optional<double> {
          const double u0 = uniform(random);
          facets.SampleVisible(c.W(), {u0, uniform(random)}, &uc);
          return uc;
        },
        [](double) { return 1.0; }, 0, 1, {.samples = 20'000, .rows = 10, .columns = 10});
    EXPECT_TRUE(fit.Passes()) << fit.message << c;
  }
}

TYPED_TEST(Microfacets, InverseGivesTheNumbersOfANormal) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Case& c : kCases) {
    const auto facets = TypeParam::Make(c.alphaX, c.alphaY);
    for (int i = 0; i < 400; ++i) {
      const Vec3 w = c.W() * (i % 2 ? 1.f : -1.f);
      double uc = uniform(random);
      const double u0 = uniform(random);
      const Vec3 wm = facets.SampleVisible(w, {u0, uniform(random)}, &uc);
      FacetNumbers numbers = facets.InvertVisible(w, wm);
      EXPECT_TRUE(numbers.u.x >= 0 && numbers.u.x <= 1 && numbers.u.y >= 0 && numbers.u.y <= 1) << c;
      EXPECT_TRUE(numbers.uc >= 0 && numbers.uc < 1) << c;
      EXPECT_LT(Distance(facets.SampleVisible(w, numbers.u, &numbers.uc), wm), 1e-3f) << c << " u " << u0;
    }
  }
}

TYPED_TEST(Microfacets, MaskingIsSymmetricAndNoLargerThanEitherSide) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  const Vec3 normal(0, 0, 1);
  for (const Case& c : kCases) {
    const auto facets = TypeParam::Make(c.alphaX, c.alphaY);
    for (int i = 0; i < 200; ++i) {
      const Vec3 w = c.W();
      double uc = uniform(random);
      const double u0 = uniform(random);
      const Vec3 wm = facets.SampleVisible(w, {u0, uniform(random)}, &uc);
      const Vec3 reflected = wm * (2 * Dot(w, wm)) - w;
      for (const Vec3& wi : {reflected, -reflected}) {
        if (wi.z == 0) continue;
        const float g = facets.G(w, wi, wm);
        EXPECT_NEAR(g, facets.G(wi, w, wm), 1e-4f * g) << c;
        EXPECT_LE(g, 1.0001f * std::min(facets.G1(w, wm), facets.G1(wi, wm))) << c;
        EXPECT_NEAR(facets.GOverCosines(w, wi, wm) * 2 * AbsCosTheta(w) * AbsCosTheta(wi), g, 1e-4f * g + 1e-6f) << c;
      }
      EXPECT_NEAR(facets.VisiblePdfOverD(w, wm) * w.z, facets.G1(w, wm), 1e-5f) << c;
    }
    EXPECT_NEAR(facets.G1(normal, normal), 1, 1e-6f);
  }
}

TYPED_TEST(Microfacets, FiniteAtGrazingAnglesAndTinyAlpha) {
  for (const float alpha : {1e-4f, 1e-3f, 1.f}) {
    const auto facets = TypeParam::Make(alpha, alpha);
    for (const float z : {1e-30f, 1e-7f, 1e-3f, 1.f}) {
      const Vec3 w = z == 1 ? Vec3(0, 0, 1) : Normalize(Vec3(1, 0, z));
      for (const double u : {0.0, 0.25, 0.5, 0.75, 0x1.fffffffffffffp-1}) {
        double uc = u;
        const Vec3 m = facets.SampleVisible(w, {u, 1 - u}, &uc);
        EXPECT_NEAR(Length(m), 1, 1e-5f);
        EXPECT_TRUE(std::isfinite(facets.D(m)) && uc >= 0 && uc < 1);
        EXPECT_TRUE(std::isfinite(facets.G1(w, m)) && std::isfinite(facets.VisiblePdf(w, m))) << alpha << " " << z;
        EXPECT_TRUE(std::isfinite(facets.GOverCosines(w, w, m)) && std::isfinite(facets.GOverCosines(w, -w, m)));
      }
    }
  }
}

TYPED_TEST(Microfacets, TinyAlphasKeepTheirWidth) {
  // The mean of tan^2 over visible normals from above: floats must not round narrow highlights away. Under D cos it is
  // alpha^2 for Gaussian slopes and, where alpha is small, cosine powers; GGX has no second moment, but its median of
  // tan^2 is alpha^2.
  const float alpha = 1e-3f;
  const auto facets = TypeParam::Make(alpha, alpha);
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> uniform(0, 1);
  constexpr int kSamples = 20'000;
  double sum = 0;
  int below = 0;
  for (int i = 0; i < kSamples; ++i) {
    double uc = uniform(random);
    const double u0 = uniform(random);
    const Vec3d m = ToDouble(facets.SampleVisible({0, 0, 1}, {u0, uniform(random)}, &uc));
    const double tan2 = (m.x * m.x + m.y * m.y) / (m.z * m.z);
    sum += tan2;
    below += tan2 < Sqr(static_cast<double>(alpha));
  }
  // tan^2 is exponentially distributed: both within five standard errors.
  const bool isGgx = std::is_same_v<typename TypeParam::Distribution, Ggx>;
  if (!isGgx) {
    EXPECT_NEAR(sum / kSamples / 1e-6, 1, 5 / std::sqrt(kSamples));
  }
  EXPECT_NEAR(below / static_cast<double>(kSamples), isGgx ? 0.5 : 1 - std::exp(-1.0), 2.5 / std::sqrt(kSamples));
}

TEST(Ggx, MaskingAgreesWithSmithsFunction) {
  for (const Case& c : kCases) {
    const Ggx ggx(c.alphaX, c.alphaY);
    const Vec3 w = c.W(), v = Normalize(Vec3(0.3f, -0.2f, 0.5f));
    EXPECT_NEAR(ggx.G1(w), 1 / (1 + ggx.Lambda(w)), 1e-6);
    EXPECT_NEAR(ggx.G(w, v), 1 / (1 + ggx.Lambda(w) + ggx.Lambda(v)), 1e-6);
  }
}

TEST(Beckmann, LambdaIsTheIntegralOverSlopes) {
  // tan(theta) times the mean of max(0, s - cot(theta)) over the slopes s along w (Smith 1967; Heitz 2014,
  // section 5.3).
  for (const Case& c : kCases) {
    const Beckmann beckmann(c.alphaX, c.alphaY);
    const Vec3 w = c.W();
    const double across = std::hypot(static_cast<double>(c.alphaX * w.x), static_cast<double>(c.alphaY * w.y));
    const double cot = static_cast<double>(w.z) / across;  // in units of alpha
    double sum = 0;
    constexpr int kSteps = 20'000;
    constexpr double kRange = 8;
    for (int i = 0; i < kSteps; ++i) {
      const double above = (i + 0.5) * kRange / kSteps;
      sum += above * std::exp(-Sqr(cot + above)) / std::sqrt(kPiD) * kRange / kSteps;
    }
    EXPECT_NEAR(beckmann.Lambda(w), sum / cot, 1e-5 * (1 + sum / cot)) << c;
  }
}

TEST(CosinePower, BlinnIsAshikhminAndShirleyIsotropic) {
  // sqrt((ex + 2) (ey + 2)) / (2 pi) becomes Blinn's (e + 2) / (2 pi) cos^e.
  const CosinePower blinn(30, 30), anisotropic(30, 5);
  for (const float z : {1.f, 0.99f, 0.8f, 0.3f}) {
    const float s = std::sqrt(1 - z * z);
    EXPECT_NEAR(blinn.D({s, 0, z}) / (16 / kPi * std::pow(z, 30.f)), 1, 1e-4f);
    EXPECT_NEAR(blinn.D({0.6f * s, 0.8f * s, z}) / blinn.D({s, 0, z}), 1, 1e-4f);
    EXPECT_NEAR(anisotropic.D({s, 0, z}) / (std::sqrt(32.f * 7) / (2 * kPi) * std::pow(z, 30.f)), 1, 1e-4f);
    EXPECT_NEAR(anisotropic.D({0, s, z}) / (std::sqrt(32.f * 7) / (2 * kPi) * std::pow(z, 5.f)), 1, 1e-4f);
  }
}

TEST(CosinePower, ExponentsBelongToAlphas) {
  EXPECT_EQ(CosinePower::ExponentOfAlpha(1), 0);
  EXPECT_EQ(CosinePower::ExponentOfAlpha(1.5f), 0);
  EXPECT_NEAR(CosinePower::ExponentOfAlpha(0.1f), 198, 1e-3f);
  EXPECT_NEAR(CosinePower(198, 30).MinAlpha(), 0.1f, 1e-6f);
}

TEST(RoughnessToAlpha, MatchesPbrt) {
  EXPECT_NEAR(RoughnessToAlphaV3(1), 1.62142f, 1e-6f);
  // The polynomial at x = ln(0.1), computed by hand.
  const double x = std::log(0.1);
  EXPECT_NEAR(RoughnessToAlphaV3(0.1f),
              1.62142 + 0.819955 * x + 0.1734 * x * x + 0.0171201 * x * x * x + 0.000640711 * x * x * x * x, 1e-5);
  EXPECT_NEAR(RoughnessToAlphaV3(0), RoughnessToAlphaV3(1e-3f), 1e-6f);
  EXPECT_EQ(RoughnessToAlphaV4(0.25f), 0.5f);
  EXPECT_TRUE(Ggx::EffectivelySmooth(9e-4f, 1e-4f));
  EXPECT_FALSE(Ggx::EffectivelySmooth(9e-4f, 1e-3f));
}

}  // namespace
}  // namespace dapple
