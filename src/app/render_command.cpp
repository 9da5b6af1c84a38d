// `dapple render`: reads a scene, renders it within a budget, writes the picture.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Option.hpp>

#include "src/app/command.h"
#include "src/app/format.h"
#include "src/app/memory.h"
#include "src/app/named_files.h"
#include "src/app/progress_display.h"
#include "src/app/render_outputs.h"
#include "src/app/render_summary.h"
#include "src/app/scene_options.h"
#include "src/app/signals.h"
#include "src/base/parallel.h"
#include "src/image/atomic_file.h"
#include "src/render/checkpoint.h"
#include "src/render/driver.h"
#include "src/render/memory_needs.h"
#include "src/render/snapshots.h"
#include "src/render/statistics.h"
#include "src/sampling/seed.h"

namespace dapple {

namespace {

struct RenderOptions : SceneOptions {
  std::vector<std::string> outputs;
  std::string statistics;
  AovSet aovs;
  std::optional<float> clamp;   ///< `Film::ClampTo`
  std::optional<double> error;  ///< at which the render ends
  std::optional<double> checkpointSeconds;
  bool resumes = false;
  std::optional<SnapshotSchedule> snapshots;
  std::optional<int64_t> memoryLimit;  ///< bytes
  bool isQuiet = false;
  bool recordsSeconds = false;
};

/// In the current folder: the name that the scene's film gives, or the scene's own, as an EXR file; for a range of
/// passes with the range, as the exact sums.
std::string DefaultOutput(const RenderOptions& options, const RenderSettings& settings) {
  const std::filesystem::path named = std::filesystem::path(settings.outputFile).filename();
  const std::string name = named.empty() ? SceneName(options.scene) : named.stem().string();
  if (options.isPart) return fmt::format("{}.{}-{}.dapple", name, options.passes->begin, options.passes->end);
  return name + ".exr";
}

/// Whether a picture with its layers is written; a part's sums only keep what these follow from.
bool WritesLayers(const RenderOptions& options) {
  return options.outputs.empty() ? !options.isPart : std::ranges::any_of(options.outputs, HoldsLayers);
}

/// All that is written under a name of its own; of snapshots see `FindClashOf`.
std::vector<NamedFile> WrittenBy(const RenderOptions& options) {
  std::vector<NamedFile> files = NamedFiles("--output", options.outputs);
  if (!options.outputs.empty()) {
    files.push_back({"the checkpoint", Checkpoint::PathFor(options.outputs[0])});
    files.push_back({"the older checkpoint", Checkpoint::OlderPathFor(options.outputs[0])});
  }
  if (!options.statistics.empty()) files.push_back({"--stats", options.statistics});
  return files;
}

/// `FindClash` of all that is written, and of the snapshots with that and with what is read.
std::string FindClashOf(const RenderOptions& options, const std::vector<NamedFile>& read) {
  std::vector<NamedFile> written = WrittenBy(options);
  const std::string clash = FindClash(written, read);
  if (!clash.empty() || !options.snapshots) return clash;
  written.insert(written.end(), read.begin(), read.end());
  return FindSnapshotClash(options.outputs, written);
}

void PrintStart(const RenderOptions& options, const Scene& scene, const RenderPlan& plan) {
  const Vec2i& resolution = scene.Settings().resolution;
  Tell(fmt::format("{}: {} x {}, {} ({}), {}", options.scene, resolution.x, resolution.y, plan.choice.name,
                   plan.choice.reason, FormatNumberOf(ThreadCount(), "thread", "threads")));
}

RenderOrigin MakeOrigin(const RenderOptions& options, const LoadedScene& loaded, const RenderPlan& plan,
                        const Film& film) {
  RenderOrigin origin;
  origin.identity = MakeIdentity(loaded.identity, film, options.aovs, plan.choice.name, plan.options, plan.seed);
  origin.record.scene = std::filesystem::path(options.scene).filename().string();
  origin.record.integrator = plan.choice.name;
  origin.record.seed = plan.seed;
  origin.record.clamp = film.Clamp();
  origin.exposure = loaded.scene->Settings().exposure;
  origin.aovs = options.aovs;
  return origin;
}

/// Whether the bias of density estimates is to be known.
bool TracksBlur(const RenderOptions& options, const RenderPlan& plan) {
  return options.error && plan.integrator->EstimatesDensity();
}

Film EmptyFilm(const RenderOptions& options, const RenderSettings& settings, const RenderPlan& plan) {
  Film film(settings.resolution, settings.crop, settings.filter);
  if (options.clamp) film.ClampTo(*options.clamp);
  if (const auto channels = FilmChannels(options.aovs); !channels.empty()) film.AddExtraChannels(channels);
  if (TracksBlur(options, plan)) film.TrackBlur();
  return film;
}

void CheckMemory(const RenderOptions& options, const Scene& scene, const RenderPlan& plan) {
  if (!options.memoryLimit) return;
  const MemoryNeeds needs = EstimateMemory(scene, options.aovs, *plan.integrator, plan.options, SeedFrom(plan.seed),
                                           TracksBlur(options, plan));
  RequireMemory(*options.memoryLimit, CurrentMemoryBytes(), needs);
}

/// What was rendered before; nothing where there is no checkpoint.
std::optional<Film> Resume(const RenderOptions& options, const RenderPlan& plan, Checkpoint& checkpoint) {
  std::optional<Film> saved = checkpoint.Load(plan.budget);
  if (!options.isQuiet) {
    Tell(saved ? fmt::format("{}: going on after {}", checkpoint.Path(),
                             FormatNumberOf(saved->PassCount(), "pass", "passes"))
               : fmt::format("{}: not there yet; beginning with the first pass", checkpoint.Path()));
  }
  return saved;
}

/// What is done between passes: progress is shown, the state saved, pictures taken on the way. Where one of these
/// cannot be written there is a warning, and the render goes on.
class BetweenPasses {
 public:
  BetweenPasses(const RenderOptions& options, const RenderOrigin& origin, Checkpoint& checkpoint)
      : origin_(origin),
        checkpoint_(checkpoint),
        snapshots_(options.snapshots),
        memoryLimit_(options.memoryLimit),
        outputs_(options.outputs) {
    std::erase_if(outputs_, IsStateName);
    if (!options.isQuiet) display_.emplace(origin.exposure);
  }

