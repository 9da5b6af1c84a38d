// A render that was ended and went on is the render that was not: the same file, to the last bit.
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <signal.h>

#include "integrators/integrator.h"
#include "src/image/image_io.h"
#include "tests/app/program.h"

namespace dapple {
namespace {

using Resume = ProgramTest;

class ReproducibleFile : public ProgramTest, public testing::WithParamInterface<std::string_view> {
 protected:
  /// Renders with these further options and gives the file. Without pilots, which take most of the time of so short a
  /// render; tests/slow has them.
  std::string Render(const std::string& options) const {
    const std::string command = "shared.pbrt --quiet --integrator " + std::string(GetParam()) + " " +
                                ShortRender(GetParam(), 9000) + "-o a.exr " + options;
    const ProgramResult result = Run(command);
    EXPECT_EQ(result.exitCode, 0) << command;
    EXPECT_EQ(result.err, "") << command;
    return Read("a.exr");
  }
};

TEST_P(ReproducibleFile, WithAnyThreadsCheckpointsBreaksAndSnapshots) {
  WriteSceneOfSharedWork("shared.pbrt");
  const std::string whole = Render("--passes 4 --threads 1");
  ASSERT_FALSE(whole.empty());
  const std::string half = Render("--passes 2 --threads 1");
  for (const std::string threads : {"1", "2", "3", "16"}) {
    EXPECT_TRUE(Render("--passes 4 --threads " + threads) == whole) << threads << " threads";
    const std::string all = " --checkpoint 0.0001 --snapshots 1 --threads " + threads;
    EXPECT_TRUE(Render("--passes 2" + all) == half) << threads << " threads";
    EXPECT_TRUE(Render("--passes 4 --resume" + all) == whole) << threads << " threads";
    EXPECT_TRUE(Read("a.00002.exr") == half) << "a snapshot is the picture of its passes";
    EXPECT_TRUE(Read("a.00004.exr") == whole);
    std::filesystem::remove(Path("a.exr.checkpoint"));
  }
  EXPECT_FALSE(Render("--passes 4 --seed 1") == whole) << "another seed, another noise";
}

std::vector<std::string_view> Names() { return IntegratorNames(); }

INSTANTIATE_TEST_SUITE_P(All, ReproducibleFile, testing::ValuesIn(Names()),
                         [](const auto& instance) { return std::string(instance.param); });

TEST_F(Resume, AfterASignalTheSameCommandEndsInTheSameFile) {
  WriteScene("tiny.pbrt");
  const std::string command = "tiny.pbrt --integrator path --aov albedo,depth -o a.exr --passes ";
  // More passes than any machine has done before it reads the signal.
  EXPECT_EQ(RunAndSignal(command + "1000000000", SIGTERM, " %: 1 pass, ").exitCode, 128 + SIGTERM);
  const std::string passes = std::to_string(std::get<int>(ReadExrMetadata(Path("a.exr")).at("passes")) + 3);
  const ProgramResult resumed = Run(command + passes + " --resume");
  EXPECT_EQ(resumed.exitCode, 0) << resumed.err;
  EXPECT_TRUE(Contains(resumed.err, "a.exr.checkpoint: going on after "));
  const std::string whole = Read("a.exr");
  ASSERT_EQ(Run(command + passes + " --quiet").exitCode, 0);
  EXPECT_TRUE(Read("a.exr") == whole);
}

TEST_F(Resume, ARangeOfPassesGoesOnToo) {
  WriteScene("tiny.pbrt");
  const std::string command = "tiny.pbrt --quiet --integrator path -o part.dapple";
  ASSERT_EQ(Run(command + " --passes 3:9").exitCode, 0);
  const std::string whole = Read("part.dapple");
  ASSERT_EQ(Run(command + " --passes 3:5 --checkpoint 60").exitCode, 0);
  ASSERT_EQ(Run(command + " --passes 3:9 --resume").exitCode, 0);
  EXPECT_TRUE(Read("part.dapple") == whole);
  const ProgramResult other = Run(command + " --passes 4:9 --resume");
  EXPECT_EQ(other.exitCode, 1);
  EXPECT_EQ(other.err,
            "part.dapple.checkpoint: error: it holds passes 3 to 8, more than the 4 to 8 that are asked for\n");
}

// Whoever forgets --resume loses nothing by it.
TEST_F(Resume, ACheckpointThatWasNotGoneOnFromIsSetAside) {
  WriteScene("tiny.pbrt");
  const std::string command = "tiny.pbrt --quiet --integrator path --checkpoint 60 -o a.exr --passes ";
  ASSERT_EQ(Run(command + "3").err, "");
  const std::string whole = Read("a.exr"), checkpoint = Read("a.exr.checkpoint");
  const ProgramResult forgotten = Run(command + "1");
  EXPECT_EQ(forgotten.exitCode, 0);
  EXPECT_EQ(forgotten.err,
            "warning: a checkpoint was there that this render does not go on from; it is now a.exr.checkpoint.old\n");
  EXPECT_TRUE(Read("a.exr.checkpoint.old") == checkpoint);
  std::filesystem::rename(Path("a.exr.checkpoint.old"), Path("a.exr.checkpoint"));
  EXPECT_EQ(Run(command + "3 --resume").err, "");
  EXPECT_TRUE(Read("a.exr") == whole);
  EXPECT_FALSE(Exists("a.exr.checkpoint.old"));
}

TEST_F(Resume, BeginsWhereThereIsNoCheckpointYet) {
  WriteScene("tiny.pbrt");
  const ProgramResult result = Run("tiny.pbrt --integrator path --passes 2 --resume -o a.exr");
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_TRUE(Contains(result.err, "a.exr.checkpoint: not there yet; beginning with the first pass\n"));
}

TEST_F(Resume, TheSummaryCountsThePassesOfAllParts) {
  WriteScene("tiny.pbrt");
  const std::string command = "tiny.pbrt --integrator path -o a.exr --checkpoint 60 ";
  const ProgramResult first = Run(command + "--passes 4");
  EXPECT_TRUE(Contains(first.out, "\n4 passes in "));
  EXPECT_FALSE(Contains(first.out, "with those before"));
  const ProgramResult second = Run(command + "--passes 6 --resume");
  EXPECT_TRUE(Contains(second.out, "\n2 passes in "));
  EXPECT_TRUE(Contains(second.out, "); with those before, 6 passes\n"));
}

TEST_F(Resume, AFolderInPlaceOfTheCheckpointIsToldAsOne) {
  WriteScene("tiny.pbrt");
  std::filesystem::create_directory(Path("a.exr.checkpoint"));
  for (const char* option : {"--resume", "--checkpoint 60"}) {
    const ProgramResult result = Run(std::string("tiny.pbrt --quiet --integrator path --passes 2 -o a.exr ") + option);
    EXPECT_EQ(result.exitCode, 1) << option;
    EXPECT_EQ(result.err, "a.exr.checkpoint: error: expected the name of a file; this is a folder\n") << option;
  }
  EXPECT_FALSE(Exists("a.exr"));
}

TEST_F(Resume, RefusesTheCheckpointOfAnotherRenderAndSaysWhatDiffers) {
  WriteScene("tiny.pbrt");
  const std::string command = "--quiet -o a.exr --passes ";
  ASSERT_EQ(Run(command + "3 tiny.pbrt --integrator path --checkpoint 60").exitCode, 0);
  const std::string checkpoint = Read("a.exr.checkpoint"), picture = Read("a.exr");
  Write("moved.pbrt", Read("tiny.pbrt") + "Translate 0 0.1 0\nShape \"sphere\" \"float radius\" 0.1\n");
  const auto difference = [&](const std::string& arguments) {
    const ProgramResult result = Run(command + arguments + " --resume");
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(Read("a.exr.checkpoint") == checkpoint && Read("a.exr") == picture) << "nothing is touched";
    return result.err;
  };
  const auto message = [](const std::string& what) {
    return "a.exr.checkpoint: error: it is of another render: " + what + "; remove it, or render without --resume\n";
  };
  EXPECT_EQ(difference("3 tiny.pbrt --integrator path --seed 5"), message("seed 0, not 5"));
  EXPECT_EQ(difference("3 tiny.pbrt --integrator light_tracing"), message("integrator path, not light_tracing"));
  EXPECT_EQ(difference("3 tiny.pbrt --integrator path --clamp 2"), message("clamp none, not 2"));
  EXPECT_EQ(difference("3 tiny.pbrt --integrator path --aov normal"), message("aov none, not normal"));
  EXPECT_EQ(difference("3 moved.pbrt --integrator path"), message("the scene's content"));
  EXPECT_EQ(difference("2 tiny.pbrt --integrator path"),
            "a.exr.checkpoint: error: it holds passes 0 to 2, more than the 0 to 1 that are asked for\n");
  Write("a.exr.checkpoint", checkpoint.substr(0, checkpoint.size() - 1));
  EXPECT_TRUE(BeginsWith(Run(command + "3 tiny.pbrt --integrator path --resume").err,
                         "a.exr.checkpoint: error: the file is damaged"));
}

// What Dapple chose may be named outright, and the reverse, where that is the same render; where the choice changes how
// an environment is sampled, that is what is told.
TEST_F(Resume, WhatWasChosenMayBeNamedWhereTheBitsAreTheSame) {
  const char* const kPath = "path --camera-samples 4";
  WriteScene("tiny.pbrt");
  WriteExr(Path("sky.exr"), Image(2, 2, {"Y"}, {1, 2, 3, 4}));
  const std::string begin =
      "LookAt 0 0 -3  0 0 0  0 1 0\nCamera \"perspective\"\n"
      "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nWorldBegin\nShape \"sphere\"\n";
  const std::string sky = "LightSource \"infinite\" \"string filename\" \"sky.exr\"";
  Write("point.pbrt", begin + "LightSource \"point\" \"point3 from\" [0 2 -2]\n");
  Write("sky.pbrt", begin + sky + "\n");
  Write("told.pbrt", begin + sky + " \"string sampling\" \"irradiance\"\n");
  for (const std::string scene : {"point.pbrt", "told.pbrt", "sky.pbrt"})
    for (const auto& [first, second] : {std::pair("auto", kPath), std::pair(kPath, "auto")}) {
      const std::string command = scene + " --quiet -o a.exr --checkpoint 60 --integrator ";
      ASSERT_EQ(Run(command + second + " --passes 3").exitCode, 0);
      const std::string whole = Read("a.exr");
      ASSERT_EQ(Run(command + first + " --passes 1").exitCode, 0);
      const ProgramResult resumed = Run(command + second + " --passes 3 --resume");
      if (scene == "sky.pbrt") {
        EXPECT_EQ(resumed.exitCode, 1);
        const bool wasChosen = std::string(first) == "auto";
        EXPECT_EQ(resumed.err,
                  "a.exr.checkpoint: error: it is of another render: environment sampling " +
                      std::string(wasChosen ? "irradiance, not importance" : "importance, not irradiance") +
                      "; remove it, or render without --resume\n");
      } else {
        EXPECT_EQ(resumed.exitCode, 0) << resumed.err;
        EXPECT_TRUE(Read("a.exr") == whole) << scene << ": " << first << ", then " << second;
      }
    }
  ASSERT_EQ(Run("point.pbrt --quiet -o a.exr --checkpoint 60 --integrator auto --passes 1").exitCode, 0);
  EXPECT_TRUE(Contains(Run("point.pbrt --quiet -o a.exr --integrator path --passes 3 --resume").err,
                       "camera-samples 4, not automatic"));
}

// Lights so bright that what they give overflows in the integrator, or is more than the film holds.
TEST_F(Resume, WhatWasLeftOutIsCountedOverAllParts) {
  Write("hot.pbrt",
        "LookAt 0 1 -4  0 0 0  0 1 0\nCamera \"perspective\"\n"
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
        "LightSource \"distant\" \"rgb L\" [3e38 3e38 3e38] \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n"
        "Shape \"bilinearmesh\" \"point3 P\" [-3 0 -3  3 0 -3  -3 0 3  3 0 3]\n"
        "AreaLightSource \"diffuse\" \"rgb L\" [3e38 3e38 3e38]\nTranslate 0 2 0\nRotate 90 1 0 0\n"
        "Shape \"disk\" \"float radius\" 5\n");
  const std::string command = "hot.pbrt --quiet --integrator path ";
  const ProgramResult whole = Run(command + "--passes 8 -o whole.exr --stats whole.json");
  ASSERT_EQ(whole.exitCode, 0) << whole.err;
  int total = 0, ofIntegrator = 0, ofFilm = 0;
  ASSERT_EQ(std::sscanf(whole.err.c_str(),
                        "warning: %d contributions were left out: infinite, not a number, or too large: "
                        "%d of the integrator, %d of values that the film refused",
                        &total, &ofIntegrator, &ofFilm),
            3)
      << whole.err;
  EXPECT_GT(ofIntegrator, 0);
  EXPECT_GT(ofFilm, 0);
  EXPECT_EQ(ofIntegrator + ofFilm, total);

  const auto counts = [&](const std::string& file) {
    const auto json = nlohmann::json::parse(Read(file));
    return std::pair(json["nonFinite"], json["nonFiniteSources"]);
  };
  ASSERT_EQ(Run(command + "--passes 3 -o a.exr --checkpoint 60").exitCode, 0);
  EXPECT_EQ(Run(command + "--passes 8 -o a.exr --resume --stats a.json").err, whole.err);
  EXPECT_EQ(counts("a.json"), counts("whole.json"));
  EXPECT_EQ(counts("a.json").first, total);

  for (const std::string range : {"0:3", "3:8"}) ASSERT_EQ(Run(command + "--passes " + range).exitCode, 0);
  EXPECT_EQ(Run("merge hot.0-3.dapple hot.3-8.dapple -o merged.exr").err, whole.err);
}

TEST_F(Resume, TheFileRecordsTheTimeOfAllParts) {
  WriteScene("tiny.pbrt");
  const auto seconds = [&] { return std::get<double>(ReadExrMetadata(Path("a.exr")).at("seconds")); };
  ASSERT_EQ(Run("tiny.pbrt --quiet --integrator path --time 0.3 --checkpoint 60 -o a.exr").exitCode, 0);
  const double first = seconds();
  ASSERT_EQ(Run("tiny.pbrt --quiet --integrator path --time 0.1 --resume -o a.exr").exitCode, 0);
  EXPECT_GT(seconds(), first);
}

TEST_F(Resume, AClampIsRecordedAndTakesLightAway) {
  WriteScene("tiny.pbrt");
  const std::string command = "tiny.pbrt --quiet --integrator path --passes 4 -o a.exr";
  const auto sum = [&] {
    const Image image = ReadImage(Path("a.exr"));  // that outlives the loop
    double total = 0;
    for (const float value : image.Values()) total += static_cast<double>(value);
    return total;
  };
  ASSERT_EQ(Run(command).exitCode, 0);
  EXPECT_FALSE(ReadExrMetadata(Path("a.exr")).contains("clamp"));
  const double all = sum();
  ASSERT_EQ(Run(command + " --clamp 0.03125").exitCode, 0);
  EXPECT_EQ(std::get<double>(ReadExrMetadata(Path("a.exr")).at("clamp")), 0.03125);
  EXPECT_LT(sum(), 0.9 * all);
  EXPECT_LE(std::ranges::max(ReadImage(Path("a.exr")).Values()), 0.03125f * 1.0001f);
}

}  // namespace
}  // namespace dapple
