#include "src/render/driver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace dapple {
namespace {

using Clock = std::chrono::steady_clock;

/// Sees nothing: the driver never asks it.
class BlindCamera : public Camera {
 public:
  CameraRay GenerateRay(const Vec2&, const Vec2d&, double) const override { return {}; }
  std::optional<WiSample> Sample_Wi(const Vec3&, const Vec2d&) const override { return std::nullopt; }
  float We(const Ray&, Vec2*) const override { return 0; }
  WePdf Pdf_We(const Ray&) const override { return {}; }
  Vec3 Position() const override { return Vec3(0); }
  float Depth(const Vec3&) const override { return 0; }
};

Scene EmptyScene() {
  SceneParts parts;
  parts.camera = std::make_unique<BlindCamera>();
  parts.settings.resolution = {2, 2};
  parts.settings.crop = {{0, 0}, {2, 2}};
  return Scene(std::move(parts));
}

Film SmallFilm() { return Film({2, 2}, {{0, 0}, {2, 2}}, Filter::Box()); }

double SecondsSince(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Adds the value pass + 1 to each pixel, takes the time it is told to, and notes what it is asked for.
class FakeIntegrator : public Integrator {
 public:
  std::string_view Name() const override { return "fake"; }
  void Prepare(const Scene& scene, uint64_t seed) override {
    preparedScene = &scene;
    preparedSeed = seed;
    ++preparations;
  }
  PassStats RenderPass(int pass, Film& film) const override {
    EXPECT_EQ(preparations, 1) << "passes follow the preparation";
    const Clock::time_point begin = Clock::now();
    if (duringPass) duringPass(pass);
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 2; ++x) film.AddSample({x, y}, Color(static_cast<float>(pass + 1)), pass);
    film.FinishPass(pass);
    passes.push_back(pass);
    durations.push_back(SecondsSince(begin));
    PassStats stats;
    stats.cameraRays = 10 + pass;
    stats.photonsEmitted = 100;
    return stats;
  }
  int DefaultPasses() const override { return 4; }

  std::function<void(int pass)> duringPass;
  const Scene* preparedScene = nullptr;
  uint64_t preparedSeed = 0;
  int preparations = 0;
  mutable std::vector<int> passes;
  mutable std::vector<double> durations;
};

TEST(Driver, PreparesOnceAndRunsThePassesOfTheBudgetInOrder) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  Film film = SmallFilm();
  const RenderResult result = Render(scene, 77, integrator, film, {.passes = 5, .seconds = {}});
  EXPECT_EQ(integrator.preparations, 1);
  EXPECT_EQ(integrator.preparedScene, &scene);
  EXPECT_EQ(integrator.preparedSeed, 77u);
  EXPECT_EQ(integrator.passes, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(result.passes, 5);
  EXPECT_EQ(film.PassCount(), 5);
  EXPECT_FALSE(result.stopped);
}

TEST(Driver, ThePictureIsTheMeanOfThePassesAndTheCountsAreTheirSum) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  Film film = SmallFilm();
  const RenderResult result = Render(scene, 0, integrator, film, {.passes = 5, .seconds = {}});
  EXPECT_FLOAT_EQ(film.ToImage().ColorAt(1, 1).g, 3);
  EXPECT_EQ(result.stats.cameraRays, 10 + 11 + 12 + 13 + 14);
  EXPECT_EQ(result.stats.photonsEmitted, 500);
}

TEST(Driver, SecondsSpentBeforeCountAsPreparation) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  Film film = SmallFilm();
  std::vector<double> seconds;
  const RenderHooks hooks{.onProgress = [&](const RenderProgress& progress) { seconds.push_back(progress.seconds); }};
  const RenderResult result = Render(scene, 0, integrator, film, {.passes = {}, .seconds = 100}, hooks, 200);
  EXPECT_EQ(result.passes, 1) << "the time was up before; one pass is always rendered";
  EXPECT_GE(result.prepareSeconds, 200);
  EXPECT_GE(result.seconds, result.prepareSeconds);
  ASSERT_EQ(seconds.size(), 2u);
  EXPECT_GE(seconds[0], 200);
}

