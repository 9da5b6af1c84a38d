// `--error`: a render that ends when its picture is good enough.
#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "src/image/image_io.h"
#include "tests/app/program.h"

namespace dapple {
namespace {

class ErrorBudget : public ProgramTest {
 protected:
  void SetUp() override { WriteSceneOfSharedWork("shared.pbrt"); }
  /// Renders to FILE with these options and gives the passes that it took.
  int Render(const std::string& file, const std::string& integrator, const std::string& options) const {
    const ProgramResult result = Run("shared.pbrt --quiet --integrator " + integrator + " " +
                                     ShortRender(integrator, 9000) + "-o " + file + " " + options);
    EXPECT_EQ(result.exitCode, 0) << options;
    EXPECT_EQ(result.err, "") << options;
    return std::get<int>(ReadExrMetadata(Path(file)).at("passes"));
  }
  bool IsSamePicture(const std::string& a, const std::string& b) const {
    const Image one = ReadImage(Path(a)), other = ReadImage(Path(b));
    return std::ranges::equal(one.Values(), other.Values());
  }
};

// The estimate changes no bit of the picture, and where it ends the render no thread count does.
TEST_F(ErrorBudget, IsThePictureOfItsPassesWithAnyThreads) {
  for (const std::string integrator : {"path", "sppm", "hybrid", "photon_mapping", "light_tracing"}) {
    const std::string options = "--error 0.25 --passes 32";
    const int passes = Render("a.exr", integrator, options + " --threads 1");
    const double error = std::get<double>(ReadExrMetadata(Path("a.exr")).at("error"));
    EXPECT_LT(error, 0.25) << integrator;
    EXPECT_GT(error, 0.001) << integrator;
    EXPECT_EQ(passes % 2, 0);
    EXPECT_GE(passes, 8);
    EXPECT_EQ(Render("b.exr", integrator, options + " --threads 3"), passes);
    EXPECT_TRUE(Read("a.exr") == Read("b.exr")) << integrator;
    Render("c.exr", integrator, "--passes " + std::to_string(passes));
    EXPECT_TRUE(IsSamePicture("a.exr", "c.exr")) << integrator;
    EXPECT_EQ(ReadExrMetadata(Path("c.exr")).count("error"), 0u);
  }
}

TEST_F(ErrorBudget, GoesOnAfterABreak) {
  const std::string options = "--error 0.1";
  const int passes = Render("a.exr", "sppm", options);
  ASSERT_GT(passes, 5);
  const ProgramResult part =
      Run("shared.pbrt --quiet --photons 9000 --no-guide --radius 0.2 --integrator sppm "
          "--error 0.1 --passes 5 --checkpoint 60 -o b.exr");
  EXPECT_TRUE(Contains(part.err, "warning: the error is about ")) << "not reached, and told so";
  EXPECT_EQ(part.exitCode, 0);
  EXPECT_EQ(Render("b.exr", "sppm", options + " --resume"), passes);
  EXPECT_TRUE(Read("a.exr") == Read("b.exr"));
  // What was rendered without an eye on the bias cannot tell it.
  std::filesystem::remove(Path("b.exr.checkpoint"));
  Render("b.exr", "sppm", "--passes 5 --checkpoint 60");
  const ProgramResult other =
      Run("shared.pbrt --quiet --photons 9000 --no-guide --radius 0.2 --integrator sppm "
          "--error 0.1 --resume -o b.exr");
  EXPECT_EQ(other.exitCode, 1);
  EXPECT_TRUE(Contains(other.err, "estimate of bias off, not on"));
}

TEST_F(ErrorBudget, IsToldInTheSummaryAndInTheStatistics) {
  const ProgramResult result = Run("shared.pbrt --integrator sppm --error 0.3 --photons 9000 --stats s.json");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_TRUE(Contains(result.out, "accuracy  error about "));
  EXPECT_TRUE(Contains(Read("s.json"), "\"bias\": 0."));
  ASSERT_EQ(Run("shared.pbrt --integrator sppm --passes 2 --photons 9000 --stats s.json").exitCode, 0);
  EXPECT_TRUE(Contains(Read("s.json"), "\"bias\": null"));
}

TEST_F(ErrorBudget, RefusesWhatItCannotEstimate) {
  for (const char* options : {"--error 0", "--error nan", "--error 0.1 --passes 2:4", "--error 0.1 --clamp 3"})
    EXPECT_EQ(Run(std::string("shared.pbrt ") + options).exitCode, 2) << options;
}

}  // namespace
}  // namespace dapple
