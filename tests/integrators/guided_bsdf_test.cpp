// Final gathers draw directions as dense as they say, keep what the BSDF scatters, and look where photons come from.
#include "integrators/guided_bsdf.h"

#include <gtest/gtest.h>

#include "src/sampling/warps.h"
#include "tests/materials/bsdf_cases.h"
#include "tests/support/chi_square.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

using testing::UniformNumbers;

std::unique_ptr<Scene> SceneOfALamp() {
  return testing_support::SceneFromText(
      "Camera \"perspective\" Film \"image\" WorldBegin LightSource \"point\" Shape \"sphere\" WorldEnd");
}

/// Light from a few sides, and none from most.
DirectionTable UnevenTable() {
  std::array<double, DirectionTable::kCells> flux{};
  flux[3] = 5;
  flux[9] = 1;
  flux[10] = 2;
  flux[22] = 0.5;
  flux[31] = 3;
  return {flux, 0.1};
}

/// A hit seen from above at a slant.
SurfaceInteraction HitOf(float tilt) {
  SurfaceInteraction hit = testing::TiltedHit(tilt);
  hit.wo = Normalize(Vec3(0.5f, 0.2f, 0.7f));
  return hit;
}

TEST(DirectionTable, DirectionsFollowTheirDensity) {
  const DirectionTable table = UnevenTable();
  const testing::ChiSquareOptions options{.samples = 100'000, .rows = 10, .columns = 24, .seed = 31};
  const auto fit = testing::ChiSquareOnCone(
      [&](UniformNumbers& random) { return std::optional(ToDouble(table.Sample(random.Get2D()))); },
      [&](const Vec3d& w) { return static_cast<double>(table.Pdf(ToFloat(w))); }, testing::ConeDomain(1), options);
  EXPECT_TRUE(fit.Passes()) << fit.message;
  EXPECT_NEAR(fit.total, 1, 2e-3);
}

TEST(DirectionTable, EvenLightNeedsNoTable) {
  std::array<double, DirectionTable::kCells> even{};
  even.fill(1);
  // Two photons a cell.
  EXPECT_EQ(DirectionTable(even, 2 * DirectionTable::kCells * Sqr(0.5)).Share(), 0);
  EXPECT_GT(UnevenTable().Share(), 0.3f);
  EXPECT_LE(UnevenTable().Share(), 0.5f);
}

// Of photons from all sides alike the few bright ones must not look like a light; told by their number alone they do.
TEST(DirectionTable, TakesUnevenFluxForNoise) {
  UniformNumbers random(17);
  double share = 0, byNumber = 0;
  constexpr int kTables = 400, kPhotons = 64;
  for (int i = 0; i < kTables; ++i) {
    std::array<double, DirectionTable::kCells> flux{};
    double sum = 0, squares = 0;
    for (int photon = 0; photon < kPhotons; ++photon) {
      const double f = std::exp(3 * random.Get1D());
      flux[static_cast<size_t>(random.Get1D() * DirectionTable::kCells)] += f;
      sum += f;
      squares += Sqr(f);
    }
    share += static_cast<double>(DirectionTable(flux, squares).Share()) / kTables;
    byNumber += static_cast<double>(DirectionTable(flux, Sqr(sum) / kPhotons).Share()) / kTables;
  }
  EXPECT_LT(share, 0.06);
  EXPECT_GT(byNumber, 0.1);
}

// Triangles of one wall, and a sphere at its equator, have normals that differ by their rounding.
TEST(GatherGuides, FramesDoNotTurnWithRounding) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {1.f, -1.f}) {
      Vec3 n(0);
      n[axis] = side;
      const Frame frame = GatherGuide::FrameAround(n);
      for (int other = 0; other < 3; ++other)
        for (const float by : {-1e-7f, -0.f, 1e-7f}) {
          if (other == axis) continue;
          Vec3 near = n;
          near[other] = by;
          const Frame there = GatherGuide::FrameAround(near);
          EXPECT_LT(Distance(there.s, frame.s) + Distance(there.t, frame.t), 1e-6f) << n << " " << near;
        }
    }
}

/// BSDFs with and without specular lobes.
class GuidedBsdfs : public ::testing::TestWithParam<testing::WeightedLobes> {};

