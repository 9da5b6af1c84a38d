// `dapple merge`: joins ranges of passes that were rendered apart into the picture of one render.
#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>

#include "src/app/command.h"
#include "src/app/format.h"
#include "src/app/named_files.h"
#include "src/app/render_outputs.h"
#include "src/app/scene_options.h"
#include "src/render/render_state.h"

namespace dapple {

namespace {

struct MergeOptions {
  std::vector<std::string> parts, outputs;
  std::optional<int> passes;
};

int RunMerge(const MergeOptions& options) {
  for (const std::string& output : options.outputs) CheckRenderOutput(output);
  RenderState whole = ReadState(options.parts.front());
  for (size_t i = 1; i < options.parts.size(); ++i) JoinState(ReadState(options.parts[i]), options.parts[i], &whole);
  // A state may be joined further, a picture is final.
  const bool isFinal = !std::ranges::all_of(options.outputs, IsStateName);
  if (isFinal || options.passes) RequireAllPasses(whole.film, options.passes);
  const WrittenOutputs outputs = WriteRenderOutputs(options.outputs, whole.origin, RecordOf(whole), whole.film);
  for (const std::string& line : outputs.errors) Tell(line);
  WarnOfVariance(outputs.paths, whole.origin.aovs, whole.film);
  WarnOfNonFinite(whole.film);
  for (const std::string& path : outputs.paths) Print(path + "\n");
  Print(fmt::format("passes    {} of {}\n", whole.film.Passes().ToString(),
                    FormatNumberOf(static_cast<int64_t>(options.parts.size()), "file", "files")));
  if (const auto error = EstimateError(whole.film, whole.origin.exposure))
    Print(fmt::format("accuracy  {}\n", FormatError(*error, whole.film.TracksBlur())));
  return outputs.errors.empty() ? kExitSuccess : kExitFailure;
}

}  // namespace

void AddMergeCommand(CLI::App& program, Action* action) {
  CLI::App* const command =
      program.add_subcommand("merge", "Join passes that `dapple render --passes A:B` rendered apart");
  const auto options = std::make_shared<MergeOptions>();
  command->add_option("parts", options->parts, "Files that hold the ranges, in any order")
      ->required()
      ->type_name("FILE.dapple...");
  command
      ->add_option(
          "-o,--output", options->outputs,
          "The picture, .exr or .png, the same as that of one render; or .dapple, to be joined further. May be "
          "given several times")
      ->required()
      ->check(CheckResultName)
      ->allow_extra_args(false)
      ->type_name("FILE");
  command
      ->add_option("--passes", options->passes,
                   "How many passes there are in all, so that it is told where the last are missing too")
      ->check(CheckWhole(1, std::numeric_limits<int>::max()))
      ->type_name("N");
  command->callback([options, action] {
    // Where a part is replaced by the sum of all nothing is lost.
    RequireNoClash(NamedFiles("--output", options->outputs), {});
    *action = [options] { return RunMerge(*options); };
  });
}

}  // namespace dapple
