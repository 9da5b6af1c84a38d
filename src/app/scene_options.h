// What the subcommands share that read a scene: the options that change a scene or how it is rendered, and the plan
// that follows.
//
//   SceneOptions options;
//   options.AddTo(command);                         // before parsing
//   const LoadedScene loaded = Load(options, diagnostics);
//   const RenderPlan plan = MakePlan(*loaded.scene, options, diagnostics);
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "integrators/select.h"
#include "src/io/build_scene.h"
#include "src/render/driver.h"
#include "src/render/render_identity.h"

namespace dapple {

/// More threads than any machine has processors would only take memory.
inline constexpr int kMaxThreads = 1024;

/// What is wrong with an option's `text` as a finite number above 0; empty where nothing is.
std::string CheckPositive(const std::string& text);

/// A check of an option's text: what is wrong with it as a whole number within these bounds.
std::function<std::string(const std::string&)> CheckWhole(int least, int most);

/// Names of integrators as the command line takes them: "auto" and all that `MakeIntegrator` knows.
std::vector<std::string> IntegratorChoices();

/// "ring.pbrt" and "ring.pbrt.gz" are both "ring".
std::string SceneName(const std::string& path);

/// As the command line gives them; what is absent is the scene's.
struct SceneOptions {
  std::string scene;
  int pbrtVersion = 0;  ///< 0: found from the file
  std::optional<Vec2i> resolution;
  std::optional<std::array<double, 4>> crop;  ///< x0, x1, y0, y1 as shares of the picture
  std::string integrator;
  std::optional<PassRange> passes;  ///< not empty; its ends are ints
  bool isPart = false;              ///< `passes` were given as a range of the whole
  std::optional<double> seconds;
  std::optional<int> seed;
  std::optional<int> maxDepth;
  std::optional<int> photons;
  std::optional<int> cameraSamples;
  std::optional<double> radius;
  std::optional<KernelShape> kernel;
  bool noGuide = false;
  std::optional<int> lightSamples;
  std::optional<DirectTechnique> direct;
  bool onlyEmission = false;  ///< the command draws from the lights' side alone
  int threads = 0;            ///< 0: one a processor
  /// How infinite lights are sampled, in place of what the file says: SAMPLING/EMISSION, or one name for both sides
  /// where emission knows it too and for next-event estimation where not. Empty: the file's own.
  std::string strategy;

  void AddTo(CLI::App* command);
  /// All but the scene, the integrator and the budget: what a comparison of integrators holds fixed.
  void AddFixedTo(CLI::App* command);
  /// Only the scene and the version of its format.
  void AddFileTo(CLI::App* command);
};

/// Throws `CLI::ValidationError` where one of the integrators cannot find direct light as the options say.
void RequireDirect(const SceneOptions& options, const std::vector<std::string>& integrators);

/// Warns of each option that is given and has no effect on any of the integrators.
void WarnOfUnused(const SceneOptions& options, const std::vector<std::string>& integrators, Diagnostics& diagnostics);

/// A scene and what its file was.
struct LoadedScene {
  int version = 0;
  std::string versionReason;
  SceneIdentity identity;
  std::unique_ptr<Scene> scene;
  std::vector<std::string> files;  ///< all that was read for it
};

/// Reads and builds the scene with the options' resolution, crop and version. Throws `Error`.
LoadedScene Load(const SceneOptions& options, Diagnostics& diagnostics);

/// How a scene will be rendered, and why so.
struct RenderPlan {
  IntegratorChoice choice;
  IntegratorOptions options;
  std::unique_ptr<Integrator> integrator;
  RenderBudget budget;
  std::string budgetReason;  ///< "the command line's", ...
  int seed = 0;
  double seconds = 0;  ///< that making it took: the rule behind "auto" may look at the scene for a while
};

/// The command line's values, else the scene's, else the integrator's. Warns of an integrator of the scene's that
/// Dapple lacks, unless the command line names one, and not of options without effect (`WarnOfUnused`). Throws `Error`
/// for an unknown integrator of the command line's.
RenderPlan MakePlan(const Scene& scene, const SceneOptions& options, Diagnostics& diagnostics);

}  // namespace dapple