TEST(Driver, ContinuesAFilmThatHoldsPasses) {
  const Scene scene = EmptyScene();
  Film atOnce = SmallFilm(), inParts = SmallFilm();
  FakeIntegrator all, first, second;
  Render(scene, 0, all, atOnce, {.passes = 8, .seconds = {}});
  Render(scene, 0, first, inParts, {.passes = 3, .seconds = {}});
  const RenderResult result = Render(scene, 0, second, inParts, {.passes = 8, .seconds = {}});
  EXPECT_EQ(second.passes, (std::vector<int>{3, 4, 5, 6, 7}));
  EXPECT_EQ(result.passes, 5);
  EXPECT_EQ(atOnce, inParts);
}

TEST(Driver, RangesOfPassesJoinToTheWholeInAnyOrder) {
  const Scene scene = EmptyScene();
  FakeIntegrator all, late, early;
  Film whole = SmallFilm(), joined = SmallFilm(), first = SmallFilm();
  Render(scene, 0, all, whole, {.passes = 7, .seconds = {}});
  Render(scene, 0, late, joined, {.passes = 4, .seconds = {}, .firstPass = 3});
  Render(scene, 0, early, first, {.passes = 3, .seconds = {}, .firstPass = 0});
  EXPECT_EQ(late.passes, (std::vector<int>{3, 4, 5, 6}));
  joined.Merge(first);
  EXPECT_EQ(joined, whole);
}

TEST(Driver, RendersWhatIsMissingBetweenPassesThatAreThere) {
  const Scene scene = EmptyScene();
  FakeIntegrator middle, rest;
  Film film = SmallFilm();
  Render(scene, 0, middle, film, {.passes = 2, .seconds = {}, .firstPass = 2});
  Render(scene, 0, rest, film, {.passes = 6, .seconds = {}});
  EXPECT_EQ(rest.passes, (std::vector<int>{0, 1, 4, 5}));
}

/// Notes when the driver told its progress: `seconds[p]` with p passes done.
struct ProgressTimes {
  RenderHooks Hooks() {
    return {.onProgress = [this](const RenderProgress& progress) { seconds.push_back(progress.seconds); },
            .stop = nullptr};
  }
  /// At least what the driver itself measured for the pass, while the integrator's own clock gives at most that.
  double Duration(size_t pass) const { return seconds[pass + 1] - seconds[pass]; }
  std::vector<double> seconds;
};

// Judged by clocks read before and after the driver's own, so that no hiccup of the machine can fail it: a pass that
// was begun had room by the slower of the two before it, and the one that was not begun had none.
TEST(Driver, ATimeBudgetIsKeptToWithinAPass) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  integrator.duringPass = [](int pass) { std::this_thread::sleep_for(std::chrono::milliseconds(pass % 2 ? 4 : 8)); };
  Film film = SmallFilm();
  ProgressTimes times;
  constexpr double kBudget = 0.1;
  const RenderResult result = Render(scene, 0, integrator, film, {.passes = {}, .seconds = kBudget}, times.Hooks());
  const size_t count = integrator.passes.size();
  ASSERT_EQ(times.seconds.size(), count + 1);
  const auto slowerOfTwoBefore = [](size_t pass, auto duration) {
    return std::max(duration(pass - 1), duration(pass >= 2 ? pass - 2 : 0));
  };
  for (size_t pass = 1; pass < count; ++pass) {
    const double atLeast = slowerOfTwoBefore(pass, [&](size_t p) { return integrator.durations[p]; });
    EXPECT_LE(times.seconds[pass] + atLeast, kBudget) << "pass " << pass;
  }
  const double atMost = slowerOfTwoBefore(count, [&](size_t p) { return times.Duration(p); });
  EXPECT_GT(result.seconds + atMost, kBudget);
  EXPECT_FALSE(result.stopped);
}