  void operator()(const RenderProgress& progress) {
    if (display_) display_->Show(progress);
    if (const std::optional<Error> error = checkpoint_.Update(progress))
      Tell(fmt::format("warning: no checkpoint was written, the one before it stays: {}", error->what()));
    if (snapshots_ && snapshots_->IsDue(progress)) TakeSnapshot(*progress.film);
    if (memoryLimit_ && PeakMemoryBytes() > *memoryLimit_) WarnOfMemory();
  }

 private:
  void WarnOfMemory() {
    Tell(fmt::format("warning: {} of memory were in use, more than the limit that was set",
                     FormatBytes(static_cast<double>(PeakMemoryBytes()))));
    memoryLimit_.reset();
  }

  void TakeSnapshot(const Film& film) const {
    RenderRecord record = origin_.record;
    record.passes = static_cast<int>(film.PassCount());
    std::vector<std::string> paths;
    for (const std::string& output : outputs_) paths.push_back(SnapshotName(output, record.passes));
    for (const std::string& error : WriteRenderOutputs(paths, origin_, record, film).errors)
      Tell(fmt::format("warning: a snapshot was not written: {}", error));
  }

  const RenderOrigin& origin_;
  Checkpoint& checkpoint_;
  std::optional<SnapshotSchedule> snapshots_;
  std::optional<int64_t> memoryLimit_;  ///< nothing once it was passed and told
  std::vector<std::string> outputs_;
  std::optional<ProgressDisplay> display_;
};

RenderResult RenderWithProgress(const RenderOptions& options, const Scene& scene, const RenderPlan& plan,
                                const RenderOrigin& origin, const StopSignals& signals, Checkpoint& checkpoint,
                                Film& film) {
  BetweenPasses betweenPasses(options, origin, checkpoint);
  const RenderHooks hooks{.onProgress = std::ref(betweenPasses), .stop = &signals.Flag()};
  return Render(scene, SeedFrom(plan.seed), *plan.integrator, film, plan.budget, hooks, plan.seconds);
}

RenderRecord MakeRecord(const RenderOptions& options, const RenderOrigin& origin, double seconds, const Film& film,
                        const std::optional<ErrorEstimate>& error) {
  RenderRecord record = origin.record;
  record.passes = static_cast<int>(film.PassCount());
  if (options.seconds || options.recordsSeconds) record.seconds = seconds;
  if (options.error && error) record.error = error->Total();
  return record;
}

/// A picture that is not as good as was asked for must not go unnoticed.
void WarnOfError(const RenderOptions& options, const Film& film, const std::optional<ErrorEstimate>& error) {
  if (!options.error || (error && error->Total() < *options.error)) return;
  if (error) {
    Tell(fmt::format("warning: the error is about {:.3g}, not below {:g}", error->Total(), *options.error));
  } else {
    Tell(film.PassCount() < 2 ? "warning: the error of a single pass cannot be estimated"
                              : "warning: the memory does not suffice to estimate the error");
  }
}

/// What stands on the disk in the end.
struct Kept {
  RenderRecord record;
  std::optional<ErrorEstimate> error;  ///< where it was asked for
  WrittenOutputs outputs;
  bool needsState = false;  ///< the state is to be saved: as was asked for, or for want of an output
  bool hasState = false;

