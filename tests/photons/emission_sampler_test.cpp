// The one door of emission: densities, inverse and flux, with and without a guide.
#include "src/photons/emission_sampler.h"

#include <cmath>

#include <gtest/gtest.h>

#include "src/base/parallel.h"
#include "src/photons/emission_pilot.h"
#include "src/photons/light_path.h"
#include "src/sampling/sampler.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

// Four kinds of lights and a glass ball whose caustic falls on a floor that the camera sees.
constexpr const char* kScene =
    "LookAt 0 -4 3  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" [40] "
    "Film \"image\" \"integer xresolution\" [64] \"integer yresolution\" [64] WorldBegin "
    "LightSource \"point\" \"rgb I\" [5 5 5] \"point from\" [1 0 3] "
    "LightSource \"distant\" \"rgb L\" [1 2 1] \"point from\" [0 1 2] \"point to\" [0 0 0] "
    "LightSource \"infinite\" \"rgb L\" [.3 .3 .5] "
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] Translate -1 1 2 Shape \"sphere\" \"float radius\" "
    "[.2] "
    "AttributeEnd AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [3 3 3] \"bool twosided\" \"true\" "
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [1 1 1 2 1 1 2 2 1 1 2 1.5] AttributeEnd "
    "Material \"glass\" AttributeBegin Translate 0 0 .7 Shape \"sphere\" \"float radius\" [.4] AttributeEnd "
    "Material \"matte\" Shape \"disk\" \"float radius\" [5] WorldEnd";

enum class Guide { None, Gathered, Joined };

EmissionGuide Learn(Guide guide, const Scene& scene, uint64_t seed = 1) {
  switch (guide) {
    case Guide::None:
      return {};
    case Guide::Gathered:
      return LearnEmissionGuide(scene, 8, 0, seed);
    case Guide::Joined:
      return LearnJoinedEmissionGuide(scene, 8, seed);
  }
  return {};
}

class Emission : public ::testing::TestWithParam<Guide> {
 protected:
  Emission() : scene_(testing_support::SceneFromText(kScene)), emission_(*scene_, Learn(GetParam(), *scene_)) {}

  static LeRandom Random(int64_t i, int64_t count) {
    Sampler sampler = Sampler::ForLightPath(7, i, 0, count);
    LeRandom u;
    u.direction = sampler.Get2D();
    u.position = sampler.Get2D();
    u.part = sampler.Get1D();
    return u;
  }

  std::unique_ptr<Scene> scene_;
  EmissionSampler emission_;
};

TEST_P(Emission, MeanFluxIsTheScenesPower) {
  // Groups of independent seeds give the standard error; 5 of them reject a right sampler once in 2,000 (15 degrees).
  constexpr int kGroups = 16, kPhotons = 1 << 15;
  Color power;
  for (const auto& light : scene_->Lights()) power += light->Power();
  std::vector<double> means;
  for (uint64_t group = 0; group < kGroups; ++group) {
    double sum = 0;
    for (int i = 0; i < kPhotons; ++i) {
      Sampler sampler = Sampler::ForLightPath(100 + group, i, 0, kPhotons);
      const auto photon = EmitPhoton(emission_, sampler);
      if (photon) sum += photon->Flux().Average();
    }
    means.push_back(sum / kPhotons);
  }
  double mean = 0, variance = 0;
  for (double m : means) mean += m / kGroups;
  for (double m : means) variance += (m - mean) * (m - mean) / (kGroups - 1) / kGroups;
  EXPECT_NEAR(mean, power.Average(), 5 * std::sqrt(variance) + 1e-5 * power.Average());
  EXPECT_LT(std::sqrt(variance), 0.02 * power.Average());
}

TEST_P(Emission, DensityOfASampleIsWhatPdfSays) {
  constexpr int kSamples = 2000;
  int others = 0;
  for (int i = 0; i < kSamples; ++i) {
    const auto photon = emission_.Sample(Random(i, kSamples));
    ASSERT_TRUE(photon);
    const EmissionPdf pdf = emission_.Pdf(photon->light, photon->le.ray, photon->le.From());
    EXPECT_DOUBLE_EQ(pdf.light, photon->pdfLight);
    const double sampled = photon->le.pdfPos * photon->le.pdfDir * photon->bend;
    const double ratio = pdf.position * pdf.direction * pdf.bend / sampled;
    if (std::abs(ratio - 1) < 1e-4) continue;
    // A guide's cell is found from the ray in float: at the border of two cells it may be the neighbour, seldom.
    ++others;
    const double own = photon->own.direction.x * 64, other = photon->own.direction.y * 64;
    const double x = photon->own.position.x * 64, y = photon->own.position.y * 64;
    const auto nearBorder = [](double c) { return std::abs(c - std::round(c)) < 0.05; };
    EXPECT_TRUE(nearBorder(own) || nearBorder(other) || nearBorder(x) || nearBorder(y))
        << "light " << photon->light << ": " << ratio;
  }
  EXPECT_LE(others, GetParam() == Guide::None ? 0 : kSamples / 100);
}

TEST_P(Emission, InverseLeadsBackToTheRay) {
  constexpr int kSamples = 2000;
  for (int i = 0; i < kSamples; ++i) {
    const auto photon = emission_.Sample(Random(i, kSamples));
    ASSERT_TRUE(photon);
    const LeRandom u = emission_.Inverse(photon->light, photon->le.ray, photon->le.From());
    const auto again = emission_.Sample(u);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->light, photon->light);
    EXPECT_LT(Length(again->le.ray.d - photon->le.ray.d), 2e-3f) << "light " << photon->light;
    EXPECT_LT(Length(Cross(again->le.ray.o - photon->le.ray.o, photon->le.ray.d)), 2e-2f) << "light " << photon->light;
  }
}

