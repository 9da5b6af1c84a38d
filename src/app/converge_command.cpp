// `dapple converge`: algorithms compared by error against time, as a page to look at and as data.
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fmt/chrono.h>
#include <nlohmann/json.hpp>

#include "src/app/command.h"
#include "src/app/command_line.h"
#include "src/app/convergence_study.h"
#include "src/app/format.h"
#include "src/app/named_files.h"
#include "src/app/report_page.h"
#include "src/app/signals.h"
#include "src/base/parallel.h"
#include "src/image/atomic_file.h"
#include "src/image/false_color.h"
#include "src/image/image_io.h"
#include "src/render/json_text.h"
#include "src/render/output.h"
#include "src/render/version.h"

namespace dapple {

namespace {

struct ConvergeOptions : StudyOptions {
  std::vector<std::string> scenes;
  std::string folder;
  bool isQuiet = false;
};

using Json = nlohmann::ordered_json;

/// A folder that is there in the end and can be written to.
void MakeFolder(const std::string& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure || !std::filesystem::is_directory(folder))
    throw Error(FileLocation(folder), fmt::format("cannot make the folder: {}", failure.message()));
}

Json About() {
  return {{"version", Version()},
          {"instructionSet", InstructionSet()},
          {"processor", ProcessorName()},
          {"processors", std::thread::hardware_concurrency()},
          {"threads", ThreadCount()},
          {"date", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::chrono::system_clock::now()))},
          {"commandLine", CommandLine()}};
}

Json ToJson(const StudyPictures& pictures) {
  Json json = {{"reference", PngUrl(EncodePng(pictures.reference))}, {"contenders", Json::array()}};
  for (const std::vector<StudyPicture>& ofContender : pictures.contenders) {
    Json list = Json::array();
    for (const StudyPicture& picture : ofContender)
      list.push_back({{"timeIndex", picture.timeIndex},
                      {"seconds", picture.seconds},
                      {"passes", picture.passes},
                      {"picture", PngUrl(picture.picture)},
                      {"difference", PngUrl(picture.difference)}});
    json["contenders"].push_back(list);
  }
  return json;
}

/// The colours of differences, evenly along their scale, as CSS writes them.
Json RampForPage() {
  constexpr int kSteps = 20;
  Json colors = Json::array();
  for (int i = 0; i <= kSteps; ++i) {
    const Color c = Map(RampColor(static_cast<double>(i) / kSteps), EncodeSRgb);
    colors.push_back(fmt::format("rgb({:.0f} {:.0f} {:.0f})", 255 * c.r, 255 * c.g, 255 * c.b));
  }
  return colors;
}

std::string PathOf(const ConvergeOptions& options, const std::string& name) {
  return (std::filesystem::path(options.folder) / name).string();
}

std::string ReferencePath(const ConvergeOptions& options, const std::string& sceneName) {
  return PathOf(options, fmt::format("reference-{}.exr", sceneName));
}

/// The report and the references that are rendered, one a scene, by the scene's name alone.
std::vector<NamedFile> WrittenBy(const ConvergeOptions& options) {
  std::vector<NamedFile> files;
  for (const char* name : {"data.csv", "data.json", "index.html"}) files.push_back({name, PathOf(options, name)});
  if (!options.referenceFile.empty()) return files;
  for (const std::string& scene : options.scenes)
    files.push_back({fmt::format("the reference of {}", scene), ReferencePath(options, SceneName(scene))});
  return files;
}

/// Where a file of it cannot be written the others are; false then, with a word.
bool WriteReport(const ConvergeOptions& options, const std::vector<Study>& studies) {
  std::vector<SceneConvergence> scenes;
  for (const Study& study : studies) scenes.push_back(study.convergence);
  Json data = ConvergenceToJson(scenes, About());
  const auto write = [&](const std::string& name, const auto& makeText) {
    const std::string path = PathOf(options, name);
    return TryToWrite(path, [&] { WriteFileAtomically(path, makeText()); });
  };
  bool isWritten = write("data.csv", [&] { return ConvergenceToCsv(scenes); });
  isWritten &= write("data.json", [&] { return DumpJson(data, 1) + "\n"; });
  const bool hasPage = write("index.html", [&] {
    for (size_t i = 0; i < studies.size(); ++i) data["scenes"][i]["pictures"] = ToJson(studies[i].pictures);
    data["ramp"] = RampForPage();
    return ReportPage(data);
  });
  if (!options.isQuiet) Print(ConvergenceToMarkdown(scenes, 0));
  if (hasPage) Print(PathOf(options, "index.html") + "\n");
  return isWritten && hasPage;
}

void TellDuration(const ConvergeOptions& options) {
  const double runs = static_cast<double>(options.integrators.size()) *
                      static_cast<double>(std::max<size_t>(1, options.strategies.size())) * options.seeds;
  const double ofReference = options.referenceFile.empty() ? options.referenceSeconds : 0;
  Tell(fmt::format("about {} of rendering", FormatDuration(static_cast<double>(options.scenes.size()) *
                                                           (runs * *options.scene.seconds + ofReference))));
}

/// One that cannot be read must not cost the studies of those before it. A single one is read before it is rendered
/// anyway.
void CheckScenes(ConvergeOptions options, const std::atomic<bool>& stop) {
  for (const std::string& scene : options.scenes) {
    if (stop) return;
    options.scene.scene = scene;
    CheckScene(options);
  }
}