  bool IsWhole() const { return outputs.errors.empty() && hasState == needsState; }
};

/// What is worth most comes first: the sums, from which all else can be made, then the results. What fails is told and
/// costs nothing else.
Kept WriteResults(const RenderOptions& options, const RenderOrigin& origin, const RenderResult& result,
                  const Film& film, Checkpoint& checkpoint) {
  Kept kept;
  const auto save = [&] {
    kept.needsState = true;
    kept.hasState = TryToWrite(checkpoint.Path(), [&] { checkpoint.Save(film, result.seconds); });
  };
  if (options.checkpointSeconds || options.resumes || result.stopped) save();
  if (options.error) kept.error = EstimateError(film, origin.exposure);
  kept.record = MakeRecord(options, origin, checkpoint.SecondsBefore() + result.seconds, film, kept.error);
  kept.outputs = WriteRenderOutputs(options.outputs, origin, kept.record, film);
  for (const std::string& line : kept.outputs.errors) Tell(line);
  if (!kept.outputs.errors.empty() && !kept.needsState) save();
  return kept;
}

/// Where a signal ended the render or a result is missing.
void TellHowToGoOn(const Kept& kept, const RenderResult& result, const Film& film, const Checkpoint& checkpoint) {
  if (!kept.hasState || (!result.stopped && kept.outputs.errors.empty())) return;
  Tell(fmt::format("{} {}; to go on, give the same command with --resume (it reads {})",
                   result.stopped ? "stopped after" : "kept:", FormatNumberOf(film.PassCount(), "pass", "passes"),
                   checkpoint.Path()));
}

/// Where a signal came before the first pass was done.
int NothingWritten() {
  Tell("stopped before the first pass was done; nothing is written");
  return kExitFailure;
}

/// Where a pass fails: what it added already cannot be told from what was before, so only a checkpoint helps.
int Fail(const std::exception& error, const Film& film, const Checkpoint& checkpoint) {
  Tell(ErrorLine(error));
  if (checkpoint.PassesSaved() > 0) {
    Tell(fmt::format("{} holds {}; to go on with them, give the same command with --resume", checkpoint.Path(),
                     FormatNumberOf(checkpoint.PassesSaved(), "pass", "passes")));
  } else if (film.PassCount() > 0) {
    Tell(fmt::format("nothing is kept of {}: no checkpoint was saved (see --checkpoint)",
                     FormatNumberOf(film.PassCount(), "pass", "passes")));
  }
  return kExitFailure;
}

/// Writes all that was asked for and tells what was done; returns the exit code.
int Finish(const RenderOptions& options, const RenderOrigin& origin, const RenderResult& result,
           const RenderNeeds& needs, const Film& film, int signal, Checkpoint& checkpoint) {
  if (film.PassCount() == 0) return NothingWritten();
  const Kept kept = WriteResults(options, origin, result, film, checkpoint);
  WarnOfVariance(kept.outputs.paths, origin.aovs, film);
  WarnOfNonFinite(film);
  WarnOfError(options, film, kept.error);
  TellHowToGoOn(kept, result, film, checkpoint);
  std::optional<ErrorEstimate> error = kept.error;
  if (!error && !(options.isQuiet && options.statistics.empty())) error = EstimateError(film, origin.exposure);
  const bool hasStatistics =
      options.statistics.empty() || TryToWrite(options.statistics, [&] {
        WriteFileAtomically(options.statistics, StatisticsToJson(kept.record, result, needs, film, error));
      });
  if (!options.isQuiet) {
    for (const std::string& path : kept.outputs.paths) Print(path + "\n");
    PrintSummary(result, needs, film, error);
  }
  if (!kept.IsWhole()) return kExitFailure;
  if (result.stopped) return 128 + signal;
  return hasStatistics ? kExitSuccess : kExitFailure;
}

/// What can be told before the scene is read.
void CheckOutputs(const RenderOptions& options) {
  for (const std::string& output : options.outputs) CheckRenderOutput(output);
  if (!options.statistics.empty()) CheckFolder(options.statistics);
}

/// What takes the scene to be known: names that it gives, files that it reads.
void CheckFiles(RenderOptions* options, const LoadedScene& loaded) {
  if (options->outputs.empty()) {
    options->outputs.push_back(DefaultOutput(*options, loaded.scene->Settings()));
    CheckRenderOutput(options->outputs[0]);
  }
  if (options->checkpointSeconds || options->resumes) CheckFolder(Checkpoint::PathFor(options->outputs[0]));
  if (options->checkpointSeconds && !options->resumes) CheckFolder(Checkpoint::OlderPathFor(options->outputs[0]));
  const std::vector<NamedFile> read = NamedFiles("what the scene is read from", loaded.files);
  if (const auto clash = FindClashOf(*options, read); !clash.empty()) throw Error(FileLocation(options->scene), clash);
}

/// The plan, of which nothing more stands in the way of the render.
RenderPlan CheckedPlan(const RenderOptions& options, const Scene& scene, Diagnostics& diagnostics) {
  RenderPlan plan = MakePlan(scene, options, diagnostics);
  WarnOfUnused(options, {plan.choice.name}, diagnostics);
  RequireFilm(scene.Settings(), options.aovs, TracksBlur(options, plan), MachineMemoryBytes());
  plan.budget.error = options.error;
  // What the scene's file says bounds no one who asks for an error.
  if (options.error && !options.passes) plan.budget.passes.reset();
  if (options.aovs.variance && plan.budget.passes == 1 && WritesLayers(options))
    throw Error(
        FileLocation(options.scene),
        fmt::format("--aov variance needs two passes at least, and {} make one: see --passes", plan.budgetReason));
  if (!scene.Facts().EmitsLight() && scene.Facts().blackLights > 0) {
    diagnostics.Warn(FileLocation(options.scene), "none of the lights emits anything; the image will be black");
  }
  CheckMemory(options, scene, plan);
  return plan;
}

void TellSetAside(const std::string& older) {
  Tell(fmt::format("warning: a checkpoint was there that this render does not go on from; it is now {}", older));
}

int RunRender(RenderOptions options) {
  // What comes before the first pass cannot be interrupted, but it is the end where a signal came in it.
  const StopSignals signals;
  CheckOutputs(options);
  const ThreadLimit threads(options.threads);
  Diagnostics diagnostics(Tell);
  const LoadedScene loaded = Load(options, diagnostics);
  const Scene& scene = *loaded.scene;
  CheckFiles(&options, loaded);
  if (signals.Flag()) return NothingWritten();
  const RenderPlan plan = CheckedPlan(options, scene, diagnostics);
  if (signals.Flag()) return NothingWritten();
  std::optional<Film> film = EmptyFilm(options, scene.Settings(), plan);
  const RenderOrigin origin = MakeOrigin(options, loaded, plan, *film);
  Checkpoint checkpoint(options.outputs[0], origin, options.checkpointSeconds, TellSetAside);
  if (!options.isQuiet) PrintStart(options, scene, plan);
  if (options.resumes) {
    film.reset();  // the file takes as much memory
    film = Resume(options, plan, checkpoint);
    if (!film) film = EmptyFilm(options, scene.Settings(), plan);
  }
  RenderResult result;
  try {
    result = RenderWithProgress(options, scene, plan, origin, signals, checkpoint, *film);
  } catch (const std::exception& error) {
    return Fail(error, *film, checkpoint);
  }
  RenderNeeds needs{scene.Resources(), plan.integrator->Preparation()};
  needs.preparation.pilots += plan.choice.pilots;
  return Finish(options, origin, result, needs, *film, signals.Signal(), checkpoint);
}

/// A snapshot is a picture, of outputs that are one.
bool HasNoPicture(const RenderOptions& options) {
  return options.outputs.empty() ? options.isPart : std::ranges::all_of(options.outputs, IsStateName);
}

SnapshotSchedule ParseSnapshots(const std::string& text) {
  if (text == "times") return SnapshotSchedule::AtTimes(1, 2);
  int passes = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), passes);
  if (status == std::errc() && end == text.data() + text.size() && passes >= 1)
    return SnapshotSchedule::EveryPasses(passes);
  throw CLI::ValidationError("--snapshots", fmt::format("expected a number of passes >= 1, or times, not '{}'", text));
}