TEST(Driver, RendersOnePassHoweverShortTheTime) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  integrator.duringPass = [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(5)); };
  Film film = SmallFilm();
  EXPECT_EQ(Render(scene, 0, integrator, film, {.passes = {}, .seconds = 1e-6}).passes, 1);
}

TEST(Driver, TheFirstOfTwoBudgetsEndsTheRender) {
  const Scene scene = EmptyScene();
  FakeIntegrator few, slow;
  Film fewFilm = SmallFilm(), slowFilm = SmallFilm();
  EXPECT_EQ(Render(scene, 0, few, fewFilm, {.passes = 3, .seconds = 1000}).passes, 3);
  slow.duringPass = [](int) { std::this_thread::sleep_for(std::chrono::milliseconds(5)); };
  EXPECT_LT(Render(scene, 0, slow, slowFilm, {.passes = 1000000, .seconds = 0.03}).passes, 10);
}

/// Adds 1 to each pixel, and noise that takes turns: even passes are brighter by `noise` / (pass / 2 + 1), odd ones
/// darker.
class NoisyIntegrator : public Integrator {
 public:
  explicit NoisyIntegrator(float noise) : noise_(noise) {}
  std::string_view Name() const override { return "noisy"; }
  void Prepare(const Scene&, uint64_t) override {}
  PassStats RenderPass(int pass, Film& film) const override {
    const float offset = noise_ / static_cast<float>(pass / 2 + 1);
    for (int i = 0; i < 4; ++i) film.AddSample({i % 2, i / 2}, Color(pass % 2 == 0 ? 1 + offset : 1 - offset), pass);
    film.FinishPass(pass);
    return {};
  }
  int DefaultPasses() const override { return 4; }

 private:
  float noise_;
};

/// The error that is estimated of its first passes: the root of the mean of (h0 - h1)^2 / 4 over 1.01.
double ErrorOfNoisy(double noise, int passes) {
  double sum = 0;
  for (int pair = 1; pair <= passes / 2; ++pair) sum += noise / pair;
  return sum / (passes / 2) / std::sqrt(1.01);
}

TEST(Driver, EndsAtTheFirstLookThatFindsTheErrorSmallEnough) {
  const Scene scene = EmptyScene();
  for (const int last : {8, 10, 24, 28, 40}) {
    NoisyIntegrator integrator(0.3f);
    Film film = SmallFilm();
    RenderBudget budget;
    budget.error = ErrorOfNoisy(0.3, last) * 1.001;
    const RenderResult result = Render(scene, 0, integrator, film, budget);
    EXPECT_EQ(result.passes, last);
    EXPECT_FALSE(result.stopped);
    EXPECT_NEAR(EstimateError(film, 1)->Total(), ErrorOfNoisy(0.3, last), 1e-5);
  }
}

// A break changes nothing, wherever it is; what is good enough already is left alone; other budgets hold too.
TEST(Driver, WhereAnErrorEndsARenderDependsOnThePictureAlone) {
  const Scene scene = EmptyScene();
  RenderBudget budget;
  budget.error = ErrorOfNoisy(0.3, 24) * 1.001;
  for (const int before : {1, 8, 9, 23, 24}) {
    NoisyIntegrator first(0.3f), second(0.3f);
    Film film = SmallFilm();
    Render(scene, 0, first, film, {.passes = before, .seconds = {}});
    EXPECT_EQ(Render(scene, 0, second, film, budget).passes, 24 - before);
  }
  budget.passes = 13;
  NoisyIntegrator bounded(0.3f);
  Film film = SmallFilm();
  EXPECT_EQ(Render(scene, 0, bounded, film, budget).passes, 13);
}

TEST(Driver, AStopLetsTheRunningPassEnd) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  std::atomic<bool> stop{false};
  integrator.duringPass = [&](int pass) { stop = pass == 2; };
  Film film = SmallFilm();
  const RenderResult result =
      Render(scene, 0, integrator, film, {.passes = 9, .seconds = {}}, {.onProgress = {}, .stop = &stop});
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.passes, 3);
  EXPECT_EQ(film.PassCount(), 3);
}

