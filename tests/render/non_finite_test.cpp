// NaNs and infinities that a light, a material or an integrator gives: none reaches the film, each is counted for what
// gave it, and all else is rendered.
#include "integrators/non_finite.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "integrators/pixel_loop.h"
#include "lights/point_light.h"
#include "src/io/build_scene.h"
#include "src/io/pbrt_parser.h"
#include "src/materials/diffuse_materials.h"
#include "src/materials/material_parts.h"
#include "src/render/driver.h"
#include "src/render/statistics.h"

namespace dapple {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();

/// A point light that is no number every now and then, toward points and into the scene.
class SickPoint final : public Light {
 public:
  explicit SickPoint(float bad) : bad_(bad) {}
  std::string_view Name() const override { return "sick point"; }
  bool IsDelta() const override { return true; }
  Color Power() const override { return point_.Power(); }
  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const override {
    std::optional<LiSample> sample = point_.Sample_Li(at, u);
    if (sample && at.p.x > 0) sample->L = Color(1, bad_, 1);
    return sample;
  }
  double Pdf_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return 0; }
  LiRandom Invert_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return {}; }
  std::optional<LeSample> Sample_Le(const LeRandom& u) const override {
    std::optional<LeSample> sample = point_.Sample_Le(u);
    if (sample && sample->ray.d.x > 0) sample->Le = Color(bad_);
    return sample;
  }
  LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const override { return point_.Pdf_Le(ray, from); }
  LeRandom Invert_Le(const Ray& ray, const LightPoint& from) const override { return point_.Invert_Le(ray, from); }

 private:
  PointLight point_{Vec3(0, 1, -3), Color(10)};
  float bad_;
};

/// A sky that rays find, and that is no number in one half.
class SickSky final : public Light {
 public:
  std::string_view Name() const override { return "sick sky"; }
  bool IsInfinite() const override { return true; }
  Color Power() const override { return Color(1); }
  std::optional<LiSample> Sample_Li(const LightContext&, const LiRandom&) const override { return std::nullopt; }
  double Pdf_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return 0; }
  LiRandom Invert_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return {}; }
  std::optional<LeSample> Sample_Le(const LeRandom&) const override { return std::nullopt; }
  LePdf Pdf_Le(const Ray&, const LightPoint&) const override { return {1, 1}; }
  LeRandom Invert_Le(const Ray&, const LightPoint&) const override { return {}; }
  Color Le(const Ray& ray) const override { return ray.d.x > 0 ? Color(kNan, 1, 1) : Color(1); }
};

/// Reflects no number where x > 0.
class SickMaterial final : public Material {
 public:
  Bsdf GetBsdf(const SurfaceInteraction& hit) const override {
    Bsdf bsdf = BlackBsdf(hit, nullptr);
    bsdf.Add(LambertianReflection{hit.p.x > 0 ? Color(0.5f, kNan, 0.5f) : Color(0.5f)});
    return bsdf;
  }
  MaterialFacts Facts() const override {
    MaterialFacts facts = NoFacts();
    AddFact(LobeFlags::kDiffuseReflection, 1, &facts);
    return facts;
  }
};

/// A wall before the camera, a point light between, and a glass ball that makes photons worth while.
SceneParts WallParts() {
  Diagnostics diagnostics([](const std::string& line) { ADD_FAILURE() << line; });
  const std::string text =
      "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nPixelFilter \"box\"\n"
      "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\n"
      "LightSource \"point\" \"rgb I\" [10 10 10] \"point3 from\" [0 1 -3]\n"
      "MakeNamedMaterial \"wall\" \"string type\" \"diffuse\"\nNamedMaterial \"wall\"\n"
      "Shape \"bilinearmesh\" \"point3 P\" [-1.5 -1.5 0  1.5 -1.5 0  -1.5 1.5 0  1.5 1.5 0]\n"
      "Material \"dielectric\"\nTranslate -1 0.5 -1.5\nShape \"sphere\" \"float radius\" 0.3\n";
  return BuildSceneParts(ParsePbrtString(text, "wall.pbrt", "", {4}, diagnostics), {}, diagnostics);
}

struct Rendered {
  Film film;
  RenderResult result;
};

Rendered RenderTwice(const Scene& scene, Integrator& integrator) {
  const RenderSettings& settings = scene.Settings();
  Rendered rendered{Film(settings.resolution, settings.crop, settings.filter), {}};
  RenderBudget budget;
  budget.passes = 2;
  rendered.result = Render(scene, 1, integrator, rendered.film, budget);
  return rendered;
}