/// Adds the study of the scene, with all of it that is complete. False, with a word, where something failed.
bool AddStudy(const ConvergeOptions& options, const std::atomic<bool>& stop, std::vector<Study>* studies) {
  try {
    Study study = RunStudy(options, options.isQuiet, stop);
    const Image reference = study.pictures.reference;
    const std::string failure = study.failure;
    const bool hasRuns = study.HasRuns();
    if (hasRuns) studies->push_back(std::move(study));
    if (!failure.empty()) Tell(failure);
    // One that nothing is compared with does not replace another.
    if (hasRuns && options.referenceFile.empty())
      WriteExr(ReferencePath(options, SceneName(options.scene.scene)), reference);
    return failure.empty();
  } catch (const std::exception& error) {
    Tell(ErrorLine(error));
    return false;
  }
}

int RunConverge(ConvergeOptions options) {
  const StopSignals signals;
  MakeFolder(options.folder);
  options.written = WrittenBy(options);
  for (const NamedFile& file : options.written) CheckFolder(file.path);
  const ThreadLimit threads(options.scene.threads);
  if (options.referenceSeconds == 0) options.referenceSeconds = 10 * *options.scene.seconds;
  if (!options.isQuiet) TellDuration(options);
  if (options.scenes.size() > 1) CheckScenes(options, signals.Flag());
  std::vector<Study> studies;
  bool isWhole = true;
  for (size_t i = 0; i < options.scenes.size() && !signals.Flag(); ++i) {
    options.scene.scene = options.scenes[i];
    isWhole &= AddStudy(options, signals.Flag(), &studies);
  }
  if (studies.empty()) {
    if (signals.Flag()) Tell("stopped before the first run was complete; no report is written");
    return kExitFailure;
  }
  if (!WriteReport(options, studies)) return kExitFailure;
  if (signals.Flag()) return 128 + signals.Signal();
  return isWhole ? kExitSuccess : kExitFailure;
}

void AddReferenceGroup(CLI::App* command, ConvergeOptions* options) {
  const std::string group = "Reference";
  CLI::Option* const file =
      command->add_option("--reference", options->referenceFile, "The image that counts as true; else one is rendered")
          ->type_name("FILE")
          ->group(group);
  command
      ->add_option("--reference-error", options->referenceError,
                   "The relative MSE that the file itself has, shown as a band")
      ->check(CheckPositive)
      ->needs(file)
      ->type_name("E")
      ->group(group);
  command->add_option("--reference-integrator", options->referenceIntegrator, "What renders it; by default auto")
      ->check(CLI::IsMember(IntegratorChoices()).description(""))
      ->excludes(file)
      ->type_name("NAME")
      ->group(group);
  command->add_option("--reference-time", options->referenceSeconds, "How long; by default ten times --time")
      ->check(CheckPositive)
      ->excludes(file)
      ->type_name("SECONDS")
      ->group(group);
}

}  // namespace

void AddConvergeCommand(CLI::App& program, Action* action) {
  CLI::App* const command = program.add_subcommand("converge", "Compare algorithms: error against time, as a page");
  const auto options = std::make_shared<ConvergeOptions>();
  command->add_option("scenes", options->scenes, "Scenes: .pbrt or .pbrt.gz files")->required()->type_name("FILE");
  command->add_option("--integrators", options->integrators, "Which to compare, as in path,sppm")
      ->required()
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(IntegratorChoices()).description(""))
      ->type_name("A,B,...");
  command->add_option("--time", options->scene.seconds, "How long each renders, with each seed")
      ->required()
      ->check(CheckPositive)
      ->type_name("SECONDS");
  command
      ->add_option("--seeds", options->seeds,
                   "Runs of each with seeds of their own: their spread gives the slopes' intervals; 3 by default")
      ->check(CheckWhole(1, 1000))
      ->type_name("N");
  command
      ->add_option(
          "--strategies", options->strategies,
          "Each algorithm with each of these for infinite lights: uniform, cosine, importance, irradiance, "
          "compensated, structured or product, for emission too where it knows the name; SAMPLING/EMISSION sets both")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("A,B,...");
  command->add_option("-o,--output", options->folder, "Folder for index.html, data.csv and data.json; made if missing")
      ->required()
      ->type_name("FOLDER");
  command->add_option("--images", options->imageTimes, "Pictures at N times in the page, each four times the last; 5")
      ->check(CheckWhole(1, 5))
      ->type_name("N");
  command->add_flag("--quiet", options->isQuiet, "No progress; warnings and errors only");
  AddReferenceGroup(command, options.get());
  options->scene.AddFixedTo(command);
  command->callback([options, action] {
    if (!options->referenceFile.empty() && options->scenes.size() > 1)
      throw CLI::ValidationError("--reference", "it is of one scene, and several were given");
    RequireDirect(options->scene, options->integrators);
    RequireDirect(options->scene, {options->referenceIntegrator});
    std::vector<NamedFile> read = NamedFiles("the scene", options->scenes);
    if (!options->referenceFile.empty()) read.push_back({"--reference", options->referenceFile});
    RequireNoClash(WrittenBy(*options), read);
    *action = [options] { return RunConverge(*options); };
  });
}

}  // namespace dapple
