#include "lights/light_picker.h"

#include <cmath>

#include <gtest/gtest.h>

#include "lights/area_light.h"
#include "lights/environment_light.h"
#include "lights/point_light.h"
#include "src/geometry/disk.h"
#include "tests/lights/choice_checks.h"

namespace dapple {
namespace {

using Lights = std::vector<std::unique_ptr<Light>>;

Lights PointLights(const std::vector<float>& intensities) {
  Lights lights;
  for (size_t i = 0; i < intensities.size(); ++i) {
    lights.push_back(std::make_unique<PointLight>(Vec3(static_cast<float>(i), 0, 1), Color(intensities[i])));
  }
  return lights;
}

const Disk& DiskFacingDown() {
  static const Disk disk(Transform::Translate({0, 0, 1}) * Transform::Rotate(180, {1, 0, 0}), false, 0, 1, 0, 360);
  return disk;
}

Lights Mixed() {
  Lights lights = PointLights({1, 1000, 0, 2});
  lights.push_back(std::make_unique<AreaLight>(&DiskFacingDown(), Color(1), false));
  lights.push_back(std::make_unique<UniformEnvironmentLight>(Color(0.1f)));
  lights.back()->Prepare(kTestExtent);
  return lights;
}

TEST(LightPicker, PicksByPower) {
  const Lights lights = PointLights({1, 0, 3});
  const LightPicker picker(lights);
  EXPECT_NEAR(picker.ProbabilityByPower(0), 0.25, 1e-7);
  EXPECT_EQ(picker.ProbabilityByPower(1), 0);
  EXPECT_EQ(picker.PickByPower(0.24).index, 0);
  EXPECT_EQ(picker.PickByPower(0.26).index, 2);
  EXPECT_NEAR(picker.InvertByPower(2, picker.PickByPower(0.7).u), 0.7, 1e-12);
}

TEST(LightPicker, PicksFollowTheirProbabilities) {
  const Lights few = PointLights({1, 0, 3, 2}), mixed = Mixed();
  const LightPicker ofFew(few), ofMixed(mixed);
  const auto expect = [](const Verdict& verdict) { EXPECT_TRUE(verdict.passes) << verdict.message; };
  for (const auto& [picker, lights] : {std::pair(&ofFew, &few), {&ofMixed, &mixed}}) {
    expect(CheckPicks([&](double u) { return picker->PickByPower(u); },
                      [&](int light) { return picker->ProbabilityByPower(light); }, static_cast<int>(lights->size())));
  }
  const LightContext at(Vec3(0.5f, 0.5f, 0.5f));
  expect(CheckPicks([&](double u) { return ofMixed.PickFor(at, u); },
                    [&](int light) { return ofMixed.ProbabilityFor(at, light); }, static_cast<int>(mixed.size())));
}

TEST(LightPicker, RaysOfPickedLightsCarryThePowerOfAllEvenly) {
  const Lights lights = PointLights({1, 0, 3, 2, 1000});
  const LightPicker picker(lights);
  const auto pick = [&](double u) { return picker.PickByPower(u); };
  for (const Verdict& verdict : {CheckPickedEnergy(pick, lights), CheckPickedEvenness(pick, lights)})
    EXPECT_TRUE(verdict.passes) << verdict.message;
}

TEST(LightPicker, ProbabilitiesAtAPointAreThoseOfThePick) {
  const Lights lights = Mixed();
  const LightPicker picker(lights);
  RandomNumbers random(3);
  for (int i = 0; i < 50; ++i) {
    const Vec3 p(static_cast<float>(random.Get1D() * 4 - 2), 0.5f, static_cast<float>(random.Get1D() * 2));
    const LightContext at = i % 2 == 0 ? LightContext(p) : LightContext(p, Vec3(0, 0, i % 4 == 1 ? 1.f : -1.f), false);
    double sum = 0;
    for (size_t light = 0; light < lights.size(); ++light) sum += picker.ProbabilityFor(at, static_cast<int>(light));
    ASSERT_NEAR(sum, 1, 1e-12);
    std::vector<int> count(lights.size());
    constexpr int kDraws = 1000;
    for (int j = 0; j < kDraws; ++j) {
      const PickedLight picked = picker.PickFor(at, (j + 0.5) / kDraws);
      ASSERT_EQ(picked.probability, picker.ProbabilityFor(at, picked.index));
      ASSERT_GT(picked.probability, 0);
      ASSERT_TRUE(picked.u >= 0 && picked.u < 1);
      ++count[static_cast<size_t>(picked.index)];
    }
    for (size_t light = 0; light < lights.size(); ++light) {
      ASSERT_NEAR(count[light], kDraws * picker.ProbabilityFor(at, static_cast<int>(light)), 1.01);
    }
  }
}

TEST(LightPicker, NearLightsComeFirstAndNoneThatReachesStarves) {
  const Lights lights = PointLights({1, 1, 1e-6f});
  const LightPicker picker(lights);
  const LightContext nearFirst(Vec3(0, 0, 0.9f));
  EXPECT_GT(picker.ProbabilityFor(nearFirst, 0), 0.9);
  EXPECT_GT(picker.ProbabilityFor(nearFirst, 2), 0.03);
}

TEST(LightPicker, LightsThatCannotReachAreNotPicked) {
  const Lights lights = Mixed();
  const LightPicker picker(lights);
  const LightContext behind(Vec3(0, 0, 2));
  EXPECT_EQ(picker.ProbabilityFor(behind, 4), 0);
  EXPECT_EQ(picker.ProbabilityFor(behind, 2), 0);  // black
  const LightContext below(Vec3(0, 0, 0), Vec3(0, 0, -1), false);
  for (int light = 0; light < 5; ++light) EXPECT_EQ(picker.ProbabilityFor(below, light), 0) << light;
  EXPECT_NEAR(picker.ProbabilityFor(below, 5), 1, 1e-12);
  const LightContext through(Vec3(0, 0, 0), Vec3(0, 0, -1), true);
  EXPECT_GT(picker.ProbabilityFor(through, 0), 0);
}

TEST(LightPicker, PicksSomethingEvenWhereNothingArrives) {
  const Lights lights = PointLights({1, 3});
  const LightPicker picker(lights);
  const LightContext below(Vec3(0, 0, 0), Vec3(0, 0, -1), false);
  EXPECT_NEAR(picker.ProbabilityFor(below, 1), 0.75, 1e-7);
  EXPECT_EQ(picker.PickFor(below, 0.5).index, 1);
}

TEST(LightPicker, ManyLightsGoByPower) {
  const Lights lights = PointLights(std::vector<float>(100000, 2));
  const LightPicker picker(lights);
  const LightContext at(Vec3(7, 0, 0.9f));
  EXPECT_NEAR(picker.ProbabilityFor(at, 7), 1e-5, 1e-12);
  EXPECT_EQ(picker.PickFor(at, 0.5).index, 50000);
}

TEST(LightPicker, EvenWherePowerSaysNothing) {
  const Lights none;
  EXPECT_TRUE(LightPicker(none).Empty());
  const Lights black = PointLights({0, 0});
  EXPECT_NEAR(LightPicker(black).ProbabilityByPower(1), 0.5, 1e-12);
  EXPECT_NEAR(LightPicker(black).ProbabilityFor(LightContext(Vec3(0)), 1), 0.5, 1e-12);
}

}  // namespace
}  // namespace dapple
