// `dapple emit`: the rays that a scene's lights emit, as a table.
#include <cstdio>
#include <limits>
#include <memory>
#include <string>

#include <CLI/App.hpp>
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>

#include "src/app/command.h"
#include "src/app/format.h"
#include "src/app/named_files.h"
#include "src/app/scene_options.h"
#include "src/base/parallel.h"
#include "src/image/atomic_file.h"
#include "src/io/build_context.h"
#include "src/render/emitted_rays.h"
#include "src/render/output.h"

namespace dapple {

namespace {

/// Some gigabytes of text.
constexpr int kMostRays = 10'000'000;

struct EmitCommandOptions {
  SceneOptions scene;
  EmitOptions emit;
  std::string output;
  int threads = 0;
};

using RayFormat = std::string (*)(const Scene&, const EmittedRays&);

/// Null for an ending that is none of a table.
RayFormat FormatOf(const std::string& path) {
  const std::string extension = LowerCaseExtension(path);
  if (extension == ".csv") return RaysToCsv;
  if (extension == ".json") return RaysToJson;
  if (extension == ".ply") return RaysToPly;
  return nullptr;
}

std::string CheckTableName(const std::string& path) {
  return FormatOf(path) ? "" : fmt::format("expected a file name that ends in .csv, .json or .ply, not '{}'", path);
}

/// Sums of millions of colours need more than floats: the red, green and blue of one.
Vec3d ComponentsOf(const Color& c) { return ToDouble(Vec3(c.r, c.g, c.b)); }

/// The power of what the rays were drawn from.
Vec3d PowerOf(const Scene& scene, const std::optional<int>& light) {
  if (light) return ComponentsOf(scene.Lights()[static_cast<size_t>(*light)]->Power());
  Vec3d sum(0);
  for (const auto& one : scene.Lights()) sum += ComponentsOf(one->Power());
  return sum;
}

int RunEmit(const EmitCommandOptions& options) {
  const RayFormat format = FormatOf(options.output);
  CheckFolder(options.output);
  const ThreadLimit threads(options.threads);
  Diagnostics diagnostics(Tell);
  const LoadedScene loaded = Load(options.scene, diagnostics);
  const Scene& scene = *loaded.scene;
  if (const auto clash =
          FindClash({{"--output", options.output}}, NamedFiles("what the scene is read from", loaded.files));
      !clash.empty())
    throw Error(FileLocation(options.scene.scene), clash);
  const EmittedRays emitted =
      AtLocation(FileLocation(options.scene.scene), [&] { return EmitRays(scene, options.emit); });
  WriteFileAtomically(options.output, format(scene, emitted));

  Vec3d flux(0);
  for (const EmittedRay& ray : emitted.rays) flux += ComponentsOf(ray.flux);
  const Vec3d power = PowerOf(scene, options.emit.light);
  fmt::print("{}\n", options.output);
  fmt::print("rays      {} of {}\n", FormatNumberOf(static_cast<int64_t>(emitted.rays.size()), "ray", "rays"),
             options.emit.light ? fmt::format("light {}", *options.emit.light)
                                : FormatNumberOf(static_cast<int64_t>(scene.Lights().size()), "light", "lights"));
  fmt::print("flux      {:.6g} {:.6g} {:.6g} W together\n", flux.x, flux.y, flux.z);
  fmt::print("power     {:.6g} {:.6g} {:.6g} W\n", power.x, power.y, power.z);
  const SceneResources& resources = scene.Resources();
  const TableUse tables = resources.environmentTables + resources.lightTables + resources.choiceTables;
  fmt::print("held      {} ({})\n", FormatNumberOf(tables.count, "table", "tables"),
             FormatBytes(static_cast<double>(tables.bytes)));
  return kExitSuccess;
}

}  // namespace

void AddEmitCommand(CLI::App& program, Action* action) {
  CLI::App* const command = program.add_subcommand("emit", "Write the rays that a scene's lights emit to a table");
  const auto options = std::make_shared<EmitCommandOptions>();
  options->scene.AddFileTo(command);
  options->scene.onlyEmission = true;
  command->add_option("-o,--output", options->output, "The table: .csv, .json or .ply")
      ->required()
      ->allow_extra_args(false)
      ->check(CheckTableName)
      ->type_name("FILE");
  command->add_option("--rays", options->emit.count, "Emit N rays; 1000 by default")
      ->check(CheckWhole(1, kMostRays))
      ->type_name("N");
  command
      ->add_option(
          "--light", options->emit.light,
          "Of this light only, by the number that `dapple info` shows; otherwise each ray is of a light chosen "
          "by power")
      ->check(CheckWhole(0, std::numeric_limits<int>::max()))
      ->type_name("K");
  command->add_option("--seed", options->emit.seed, "Seed of all random numbers")
      ->check(CheckWhole(std::numeric_limits<int>::min(), std::numeric_limits<int>::max()))
      ->type_name("S");
  command
      ->add_option("--threads", options->threads, "Threads; 0: one a processor. The rays are the same with any number")
      ->check(CheckWhole(0, kMaxThreads))
      ->type_name("N");
  command->callback([options, action] {
    RequireNoClash({{"--output", options->output}}, {{"the scene", options->scene.scene}});
    *action = [options] { return RunEmit(*options); };
  });
}

}  // namespace dapple
