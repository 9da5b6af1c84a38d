#include "src/materials/microfacet.h"

#include <gtest/gtest.h>

#include "tests/support/chi_square.h"

namespace dapple {
namespace {

using testing::IntegrateSphere;

struct Case {
  float alphaX, alphaY;
  float cosTheta, phi;

  Vec3 W() const {
    const float s = std::sqrt(1 - cosTheta * cosTheta);
    return {s * std::cos(phi), s * std::sin(phi), cosTheta};
  }
};

/// Grids of directions with the pole along x, away from the facets around z.
const Frame kGrid(Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 0, 0));

const Case kCases[] = {
    {0.3f, 0.3f, 0.9f, 0}, {0.3f, 0.3f, 0.05f, 1}, {1, 1, 0.5f, 2}, {0.2f, 0.6f, 0.7f, 0.5f}, {0.6f, 0.15f, 0.2f, 4},
};

TEST(Ggx, ProjectedAreaOfFacetsIsOne) {
  for (const Case& c : kCases) {
    const Ggx ggx(c.alphaX, c.alphaY);
    EXPECT_NEAR(IntegrateSphere([&](const Vec3& m) { return m.z > 0 ? ggx.D(m) * m.z : 0; }, kGrid), 1, 1e-4);
  }
}

TEST(Ggx, MaskingKeepsTheProjectedAreaOfVisibleFacets) {
  // The integral of G1(w) max(0, w.m) D(m) over normals is cos theta (Heitz 2014, equation 16); divided by it and taken
  // over reflected directions, this is the weak white furnace test.
  for (const Case& c : kCases) {
    const Ggx ggx(c.alphaX, c.alphaY);
    const Vec3 w = c.W();
    const double visible = IntegrateSphere(
        [&](const Vec3& m) { return m.z > 0 ? ggx.G1(w) * std::max(0.f, Dot(w, m)) * ggx.D(m) : 0; }, kGrid);
    EXPECT_NEAR(visible / w.z, 1, 2e-4) << c.alphaX << " " << c.alphaY << " " << c.cosTheta;
    const double furnace = IntegrateSphere(
        [&](const Vec3& wi) {
          const Vec3 h = w + wi;
          if (!(h.z > 0)) return 0.f;
          const Vec3 m = Normalize(h);
          return ggx.D(m) * ggx.G1(w) / (4 * w.z);
        },
        kGrid);
    EXPECT_NEAR(furnace, 1, 5e-4) << c.alphaX << " " << c.alphaY << " " << c.cosTheta;
  }
}

TEST(Ggx, VisibleNormalsFollowTheirDensity) {
  const double level = testing::SidakLevel(0.01, 2 * static_cast<int>(std::size(kCases)));
  uint64_t seed = 1;
  for (const Case& c : kCases) {
    for (const float side : {1.f, -1.f}) {
      const Ggx ggx(c.alphaX, c.alphaY);
      const Vec3 w = c.W() * side;
      const auto fit = testing::ChiSquareOnSphere(
          [&](double, const Vec2d& u) { return ggx.SampleVisible(w, u); },
          [&](const Vec3& m) { return m.z * w.z > 0 && Dot(m, w) > 0 ? ggx.VisiblePdf(w, m) : 0; },
          {.seed = seed++, .frame = kGrid});
      EXPECT_GT(fit.pValue, level) << fit.message << " alpha " << c.alphaX << " " << c.alphaY << " cos " << c.cosTheta;
      EXPECT_NEAR(fit.total, 1, 5e-4);
    }
  }
}

TEST(Ggx, MaskingAgreesWithSmithsFunction) {
  for (const Case& c : kCases) {
    const Ggx ggx(c.alphaX, c.alphaY);
    const Vec3 w = c.W(), v = Normalize(Vec3(0.3f, -0.2f, 0.5f));
    EXPECT_NEAR(ggx.G1(w), 1 / (1 + ggx.Lambda(w)), 1e-6);
    EXPECT_NEAR(ggx.G(w, v), 1 / (1 + ggx.Lambda(w) + ggx.Lambda(v)), 1e-6);
    EXPECT_EQ(ggx.G(w, v), ggx.G(v, w));
    EXPECT_LE(ggx.G(w, v), std::min(ggx.G1(w), ggx.G1(v)));
  }
}

TEST(Ggx, FiniteAtGrazingAnglesAndTinyAlpha) {
  for (const float alpha : {1e-4f, 1e-3f, 1.f}) {
    const Ggx ggx(alpha, alpha);
    for (const float z : {1e-30f, 1e-7f, 1e-3f}) {
      const Vec3 w = Normalize(Vec3(1, 0, z));
      EXPECT_TRUE(std::isfinite(ggx.G1(w)) && std::isfinite(ggx.VisiblePdfOverD(w)));
      for (const double u : {0.0, 0.25, 0.5, 0.75, 0x1.fffffffffffffp-1}) {
        const Vec3 m = ggx.SampleVisible(w, {u, 1 - u});
        EXPECT_NEAR(Length(m), 1, 1e-5f);
        EXPECT_TRUE(std::isfinite(ggx.D(m)));
      }
    }
  }
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
