#include "src/app/convergence_study.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <tuple>

#include <fmt/format.h>

#include "src/app/format.h"
#include "src/app/memory.h"
#include "src/image/false_color.h"
#include "src/image/metrics.h"
#include "src/io/build_context.h"
#include "src/render/aov.h"
#include "src/render/convergence_run.h"
#include "src/render/memory_needs.h"
#include "src/render/output.h"
#include "src/sampling/seed.h"

namespace dapple {

namespace {

/// Far from the seeds that people choose.
constexpr int kReferenceSeed = 0x5eedf00d;

Film FilmOf(const Scene& scene) {
  return Film(scene.Settings().resolution, scene.Settings().crop, scene.Settings().filter);
}

Image Exposed(Image picture, const Scene& scene) {
  for (float& value : picture.Values()) value *= scene.Settings().exposure;
  return picture;
}

class StudyRunner {
 public:
  StudyRunner(const StudyOptions& options, bool isQuiet, const std::atomic<bool>& stop, Diagnostics::Sink warn)
      : options_(options),
        isQuiet_(isQuiet),
        stop_(stop),
        times_(SnapshotTimes(*options.scene.seconds)),
        name_(SceneName(options.scene.scene)),
        diagnostics_(std::move(warn)) {}

  void Check() {
    SceneOf("path", "");
    for (const std::string& integrator : options_.integrators)
      for (const std::string& strategy : Strategies()) SceneOf(integrator, strategy);
  }

  Study Run() {
    const Scene& scene = SceneOf("path", "");
    SceneConvergence& convergence = study_.convergence;
    convergence.name = name_;
    convergence.file = options_.scene.scene;
    convergence.seconds = *options_.scene.seconds;
    AddContenders();
    const ErrorMeter meter(MakeReference(scene));
    convergence.width = meter.Reference().Width();
    convergence.height = meter.Reference().Height();
    study_.pictures.reference = meter.Reference();
    study_.pictures.contenders.resize(convergence.contenders.size());
    firstSeed_ = options_.scene.seed.value_or(scene.Settings().seed.value_or(0));
    try {
      RunContenders(meter);
    } catch (const std::exception& error) {
      study_.failure = ErrorLine(error);
    }
    return std::move(study_);
  }

 private:
  template <typename... Args>
  void Report(fmt::format_string<Args...> format, Args&&... args) const {
    if (!isQuiet_) Tell(fmt::format("{}: {}", name_, fmt::format(format, std::forward<Args>(args)...)));
  }

  /// The scene's own where none is asked for.
  std::vector<std::string> Strategies() const {
    return options_.strategies.empty() ? std::vector<std::string>{""} : options_.strategies;
  }

  /// As it is loaded for that integrator.
  const Scene& SceneOf(const std::string& integrator, const std::string& strategy) {
    std::unique_ptr<Scene>& scene =
        scenes_[{strategy.empty() && IsLeftToDapple(integrator, ""),
                 DrawsTowardLights(integrator, options_.scene.direct.value_or(DirectTechnique::Mis)), strategy}];
    if (!scene) {
      SceneOptions options = options_.scene;
      options.integrator = integrator;
      options.strategy = strategy;
      LoadedScene loaded = Load(options, diagnostics_);
      const std::vector<NamedFile> read = NamedFiles("what the scene is read from", loaded.files);
      if (const auto clash = FindClash(options_.written, read); !clash.empty())
        throw Error(FileLocation(options.scene), clash);
      scene = std::move(loaded.scene);
      RequireFilm(scene->Settings(), {}, false, MachineMemoryBytes());
    }
    return *scene;
  }

  RenderPlan PlanOf(const std::string& integrator, const Scene& scene, std::optional<int> seed = {}) {
    SceneOptions options = options_.scene;
    if (seed) options.seed = seed;
    options.integrator = integrator;
    return MakePlan(scene, options, diagnostics_);
  }

  void AddContenders() {
    for (const std::string& integrator : options_.integrators) {
      for (const std::string& strategy : Strategies()) {
        Contender contender;
        contender.integrator = PlanOf(integrator, SceneOf(integrator, strategy)).choice.name;
        contender.strategy = strategy;
        contender.name = integrator == "auto" ? fmt::format("auto ({})", contender.integrator) : integrator;
        if (!strategy.empty()) contender.name += " " + strategy;
        study_.convergence.contenders.push_back(contender);
        requested_.push_back(integrator);
      }
    }
    std::vector<std::string> integrators;
    for (const Contender& contender : study_.convergence.contenders) integrators.push_back(contender.integrator);
    integrators.erase(std::unique(integrators.begin(), integrators.end()), integrators.end());  // by strategies
    WarnOfUnused(options_.scene, integrators, diagnostics_);
  }

  Image MakeReference(const Scene& scene) {
    return options_.referenceFile.empty() ? RenderReference(scene) : ReadReference(scene);
  }

  Image ReadReference(const Scene& scene) {
    ReferenceInfo& info = study_.convergence.reference;
    info.source = std::filesystem::path(options_.referenceFile).filename().string();
    if (options_.referenceError) {
      info.errors.emplace();
      info.errors->fill(std::numeric_limits<double>::quiet_NaN());
      (*info.errors)[0] = *options_.referenceError;
      info.errorSource = "relative MSE as told by --reference-error";
    } else {
      info.errorSource = "not known: it comes from a file, and no --reference-error was given";
    }
    Image reference = ReadImage(options_.referenceFile);
    // What is rendered must be comparable with it; told now, before hours of work.
    const ComparablePair pair = FitReference(ToPicture(FilmOf(scene), scene.Settings().exposure), reference);
    if (pair.test.Width() != scene.Settings().crop.Width() || pair.test.Height() != scene.Settings().crop.Height())
      throw Error(FileLocation(options_.referenceFile),
                  fmt::format("the reference does not cover what is rendered of {}", options_.scene.scene));
    return pair.reference;
  }

