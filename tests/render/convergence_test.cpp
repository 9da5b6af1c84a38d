// Runs with snapshots, what is measured of them and what follows: on whole scenes, and on curves made up.
#include <chrono>
#include <cmath>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "src/image/metrics.h"
#include "src/io/build_scene.h"
#include "src/render/convergence_data.h"
#include "src/render/convergence_run.h"
#include "tests/support/random_numbers.h"

namespace dapple {
namespace {

std::unique_ptr<Scene> Load(const std::string& name, const Vec2i& resolution) {
  Diagnostics diagnostics([](const std::string& line) { ADD_FAILURE() << line; });
  BuildOptions options;
  options.resolution = resolution;
  return LoadScene(DAPPLE_SOURCE_DIR "/scenes/" + name, options, diagnostics);
}

Film FilmOf(const Scene& scene) {
  return Film(scene.Settings().resolution, scene.Settings().crop, scene.Settings().filter);
}

RenderBudget Passes(int count) {
  RenderBudget budget;
  budget.passes = count;
  return budget;
}

TEST(ConvergenceRun, SnapshotsDoNotChangeTheBits) {
  const auto scene = Load("ring.pbrt", {24, 20});
  IntegratorOptions options;
  options.photonsPerPass = 2000;
  options.guideEmission = false;
  for (const char* name : {"path", "sppm"}) {
    Film watched = FilmOf(*scene), plain = FilmOf(*scene);
    const ConvergenceRun run = RunWithSnapshots(*scene, 7, *MakeIntegrator(name, options), SnapshotTimes(0.1), watched);
    ASSERT_GE(run.snapshots.size(), 1u);
    Render(*scene, 7, *MakeIntegrator(name, options), plain, Passes(run.passes));
    EXPECT_EQ(watched, plain) << name;
    // Each snapshot is what a render of so many passes gives.
    for (const Snapshot& snapshot : run.snapshots) {
      if (snapshot.passes > 4) continue;
      Film shorter = FilmOf(*scene);
      Render(*scene, 7, *MakeIntegrator(name, options), shorter, Passes(snapshot.passes));
      EXPECT_TRUE(std::ranges::equal(snapshot.picture.Values(), shorter.ToImage().Values())) << snapshot.passes;
    }
  }
}

TEST(ConvergenceRun, TimesAscendByTheRootOfTwoToTheBudget) {
  const std::vector<double> times = SnapshotTimes(8);
  EXPECT_EQ(times.size(), 17u);
  EXPECT_EQ(times.back(), 8);
  EXPECT_EQ(times.front(), 8. / 256);
  for (size_t i = 1; i < times.size(); ++i) EXPECT_NEAR(times[i] / times[i - 1], std::sqrt(2.), 1e-12);
}

/// Adds gray to each pixel, after so many seconds of sleep.
class SleepingIntegrator : public Integrator {
 public:
  explicit SleepingIntegrator(double seconds) : seconds_(seconds) {}
  std::string_view Name() const override { return "sleeping"; }
  void Prepare(const Scene&, uint64_t) override {}
  PassStats RenderPass(int pass, Film& film) const override {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds_));
    film.FinishPass(pass);
    return {};
  }
  int DefaultPasses() const override { return 1; }

 private:
  double seconds_;
};

TEST(ConvergenceRun, TheClockStandsStillBetweenPasses) {
  const auto scene = Load("ring.pbrt", {4, 4});
  SleepingIntegrator integrator(0.01);
  Film film = FilmOf(*scene);
  const auto begin = std::chrono::steady_clock::now();
  // The watcher takes five times as long as a pass.
  const ConvergenceRun run = RunWithSnapshots(*scene, 0, integrator, {0.025, 0.05, 0.1}, film, [](double) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  });
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_LE(run.seconds, wall - 0.05 * (run.passes + 1));
  EXPECT_GE(run.seconds, 0.01 * run.passes);
  ASSERT_FALSE(run.snapshots.empty());
  EXPECT_EQ(run.snapshots.back().timeIndex, 2);
  EXPECT_EQ(run.snapshots.back().passes, run.passes);
  EXPECT_EQ(run.snapshots.back().seconds, run.seconds);
  for (size_t i = 1; i < run.snapshots.size(); ++i)
    EXPECT_GT(run.snapshots[i].timeIndex, run.snapshots[i - 1].timeIndex);
}