/// "500M", "4G", in powers of 1000, to bytes.
int64_t ParseMemory(const std::string& text) {
  double number = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string unit(end, text.data() + text.size());
  const double factor = unit.empty() ? 1 : unit == "k" ? 1e3 : unit == "M" ? 1e6 : unit == "G" ? 1e9 : 0;
  if (status == std::errc() && number * factor >= 1 && number * factor < 1e18)
    return static_cast<int64_t>(number * factor);
  throw CLI::ValidationError("--memory", fmt::format("expected a number of bytes, as in 500M or 4G, not '{}'", text));
}

AovSet ParseAovOption(const std::string& text) {
  const std::optional<AovSet> aovs = ParseAovs(text);
  if (aovs && !text.empty()) return *aovs;
  throw CLI::ValidationError("--aov",
                             fmt::format("expected some of albedo,normal,depth,position,variance, not '{}'", text));
}

/// What bounds the error, or gives up on it.
void AddErrorOptions(CLI::App* command, RenderOptions* options) {
  const std::string group = command->get_option("--passes")->get_group();
  command
      ->add_option("--clamp", options->clamp,
                   "The most that one sample adds to a pixel of a pass, in any channel; by default there is no such "
                   "bound. Takes fireflies away, and energy with them; recorded in the file")
      ->check(CheckPositive)
      ->type_name("VALUE")
      ->group(group);
  command
      ->add_option("--error", options->error,
                   "Render until the estimated relative error, noise and bias together, is below E (0.01: one per "
                   "cent), or to --passes or --time. It is the root of the relative MSE that `dapple compare` would "
                   "measure against the converged picture; what the algorithm cannot find is not in it")
      ->check(CheckPositive)
      ->excludes("--clamp")
      ->type_name("E")
      ->group(group);
}