  ComparablePair FitReference(const Image& picture, const Image& reference) const {
    const auto sizeOf = [](const Image& image) { return fmt::format("{} x {}", image.fullSize.x, image.fullSize.y); };
    const FileLocation file(options_.referenceFile);
    if (picture.fullSize != reference.fullSize)
      throw Error(file, fmt::format("the reference is of {} pixels, but {} is rendered with {}", sizeOf(reference),
                                    options_.scene.scene, sizeOf(picture)));
    return AtLocation(file, [&] { return MakeComparable(picture, reference); });
  }

  Image RenderReference(const Scene& scene) {
    const RenderPlan plan = PlanOf(options_.referenceIntegrator, scene, kReferenceSeed);
    Report("reference, {}, {}", plan.choice.name, FormatDuration(options_.referenceSeconds));
    Film film = FilmOf(scene);
    RenderBudget budget;
    budget.seconds = options_.referenceSeconds;
    RenderHooks hooks;
    hooks.stop = &stop_;
    const RenderResult result =
        Render(scene, SeedFrom(kReferenceSeed), *plan.integrator, film, budget, hooks, plan.seconds);
    if (film.PassCount() == 0)
      throw Error(fmt::format("stopped before the reference of {} had a pass", options_.scene.scene));
    ReferenceInfo& info = study_.convergence.reference;
    info.source = fmt::format("{}, {} in {}", plan.choice.name, FormatNumberOf(film.PassCount(), "pass", "passes"),
                              FormatDuration(result.seconds));
    info.errors = ErrorsOfNoise(film, scene.Settings().exposure);
    info.errorSource = info.errors ? "noise, estimated from its half-images; bias is not seen"
                                   : "not known: it has one pass only, and so no half-images";
    return ToPicture(film, scene.Settings().exposure);
  }

  void RunContenders(const ErrorMeter& meter) {
    for (int k = 0; k < options_.seeds; ++k) {
      // Behind the greatest seed comes the least.
      const int seed = static_cast<int>(static_cast<uint32_t>(firstSeed_) + static_cast<uint32_t>(k));
      for (size_t i = 0; i < study_.convergence.contenders.size() && !stop_; ++i) RunContender(i, seed, k == 0, meter);
    }
  }

  void RunContender(size_t index, int seed, bool keepsPictures, const ErrorMeter& meter) {
    Contender& contender = study_.convergence.contenders[index];
    const Scene& scene = SceneOf(requested_[index], contender.strategy);
    const RenderPlan plan = PlanOf(requested_[index], scene, seed);
    Film film = FilmOf(scene);
    const ConvergenceRun run =
        RunWithSnapshots(scene, SeedFrom(seed), *plan.integrator, times_, film, {}, &stop_, plan.seconds);
    if (run.stopped) return;
    SeedRun result{seed, run.prepareSeconds, run.seconds, run.snapshotSeconds, run.passes, {}};
    for (const Snapshot& snapshot : run.snapshots) {
      const Image picture = Exposed(snapshot.picture, scene);
      result.snapshots.push_back({snapshot.timeIndex, snapshot.seconds, snapshot.passes, meter.Measure(picture)});
      if (keepsPictures && IsPictured(snapshot.timeIndex)) Keep(index, snapshot, picture, meter.Reference());
    }
    Report("{}, seed {}: {} in {}, relative MSE {:.3g}", contender.name, seed,
           FormatNumberOf(run.passes, "pass", "passes"), FormatDuration(run.seconds),
           result.snapshots.back().errors[0]);
    contender.seeds.push_back(std::move(result));
  }

  /// Every fourth time, each four times the one before, counted from the last.
  bool IsPictured(int timeIndex) const {
    const int fromLast = static_cast<int>(times_.size()) - 1 - timeIndex;
    return fromLast % 4 == 0 && fromLast / 4 < options_.imageTimes;
  }

  void Keep(size_t index, const Snapshot& snapshot, const Image& picture, const Image& reference) {
    const Image difference = FalseColorLogarithmic(RelativeErrors(picture, reference), 1e-3, 1);
    study_.pictures.contenders[index].push_back(
        {snapshot.timeIndex, snapshot.seconds, snapshot.passes, EncodePng(picture), EncodePng(difference)});
  }

  const StudyOptions& options_;
  bool isQuiet_;
  const std::atomic<bool>& stop_;
  std::vector<double> times_;
  std::string name_;
  Diagnostics diagnostics_;
  /// For "auto" or not, for algorithms that draw toward lights or not, by strategy.
  std::map<std::tuple<bool, bool, std::string>, std::unique_ptr<Scene>> scenes_;
  std::vector<std::string> requested_;  ///< of each contender; "auto" too
  int firstSeed_ = 0;
  Study study_;
};

}  // namespace

bool Study::HasRuns() const {
  return std::ranges::any_of(convergence.contenders, [](const Contender& c) { return !c.seeds.empty(); });
}

void CheckScene(const StudyOptions& options) {
  const std::atomic<bool> stop = false;
  StudyRunner(options, true, stop, [](const std::string&) {}).Check();
}

Study RunStudy(const StudyOptions& options, bool isQuiet, const std::atomic<bool>& stop) {
  return StudyRunner(options, isQuiet, stop, Tell).Run();
}

}  // namespace dapple
