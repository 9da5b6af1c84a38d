#include "src/app/scene_options.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <new>
#include <sstream>
#include <string_view>

#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/app/named_files.h"
#include "src/image/image_io.h"
#include "src/io/build_context.h"
#include "src/io/nearest_name.h"
#include "src/io/pbrt_parser.h"
#include "src/io/scene_hash.h"
#include "src/sampling/seed.h"

namespace dapple {

namespace {

constexpr int kLeast = std::numeric_limits<int>::min(), kMost = std::numeric_limits<int>::max();
constexpr int kMaxCameraSamples = 1 << 12;

/// The numbers of `text`, which `separator` parts; nothing where it holds anything else.
template <typename T>
std::optional<std::vector<T>> SplitNumbers(const std::string& text, char separator) {
  std::vector<T> numbers;
  std::istringstream stream(text);
  for (T number; stream >> number;) {
    numbers.push_back(number);
    if (stream.eof()) return numbers;
    if (stream.get() != separator) return std::nullopt;
  }
  return std::nullopt;
}

/// Pictures that could not be written are refused before they are rendered.
Vec2i ParseResolution(const std::string& text) {
  const auto sizes = SplitNumbers<int>(text, 'x');
  const auto isSide = [](int size) { return size >= 1 && size <= kMaxImageSide; };
  if (!sizes || sizes->size() != 2 || !isSide((*sizes)[0]) || !isSide((*sizes)[1])) {
    throw CLI::ValidationError(
        "--resolution", fmt::format("expected WIDTHxHEIGHT in pixels, as in 640x480 and at most {} each, not '{}'",
                                    kMaxImageSide, text));
  }
  return {(*sizes)[0], (*sizes)[1]};
}

std::array<double, 4> ParseCrop(const std::string& text) {
  const auto n = SplitNumbers<double>(text, ',');
  const auto isFraction = [](double low, double high) { return low >= 0 && low < high && high <= 1; };
  if (!n || n->size() != 4 || !isFraction((*n)[0], (*n)[1]) || !isFraction((*n)[2], (*n)[3])) {
    throw CLI::ValidationError(
        "--crop", fmt::format("expected x0,x1,y0,y1 as fractions of the picture, 0 <= x0 < x1 <= 1, not '{}'", text));
  }
  return {(*n)[0], (*n)[1], (*n)[2], (*n)[3]};
}

void ParsePasses(const std::string& text, SceneOptions* options) {
  const auto n = SplitNumbers<int>(text, ':');
  options->isPart = n && n->size() == 2;
  if (n && n->size() <= 2) options->passes = options->isPart ? PassRange{(*n)[0], (*n)[1]} : PassRange{0, (*n)[0]};
  if (options->passes && options->passes->begin >= 0 && !options->passes->IsEmpty()) return;
  throw CLI::ValidationError(
      "--passes", fmt::format("expected a whole number N from 1 to {0}, or a range A:B with 0 <= A < B <= {0}, "
                              "not '{1}'",
                              kMost, text));
}

DirectTechnique ParseDirect(const std::string& text) {
  if (text == "mis") return DirectTechnique::Mis;
  if (text == "light") return DirectTechnique::Light;
  if (text == "bsdf") return DirectTechnique::Bsdf;
  throw CLI::ValidationError("--direct", fmt::format("expected mis, light or bsdf, not '{}'", text));
}

KernelShape ParseKernel(const std::string& text) {
  if (text == "epanechnikov") return KernelShape::Epanechnikov;
  if (text == "cone") return KernelShape::Cone;
  throw CLI::ValidationError("--kernel", fmt::format("expected epanechnikov or cone, not '{}'", text));
}

constexpr const char* kSceneGroup = "Scene";

void AddVersion(CLI::App* command, SceneOptions* options) {
  command
      ->add_option("--pbrt-version", options->pbrtVersion,
                   "Read the file as of this version of pbrt; found from the text otherwise")
      ->check(CLI::IsMember({3, 4}).description(""))
      ->type_name("3|4")
      ->group(kSceneGroup);
}

void AddPictureGroup(CLI::App* command, SceneOptions* options) {
  command
      ->add_option_function<std::string>(
          "--resolution", [options](const std::string& text) { options->resolution = ParseResolution(text); },
          "Size of the picture in pixels")
      ->type_name("WxH")
      ->group(kSceneGroup);
  command
      ->add_option_function<std::string>(
          "--crop", [options](const std::string& text) { options->crop = ParseCrop(text); },
          "The part to render, in fractions of the picture")
      ->type_name("X0,X1,Y0,Y1")
      ->group(kSceneGroup);
}

const char* const kRenderGroup = "Rendering (what is not given is the scene's)";

void AddBudgetGroup(CLI::App* command, SceneOptions* options) {
  const std::string group = kRenderGroup;
  const std::vector<std::string> names = IntegratorChoices();
  command->add_option("--integrator", options->integrator, fmt::format("{}", fmt::join(names, ", ")))
      ->check(CLI::IsMember(names).description(""))
      ->type_name("NAME")
      ->group(group);
  CLI::Option* const passes = command
                                  ->add_option_function<std::string>(
                                      "--passes", [options](const std::string& text) { ParsePasses(text, options); },
                                      "Render N passes; or, of the whole, passes A to B - 1, for `dapple merge`")
                                  ->type_name("N|A:B")
                                  ->group(group);
  command->add_option("--time", options->seconds, "Render for so long, to within a pass")
      ->check(CheckPositive)
      ->excludes(passes)
      ->type_name("SECONDS")
      ->group(group);
}

void AddAlgorithmGroup(CLI::App* command, SceneOptions* options) {
  const std::string group = kRenderGroup;
  command->add_option("--seed", options->seed, "Seed of all random numbers")
      ->check(CheckWhole(kLeast, kMost))
      ->type_name("N")
      ->group(group);
  command->add_option("--max-depth", options->maxDepth, "Scattering events on a path")
      ->check(CheckWhole(0, kMostDepth))
      ->type_name("N")
      ->group(group);
  command
      ->add_option("--camera-samples", options->cameraSamples,
                   "path: as many rays a pass as N camera paths a pixel take, more of them where a pilot finds noise; "
                   "without it one path through each pixel, or with auto N = 4")
      ->check(CheckWhole(1, kMaxCameraSamples))
      ->type_name("N")
      ->group(group);
  command->add_option("--photons", options->photons, "Light paths a pass")
      ->check(CheckWhole(1, kMost))
      ->type_name("N")
      ->group(group);
  command->add_option("--radius", options->radius, "Starting radius of photon lookups, in the scene's units")
      ->check(CheckPositive)
      ->type_name("R")
      ->group(group);
  command
      ->add_option_function<std::string>(
          "--kernel", [options](const std::string& text) { options->kernel = ParseKernel(text); },
          "How photons count by their distance: epanechnikov (the least error) or cone (more weight in the middle)")
      ->type_name("SHAPE")
      ->group(group);
  command
      ->add_flag("--no-guide", options->noGuide,
                 "Emit photons as the lights do, without a pilot that learns which of them are of use")
      ->group(group);
  command
      ->add_option("--light-samples", options->lightSamples,
                   "Next-event samples at each vertex of a camera path; by default 1, or an infinite light's own "
                   "\"samples\"")
      ->check(CheckWhole(1, kMostLightSamples))
      ->type_name("N")
      ->group(group);
  command
      ->add_option_function<std::string>(
          "--direct", [options](const std::string& text) { options->direct = ParseDirect(text); },
          "What finds direct light on camera paths: mis (light and BSDF sampling, weighted), light or bsdf (alone)")
      ->type_name("TECHNIQUE")
      ->group(group);
  command
      ->add_option("--threads", options->threads,
                   "Threads; 0: one a processor. The picture is the same with any number")
      ->check(CheckWhole(0, kMaxThreads))
      ->type_name("N")
      ->group(group);
}

/// The first of the two that is there.
template <typename T>
std::optional<T> Either(const std::optional<T>& first, const std::optional<T>& second) {
  return first ? first : second;
}

/// Passes that take about as long as `samples` passes of one camera path a pixel.
int PassesOf(int samples, const RenderPlan& plan) {
  const int samplesOfPass = plan.options.cameraSamples.value_or(1);
  const int passes = samples / samplesOfPass + (samples % samplesOfPass > 0 ? 1 : 0);
  // Of one pass no error could be told.
  return std::max(passes, std::min(samples, 2));
}

void SetBudget(const RenderSettings& settings, const SceneOptions& options, RenderPlan* plan) {
  const bool hasIterations = plan->choice.name == "sppm" && settings.iterations;
  if (options.seconds) {
    plan->budget.seconds = options.seconds;
    plan->budgetReason = "asked for";
  } else if (options.passes) {
    plan->budget.passes = static_cast<int>(options.passes->Count());
    plan->budget.firstPass = static_cast<int>(options.passes->begin);
    plan->budgetReason = "asked for";
  } else if (hasIterations || settings.samplesPerPixel) {
    plan->budget.passes = hasIterations ? *settings.iterations : PassesOf(*settings.samplesPerPixel, *plan);
    plan->budgetReason = hasIterations ? "the scene's iterations" : "the scene's samples a pixel";
  } else {
    plan->budget.passes = PassesOf(plan->integrator->DefaultPasses(), *plan);
    plan->budgetReason = "the integrator's default";
  }
}

Parameter StringParameter(const char* name, const std::string& value) {
  Parameter parameter;
  parameter.type = ParameterType::String;
  parameter.name = name;
  parameter.strings = {value};
  return parameter;
}

void SetStrategy(const SceneOptions& options, SceneDescription* description) {
  const auto set = [&](const char* name, const std::string& value) {
    if (SetOnInfiniteLights(description, StringParameter(name, value)) == 0)
      throw Error(
          FileLocation(options.scene),
          fmt::format("strategy {}: the scene has no infinite light whose directions it could draw", options.strategy));
  };
  const size_t slash = options.strategy.find('/');
  const std::string sampling = options.strategy.substr(0, slash);
  set("sampling", sampling);
  if (slash != std::string::npos) {
    set("emission", options.strategy.substr(slash + 1));
  } else if (sampling == "uniform" || sampling == "importance") {
    set("emission", sampling);
  }
}

/// An option that some algorithms have no use for.
struct PartialOption {
  std::string_view name;
  bool (*isGiven)(const SceneOptions&);
  std::vector<std::string_view> users;
};

std::vector<PartialOption> PartialOptions() {
  using Options = const SceneOptions&;
  const std::vector<std::string_view> withPhotons{"light_tracing", "photon_mapping", "sppm", "hybrid"};
  const std::vector<std::string_view> withLookups{"photon_mapping", "sppm", "hybrid"};
  const std::vector<std::string_view> fromCamera{"path", "photon_mapping", "sppm", "hybrid"};
  return {{"--camera-samples", [](Options o) { return o.cameraSamples.has_value(); }, {"path"}},
          {"--photons", [](Options o) { return o.photons.has_value(); }, withPhotons},
          {"--no-guide", [](Options o) { return o.noGuide; }, withPhotons},
          {"--radius", [](Options o) { return o.radius.has_value(); }, withLookups},
          {"--kernel", [](Options o) { return o.kernel.has_value(); }, withLookups},
          {"--direct", [](Options o) { return o.direct.has_value(); }, fromCamera},
          {"--light-samples", [](Options o) { return o.lightSamples.has_value(); }, fromCamera}};
}

void WarnOfLackingIntegrator(const RenderSettings& settings, const IntegratorChoice& choice, Diagnostics& diagnostics) {
  const std::vector<std::string_view> known = IntegratorNames();
  if (settings.integrator.empty() || std::find(known.begin(), known.end(), settings.integrator) != known.end()) return;
  diagnostics.Warn(settings.integratorLocation,
                   fmt::format("integrator \"{}\" is not one of Dapple's ({}); what the scene holds decides: {}{}",
                               settings.integrator, fmt::join(known, ", "), choice.name,
                               DidYouMean(settings.integrator, {known.begin(), known.end()})));
}

}  // namespace

std::string CheckPositive(const std::string& text) {
  // CLI11's own check lets NaN pass.
  const auto number = SplitNumbers<double>(text, ',');
  const bool isPositive = number && number->size() == 1 && number->front() > 0 && std::isfinite(number->front());
  return isPositive ? "" : fmt::format("expected a number above 0, not '{}'", text);
}

std::function<std::string(const std::string&)> CheckWhole(int least, int most) {
  return [least, most](const std::string& text) -> std::string {
    int number = 0;
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [end, status] = std::from_chars(begin, text.data() + text.size(), number);
    const bool isWhole = status == std::errc() && end == text.data() + text.size();
    // What is read after this check takes a leading 0 for the mark of an octal number.
    const bool isDecimal = text == "0" || text.find_first_not_of("+-") == text.find_first_not_of("+-0");
    if (isWhole && isDecimal && number >= least && number <= most) return "";
    return fmt::format("expected a whole number from {} to {}, in digits alone and without a leading 0, not '{}'",
                       least, most, text);
  };
}

std::vector<std::string> IntegratorChoices() {
  std::vector<std::string> names{"auto"};
  for (const std::string_view name : IntegratorNames()) names.emplace_back(name);
  return names;
}

std::string SceneName(const std::string& path) {
  std::filesystem::path name = std::filesystem::path(path).filename();
  if (name.extension() == ".gz") name = name.stem();
  return name.stem().string();
}

void SceneOptions::AddFileTo(CLI::App* command) {
  command->add_option("scene", scene, "The scene: a .pbrt or .pbrt.gz file")->required()->type_name("FILE");
  AddVersion(command, this);
}

void SceneOptions::AddTo(CLI::App* command) {
  AddFileTo(command);
  AddPictureGroup(command, this);
  AddBudgetGroup(command, this);
  AddAlgorithmGroup(command, this);
}

void SceneOptions::AddFixedTo(CLI::App* command) {
  AddVersion(command, this);
  AddPictureGroup(command, this);
  AddAlgorithmGroup(command, this);
}

void RequireDirect(const SceneOptions& options, const std::vector<std::string>& integrators) {
  const bool isHybrid = std::ranges::find(integrators, "hybrid") != integrators.end();
  if (isHybrid && options.direct.value_or(DirectTechnique::Mis) != DirectTechnique::Mis)
    throw CLI::ValidationError("--direct", "hybrid joins all techniques: expected mis, or integrator path or sppm");
}

void WarnOfUnused(const SceneOptions& options, const std::vector<std::string>& integrators, Diagnostics& diagnostics) {
  const auto hasEffect = [](const PartialOption& option, const std::string& integrator) {
    return std::ranges::find(option.users, integrator) != option.users.end();
  };
  for (const PartialOption& option : PartialOptions()) {
    if (!option.isGiven(options)) continue;
    if (std::ranges::any_of(integrators, [&](const std::string& name) { return hasEffect(option, name); })) continue;
    diagnostics.Warn(FileLocation(options.scene),
                     fmt::format("{} is for {}; it has no effect on {}", option.name, fmt::join(option.users, ", "),
                                 fmt::join(integrators, ", ")));
  }
}

namespace {

LoadedScene LoadUnchecked(const SceneOptions& options, Diagnostics& diagnostics) {
  SceneDescription description = ParsePbrtFile(options.scene, {.pbrtVersion = options.pbrtVersion}, diagnostics);
  const std::string ofFile = IntegratorNameOf(description);
  if (!options.strategy.empty()) {
    SetStrategy(options, &description);
  } else if (IsLeftToDapple(options.integrator, ofFile)) {
    // The algorithm's parts are left to it too: here with less error in the same time (docs/performance.md).
    SetDefaultOnEnvironmentMaps(&description, StringParameter("sampling", "irradiance"));
  }
  BuildOptions build;
  build.resolution = options.resolution;
  build.cropWindow = options.crop;
  build.drawsTowardLights =
      !options.onlyEmission && DrawsTowardLights(options.integrator.empty() ? ofFile : options.integrator,
                                                 options.direct.value_or(DirectTechnique::Mis));
  build.lightSamples = options.lightSamples;
  // Where no direction is drawn all ways to draw them give the same bits.
  SceneContent content = HashSceneContent(description);
  SceneIdentity identity{std::move(content.hash),
                         build.drawsTowardLights ? DescribeEnvironmentSampling(description) : "none"};
  return {description.version, description.versionReason, std::move(identity),
          BuildScene(description, build, diagnostics), std::move(content.files)};
}

}  // namespace

// What libraries complain of has no place of its own.
LoadedScene Load(const SceneOptions& options, Diagnostics& diagnostics) {
  const FileLocation scene(options.scene);
  try {
    return AtLocation(scene, [&] { return LoadUnchecked(options, diagnostics); });
  } catch (const std::bad_alloc&) {
    throw Error(scene, "the memory does not suffice for the scene");
  }
}

RenderPlan MakePlan(const Scene& scene, const SceneOptions& options, Diagnostics& diagnostics) {
  const auto begin = std::chrono::steady_clock::now();
  const RenderSettings& settings = scene.Settings();
  RenderPlan plan;
  plan.seed = Either(options.seed, settings.seed).value_or(0);
  plan.options.maxDepth = Either(options.maxDepth, settings.maxDepth).value_or(plan.options.maxDepth);
  plan.options.photonsPerPass = options.photons;
  plan.options.cameraSamples = options.cameraSamples;
  plan.options.radius = options.radius;
  plan.options.kernel = options.kernel.value_or(plan.options.kernel);
  plan.options.guideEmission = !options.noGuide;
  plan.options.direct = {options.direct.value_or(DirectTechnique::Mis), options.lightSamples};
  plan.choice = ResolveIntegrator(options.integrator, scene, plan.options, SeedFrom(plan.seed));
  plan.options.guide = plan.choice.guide;
  if (plan.choice.name == "path") {
    plan.options.cameraSamples = Either(options.cameraSamples, plan.choice.cameraSamples);
  } else {
    plan.options.cameraSamples.reset();
  }
  if (options.integrator.empty()) WarnOfLackingIntegrator(settings, plan.choice, diagnostics);
  // What a file tunes for an algorithm holds for that one alone: others choose by themselves.
  if (plan.choice.name == settings.integrator) {
    plan.options.photonsPerPass = Either(options.photons, settings.photonsPerIteration);
    plan.options.radius = Either(options.radius, settings.radius);
  }
  plan.integrator = MakeIntegrator(plan.choice.name, plan.options);
  SetBudget(settings, options, &plan);
  plan.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return plan;
}

}  // namespace dapple