TEST(Driver, AStopInTheLastPassComesTooLateToMatter) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  std::atomic<bool> stop{false};
  integrator.duringPass = [&](int pass) { stop = pass == 2; };
  Film film = SmallFilm();
  EXPECT_FALSE(
      Render(scene, 0, integrator, film, {.passes = 3, .seconds = {}}, {.onProgress = {}, .stop = &stop}).stopped);
}

TEST(Driver, AStopBeforeTheFirstPassLeavesTheFilmEmpty) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  const std::atomic<bool> stop{true};
  Film film = SmallFilm();
  const RenderResult result =
      Render(scene, 0, integrator, film, {.passes = 9, .seconds = {}}, {.onProgress = {}, .stop = &stop});
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.passes, 0);
  EXPECT_EQ(film.PassCount(), 0);
}

TEST(Driver, TellsItsProgressBetweenPasses) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  Film film = SmallFilm();
  std::vector<RenderProgress> seen;
  Render(scene, 0, integrator, film, {.passes = 4, .seconds = {}},
         {.onProgress =
              [&](const RenderProgress& progress) {
                EXPECT_EQ(progress.film, &film);
                EXPECT_EQ(progress.film->PassCount(), progress.passesDone);
                seen.push_back(progress);
              },
          .stop = nullptr});
  ASSERT_EQ(seen.size(), 5u);
  EXPECT_FALSE(seen[0].secondsLeft) << "nothing is known before the first pass";
  for (int i = 0; i <= 4; ++i) {
    EXPECT_EQ(seen[i].passesDone, i);
    EXPECT_DOUBLE_EQ(seen[i].fraction, i / 4.);
    EXPECT_EQ(seen[i].stats.photonsEmitted, 100 * i);
  }
  EXPECT_EQ(seen[4].secondsLeft, 0.);
}

TEST(Driver, ForeseesTheTimeLeftFromTheMeanOfThePasses) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  integrator.duringPass = [](int pass) { std::this_thread::sleep_for(std::chrono::milliseconds(pass % 3)); };
  Film film = SmallFilm();
  double begin = -1;
  int checked = 0;
  constexpr int kPasses = 10;
  Render(scene, 0, integrator, film, {.passes = kPasses, .seconds = {}},
         {.onProgress =
              [&](const RenderProgress& progress) {
                if (progress.passesDone == 0) {
                  begin = progress.seconds;
                  return;
                }
                const double share = static_cast<double>(kPasses - progress.passesDone) / progress.passesDone;
                double inside = 0;  // of the passes, by the integrator's clock: at most what the driver measures
                for (const double duration : integrator.durations) inside += duration;
                EXPECT_GE(progress.secondsLeft.value(), share * inside);
                EXPECT_LE(progress.secondsLeft.value(), share * (progress.seconds - begin));
                ++checked;
              },
          .stop = nullptr});
  EXPECT_EQ(checked, kPasses);
}

TEST(Driver, SaysForWhatTheMemoryDidNotSuffice) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  integrator.duringPass = [](int pass) {
    if (pass == 1) throw std::bad_alloc();
  };
  Film film = SmallFilm();
  try {
    Render(scene, 0, integrator, film, {.passes = 3, .seconds = {}});
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("the memory does not suffice for pass 1;"), std::string::npos);
  }
  EXPECT_EQ(film.PassCount(), 1);
}

TEST(Driver, PassesErrorsOn) {
  const Scene scene = EmptyScene();
  FakeIntegrator integrator;
  integrator.duringPass = [](int pass) {
    if (pass == 1) throw Error("no more");
  };
  Film film = SmallFilm();
  EXPECT_THROW(Render(scene, 0, integrator, film, {.passes = 3, .seconds = {}}), Error);
}

}  // namespace
}  // namespace dapple