/// What a render leaves behind, beside the picture.
void AddFilesGroup(CLI::App* command, RenderOptions* options) {
  const std::string group = "Files";
  command
      ->add_option(
          "--checkpoint", options->checkpointSeconds,
          "Save the state every so often, and in the end, beside the first output (OUTPUT.checkpoint); one that is "
          "there, and that --resume did not go on from, becomes OUTPUT.checkpoint.old")
      ->check(CheckPositive)
      ->type_name("SECONDS")
      ->group(group);
  command
      ->add_flag("--resume", options->resumes,
                 "Go on from OUTPUT.checkpoint, which --checkpoint, Ctrl-C and SIGTERM write; the picture is that of a "
                 "render without a break. Where there is none the render begins with its first pass")
      ->group(group);
  command
      ->add_option_function<std::string>(
          "--snapshots", [options](const std::string& text) { options->snapshots = ParseSnapshots(text); },
          "Write pictures on the way, as OUTPUT with the number of passes in its name: every N passes, or at times: "
          "after 1, 2, 4, 8, ... seconds. Of outputs that are pictures")
      ->type_name("N|times")
      ->group(group);
  command
      ->add_option_function<std::string>(
          "--aov", [options](const std::string& text) { options->aovs = ParseAovOption(text); },
          "Layers of the EXR file beside the picture, some of albedo,normal,depth,position,variance")
      ->type_name("NAMES")
      ->group(group);
  command->add_option("--stats", options->statistics, "Write what the render did (rays, photons, seconds) as JSON")
      ->type_name("FILE.json")
      ->group(group);
  command
      ->add_flag("--record-seconds", options->recordsSeconds,
                 "Record in the file how long the render took, with --passes too; else the same seed and passes give "
                 "the same file")
      ->group(group);
}