std::string NameOf(const ::testing::TestParamInfo<Guide>& guide) {
  switch (guide.param) {
    case Guide::None:
      return "ByPower";
    case Guide::Gathered:
      return "GuidedToGathers";
    case Guide::Joined:
      return "GuidedToThePicture";
  }
  return "";
}

INSTANTIATE_TEST_SUITE_P(Sampler, Emission, ::testing::Values(Guide::None, Guide::Gathered, Guide::Joined), NameOf);

/// How many vertices of 20,000 light paths are of use.
template <typename IsUseful>
int CountUseful(const Scene& scene, const EmissionSampler& emission, IsUseful isUseful) {
  int useful = 0;
  constexpr int kPaths = 20000;
  for (int i = 0; i < kPaths; ++i) {
    Sampler sampler = Sampler::ForLightPath(3, i, 0, kPaths);
    const auto emitted = EmitPhoton(emission, sampler);
    if (!emitted) continue;
    TraceLightPath(scene, *emitted, sampler, 8, [&](const LightVertex& v) { useful += isUseful(v); });
  }
  return useful;
}

TEST(EmissionGuide, SendsMorePhotonsWhereTheyAreOfUse) {
  const auto scene = testing_support::SceneFromText(kScene);
  const auto useful = [&](Guide guide) {
    return CountUseful(*scene, EmissionSampler(*scene, Learn(guide, *scene)),
                       [](const LightVertex& v) { return v.isCaustic; });
  };
  EXPECT_GT(useful(Guide::Gathered), 3 * useful(Guide::None));
}

// The camera sees a patch of the floor around the origin, from above: no surface hides it.
TEST(EmissionGuide, SendsMoreLightPathsIntoThePicture) {
  const auto scene = testing_support::SceneFromText(
      "LookAt 0 0 4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" [30] "
      "Film \"image\" \"integer xresolution\" [64] \"integer yresolution\" [64] WorldBegin "
      "LightSource \"point\" \"rgb I\" [5 5 5] \"point from\" [1 0 3] LightSource \"infinite\" \"rgb L\" [.3 .3 .5] "
      "Material \"matte\" Shape \"disk\" \"float radius\" [20] WorldEnd");
  const double halfSide = 4 * std::tan(Radians(15.0));
  const auto useful = [&](Guide guide) {
    return CountUseful(*scene, EmissionSampler(*scene, Learn(guide, *scene)), [&](const LightVertex& v) {
      const Vec3d p = scene->RenderToWorld().Point(ToDouble(v.hit.p));
      return std::abs(p.x) < halfSide && std::abs(p.y) < halfSide;
    });
  };
  EXPECT_GT(useful(Guide::Joined), 5 * useful(Guide::None));
}

// A thousand lamps, all of use.
TEST(EmissionGuide, OfManyLightsTakesLittleMemory) {
  constexpr int kLights = 1000;
  const std::vector<double> power(kLights, 1);
  std::vector<PilotPhoton> pilot;
  for (int i = 0; i < 4 * kLights; ++i) pilot.push_back({i % kLights, {0.3, 0.7}, {0.2, 0.9}, false, false, 1});
  const EmissionGuide guide(power, pilot);
  int guided = 0;
  for (int i = 0; i < kLights; ++i) {
    guided += guide.Bends(i);
    EXPECT_NEAR(guide.LightProbability(i), 1.0 / kLights, 1e-9);
  }
  EXPECT_EQ(guided, 512);
  EXPECT_LE(guide.MemoryBytes(), EmissionGuide::MostMemoryBytes(kLights));
  EXPECT_GT(guide.MemoryBytes(), EmissionGuide::MostMemoryBytes(kLights) / 2);
}

TEST(EmissionGuide, IsAFunctionOfTheSeedWhateverTheThreads) {
  const auto scene = testing_support::SceneFromText(kScene);
  for (const Guide guide : {Guide::Gathered, Guide::Joined}) {
    std::vector<Vec3> directions[2];
    for (int threads : {1, 3}) {
      const ThreadLimit limit(threads);
      const EmissionSampler emission(*scene, Learn(guide, *scene, 5));
      for (int i = 0; i < 100; ++i) {
        Sampler sampler = Sampler::ForLightPath(1, i, 0, 100);
        directions[threads / 2].push_back(EmitPhoton(emission, sampler)->le.ray.d);
      }
    }
    EXPECT_EQ(directions[0], directions[1]);
  }
}

TEST(EmissionGuide, BendsNothingWhereNoPhotonComesToAnything) {
  const auto scene = testing_support::SceneFromText(
      "LookAt 0 0 5  0 0 0  0 1 0 Camera \"perspective\" Film \"image\" WorldBegin "
      "LightSource \"point\" \"rgb I\" [1 1 1] Material \"matte\" \"rgb Kd\" [0 0 0] Shape \"sphere\" WorldEnd");
  EXPECT_TRUE(Learn(Guide::Gathered, *scene).IsEmpty());
  EXPECT_TRUE(Learn(Guide::Joined, *scene).IsEmpty());
}

}  // namespace
}  // namespace dapple