TEST(ConvergenceRun, APassThatIsLongerThanTheBudgetIsTheOnlyOne) {
  const auto scene = Load("ring.pbrt", {4, 4});
  SleepingIntegrator integrator(0.05);
  Film film = FilmOf(*scene);
  const ConvergenceRun run = RunWithSnapshots(*scene, 0, integrator, {0.01, 0.02}, film);
  EXPECT_EQ(run.passes, 1);
  ASSERT_EQ(run.snapshots.size(), 1u);
  EXPECT_EQ(run.snapshots[0].timeIndex, 1);
}

TEST(ConvergenceRun, WhatWasSpentBeforeCounts) {
  const auto scene = Load("ring.pbrt", {4, 4});
  SleepingIntegrator integrator(0.01);
  Film film = FilmOf(*scene);
  const ConvergenceRun run = RunWithSnapshots(*scene, 0, integrator, {100, 100.05}, film, {}, nullptr, 100);
  EXPECT_GE(run.prepareSeconds, 100);
  EXPECT_GE(run.seconds, 100 + 0.01 * run.passes);
  EXPECT_LE(run.passes, 5);
  EXPECT_EQ(run.snapshots.front().passes, 1);
  EXPECT_EQ(run.snapshots.back().seconds, run.seconds);
}

TEST(ConvergenceRun, StopsWhenAskedTo) {
  const auto scene = Load("ring.pbrt", {4, 4});
  SleepingIntegrator integrator(0.005);
  Film film = FilmOf(*scene);
  std::atomic<bool> stop{false};
  int passes = 0;
  const ConvergenceRun run = RunWithSnapshots(
      *scene, 0, integrator, {3600}, film, [&](double) { stop = ++passes >= 4; }, &stop);
  EXPECT_TRUE(run.stopped);
  EXPECT_EQ(run.snapshots.size(), 1u);
  EXPECT_LT(run.passes, 8);
}

/// A film of `passes` passes, each the image plus noise, evenly in +- 0.6 and independent.
Film NoisyFilm(const Image& image, int passes, uint64_t seed) {
  testing::UniformNumbers random(seed);
  Film film({image.Width(), image.Height()}, {{0, 0}, {image.Width(), image.Height()}}, Filter::Box());
  for (int pass = 0; pass < passes; ++pass) {
    for (int y = 0; y < image.Height(); ++y) {
      for (int x = 0; x < image.Width(); ++x) {
        Color noise;
        for (int c = 0; c < 3; ++c) noise[c] = static_cast<float>(1.2 * random.Get1D() - 0.6);
        film.AddSample({x, y}, image.ColorAt(x, y) + noise, pass);
      }
    }
    film.FinishPass(pass);
  }
  return film;
}

// What the half-images tell is how far the image is from what it converges to: 3 x 4096 deviations have a mean square
// with a relative standard deviation of sqrt(2 / 12288) = 1.3 %, the two compared each have it, and the tolerance is
// four of both. The relative errors look at a noisy image in place of the true one: 3 % more for the offset. FLIP
// compares edges of noise with edges of noise, not with none, and is a tenth too high.
TEST(ErrorsOfNoise, AreTheErrors) {
  Image truth = Image::Rgb(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) truth.SetColor(x, y, Color(x < 32 ? 2.f : 1.f, 1.5f, y < 32 ? 1.f : 3.f));
  const ErrorMeter meter(truth);
  for (const int passes : {16, 17, 24}) {  // halves of one and of two sizes
    const Film film = NoisyFilm(truth, passes, 11);
    const MeasuredErrors errors = meter.Measure(film.ToImage()), estimate = *ErrorsOfNoise(film, 1);
    EXPECT_NEAR(errors[2] * passes, 0.12, 0.12 * 0.052) << "variance of the noise";
    for (size_t m = 0; m < kErrorMeasures.size(); ++m)
      EXPECT_NEAR(estimate[m] / errors[m], 1, kErrorMeasures[m].key == "flip" ? 0.2 : 0.073 + 0.03)
          << kErrorMeasures[m].key << " of " << passes;
  }
  const Film film = NoisyFilm(truth, 4, 5);
  const MeasuredErrors plain = *ErrorsOfNoise(film, 1), exposed = *ErrorsOfNoise(film, 2);
  EXPECT_NEAR(exposed[2], 4 * plain[2], 1e-5 * exposed[2]);
  EXPECT_FALSE(ErrorsOfNoise(NoisyFilm(truth, 1, 3), 1));
}

/// Runs whose errors are scale / seconds, and half of it by the second measure.
SeedRun InverseTime(int seed, double scale, double passesPerSecond, int from = 0) {
  SeedRun run;
  run.seed = seed;
  for (int i = from; i < 8; ++i) {
    MeasuredSnapshot snapshot{i, std::exp2(i) / 16, static_cast<int>(passesPerSecond * std::exp2(i)), {}};
    snapshot.errors.fill(scale / snapshot.seconds);
    run.snapshots.push_back(snapshot);
  }
  run.seconds = 8;
  return run;
}

