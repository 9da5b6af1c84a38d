// All algorithms give the same picture: every scene in scenes/, block by block, within 1 % and three standard errors.
//
// Density estimation is blurred by its radius; its picture is extrapolated to radius zero from two radii. What an
// algorithm cannot see is left out: light tracing where the camera looks at a smooth mirror or glass, path tracing
// where a light without extent shines through them; there, photon algorithms are compared with each other.
#include <algorithm>
#include <filesystem>
#include <iostream>

#include <gtest/gtest.h>

#include "src/io/build_scene.h"
#include "src/io/pbrt_parser.h"
#include "tests/support/grouped_render.h"

namespace dapple {
namespace {

using namespace testing_support;

constexpr int kGroups = 8;
constexpr int kBlockSize = 32;
constexpr double kTolerance = 0.01;
/// Of algorithms with photons; the others' are cheaper. Errors of 0.1 to 0.7 % a block, in the median.
constexpr int kPasses = 32, kPathPasses = 384, kLightTracingPasses = 128;

std::filesystem::path SceneFolder() { return std::filesystem::path(DAPPLE_SOURCE_DIR) / "scenes"; }

std::vector<std::string> SceneNames() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(SceneFolder()))
    if (entry.path().extension() == ".pbrt") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

SceneParts PartsOf(const std::string& name) {
  Diagnostics diagnostics([](const std::string& line) { ADD_FAILURE() << line; });
  return BuildSceneParts(ParsePbrtFile(SceneFolder() / (name + ".pbrt"), {}, diagnostics), {}, diagnostics);
}

IntegratorOptions Options(double radiusScale = 1) {
  IntegratorOptions options;
  options.photonsPerPass = 100000;
  options.radiusScale = radiusScale;
  return options;
}

// The blur at the borders of surfaces grows with the radius: what is left at radius zero, from 1.2 and 0.6 times that
// which the algorithm chooses.
GroupedImages AtRadiusZero(const Scene& scene, const std::string& integrator, int passes) {
  return RenderGroupsAtRadiusZero(scene, integrator, Options(1.2), passes, kGroups, 3);
}

/// Where a small caustic is most of the light on other surfaces, a final gather finds much of it by chance: with fewer
/// passes the error of the darkest blocks is told too small, for most groups have none of a few rare finds.
int PassesOf(const std::string& scene, const std::string& integrator) {
  return scene == "caustic-glass" && integrator == "photon_mapping" ? 4 * kPasses : kPasses;
}

bool PathSeesAll(const SceneFacts& facts) { return !(facts.hasDeltaLight && facts.hasSpecular); }

class AllIntegratorsAgree : public ::testing::TestWithParam<std::string> {};

TEST_P(AllIntegratorsAgree, BlockByBlock) {
  const Scene scene(PartsOf(GetParam()));
  const auto expectAgreement = [](const std::string& what, const BlockReport& report) {
    std::cout << what << ": " << report.text << "\n";
    EXPECT_GT(report.blocks, 0) << what;
    EXPECT_LE(report.worstExcess, 0) << what << ": " << report.text;
    EXPECT_LT(report.medianSigma, 0.01) << what << ": too noisy to say anything";
  };
  const bool pathSeesAll = PathSeesAll(scene.Facts());
  const std::vector<bool> specular = PixelsOnSpecularSurfaces(scene);
  const GroupedImages sppm = AtRadiusZero(scene, "sppm", kPasses);
  GroupedImages path;
  if (pathSeesAll) path = RenderGroups(scene, "path", Options(), kPathPasses, kGroups, 1);
  for (const std::string_view name : IntegratorNames()) {
    const std::string integrator(name);
    if (integrator == "path") continue;
    const bool isLightTracing = integrator == "light_tracing";
    const GroupedImages images =
        isLightTracing
            ? RenderGroups(scene, integrator, Options(), kLightTracingPasses, kGroups, 2)
            : (integrator == "sppm" ? sppm : AtRadiusZero(scene, integrator, PassesOf(GetParam(), integrator)));
    const std::vector<bool> leftOut = isLightTracing ? specular : std::vector<bool>();
    if (pathSeesAll) {
      expectAgreement(integrator + " against path", CompareBlocks(images, path, kBlockSize, kTolerance, leftOut));
    } else if (integrator != "sppm") {
      expectAgreement(integrator + " against sppm", CompareBlocks(images, sppm, kBlockSize, kTolerance, leftOut));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, AllIntegratorsAgree, ::testing::ValuesIn(SceneNames()), [](const auto& scene) {
  std::string name = scene.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

/// A light that sends `factor` times as much as it says of itself.
class BrighterLight final : public Light {
 public:
  BrighterLight(std::unique_ptr<Light> light, float factor) : light_(std::move(light)), factor_(factor) {}

  std::string_view Name() const override { return light_->Name(); }
  bool IsDelta() const override { return light_->IsDelta(); }
  bool IsInfinite() const override { return light_->IsInfinite(); }
  bool ComesFromOutside() const override { return light_->ComesFromOutside(); }
  void Prepare(const SceneExtent& extent) override { light_->Prepare(extent); }
  Color Power() const override { return light_->Power(); }
  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const override {
    auto sample = light_->Sample_Li(at, u);
    if (sample) sample->L *= factor_;
    return sample;
  }
  double Pdf_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const override {
    return light_->Pdf_Li(at, wi, hit);
  }
  LiRandom Invert_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const override {
    return light_->Invert_Li(at, wi, hit);
  }
  std::optional<LeSample> Sample_Le(const LeRandom& u) const override {
    auto sample = light_->Sample_Le(u);
    if (sample) sample->Le *= factor_;
    return sample;
  }
  LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const override { return light_->Pdf_Le(ray, from); }
  LeRandom Invert_Le(const Ray& ray, const LightPoint& from) const override { return light_->Invert_Le(ray, from); }
  Color Le(const Ray& ray) const override { return light_->Le(ray) * factor_; }
  Color L(const SurfaceInteraction& hit, const Vec3& w) const override { return light_->L(hit, w) * factor_; }

 private:
  std::unique_ptr<Light> light_;
  float factor_;
};

// The check above must be able to fail: with its own passes, two percent more in one light's emission alone, or in both
// of its sides, are found in most blocks; the same renders without the fault pass.
TEST(AllIntegratorsAgree, TwoPercentMoreFromOneLightAreRejected) {
  const std::string name = "box";
  const Scene scene(PartsOf(name));
  SceneParts faulty = PartsOf(name);
  faulty.lights[0] = std::make_unique<BrighterLight>(std::move(faulty.lights[0]), 1.02f);
  const Scene faultyScene(std::move(faulty));
  const std::vector<bool> specular = PixelsOnSpecularSurfaces(scene);
  const auto compare = [&](const GroupedImages& a, const GroupedImages& b) {
    const BlockReport report = CompareBlocks(a, b, kBlockSize, kTolerance, specular);
    std::cout << report.text << "\n";
    return report;
  };
  const GroupedImages path = RenderGroups(scene, "path", Options(), kPathPasses, kGroups, 1);
  const GroupedImages light = RenderGroups(scene, "light_tracing", Options(), kLightTracingPasses, kGroups, 2);
  const GroupedImages faultyPath = RenderGroups(faultyScene, "path", Options(), kPathPasses, kGroups, 2);
  const GroupedImages faultyLight =
      RenderGroups(faultyScene, "light_tracing", Options(), kLightTracingPasses, kGroups, 2);
  EXPECT_LE(compare(light, path).worstExcess, 0);
  for (const GroupedImages* faultyImages : {&faultyPath, &faultyLight}) {
    const BlockReport report = compare(*faultyImages, path);
    EXPECT_GT(2 * report.failed, report.blocks);
  }
}

// The flux in a caustic: the sum of the pixels of a region around it, by photons and by light tracing.
class CausticFlux : public ::testing::TestWithParam<std::string> {};

TEST_P(CausticFlux, SppmAndLightTracingAgree) {
  const Scene scene(PartsOf(GetParam()));
  constexpr int kSppmPasses = 32;
  const Image sppm = RenderGroups(scene, "sppm", Options(), kSppmPasses, 1, 5).Mean();
  const Image light = RenderGroups(scene, "light_tracing", Options(), 4 * kSppmPasses, 1, 6).Mean();
  const Image region = RenderGroups(scene, "light_tracing", Options(), kSppmPasses, 1, 7).Mean();
  const std::vector<bool> specular = PixelsOnSpecularSurfaces(scene);

  // The caustic: pixels that light tracing, with another seed, finds over four times as bright as the middle one.
  std::vector<float> brightness;
  for (int y = 0; y < light.Height(); ++y)
    for (int x = 0; x < light.Width(); ++x) brightness.push_back(region.ColorAt(x, y).Luminance());
  std::vector<float> sorted = brightness;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<int64_t>(sorted.size() / 2), sorted.end());
  const float threshold = 4 * sorted[sorted.size() / 2];
  double sppmFlux = 0, lightFlux = 0;
  int pixels = 0;
  constexpr int kMargin = 4;  // what the photon map's radius spreads stays in the region
  for (int y = kMargin; y < light.Height() - kMargin; ++y)
    for (int x = kMargin; x < light.Width() - kMargin; ++x) {
      bool near = false;
      for (int dy = -kMargin; dy <= kMargin; ++dy)
        for (int dx = -kMargin; dx <= kMargin; ++dx)
          near |= brightness[static_cast<size_t>((y + dy) * light.Width() + x + dx)] > threshold;
      if (!near || specular[static_cast<size_t>(y * light.Width() + x)]) continue;
      ++pixels;
      sppmFlux += sppm.ColorAt(x, y).Average();
      lightFlux += light.ColorAt(x, y).Average();
    }
  ASSERT_GT(pixels, 100);
  std::cout << pixels << " pixels of caustic, sppm / light tracing = " << sppmFlux / lightFlux << "\n";
  EXPECT_NEAR(sppmFlux / lightFlux, 1, 0.02);
}

INSTANTIATE_TEST_SUITE_P(GlassSphere, CausticFlux, ::testing::Values("point-glass", "spot-glass"),
                         [](const auto& scene) { return scene.param.substr(0, scene.param.find('-')); });

}  // namespace
}  // namespace dapple