/// Throws `CLI::ValidationError` for options that are right one by one and not together.
void RequireUsable(const RenderOptions& options) {
  if (options.error && options.isPart)
    throw CLI::ValidationError("--error", "it is of the whole picture, not of a range of passes");
  if (options.snapshots && HasNoPicture(options))
    throw CLI::ValidationError("--snapshots", "they are pictures: give an --output that is one, .exr or .png");
  const bool keepsSums = std::ranges::any_of(options.outputs, IsStateName);
  if (!options.aovs.IsEmpty() && !options.outputs.empty() && !keepsSums && !WritesLayers(options))
    throw CLI::ValidationError("--aov", "no output holds layers: give one that is .exr");
  if (options.aovs.variance && options.passes && options.passes->Count() == 1 && WritesLayers(options))
    throw CLI::ValidationError("--aov", "the variance needs two passes at least");
  RequireDirect(options, {options.integrator});
  if (const auto clash = FindClashOf(options, {{"the scene", options.scene}}); !clash.empty())
    throw CLI::ValidationError(clash);
}

}  // namespace

void AddRenderCommand(CLI::App& program, Action* action) {
  CLI::App* const command = program.add_subcommand("render", "Render a scene to an image file");
  const auto options = std::make_shared<RenderOptions>();
  command
      ->add_option("-o,--output", options->outputs,
                   "The picture: .exr (linear, all digits) or .png (sRGB); or .dapple, the exact sums for `dapple "
                   "merge`. May be given several times. By default the name that the scene gives, as .exr in the "
                   "current folder")
      ->check(CheckResultName)
      ->allow_extra_args(false)
      ->type_name("FILE");
  options->AddTo(command);
  AddErrorOptions(command, options.get());
  AddFilesGroup(command, options.get());
  command
      ->add_option_function<std::string>(
          "--memory", [options = options.get()](const std::string& text) { options->memoryLimit = ParseMemory(text); },
          "The memory that the render may take, as in 500M or 4G: where scene, film and photons need more, it does not "
          "start, and says what takes how much")
      ->type_name("LIMIT");
  command->add_flag("--quiet", options->isQuiet, "No progress and no summary; warnings and errors only");
  command->callback([options, action] {
    RequireUsable(*options);
    *action = [options] { return RunRender(*options); };
  });
}

}  // namespace dapple