INSTANTIATE_TEST_SUITE_P(Lobes, GuidedBsdfs, ::testing::ValuesIn([] {
                           std::vector<testing::WeightedLobes> cases;
                           for (const auto& lobes : testing::NonSpecularCases())
                             for (const char* name : {"LambertianReflection", "Plastic", "RoughConductor", "Uber"})
                               if (lobes.name == name) cases.push_back(lobes);
                           return cases;
                         }()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(GuidedBsdfs, DirectionsFollowTheirDensity) {
  const auto scene = SceneOfALamp();
  const DirectionTable table = UnevenTable();
  uint64_t seed = 41;
  for (const float tilt : {0.f, 0.4f}) {
    const SurfaceInteraction hit = HitOf(tilt);
    const Bsdf bsdf = testing::MakeBsdf(GetParam(), tilt);
    const GuidedBsdf guided(hit, bsdf, &table);
    PassStats stats;
    const auto sample = [&](double uc, const Vec2d& u) -> std::optional<Vec3> {
      const auto next = guided.Sample(*scene, uc, u, stats);
      return next && !next->IsSpecular() ? std::optional(next->wi) : std::nullopt;
    };
    const auto pdf = [&](const Vec3& wi) -> double {
      // Directions that scatter nothing are not returned.
      return bsdf.Eval(hit.wo, wi, TransportMode::Radiance).IsBlack() ? 0 : static_cast<double>(guided.Pdf(wi));
    };
    const auto fit =
        testing::ChiSquareOnSphere(sample, pdf, {.samples = 50'000, .rows = 16, .columns = 24, .seed = seed++});
    EXPECT_TRUE(fit.Passes()) << fit.message << ", tilt " << tilt;
  }
}

struct Mean {
  double value, error;  ///< one standard deviation
};

// The mean weight, specular lobes' share included, is that of the BSDF alone, whatever the table says.
TEST_P(GuidedBsdfs, KeepWhatTheBsdfScatters) {
  const auto scene = SceneOfALamp();
  const SurfaceInteraction hit = HitOf(0);
  const Bsdf bsdf = testing::MakeBsdf(GetParam(), 0);
  const auto meanWeight = [&](const DirectionTable* table, uint64_t seed) -> Mean {
    constexpr int kSamples = 1 << 17;
    const GuidedBsdf guided(hit, bsdf, table);
    UniformNumbers random(seed);
    PassStats stats;
    double sum = 0, squares = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double uLobe = random.Get1D();
      const auto next = guided.Sample(*scene, uLobe, random.Get2D(), stats);
      const double weight = next ? static_cast<double>(next->weight.Average()) : 0;
      sum += weight;
      squares += weight * weight;
    }
    const double mean = sum / kSamples;
    return {mean, std::sqrt(std::max(0.0, squares / kSamples - mean * mean) / kSamples)};
  };
  const DirectionTable table = UnevenTable();
  const Mean guided = meanWeight(&table, 7), plain = meanWeight(nullptr, 8);
  EXPECT_LT(guided.error, 0.005 * guided.value);
  EXPECT_NEAR(guided.value, plain.value, 5 * std::hypot(guided.error, plain.error));
}

GatherGuide GuideOfScene(const Scene& scene) { return {scene, EmissionSampler(scene), 32, 1}; }

// A spot light makes a bright patch on the ceiling, and little else is lit: on the floor light comes from there.
TEST(GatherGuides, LookWhereLightComesFrom) {
  const auto scene = testing_support::SceneFromText(
      "LookAt 0 -4 1  0 0 1  0 0 1 Camera \"perspective\" \"float fov\" [60] "
      "Film \"image\" \"integer xresolution\" [64] \"integer yresolution\" [64] WorldBegin "
      "LightSource \"spot\" \"point from\" [1.5 0 1] \"point to\" [1.5 0 2] \"float coneangle\" [15] "
      "Material \"matte\" \"rgb Kd\" [.5 .5 .5] "
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3  4 5 6 4 6 7] "
      "\"point P\" [-2 -2 0 2 -2 0 2 2 0 -2 2 0  -2 -2 2 2 -2 2 2 2 2 -2 2 2] WorldEnd");
  const GatherGuide guide = GuideOfScene(*scene);
  const auto toRender = scene->RenderToWorld().Inverse();
  const Vec3 p = toRender.Point(Vec3(-0.5f, 0.3f, 0)), patch = toRender.Point(Vec3(1.5f, 0, 2));
  const Vec3 n(0, 0, 1);
  const DirectionTable* table = guide.At(p, n);
  ASSERT_TRUE(table);
  EXPECT_GT(table->Share(), 0.3f);
  const Vec3 toPatch = GatherGuide::FrameAround(n).ToLocal(Normalize(patch - p));
  EXPECT_GT(table->Pdf(toPatch), 5 * CosineHemispherePdf(static_cast<double>(toPatch.z)));
  // From below nothing is known of it, nor of what lies where no photon came.
  EXPECT_FALSE(guide.At(p, -n));
  EXPECT_FALSE(guide.At(p + Vec3(0, 0, 100), n));
  EXPECT_FALSE(GatherGuide().At(p, n));
}

// Inside a sphere that glows evenly light comes from all sides alike.
TEST(GatherGuides, LeaveEvenLightToTheBsdf) {
  const auto scene = testing_support::SceneFromText(
      "LookAt 0 0 0  0 0 -1  0 1 0 Camera \"perspective\" \"float fov\" [40] "
      "Film \"image\" \"integer xresolution\" [40] \"integer yresolution\" [40] WorldBegin "
      "ReverseOrientation Material \"matte\" \"rgb Kd\" [.5 .5 .5] "
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Shape \"sphere\" \"float radius\" [1] WorldEnd");
  const GatherGuide guide = GuideOfScene(*scene);
  constexpr int kSide = 16;
  double share = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const Vec3 p = ToFloat(SampleSphere({(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide}));
    const DirectionTable* table = guide.At(p, -p);
    ASSERT_TRUE(table);
    share += static_cast<double>(table->Share()) / (kSide * kSide);
  }
  EXPECT_LT(share, 0.05);
}

}  // namespace
}  // namespace dapple
