// `dapple converge` from end to end, but for what a browser makes of the page.
#include <cmath>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <signal.h>

#include "src/image/image_io.h"
#include "src/image/metrics.h"
#include "src/render/version.h"
#include "tests/app/program.h"

namespace dapple {
namespace {

using Converge = ProgramTest;

TEST_F(Converge, WritesDataAndAPageThatNeedsNothingElse) {
  WriteScene("tiny.pbrt");
  const ProgramResult result = Run(
      "converge tiny.pbrt --integrators path,sppm --time 0.1 --seeds 2 --reference-time 0.2 --photons 500 --no-guide "
      "-o out/report");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_TRUE(BeginsWith(result.out, "| relative MSE | `path` | `sppm` |\n|---|---|---|\n| `tiny` |"));
  EXPECT_TRUE(result.out.ends_with("\nout/report/index.html\n"));
  const auto json = nlohmann::json::parse(Read("out/report/data.json"));
  EXPECT_EQ(json["about"]["version"], Version());
  EXPECT_TRUE(BeginsWith(json["about"]["commandLine"], "dapple converge tiny.pbrt --integrators path,sppm"));
  const auto& scene = json["scenes"][0];
  EXPECT_EQ(scene["name"], "tiny");
  EXPECT_EQ(scene["width"], 24);
  EXPECT_GT(scene["reference"]["errors"]["relativeMse"], 0);
  ASSERT_EQ(scene["contenders"].size(), 2u);
  int snapshots = 0;
  for (const auto& contender : scene["contenders"]) {
    ASSERT_EQ(contender["seeds"].size(), 2u);
    for (const auto& run : contender["seeds"]) {
      ASSERT_GE(run["snapshots"].size(), 1u);
      EXPECT_EQ(run["snapshots"].back()["passes"], run["passes"]);
      EXPECT_EQ(run["snapshots"].back()["timeIndex"], 16);
      snapshots += static_cast<int>(run["snapshots"].size());
    }
  }
  std::istringstream csv(Read("out/report/data.csv"));
  int lines = 0;
  for (std::string line; std::getline(csv, line);) ++lines;
  EXPECT_EQ(lines, snapshots + 1);
  const std::string page = Read("out/report/index.html");
  EXPECT_FALSE(std::regex_search(
      page, std::regex("(src|href)\\s*=|@import|url\\(|fetch\\(|@STYLE@|@DATA@|@SCRIPT@", std::regex::optimize)));
  EXPECT_TRUE(Contains(page, "data:image/png;base64,iVBORw0KGgo"));
}

// What is measured is what `compare` measures, of a render of as many passes.
TEST_F(Converge, ErrorsAreThoseOfTheRender) {
  WriteScene("tiny.pbrt");
  ASSERT_EQ(Run("tiny.pbrt --integrator path --passes 256 --seed 99 -o ref.exr --quiet").exitCode, 0);
  ASSERT_EQ(Run("converge tiny.pbrt --integrators path --time 0.05 --seeds 1 --seed 5 --reference ref.exr "
                "--reference-error 1e-4 -o out --quiet")
                .exitCode,
            0);
  const auto scene = nlohmann::json::parse(Read("out/data.json"))["scenes"][0];
  EXPECT_EQ(scene["reference"]["errors"]["relativeMse"], 1e-4);
  EXPECT_TRUE(scene["reference"]["errors"]["flip"].is_null());
  const auto& last = scene["contenders"][0]["seeds"][0]["snapshots"].back();
  ASSERT_EQ(Run("tiny.pbrt --integrator path --seed 5 -o a.exr --quiet --passes " + last["passes"].dump()).exitCode, 0);
  const ImageDifference difference = CompareImages(ReadImage(Path("a.exr")), ReadImage(Path("ref.exr")));
  EXPECT_DOUBLE_EQ(last["errors"]["relativeMse"], difference.relativeMse);
  EXPECT_DOUBLE_EQ(last["errors"]["mape"], difference.mape);
}

TEST_F(Converge, StrategiesOfInfiniteLights) {
  WriteScene("tiny.pbrt");
  Write("sky.pbrt", Read("tiny.pbrt") + "LightSource \"infinite\" \"rgb L\" [1 1 2]\n");
  const std::string rest = " --integrators path --time 0.02 --seeds 1 --reference-time 0.05 -o out --quiet";
  ASSERT_EQ(Run("converge sky.pbrt --strategies uniform,product/importance" + rest).exitCode, 0);
  const auto contenders = nlohmann::json::parse(Read("out/data.json"))["scenes"][0]["contenders"];
  ASSERT_EQ(contenders.size(), 2u);
  EXPECT_EQ(contenders[0]["name"], "path uniform");
  EXPECT_EQ(contenders[1]["strategy"], "product/importance");
  const ProgramResult unknown = Run("converge sky.pbrt --strategies best" + rest);
  EXPECT_EQ(unknown.exitCode, 1);
  EXPECT_TRUE(Contains(unknown.err, "unknown sampling \"best\""));
  const ProgramResult lightless = Run("converge tiny.pbrt --strategies uniform" + rest);
  EXPECT_EQ(lightless.exitCode, 1);
  EXPECT_TRUE(BeginsWith(lightless.err, "tiny.pbrt: error: strategy uniform: the scene has no infinite light"));
}

TEST_F(Converge, ASignalEndsItWithTheRunsThatAreComplete) {
  WriteScene("tiny.pbrt");
  const ProgramResult result = RunAndSignal(
      "converge tiny.pbrt --integrators path --time 0.2 --seeds 1000 --reference-time 0.1 -o out", SIGINT, "seed 1:");
  EXPECT_EQ(result.exitCode, 128 + SIGINT) << result.err;
  const auto seeds = nlohmann::json::parse(Read("out/data.json"))["scenes"][0]["contenders"][0]["seeds"];
  ASSERT_GE(seeds.size(), 2u);
  for (const auto& run : seeds) EXPECT_EQ(run["snapshots"].back()["timeIndex"], 16);
  EXPECT_TRUE(Exists("out/index.html"));
}

std::vector<std::string> ScenesOf(const std::string& json) {
  std::vector<std::string> names;
  const auto report = nlohmann::json::parse(json);  // that outlives the loop
  for (const auto& scene : report["scenes"]) names.push_back(scene["name"]);
  return names;
}

// Whether a run of the second scene was complete is a matter of speed.
TEST_F(Converge, ASignalInALaterSceneKeepsTheStudiesBefore) {
  WriteScene("tiny.pbrt");
  Write("slow.pbrt",
        "Camera \"perspective\" \"float fov\" 90\n"
        "Film \"rgb\" \"integer xresolution\" 500 \"integer yresolution\" 500\nWorldBegin\n"
        "LightSource \"point\" Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n"
        "Shape \"sphere\" \"float radius\" 9\n");
  const ProgramResult result = RunAndSignal(
      "converge tiny.pbrt slow.pbrt --integrators path --reference-integrator path --time 0.02 --seeds 100 "
      "--reference-time 0.05 -o out",
      SIGTERM, "slow: reference, ");
  EXPECT_EQ(result.exitCode, 128 + SIGTERM) << result.err;
  EXPECT_EQ(ScenesOf(Read("out/data.json")).front(), "tiny");
  EXPECT_TRUE(Exists("out/index.html") && Exists("out/data.csv"));
}

TEST_F(Converge, AFileThatCannotBeWrittenCostsNoStudyAndNoOtherFile) {
  WriteScene("a.pbrt");
  WriteScene("b.pbrt");
  for (const std::string name : {"out/reference-a.exr", "out/reference-b.exr", "out/data.csv"}) {
    std::filesystem::remove_all(Path("out"));
    std::filesystem::create_directory(Path("out"));
    std::filesystem::create_symlink("/dev/full", Path(name));
    const ProgramResult result =
        Run("converge a.pbrt b.pbrt --integrators path --time 0.02 --seeds 1 --reference-time 0.05 -o out --quiet");
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_EQ(result.err, name + ": error: cannot write the file: No space left on device\n");
    EXPECT_EQ(ScenesOf(Read("out/data.json")), (std::vector<std::string>{"a", "b"}));
    EXPECT_TRUE(Exists("out/index.html"));
  }
}

TEST_F(Converge, WhatCannotBeWrittenIsToldBeforeAnythingIsRendered) {
  WriteScene("tiny.pbrt");
  const std::string rest = " --integrators path --time 0.02 --seeds 1 -o out";
  for (const std::string name : {"out/index.html", "out/data.json", "out/data.csv", "out/reference-tiny.exr"}) {
    std::filesystem::create_directories(Path(name));
    const ProgramResult result = Run("converge tiny.pbrt" + rest);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_EQ(result.err, name + ": error: expected the name of a file; this is a folder\n");
    std::filesystem::remove(Path(name));
  }
  // Nor may it replace what a scene is read from.
  Write("out/data.csv", Read("tiny.pbrt"));
  Write("uses.pbrt", "Include \"out/data.csv\"\n");
  const ProgramResult used = Run("converge uses.pbrt" + rest);
  EXPECT_EQ(used.exitCode, 1);
  EXPECT_TRUE(Contains(used.err, "uses.pbrt: error: what the scene is read from and data.csv are one file: "));
  EXPECT_FALSE(Contains(used.err, "uses: ")) << "nothing was rendered";
  WriteExr(Path("out/reference-tiny.exr"), Image::Rgb(24, 16));
  EXPECT_EQ(Run("converge out/data.csv tiny.pbrt" + rest).exitCode, 2);
  EXPECT_EQ(Read("out/data.csv"), Read("tiny.pbrt"));
}

// Else the studies of those before it would be lost.
TEST_F(Converge, ASceneThatCannotBeReadIsToldBeforeAnyIsRendered) {
  WriteScene("tiny.pbrt");
  Write("broken.pbrt", "Camera \"perspective\"\nWorldBegin\n  Shap \"sphere\"\n");
  const auto error = [&](const std::string& arguments) {
    const ProgramResult result =
        Run("converge tiny.pbrt " + arguments + " --integrators path --time 0.02 --seeds 1 -o out");
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_FALSE(Contains(result.err, "tiny: ")) << "nothing was rendered";
    EXPECT_FALSE(Exists("out/reference-tiny.exr"));
    return result.err;
  };
  EXPECT_TRUE(Contains(error("nowhere.pbrt"), "nowhere.pbrt: error: "));
  EXPECT_TRUE(Contains(error("broken.pbrt"), "broken.pbrt:3:3: error: "));
  Write("sky.pbrt", "WorldBegin\nLightSource \"infinite\"\nShape \"sphere\"\n");
  EXPECT_TRUE(
      Contains(Run("converge sky.pbrt tiny.pbrt --integrators path --strategies uniform --time 0.02 -o out").err,
               "tiny.pbrt: error: strategy uniform: the scene has no infinite light"));
  EXPECT_FALSE(Exists("out/reference-sky.exr"));
}

TEST_F(Converge, SeedsGoOnBehindTheGreatest) {
  WriteScene("tiny.pbrt");
  ASSERT_EQ(Run("converge tiny.pbrt --integrators path --time 0.02 --seeds 2 --seed 2147483647 --reference-time 0.05 "
                "-o out --quiet")
                .exitCode,
            0);
  const auto seeds = nlohmann::json::parse(Read("out/data.json"))["scenes"][0]["contenders"][0]["seeds"];
  ASSERT_EQ(seeds.size(), 2u);
  EXPECT_EQ(seeds[0]["seed"], 2147483647);
  EXPECT_EQ(seeds[1]["seed"], -2147483648);
}

// All that is random in it follows from its own seed: what a pilot of `auto` learned too.
TEST_F(Converge, TheReferenceIsARenderOfItsSeed) {
  WriteScene("tiny.pbrt");
  ASSERT_EQ(
      Run("converge tiny.pbrt --integrators path --time 0.02 --seeds 1 --reference-time 0.4 -o out --quiet").exitCode,
      0);
  const auto scene = nlohmann::json::parse(Read("out/data.json"))["scenes"][0];
  const std::string source = scene["reference"]["source"];
  ASSERT_TRUE(BeginsWith(source, "hybrid, "));
  const std::string passes = source.substr(8, source.find(" pass") - 8);
  ASSERT_EQ(Run("tiny.pbrt --integrator auto --seed 1592651789 -o a.exr --quiet --passes " + passes).exitCode, 0);
  EXPECT_EQ(CompareImages(ReadImage(Path("a.exr")), ReadImage(Path("out/reference-tiny.exr"))).mse, 0);
}

// Names of files may hold any bytes.
TEST_F(Converge, ANameThatIsNoUtf8LosesNoStudy) {
  WriteScene("caf\xe9.pbrt");
  const ProgramResult result =
      Run("converge 'caf\xe9.pbrt' --integrators path --time 0.02 --seeds 1 --reference-time 0.05 -o out --quiet");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(Read("out/data.json"))["scenes"][0]["name"], "caf\xef\xbf\xbd");
  EXPECT_TRUE(Contains(Read("out/index.html"), "\"name\":\"caf\xef\xbf\xbd\""));
}

TEST_F(Converge, AReferenceThatDoesNotFitIsTold) {
  WriteScene("tiny.pbrt");
  WriteExr(Path("wide.exr"), Image::Rgb(25, 16));
  Image part = Image::Rgb(12, 16);
  part.fullSize = {24, 16};
  WriteExr(Path("part.exr"), part);
  const std::string rest = " --integrators path --time 0.02 --seeds 1 -o out --quiet";
  const ProgramResult wide = Run("converge tiny.pbrt --reference wide.exr" + rest);
  EXPECT_EQ(wide.exitCode, 1);
  EXPECT_EQ(wide.err, "wide.exr: error: the reference is of 25 x 16 pixels, but tiny.pbrt is rendered with 24 x 16\n");
  const ProgramResult half = Run("converge tiny.pbrt --reference part.exr" + rest);
  EXPECT_EQ(half.exitCode, 1);
  EXPECT_TRUE(BeginsWith(half.err, "part.exr: error: the reference does not cover what is rendered of tiny.pbrt"));
  WriteExr(Path("depth.exr"), Image(24, 16, {"Z"}));
  EXPECT_TRUE(BeginsWith(Run("converge tiny.pbrt --reference depth.exr" + rest).err, "depth.exr: error: "));
  EXPECT_EQ(Run("converge missing.pbrt" + rest).exitCode, 1);
}

}  // namespace
}  // namespace dapple