/// Each value of the picture is finite, some light is left, and all that was left out came from `source`.
void ExpectOnly(const Scene& scene, const Rendered& rendered, const NonFiniteSource& source, const std::string& name) {
  const Image image = rendered.film.ToImage();
  for (const float value : image.Values()) ASSERT_TRUE(std::isfinite(value));
  EXPECT_GT(*std::ranges::max_element(image.Values()), 0);
  const NonFiniteCounts& counts = rendered.result.stats.nonFinite;
  EXPECT_GT(counts.Total(), 0);
  EXPECT_EQ(rendered.film.NonFiniteCount(), counts.Total());
  for (const auto& [found, count] : counts.BySource()) {
    EXPECT_EQ(found, source) << NameOf(found, scene);
    EXPECT_EQ(NameOf(found, scene), name);
  }
  const auto json = nlohmann::json::parse(StatisticsToJson({}, rendered.result, {}, rendered.film, {}));
  EXPECT_EQ(json["nonFinite"], counts.Total());
  EXPECT_EQ(json["nonFiniteSources"], (nlohmann::json{{name, counts.Total()}}));
  EXPECT_EQ(DescribeNonFinite(rendered.film), std::to_string(counts.Total()) + " of " + name);
}

class NonFinite : public testing::TestWithParam<std::string_view> {
 protected:
  Rendered Render(const Scene& scene) const {
    IntegratorOptions options;
    options.photonsPerPass = 2000;
    options.radius = 0.1;
    const std::unique_ptr<Integrator> integrator = MakeIntegrator(GetParam(), options);
    return RenderTwice(scene, *integrator);
  }
};

INSTANTIATE_TEST_SUITE_P(All, NonFinite, testing::ValuesIn(IntegratorNames()),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(NonFinite, NothingIsLeftOutOfAHealthyScene) {
  const Scene scene(WallParts());
  const Rendered rendered = Render(scene);
  EXPECT_EQ(rendered.film.NonFiniteCount(), 0);
  EXPECT_TRUE(rendered.result.stats.nonFinite.BySource().empty());
}

TEST_P(NonFinite, OfALight) {
  for (const float bad : {kNan, kInfinity}) {
    SceneParts parts = WallParts();
    parts.lights[0] = std::make_unique<SickPoint>(bad);
    const Scene scene(std::move(parts));
    ExpectOnly(scene, Render(scene), NonFiniteSource::Light(0), "light 0 (sick point)");
  }
}

TEST_P(NonFinite, OfALightThatRaysFind) {
  SceneParts parts = WallParts();
  parts.lights.push_back(std::make_unique<SickSky>());
  const Scene scene(std::move(parts));
  ExpectOnly(scene, Render(scene), NonFiniteSource::Light(1), "light 1 (sick sky)");
}

TEST_P(NonFinite, OfAMaterial) {
  SceneParts parts = WallParts();
  parts.materials[0] = std::make_unique<SickMaterial>();
  const Scene scene(std::move(parts));
  ExpectOnly(scene, Render(scene), NonFiniteSource::Material(0), "material \"wall\" (wall.pbrt:7:1)");
}

/// Divides zero by zero in every other pixel.
class SickIntegrator final : public Integrator {
 public:
  std::string_view Name() const override { return "sick"; }
  void Prepare(const Scene& scene, uint64_t) override { scene_ = &scene; }
  PassStats RenderPass(int pass, Film& film) const override {
    int64_t calls = 0;
    const PassStats stats = RenderPixels(
        *scene_, 1, pass, SampleAllocation(1),
        [&](const CameraRay&, Sampler&, PassStats&) {
          return std::atomic_ref(calls).fetch_add(1) % 2 == 0 ? Color(kNan) : Color(1);
        },
        film);
    film.FinishPass(pass);
    return stats;
  }
  int DefaultPasses() const override { return 1; }

 private:
  const Scene* scene_ = nullptr;
};

TEST(SickIntegrator, IsNamedItself) {
  const Scene scene(WallParts());
  SickIntegrator integrator;
  const Rendered rendered = RenderTwice(scene, integrator);
  ExpectOnly(scene, rendered, NonFiniteSource::Integrator(), "the integrator");
  EXPECT_EQ(rendered.film.NonFiniteCount(), 2 * 16 * 16 / 2);
}

}  // namespace
}  // namespace dapple
