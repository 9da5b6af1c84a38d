// `dapple compare`: how far images are from a reference.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <CLI/Option.hpp>
#include <CLI/Validators.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "src/app/command.h"
#include "src/app/format.h"
#include "src/app/named_files.h"
#include "src/app/render_outputs.h"
#include "src/app/scene_options.h"
#include "src/base/parallel.h"
#include "src/image/false_color.h"
#include "src/image/flip.h"
#include "src/image/image_io.h"
#include "src/image/metrics.h"
#include "src/io/build_context.h"
#include "src/render/json_text.h"
#include "src/render/output.h"

namespace dapple {

namespace {

struct CompareOptions {
  std::string reference;
  std::vector<std::string> tests;
  std::vector<std::string> pictures;  ///< of differences, one for each test or none
  std::string of = "flip";
  double pixelsPerDegree = PixelsPerDegree();
  bool isJson = false;
  int threads = 0;
};

struct Comparison {
  std::string file;
  int width = 0, height = 0;  ///< of what is compared
  bool isCut = false;
  ImageDifference difference;
  double flip = 0, lowRangeFlip = 0;
};

/// Relative errors from a thousandth to all of the value, on a logarithmic scale, and FLIP on its own from 0 to 1.
Image DifferencePicture(const CompareOptions& options, const ComparablePair& pair, const Image& flipMap,
                        const std::string& path) {
  Image map = options.of == "relative" ? RelativeErrors(pair.test, pair.reference) : flipMap;
  map.origin = pair.reference.origin;
  map.fullSize = pair.reference.fullSize;
  if (path.ends_with(".exr")) return map;
  return options.of == "relative" ? FalseColorLogarithmic(map, 1e-3, 1) : FalseColorLinear(map);
}

/// Runs `work`; an Error without a place gets the file's name.
template <typename F>
auto AtFile(const std::string& file, F work) {
  return AtLocation(FileLocation(file), work);
}

Comparison Compare(const CompareOptions& options, const Image& reference, size_t i) {
  Comparison result;
  result.file = options.tests[i];
  const Image test = ReadImage(result.file);
  const ComparablePair pair = AtFile(result.file, [&] { return MakeComparable(test, reference); });
  result.width = pair.test.Width();
  result.height = pair.test.Height();
  result.isCut = pair.isCut;
  result.difference = AtFile(result.file, [&] { return CompareImages(pair.test, pair.reference); });
  const FlipResult flip = FlipReference(pair.reference, FlipRange::High, options.pixelsPerDegree).Compare(pair.test);
  result.flip = flip.mean;
  result.lowRangeFlip = FlipReference(pair.reference, FlipRange::Low, options.pixelsPerDegree).Compare(pair.test).mean;
  if (!options.pictures.empty()) {
    const std::string& path = options.pictures[i];
    WriteOutput(path, DifferencePicture(options, pair, flip.map, path), {});
  }
  return result;
}

nlohmann::ordered_json ToJson(const Comparison& c) {
  // JSON has no infinity: the ratio to a black reference is null.
  return {{"file", c.file},
          {"width", c.width},
          {"height", c.height},
          {"isCut", c.isCut},
          {"mse", c.difference.mse},
          {"relativeMse", c.difference.relativeMse},
          {"trimmedRelativeMse", c.difference.trimmedRelativeMse},
          {"mape", c.difference.mape},
          {"flip", c.flip},
          {"ldrFlip", c.lowRangeFlip},
          {"meanRatio", c.difference.meanRatio},
          {"nonFinite", c.difference.nonFinite}};
}

void PrintJson(const CompareOptions& options, const std::vector<Comparison>& comparisons) {
  nlohmann::ordered_json json = {{"reference", options.reference},
                                 {"relativeEpsilon", kRelativeEpsilon},
                                 {"pixelsPerDegree", options.pixelsPerDegree},
                                 {"images", nlohmann::ordered_json::array()}};
  for (const Comparison& comparison : comparisons) json["images"].push_back(ToJson(comparison));
  fmt::print("{}\n", DumpJson(json, 2));
}

void PrintText(const CompareOptions& options, const std::vector<Comparison>& comparisons) {
  size_t width = 5;
  for (const Comparison& c : comparisons) width = std::max(width, c.file.size());
  fmt::print("reference {}\n", options.reference);
  fmt::print("{:<{}}  {:>9}  {:>9}  {:>9}  {:>9}  {:>8}  {:>8}  {:>10}  {:>10}\n", "image", width, "MSE", "relMSE",
             "trimmed", "MAPE", "FLIP", "LDR-FLIP", "mean ratio", "non-finite");
  for (const Comparison& c : comparisons) {
    const ImageDifference& d = c.difference;
    fmt::print("{:<{}}  {:>9.3g}  {:>9.3g}  {:>9.3g}  {:>9.3g}  {:>8.4f}  {:>8.4f}  {:>10.5g}  {:>10}\n", c.file, width,
               d.mse, d.relativeMse, d.trimmedRelativeMse, d.mape, c.flip, c.lowRangeFlip, d.meanRatio, d.nonFinite);
  }
  for (const Comparison& c : comparisons) {
    if (c.isCut) fmt::print("{}: compared where the data windows overlap, {} x {} pixels\n", c.file, c.width, c.height);
  }
  fmt::print(
      "relMSE: mean of (t - r)^2 / (r^2 + {0}); trimmed: without the worst 0.1 % of pixels; MAPE: mean of |t - r| / "
      "(|r| + {0});\nFLIP: HDR-FLIP over all exposures, LDR-FLIP of values in [0, 1], at {1:.3g} pixels a degree\n",
      kRelativeEpsilon, options.pixelsPerDegree);
}

int RunCompare(const CompareOptions& options) {
  for (const std::string& picture : options.pictures) CheckOutput(picture);
  const ThreadLimit threads(options.threads);
  const Image reference = ReadImage(options.reference);
  std::vector<Comparison> comparisons;
  for (size_t i = 0; i < options.tests.size(); ++i) comparisons.push_back(Compare(options, reference, i));
  options.isJson ? PrintJson(options, comparisons) : PrintText(options, comparisons);
  return kExitSuccess;
}

void RequireUsable(const CompareOptions& options) {
  if (!options.pictures.empty() && options.pictures.size() != options.tests.size())
    throw CLI::ValidationError(
        fmt::format("{} but {}: expected one --difference for each image",
                    FormatNumberOf(static_cast<int64_t>(options.tests.size()), "image", "images"),
                    FormatNumberOf(static_cast<int64_t>(options.pictures.size()), "picture of differences",
                                   "pictures of differences")));
  std::vector<NamedFile> read = NamedFiles("an image", options.tests);
  read.push_back({"the reference", options.reference});
  RequireNoClash(NamedFiles("--difference", options.pictures), read);
}

}  // namespace

void AddCompareCommand(CLI::App& program, Action* action) {
  CLI::App* const command = program.add_subcommand("compare", "Measure how far images are from a reference");
  const auto options = std::make_shared<CompareOptions>();
  command->add_option("reference", options->reference, "The image that counts as true")->required()->type_name("REF");
  command->add_option("images", options->tests, "Images to compare with it")->required()->type_name("IMAGE");
  command
      ->add_option("-d,--difference", options->pictures,
                   "Picture of the differences: .png in false colours or .exr with the values; once for each image")
      ->allow_extra_args(false)
      ->check(CheckPictureName)
      ->type_name("FILE");
  command
      ->add_option("--of", options->of,
                   "What the pictures show: flip (from 0 to 1) or relative (error over value, from 0.001 to 1 on a "
                   "logarithmic scale)")
      ->check(CLI::IsMember({"flip", "relative"}).description(""))
      ->type_name("NAME");
  command
      ->add_option(
          "--pixels-per-degree", options->pixelsPerDegree,
          "How large FLIP's viewer sees the images; 67 by default: 0.7 m from a screen of 3840 pixels and 0.7 m")
      ->check(CLI::Range(1., 1000.).description(""))
      ->type_name("N");
  command->add_flag("--json", options->isJson, "Print JSON");
  command->add_option("--threads", options->threads, "Threads; 0: one a processor")
      ->check(CheckWhole(0, kMaxThreads))
      ->type_name("N");
  command->callback([options, action] {
    RequireUsable(*options);
    *action = [options] { return RunCompare(*options); };
  });
}

}  // namespace dapple
