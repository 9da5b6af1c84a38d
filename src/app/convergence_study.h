// Renders one scene with several algorithms for the same time each and measures their snapshots: the work behind
// `dapple converge`.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "src/app/named_files.h"
#include "src/app/scene_options.h"
#include "src/render/convergence_data.h"

namespace dapple {

struct StudyOptions {
  SceneOptions scene;  ///< `seconds` is the budget of each run
  std::vector<std::string> integrators;
  std::vector<std::string> strategies;  ///< as `SceneOptions::strategy`; may be empty
  int seeds = 3;
  std::string referenceFile;  ///< empty: the reference is rendered
  std::string referenceIntegrator = "auto";
  double referenceSeconds = 0;
  std::optional<double> referenceError;  ///< relative MSE of the file
  int imageTimes = 5;                    ///< at how many times pictures are kept, each four times the one before
  std::vector<NamedFile> written;        ///< by the command: none may be a file of the scene
};

/// A snapshot as a person looks at it: two PNG files.
struct StudyPicture {
  int timeIndex = 0;
  double seconds = 0;
  int passes = 0;
  std::string picture;
  std::string difference;  ///< relative errors from 0.001 to 1 in false colours
};

struct StudyPictures {
  Image reference;
  std::vector<std::vector<StudyPicture>> contenders;  ///< of the first seed
};

struct Study {
  SceneConvergence convergence;
  StudyPictures pictures;
  std::string failure;  ///< a line of what ended it before all runs were complete; empty where nothing did

  bool HasRuns() const;
};

/// Reads and builds the scene as each contender needs it, and lets it go: throws the `Error` that `RunStudy` would
/// before its first render. Warnings are left to that.
void CheckScene(const StudyOptions& options);

/// Runs go seed by seed through all contenders, so that a machine that gets slower is so for all. Tells what it does on
/// the error stream unless `isQuiet`. Where `stop` becomes true or a run fails, that is given up and the study ends
/// with those before it. Throws `Error` for what goes wrong before the first of them.
Study RunStudy(const StudyOptions& options, bool isQuiet, const std::atomic<bool>& stop);

}  // namespace dapple