SceneConvergence TwoContenders() {
  SceneConvergence scene;
  scene.name = "made, \"up\"";
  scene.seconds = 8;
  scene.contenders = {{"fast", "path", "", {InverseTime(0, 1, 4), InverseTime(1, 3, 4)}},
                      {"slow", "sppm", "", {InverseTime(0, 8, 1), InverseTime(1, 8, 1, 2)}}};
  return scene;
}

TEST(ConvergenceData, CurvesAreMeansOverTheSeedsThatAllHave) {
  const SceneConvergence scene = TwoContenders();
  const std::vector<CurvePoint> fast = MeanCurve(scene.contenders[0].seeds),
                                slow = MeanCurve(scene.contenders[1].seeds);
  ASSERT_EQ(fast.size(), 8u);
  ASSERT_EQ(slow.size(), 6u);  // one seed lacks the first two
  EXPECT_EQ(slow[0].timeIndex, 2);
  EXPECT_NEAR(fast[4].seconds, 1, 1e-12);
  EXPECT_NEAR(fast[4].mean[0], 2, 1e-12);
  EXPECT_NEAR(fast[4].low[0], 1, 1e-12);
  EXPECT_NEAR(fast[4].high[0], 3, 1e-12);
  EXPECT_TRUE(MeanCurve({}).empty());
}

TEST(ConvergenceData, SlopesAndTimesAreThoseOfTheCurves) {
  const SceneConvergence scene = TwoContenders();
  const ConvergenceSlopes slopes = FitSlopes(scene.contenders[0].seeds, 0, std::nullopt);
  EXPECT_NEAR(slopes.overTime->slope, -1, 1e-12);
  EXPECT_NEAR(slopes.overPasses->slope, -1, 1e-12);
  EXPECT_NEAR(*slopes.overTime->halfWidth, 0, 1e-9);
  EXPECT_NEAR(BestFinalError(scene.contenders, 0), 2. / 8, 1e-12);
  const auto json = ConvergenceToJson({scene}, {{"version", "1"}});
  const auto& contenders = json["scenes"][0]["contenders"];
  EXPECT_NEAR(contenders[0]["timeToBest"]["mse"]["seconds"], 8, 1e-9);
  EXPECT_EQ(contenders[0]["timeToBest"]["mse"]["kind"], "measured");
  EXPECT_NEAR(contenders[1]["timeToBest"]["mse"]["seconds"], 32, 1e-9);
  EXPECT_EQ(contenders[1]["timeToBest"]["mse"]["kind"], "extrapolated");
}

// A curve that runs into the reference's own error is flat there; those points are no part of the slope.
TEST(ConvergenceData, PointsNearTheReferencesErrorAreNotFitted) {
  std::vector<SeedRun> seeds{InverseTime(0, 1, 4)};
  for (MeasuredSnapshot& snapshot : seeds[0].snapshots) {
    if (snapshot.errors[0] < 1) snapshot.errors.fill(0.9);
  }
  MeasuredErrors own;
  own.fill(0.24);
  EXPECT_NEAR(FitSlopes(seeds, 0, own).overTime->slope, -1, 1e-12);
  EXPECT_GT(FitSlopes(seeds, 0, std::nullopt).overTime->slope, -0.95);
  own.fill(NAN);  // not known
  EXPECT_GT(FitSlopes(seeds, 0, own).overTime->slope, -0.95);
}

TEST(ConvergenceData, TheScoreboardHasTheBestInBold) {
  SceneConvergence other = TwoContenders();
  other.name = "other";
  other.contenders.erase(other.contenders.begin());
  EXPECT_EQ(ConvergenceToMarkdown({TwoContenders(), other}, 0),
            "| relative MSE | `fast` | `slow` |\n|---|---|---|\n"
            "| `made, \"up\"` | **0.25** | 1 |\n| `other` | - | **1** |\n");
}

TEST(ConvergenceData, ALineOfTheTableForEachSnapshot) {
  std::istringstream csv(ConvergenceToCsv({TwoContenders()}));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(
      line,
      "scene,contender,integrator,strategy,seed,timeIndex,seconds,passes,relativeMse,trimmedRelativeMse,mse,mape,flip");
  std::getline(csv, line);
  EXPECT_EQ(line, "\"made, \"\"up\"\"\",fast,path,,0,0,0.0625,4,16,16,16,16,16");
  int lines = 1;
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, 8 + 8 + 8 + 6);
}

}  // namespace
}  // namespace dapple
