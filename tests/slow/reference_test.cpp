// Renders of the reference scenes against images that other renderers made of them.
//
// Runs where the environment names the folder of references (DAPPLE_REFERENCES); its README tells how they were made.
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "src/image/image_io.h"
#include "src/io/build_scene.h"
#include "src/render/error_estimate.h"
#include "tests/support/grouped_render.h"

namespace dapple {
namespace {

using namespace testing_support;

/// Empty where there is none.
std::string ReferenceFolder() {
  const char* folder = std::getenv("DAPPLE_REFERENCES");
  return folder && std::filesystem::is_directory(folder) ? folder : "";
}

std::unique_ptr<Scene> Load(const std::string& file) {
  Diagnostics diagnostics([](const std::string& line) { ADD_FAILURE() << line; });
  return LoadScene(ReferenceFolder() + "/" + file, {}, diagnostics);
}

/// As the program has them: what a file tunes for sppm holds for sppm alone.
IntegratorOptions OptionsOf(const Scene& scene, const std::string& integrator) {
  IntegratorOptions options;
  options.maxDepth = scene.Settings().maxDepth.value_or(options.maxDepth);
  if (integrator != "sppm") return options;
  options.photonsPerPass = scene.Settings().photonsPerIteration;
  options.radius = scene.Settings().radius;
  return options;
}

struct Case {
  std::string scene;      // the file, without its ending
  std::string reference;  // the image, without its ending
  std::string integrator;
  int passes;
  int blockSize = 32;
  double tolerance = 0.02;
  double floor = 0;             // absolute error of the reference itself
  int referenceSamples = 0;     // random ones a pixel, of a path-traced reference whose noise is not negligible
  int photons = 0;              // light paths a pass; 0: as the scene says
  double radius = 0;            // of gathers; 0: as the scene says
  bool hasRarePhotons = false;  // that make specks
};

// At the foot of the ring the reference (another renderer's photon map) has light that leaked under the wall: its
// darkest blocks are up to 0.00055 too bright. Path tracing, which leaks nothing, and sppm at ever smaller radii agree
// on that.
constexpr double kRingLeak = 0.0006;

void PrintTo(const Case& c, std::ostream* out) { *out << c.scene << " " << c.integrator; }

std::string NameOf(const ::testing::TestParamInfo<Case>& info) {
  std::string name = info.param.scene + "_" + info.param.integrator;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

class Reference : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (ReferenceFolder().empty()) GTEST_SKIP() << "DAPPLE_REFERENCES does not name the folder of references";
  }
};

constexpr int kGroups = 8;
constexpr double kMeanTolerance = 0.01, kBlockTolerance = 0.02;
constexpr double kMaxMedianSigma = 0.01;

Case WithPhotons(Case c, int photons, double radius = 0) {
  c.photons = photons;
  c.radius = radius;
  return c;
}

void ExpectBlocksAgree(const BlockReport& report) {
  std::cout << report.text << "\n";
  constexpr int kFewestBlocks = 32;
  EXPECT_GE(report.blocks, kFewestBlocks) << "too little was compared to say anything";
  EXPECT_NEAR(report.meanRatio, 1, kMeanTolerance);
  EXPECT_EQ(report.failed, 0) << report.text;
  EXPECT_LT(report.medianSigma, kMaxMedianSigma) << "too noisy to say anything";
}

class BlockMeansAgree : public Reference {};

TEST_P(BlockMeansAgree, WithinTwoPercentAndThreeSigma) {
  const Case& c = GetParam();
  const auto scene = Load(c.scene + ".pbrt");
  // The two passes of a group are independent, so many groups of one pair show the noise of random samples.
  const bool isNoisy = c.referenceSamples > 0;
  const int groups = isNoisy ? c.passes / 2 : kGroups, kept = isNoisy ? c.blockSize : 1;
  IntegratorOptions options = OptionsOf(*scene, c.integrator);
  if (c.photons > 0) options.photonsPerPass = c.photons;
  if (c.radius > 0) options.radius = c.radius;
  const GroupedImages images = RenderGroups(*scene, c.integrator, options, c.passes, groups, 1, kept);
  const GroupedImages reference = Exact(BlockMeans(ReadImage(ReferenceFolder() + "/" + c.reference + ".exr"), kept));
  constexpr float kSeldomFound = 0.1f;
  const auto leftOut =
      c.integrator == "light_tracing" ? PixelsOnSpecularSurfaces(*scene, kSeldomFound) : std::vector<bool>();
  ASSERT_TRUE(leftOut.empty() || kept == 1) << "one flag a pixel";
  ExpectBlocksAgree(CompareBlocks(images, reference, c.blockSize / kept, c.tolerance, leftOut, c.floor,
                                  isNoisy ? double(c.passes) / c.referenceSamples : 0));
}

// Of path the renders are those of the slopes, below.
INSTANTIATE_TEST_SUITE_P(
    V3, BlockMeansAgree,
    ::testing::Values(Case{"cbox-v3", "cbox", "sppm", 128}, Case{"ring-v3", "ring", "sppm", 128, 32, 0.02, kRingLeak},
                      Case{"lens-v3", "lens", "sppm", 128}, Case{"envglass-v3", "envglass", "sppm", 128},
                      Case{"cbox-v3", "cbox", "hybrid", 64}, Case{"lens-v3", "lens", "hybrid", 64},
                      Case{"envglass-v3", "envglass", "hybrid", 64}, Case{"veach-v3", "veach", "hybrid", 64}),
    NameOf);
// Where the camera sees glass, mirrors and metal that is nearly one is left out.
INSTANTIATE_TEST_SUITE_P(LightTracing, BlockMeansAgree,
                         ::testing::Values(Case{"cbox-v3", "cbox", "light_tracing", 128, 16},
                                           Case{"ring-v3", "ring", "light_tracing", 128, 16, 0.02, kRingLeak},
                                           Case{"lens-v3", "lens", "light_tracing", 256, 32},
                                           Case{"envglass-v3", "envglass", "light_tracing", 512, 32},
                                           Case{"veach-v3", "veach", "light_tracing", 128, 16}),
                         NameOf);
// Few light paths in few passes. The radii that are chosen for so few are too wide for the shadow at the ring's foot:
// there, the one that the file gives sppm.
INSTANTIATE_TEST_SUITE_P(
    FewPasses, BlockMeansAgree,
    ::testing::Values(WithPhotons({"cbox-v3", "cbox", "photon_mapping", 32}, 32768),
                      WithPhotons({"ring-v3", "ring", "photon_mapping", 32, 32, 0.02, kRingLeak}, 32768, 0.01),
                      WithPhotons({"lens-v3", "lens", "photon_mapping", 48}, 32768),
                      WithPhotons({"envglass-v3", "envglass", "photon_mapping", 128}, 0),
                      WithPhotons({"veach-v3", "veach", "photon_mapping", 32}, 32768),
                      WithPhotons({"veach-v3", "veach", "sppm", 48}, 32768),
                      WithPhotons({"ring-v3", "ring", "hybrid", 32, 32, 0.02, kRingLeak}, 32768, 0.01)),
    NameOf);
// The square map of envglass-v4 is resampled: single blocks may differ by 3 %, as the references' README says. In the
// darkest corner of its sky they differ by 6 %: there the file itself holds 0.01414 (its texels, read without
// interpolation) where the reference and the latitude-longitude map hold 0.01337.
constexpr double kResampledSky = 0.001;
INSTANTIATE_TEST_SUITE_P(V4, BlockMeansAgree,
                         ::testing::Values(Case{"veach-v4", "veach", "path", 128},
                                           Case{"envglass-v4", "envglass", "path", 128, 32, 0.03, kResampledSky},
                                           Case{"envglass-v4", "envglass", "sppm", 128, 32, 0.03, kResampledSky}),
                         NameOf);
// References with random samples, 256 and 512 a pixel: their noise counts as that of as many random paths of ours. Half
// as many passes as the reference has samples: twice as many would narrow what is allowed by a fifth.
// A known difference lies within these bounds: where shading and geometric normals disagree pbrt-v3 counts light from
// between their hemispheres when it samples a light, but never draws such a direction from a BSDF, and so loses
// indirect light. At a foot in the killeroo's shadow (block 33, 35) a path tracer with that rule finds 0.00865 +-
// 0.00003 (red), Dapple's 0.00890, the reference 0.00854 +- 0.0001.
INSTANTIATE_TEST_SUITE_P(
    OthersScenes, BlockMeansAgree,
    ::testing::Values(Case{"../data/killeroo-simple", "../data/killeroo-simple", "path", 128, 16, 0.02, 0, 256},
                      Case{"../data/gold-teapot", "../data/gold-teapot", "path", 256, 16, 0.02, 0, 512}),
    NameOf);

// The check above must be able to fail: it rejects a picture without its caustic, and one with the caustic elsewhere.
TEST_F(Reference, MissingCausticIsRejected) {
  const auto scene = Load("lens-v3.pbrt");
  const GroupedImages images = RenderGroups(*scene, "path", OptionsOf(*scene, "path"), 16, kGroups);
  const BlockReport report =
      CompareBlocks(images, Exact(ReadImage(ReferenceFolder() + "/lens.exr")), 32, kBlockTolerance);
  EXPECT_GT(report.failed, 3) << report.text;
}

TEST_F(Reference, MisplacedCausticIsRejected) {
  const auto scene = Load("ring-v3.pbrt");
  const GroupedImages images = RenderGroups(*scene, "sppm", OptionsOf(*scene, "sppm"), 32, kGroups);
  const Image reference = ReadImage(ReferenceFolder() + "/ring.exr");
  Image shifted = reference;
  constexpr int kShift = 4;
  for (int y = 0; y < reference.Height(); ++y)
    for (int x = 0; x < reference.Width(); ++x)
      for (int c = 0; c < reference.Channels(); ++c)
        shifted.At(x, y, c) = reference.At(std::min(x + kShift, reference.Width() - 1), y, c);
  EXPECT_GT(CompareBlocks(images, Exact(shifted), 32, kBlockTolerance).failed, 3);
}

class Slope : public Reference {};

// The slope of the mean log MSE over five seeds against log passes, by least squares. What has no bias that shrinks
// with the passes is compared block by block too, in all: even and odd passes of each seed are a group.
TEST_P(Slope, OfErrorAgainstPasses) {
  const Case& c = GetParam();
  const auto scene = Load(c.scene + ".pbrt");
  const Image reference = ReadImage(ReferenceFolder() + "/" + c.reference + ".exr");
  const std::vector<int> stops = {4, 8, 16, 32, 64};
  std::vector<double> logError(stops.size());
  IntegratorOptions options = OptionsOf(*scene, c.integrator);
  if (c.photons > 0) options.photonsPerPass = c.photons;
  constexpr int kSeeds = 5;
  GroupedImages groups;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto integrator = MakeIntegrator(c.integrator, options);
    integrator->Prepare(*scene, seed);
    Film film(scene->Settings().resolution, scene->Settings().crop, scene->Settings().filter);
    for (size_t stop = 0; stop < stops.size(); ++stop) {
      while (film.PassCount() < stops[stop]) integrator->RenderPass(static_cast<int>(film.PassCount()), film);
      const auto errors = CompareImages(film.ToImage(), reference);
      logError[stop] += std::log(c.hasRarePhotons ? errors.trimmedRelativeMse : errors.mse) / kSeeds;
    }
    for (const int half : {0, 1}) groups.groups.push_back(film.HalfImage(half));
  }
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const double n = static_cast<double>(stops.size());
  for (size_t i = 0; i < stops.size(); ++i) {
    const double x = std::log(stops[i]);
    sx += x;
    sy += logError[i];
    sxx += x * x;
    sxy += x * logError[i];
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  std::cout << fmt::format("slope {:.3f}\n", slope);
  EXPECT_LE(slope, c.integrator == "sppm" ? -0.6 : -0.9);
  if (c.integrator == "path")
    ExpectBlocksAgree(CompareBlocks(groups, Exact(reference), c.blockSize, c.tolerance, {}, c.floor));
}

Case WithRarePhotons(Case c) {
  c.hasRarePhotons = true;
  return c;
}

// 50,000 light paths a pass keep the error above the references' own; envglass, where few photons are of use, has its
// 200,000. There a few specks of photons that the guide did not foresee are most of the MSE of all pixels: by these,
// five seeds do not tell a slope, so the worst 0.1 % of pixels are left out.
INSTANTIATE_TEST_SUITE_P(V3, Slope,
                         ::testing::Values(Case{"cbox-v3", "cbox", "path", 64},
                                           Case{"ring-v3", "ring", "path", 64, 32, 0.02, kRingLeak},
                                           Case{"envglass-v3", "envglass", "path", 64},
                                           Case{"veach-v3", "veach", "path", 64},
                                           WithPhotons({"cbox-v3", "cbox", "sppm", 64}, 50000),
                                           WithPhotons({"ring-v3", "ring", "sppm", 64}, 50000),
                                           WithPhotons({"lens-v3", "lens", "sppm", 64}, 50000),
                                           WithRarePhotons({"envglass-v3", "envglass", "sppm", 64})),
                         NameOf);

/// A scene and, of its reference, its own relative MSE, as the references' README tells it.
struct ErrorCase {
  std::string scene, integrator;
  double ownError;
};

void PrintTo(const ErrorCase& c, std::ostream* out) { *out << c.scene << " " << c.integrator; }

class ErrorIsTold : public ::testing::TestWithParam<ErrorCase> {};

// What `--error` goes by, against the error that the reference shows: within a factor of 1.5 after 8 passes and
// after 64.
TEST_P(ErrorIsTold, WithinAFactorOfOneAndAHalf) {
  if (ReferenceFolder().empty()) GTEST_SKIP() << "DAPPLE_REFERENCES does not name the folder of references";
  const ErrorCase& c = GetParam();
  const auto scene = Load(c.scene + "-v3.pbrt");
  const Image reference = ReadImage(ReferenceFolder() + "/" + c.scene + ".exr");
  IntegratorOptions options = OptionsOf(*scene, c.integrator);
  // Few, so that the error stays above the references' own.
  options.photonsPerPass = 10000;
  const auto integrator = MakeIntegrator(c.integrator, options);
  integrator->Prepare(*scene, 1);
  Film film(scene->Settings().resolution, scene->Settings().crop, scene->Settings().filter);
  film.TrackBlur();
  int pass = 0;
  for (int passes : {8, 64}) {
    for (; pass < passes; ++pass) integrator->RenderPass(pass, film);
    const double found = CompareImages(film.ToImage(), reference).relativeMse;
    ASSERT_GT(found, 2 * c.ownError) << "the reference is not good enough to tell";
    const double error = std::sqrt(found - c.ownError);
    const std::optional<ErrorEstimate> estimate = EstimateError(film, scene->Settings().exposure);
    ASSERT_TRUE(estimate);
    const double ratio = estimate->Total() / error;
    std::cout << fmt::format("{} passes: told {:.2f} %, is {:.2f} %, ratio {:.2f}\n", passes, 100 * estimate->Total(),
                             100 * error, ratio);
    EXPECT_GT(ratio, 1 / 1.5) << passes << " passes";
    EXPECT_LT(ratio, 1.5) << passes << " passes";
  }
}

// The caustics of ring and lens are what paths cannot find, or seldom: what is not in the picture cannot be told.
INSTANTIATE_TEST_SUITE_P(V3, ErrorIsTold,
                         ::testing::Values(ErrorCase{"cbox", "path", 3e-4}, ErrorCase{"envglass", "path", 1e-5},
                                           ErrorCase{"veach", "path", 5e-4}, ErrorCase{"cbox", "sppm", 3e-4},
                                           ErrorCase{"ring", "sppm", 2e-4}, ErrorCase{"lens", "sppm", 2e-4},
                                           ErrorCase{"envglass", "sppm", 1e-5}, ErrorCase{"veach", "sppm", 5e-4}),
                         [](const auto& test) { return test.param.scene + "_" + test.param.integrator; });

}  // namespace
}  // namespace dapple
