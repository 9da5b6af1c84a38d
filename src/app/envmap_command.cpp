// `dapple envmap`: what an environment image is like, and pictures of how directions are drawn from it.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <string>

#include <CLI/App.hpp>
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fmt/ranges.h>

#include "lights/environment_statistics.h"
#include "src/app/command.h"
#include "src/app/environment_pictures.h"
#include "src/app/format.h"
#include "src/app/named_files.h"
#include "src/app/render_outputs.h"
#include "src/app/scene_options.h"
#include "src/base/numerics.h"
#include "src/base/parallel.h"
#include "src/io/build_context.h"
#include "src/render/output.h"

namespace dapple {

namespace {

struct EnvmapOptions {
  std::string file;
  std::string mapping;  ///< empty: by the image's shape
  std::string densityImage, sampleImage;
  int samples = 1000;
  int seed = 0;
  int threads = 0;
};

struct ChosenMapping {
  EnvironmentMapping mapping;
  std::string reason;
};

ChosenMapping ChooseMapping(const EnvmapOptions& options, const Image& image) {
  const bool isSquare = image.Width() == image.Height();
  const bool isEqualArea = options.mapping.empty() ? isSquare : options.mapping == "equalarea";
  const std::string reason = !options.mapping.empty() ? "asked for"
                             : isSquare               ? "the image is square"
                                                      : "the image is not square";
  return {isEqualArea ? EnvironmentMapping::EqualArea : EnvironmentMapping::LatLong,
          fmt::format("{} ({})", isEqualArea ? "equal-area" : "latitude-longitude", reason)};
}

void PrintLine(std::string_view heading, const std::string& text) { fmt::print("{:<10}{}\n", heading, text); }

std::string ToText(const Color& c) { return fmt::format("{:.4g} {:.4g} {:.4g}", c.r, c.g, c.b); }

std::string Percent(double share) { return fmt::format("{:.3g} %", 100 * share); }

void PrintStatistics(const EnvironmentStatistics& s) {
  PrintLine("radiance", fmt::format("least    {}", ToText(s.least)));
  PrintLine("", fmt::format("mean     {}", ToText(s.mean)));
  PrintLine("", fmt::format("greatest {}", ToText(s.greatest)));
  if (s.greatestLuminance == 0) return;
  PrintLine("range", fmt::format("luminance from {:.4g} to {:.4g}: {:.1f} stops", s.leastLuminance, s.greatestLuminance,
                                 std::log2(s.greatestLuminance / s.leastLuminance)));
  PrintLine("brightest",
            fmt::format("pixel ({}, {}), in the direction ({:.4f}, {:.4f}, {:.4f}) of the map", s.brightestPixel.x,
                        s.brightestPixel.y, s.brightestDirection.x, s.brightestDirection.y, s.brightestDirection.z));
  PrintLine("black", fmt::format("{} of the sphere", Percent(s.blackShare)));
  PrintLine("uneven",
            fmt::format("the brightest 1 % of the sphere sends {} of the light; as concentrated as even light "
                        "from {} of it",
                        Percent(s.lightOfBrightestHundredth), Percent(s.effectiveShare)));
}

/// Its construction, timed.
EnvironmentMap BuildMap(const EnvmapOptions& options, const Image& image, EnvironmentMapping mapping) {
  const auto start = std::chrono::steady_clock::now();
  EnvironmentMap map = AtLocation(FileLocation(options.file), [&] { return EnvironmentMap(image, mapping, Color(1)); });
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  PrintLine("integral", fmt::format("{} over the sphere, of the bilinear lookup", ToText(map.Integral())));
  PrintLine("table", fmt::format("{}, built in {}", FormatBytes(static_cast<double>(map.MemoryBytes())),
                                 FormatDuration(seconds)));
  return map;
}

int RunEnvmap(const EnvmapOptions& options) {
  for (const std::string& output : {options.densityImage, options.sampleImage}) {
    if (!output.empty()) CheckOutput(output);
  }
  const ThreadLimit threads(options.threads);
  const Image file = ReadImage(options.file);
  int64_t repaired = 0;
  const Image image = EnvironmentMap::Repair(file, &repaired);
  const ChosenMapping chosen = ChooseMapping(options, image);
  PrintLine("file", options.file);
  PrintLine("image", fmt::format("{} x {} pixels, channels {}", file.Width(), file.Height(),
                                 fmt::join(file.ChannelNames(), " ")));
  PrintLine("mapping", chosen.reason);
  PrintLine("repaired",
            fmt::format("{} (negative, infinite or not a number)", FormatNumberOf(repaired, "pixel", "pixels")));
  PrintStatistics(MeasureEnvironment(image, chosen.mapping));
  const EnvironmentMap map = BuildMap(options, image, chosen.mapping);
  if (map.IsBlack() && !(options.densityImage + options.sampleImage).empty()) {
    throw Error(FileLocation(options.file), "the map is black: no directions are drawn from it, expected some light");
  }
  if (!options.densityImage.empty()) {
    WriteOutput(options.densityImage, DensityPicture(map), {});
    fmt::print("{}\n", options.densityImage);
  }
  if (!options.sampleImage.empty()) {
    WriteOutput(options.sampleImage, SamplesPicture(map, options.samples, options.seed), {});
    fmt::print("{}\n", options.sampleImage);
  }
  return kExitSuccess;
}

}  // namespace

void AddEnvmapCommand(CLI::App& program, Action* action) {
  CLI::App* const command =
      program.add_subcommand("envmap", "Say what an environment image is like; draw how it is sampled");
  const auto options = std::make_shared<EnvmapOptions>();
  command->add_option("image", options->file, "The environment: any image that can be read")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--mapping", options->mapping,
                   "latlong (as in version 3 of pbrt) or equalarea (version 4, square); by the image's shape otherwise")
      ->check(CLI::IsMember({"latlong", "equalarea"}).description(""))
      ->type_name("NAME");
  command->add_option("--pdf-image", options->densityImage, "Picture of the density of directions: .png or .exr")
      ->check(CheckPictureName)
      ->type_name("FILE");
  CLI::Option* const sampleImage =
      command->add_option("--sample-image", options->sampleImage, "Picture of the map and of directions drawn from it")
          ->check(CheckPictureName)
          ->type_name("FILE");
  command->add_option("--samples", options->samples, "Draw N directions; 1000 by default")
      ->check(CheckWhole(1, 1'000'000))
      ->needs(sampleImage)
      ->type_name("N");
  command->add_option("--seed", options->seed, "Seed of the directions")
      ->check(CheckWhole(std::numeric_limits<int>::min(), std::numeric_limits<int>::max()))
      ->type_name("S");
  command->add_option("--threads", options->threads, "Threads; 0: one a processor")
      ->check(CheckWhole(0, kMaxThreads))
      ->type_name("N");
  command->callback([options, action] {
    std::vector<NamedFile> written;
    if (!options->densityImage.empty()) written.push_back({"--pdf-image", options->densityImage});
    if (!options->sampleImage.empty()) written.push_back({"--sample-image", options->sampleImage});
    RequireNoClash(written, {{"the image", options->file}});
    *action = [options] { return RunEnvmap(*options); };
  });
}

}  // namespace dapple
