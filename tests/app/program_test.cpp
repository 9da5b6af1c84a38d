// The program from end to end: what it takes, what it writes, what it says and how it exits.
#include "tests/app/program.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <signal.h>

#include "src/image/image_io.h"
#include "src/render/version.h"

namespace dapple {
namespace {

using Program = ProgramTest;

TEST_F(Program, HelpNamesTheSubcommandsAndExitCodes) {
  const ProgramResult result = Run("--help");
  EXPECT_EQ(result.exitCode, 0);
  for (const char* text : {"render", "info", "emit", "envmap", "compare", "converge", "Exit codes"})
    EXPECT_TRUE(Contains(result.out, text));
  EXPECT_TRUE(Contains(Run("render --help").out, "--integrator"));
  EXPECT_TRUE(Contains(Run("info --help").out, "--pbrt-version"));
}

TEST_F(Program, TellsItsVersion) {
  const ProgramResult result = Run("--version");
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_TRUE(BeginsWith(result.out, "dapple " + Version() + ", " + InstructionSet()));
}

// Passes that auto makes larger are fewer by as much.
TEST_F(Program, APassOfManyCameraPathsCountsAsMany) {
  const auto write = [&](int samples) {
    Write("many.pbrt",
          "Sampler \"random\" \"integer pixelsamples\" " + std::to_string(samples) +
              "\nCamera \"perspective\"\nFilm \"image\" \"integer xresolution\" 8 \"integer yresolution\" 8\n"
              "WorldBegin\nLightSource \"point\"\nMaterial \"matte\"\n"
              "Translate 0 0 3 Shape \"sphere\"\nWorldEnd\n");
  };
  const auto passes = [&](int samples, const std::string& options) {
    write(samples);
    return Run("many.pbrt --quiet -o a.exr --stats stats.json " + options).exitCode == 0
               ? nlohmann::json::parse(Read("stats.json"))["passes"].get<int>()
               : -1;
  };
  EXPECT_EQ(passes(64, "--integrator path"), 64);
  EXPECT_EQ(passes(64, "--integrator auto"), 16);
  EXPECT_EQ(passes(64, "--integrator path --camera-samples 10"), 7);
  EXPECT_EQ(passes(2, "--integrator auto"), 2) << "of one pass no error could be told";
  EXPECT_EQ(passes(1, "--integrator auto"), 1);
  EXPECT_EQ(passes(6, "--integrator hybrid --photons 10 --camera-samples 4"), 6);
  EXPECT_TRUE(
      Contains(Run("many.pbrt --integrator hybrid --photons 10 --passes 1 --quiet -o a.exr --camera-samples 4").err,
               "many.pbrt: warning: --camera-samples is for path; it has no effect on hybrid\n"));
}

TEST_F(Program, StatisticsCountWhatWasDone) {
  WriteScene("tiny.pbrt");
  ASSERT_EQ(Run("tiny.pbrt --integrator path --passes 3 -o a.exr --stats stats.json --quiet").exitCode, 0);
  const auto json = nlohmann::json::parse(Read("stats.json"));
  EXPECT_EQ(json["integrator"], "path");
  EXPECT_EQ(json["passes"], 3);
  EXPECT_GT(json["rays"]["camera"], 0);
  EXPECT_EQ(json["rays"]["photon"], 0);
  EXPECT_EQ(json["photons"]["emitted"], 0);
  EXPECT_EQ(Run("tiny.pbrt --passes 1 -o a.exr --stats missing/stats.json").exitCode, 1);
}

// What `auto` chooses by its pilot costs what the same by name costs, and the pilot: neither time nor paths of it are
// given away, and the picture is the same.
TEST_F(Program, StatisticsCountThePilotOfAuto) {
  // Those that look for rare light, and those that tell how many light paths a pass would have.
  constexpr int kPilotPaths = (1 << 14) + 4096;
  WriteScene("tiny.pbrt");
  // Glass under the floor, in the dark, leaves the light to paths, but the pilot must find that out.
  const std::string dark = Read("tiny.pbrt");
  const size_t ball = dark.find("Shape \"sphere\"");
  Write("dark.pbrt", dark.substr(0, ball) + "Translate 0 -3 0\n" + dark.substr(ball));
  const auto statistics = [&](const std::string& arguments) {
    const ProgramResult result = Run(arguments + " --quiet --passes 2 --stats s.json");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return nlohmann::json::parse(Read("s.json"));
  };
  const auto hybrid = statistics("tiny.pbrt --integrator hybrid -o a.exr");
  const auto chosen = statistics("tiny.pbrt --integrator auto -o b.exr");
  EXPECT_EQ(chosen["integrator"], "hybrid");
  EXPECT_EQ(chosen["photons"]["inPilots"], hybrid["photons"]["inPilots"].get<int>() + kPilotPaths);
  EXPECT_TRUE(Read("a.exr") == Read("b.exr"));
  const auto path = statistics("dark.pbrt --integrator path --camera-samples 4 -o a.exr");
  const auto chosenPath = statistics("dark.pbrt --integrator auto -o b.exr");
  EXPECT_EQ(chosenPath["integrator"], "path");
  EXPECT_GT(chosen["rays"]["inPilots"].get<int>(), hybrid["rays"]["inPilots"].get<int>() + kPilotPaths);
  EXPECT_EQ(path["photons"]["inPilots"], 0);
  EXPECT_GT(path["rays"]["inPilots"], 0) << "that tell where the picture is noisy";
  EXPECT_GT(chosenPath["photons"]["inPilots"], kPilotPaths) << "with those that taught the guide in vain";
  EXPECT_GE(chosenPath["seconds"], chosenPath["prepareSeconds"]);
  EXPECT_TRUE(Read("a.exr") == Read("b.exr"));
}

TEST_F(Program, ANameThatIsNoUtf8LosesNoStatistics) {
  WriteScene("caf\xe9.pbrt");
  const ProgramResult result = Run("'caf\xe9.pbrt' --quiet --integrator path --passes 1 -o a.exr --stats s.json");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(Read("s.json"))["scene"], "caf\xef\xbf\xbd.pbrt");
}

TEST_F(Program, WhatAFileTunesForSppmHoldsForSppmAlone) {
  WriteScene("tiny.pbrt");
  Write("tuned.pbrt", "Integrator \"sppm\" \"integer photonsperiteration\" 100\n" + Read("tiny.pbrt"));
  const auto emitted = [&](const std::string& options) -> int64_t {
    EXPECT_EQ(Run(options + " --passes 1 -o a.exr --stats stats.json --quiet").exitCode, 0);
    return nlohmann::json::parse(Read("stats.json"))["photons"]["emitted"];
  };
  EXPECT_EQ(emitted("tuned.pbrt"), 100);
  EXPECT_NE(emitted("tuned.pbrt --integrator hybrid"), 100);
  EXPECT_EQ(emitted("tuned.pbrt --integrator hybrid"), emitted("tiny.pbrt --integrator hybrid"));
  EXPECT_EQ(emitted("tuned.pbrt --integrator hybrid --photons 50"), 50);
}

TEST_F(Program, WrongUsageExitsWith2AndSaysWhy) {
  WriteScene("tiny.pbrt");
  for (const char* arguments :
       {"",
        "--no-such-option tiny.pbrt",
        "render",
        "render tiny.pbrt extra",
        "tiny.pbrt --passes 0",
        "tiny.pbrt --passes x",
        "tiny.pbrt --passes 3:3",
        "tiny.pbrt --passes 4:3",
        "tiny.pbrt --passes -1:3",
        "tiny.pbrt --passes 1:2:3",
        "tiny.pbrt --checkpoint 0",
        "tiny.pbrt --checkpoint",
        "tiny.pbrt --snapshots 0",
        "tiny.pbrt --snapshots often",
        "tiny.pbrt --aov color",
        "tiny.pbrt --clamp 0",
        "info tiny.pbrt --clamp 1",
        "converge tiny.pbrt --integrators path --time 1 -o out --clamp 1",
        "tiny.pbrt --snapshots 2 --passes 4 -o a.dapple",
        "tiny.pbrt --snapshots 2 --passes 0:4",
        "tiny.pbrt --aov albedo -o a.png",
        "tiny.pbrt --aov variance --passes 1",
        "tiny.pbrt --aov variance --passes 3:4 -o a.exr",
        "tiny.pbrt -o x",
        "tiny.pbrt -o x.jpg",
        "tiny.pbrt --integrator hybrid --direct light",
        "info tiny.pbrt --integrator hybrid --direct bsdf",
        "converge tiny.pbrt --integrators path,hybrid --time 1 -o out --direct light",
        "converge tiny.pbrt tiny.pbrt --integrators path --time 1 -o out --reference a.exr",
        "tiny.pbrt --memory 0",
        "tiny.pbrt --memory much",
        "merge a.dapple",
        "merge -o a.exr",
        "tiny.pbrt --passes 2 --time 3",
        "tiny.pbrt --time 0",
        "tiny.pbrt --time -1",
        "tiny.pbrt --time nan",
        "tiny.pbrt --time inf",
        "tiny.pbrt --time 2s",
        "tiny.pbrt --resolution 4",
        "tiny.pbrt --resolution 0x4",
        "tiny.pbrt --resolution 4x4x4",
        "tiny.pbrt --resolution 4x4y",
        "tiny.pbrt --resolution 65537x1",
        "tiny.pbrt --crop 0,1,0",
        "tiny.pbrt --light-samples 0",
        "tiny.pbrt --direct both",
        "tiny.pbrt --crop 0.5,0.5,0,1",
        "tiny.pbrt --crop 0,2,0,1",
        "tiny.pbrt --integrator none",
        "tiny.pbrt --threads -1",
        "tiny.pbrt --pbrt-version 5",
        "tiny.pbrt --radius 0",
        "tiny.pbrt --radius nan",
        "tiny.pbrt --photons 0",
        "tiny.pbrt --max-depth -1",
        "tiny.pbrt --max-depth 1025",
        "tiny.pbrt --light-samples 65537",
        "info",
        "emit tiny.pbrt",
        "emit tiny.pbrt --rays 0 -o a.csv",
        "emit tiny.pbrt -o a.txt",
        "emit tiny.pbrt --light -1 -o a.csv",
        "emit tiny.pbrt --light x -o a.csv",
        "envmap",
        "envmap a.exr --mapping cube",
        "converge",
        "converge tiny.pbrt --integrators path --time 1",
        "converge tiny.pbrt --integrators path -o out",
        "converge tiny.pbrt --integrators path,none --time 1 -o out",
        "converge tiny.pbrt --integrators path --time 0 -o out",
        "converge tiny.pbrt --integrators path --time 1 --seeds 0 -o out",
        "converge tiny.pbrt --integrators path --time 1 --reference a.exr --reference-time 2 -o out",
        "converge tiny.pbrt --integrators path --time 1 --reference-error 0.1 -o out",
        "compare",
        "compare a.exr",
        "compare a.exr b.exr --of colour",
        "compare a.exr b.exr -d c.jpg",
        "compare a.exr b.exr -d c.png -d d.png",
        "envmap a.exr --pdf-image a.jpg",
        "envmap a.exr --samples 10",
        "envmap a.exr --samples 0 --sample-image a.png"}) {
    const ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exitCode, 2) << arguments;
    EXPECT_TRUE(BeginsWith(result.err, "error: ")) << arguments;
    EXPECT_LT(result.err.size(), 250u) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
  }
  EXPECT_FALSE(Exists("tiny.exr"));
}

TEST_F(Program, SaysWhichNumbersItTakes) {
  const auto error = [&](const std::string& arguments) {
    const ProgramResult result = Run("tiny.pbrt " + arguments);
    EXPECT_EQ(result.exitCode, 2) << arguments;
    return result.err;
  };
  EXPECT_TRUE(BeginsWith(error("--photons 1e6"),
                         "error: --photons: expected a whole number from 1 to 2147483647, in "
                         "digits alone and without a leading 0, not '1e6'\n"));
  EXPECT_TRUE(BeginsWith(error("--passes 99999999999"),
                         "error: --passes: expected a whole number N from 1 to 2147483647, or a range A:B with "
                         "0 <= A < B <= 2147483647, not '99999999999'\n"));
  for (const std::string seed : {"18446744073709551615", "1.5", "x", "010", "-08"})
    EXPECT_TRUE(BeginsWith(error("--seed " + seed),
                           "error: --seed: expected a whole number from -2147483648 to "
                           "2147483647, in digits alone and without a leading 0, not '" +
                               seed + "'\n"));
  EXPECT_TRUE(Contains(error("--threads 1025"), "expected a whole number from 0 to 1024"));
  WriteScene("tiny.pbrt");
  EXPECT_EQ(Run("tiny.pbrt --quiet --integrator path --passes 1 --seed=-2147483648").exitCode, 0);
}

TEST_F(Program, AMissingSceneIsAnErrorAtItsName) {
  for (const char* command : {"render", "info"}) {
    const ProgramResult result = Run(std::string(command) + " nowhere.pbrt");
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(BeginsWith(result.err, "nowhere.pbrt: error: "));
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << "one line";
  }
}

TEST_F(Program, ASyntaxErrorIsToldWithLineAndColumn) {
  Write("broken.pbrt", "Camera \"perspective\"\nWorldBegin\n  Shap \"sphere\"\n");
  const ProgramResult result = Run("broken.pbrt");
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_TRUE(BeginsWith(result.err, "broken.pbrt:3:3: error: "));
}

TEST_F(Program, AnOutputThatCannotBeWrittenIsToldBeforeAnythingIsRead) {
  const ProgramResult folder = Run("nowhere.pbrt -o no/such/folder/a.exr");
  EXPECT_EQ(folder.exitCode, 1);
  EXPECT_TRUE(BeginsWith(folder.err, "no/such/folder/a.exr: error: the folder 'no/such/folder' does not exist"));
  for (const std::string command : {"nowhere.pbrt", "merge nowhere.dapple"}) {
    const ProgramResult extension = Run(command + " -o a.jpg");
    EXPECT_EQ(extension.exitCode, 2);
    EXPECT_TRUE(BeginsWith(extension.err,
                           "error: --output: expected a file name that ends in .exr, .png or .dapple, not 'a.jpg'\n"));
  }
}

TEST_F(Program, RendersToTheNameTheSceneGivesInTheCurrentFolder) {
  WriteScene("scene.pbrt");
  const ProgramResult result = Run("scene.pbrt");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  ASSERT_TRUE(Exists("tiny.exr"));
  const Image image = ReadImage(Path("tiny.exr"));
  EXPECT_EQ(image.Width(), 24);
  EXPECT_EQ(image.Height(), 16);
  EXPECT_GT(*std::ranges::max_element(image.Values()), 0.f) << "the scene is lit";
}

TEST_F(Program, SaysWhatItDid) {
  WriteScene("tiny.pbrt");
  const ProgramResult result = Run("render tiny.pbrt");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  // A glass sphere under a point light is for photons; the scene's four samples a pixel are four passes.
  EXPECT_TRUE(Contains(result.err, "tiny.pbrt: 24 x 16, hybrid ("));
  for (const char* text : {" 25 %: 1 pass, ", " 75 %: 3 passes, ", "100 %: 4 passes, "})
    EXPECT_TRUE(Contains(result.err, text));
  EXPECT_FALSE(Contains(result.err, "\x1b")) << "no terminal, no control characters";
  for (const char* text : {"4 passes in ", "rays ", "photons ", "noise ", "memory "})
    EXPECT_TRUE(Contains(result.out, text));
}

TEST_F(Program, IsQuietWhenAsked) {
  WriteScene("tiny.pbrt");
  const ProgramResult result = Run("tiny.pbrt --quiet");
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, "");
}

TEST_F(Program, WritesEachOutputThatIsNamed) {
  WriteScene("tiny.pbrt");
  ASSERT_EQ(Run("-o a.png --output b.exr tiny.pbrt --passes 1").exitCode, 0);
  EXPECT_EQ(Read("a.png").substr(1, 3), "PNG");
  EXPECT_EQ(ReadImage(Path("b.exr")).Width(), 24);
}

TEST_F(Program, TheCommandLineOverridesTheScene) {
  WriteScene("tiny.pbrt");
  const ProgramResult result =
      Run("tiny.pbrt -o a.exr --integrator path --passes 3 --seed 9 --resolution 40x20 --crop 0.25,0.75,0.5,1");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const ImageMetadata metadata = ReadExrMetadata(Path("a.exr"));
  EXPECT_EQ(std::get<std::string>(metadata.at("scene")), "tiny.pbrt");
  EXPECT_EQ(std::get<std::string>(metadata.at("integrator")), "path");
  EXPECT_EQ(std::get<int>(metadata.at("passes")), 3);
  EXPECT_EQ(std::get<int>(metadata.at("seed")), 9);
  const Image image = ReadImage(Path("a.exr"));
  EXPECT_EQ(image.fullSize, Vec2i(40, 20));
  EXPECT_EQ(image.origin, Vec2i(10, 10));
  EXPECT_EQ(image.Width(), 20);
  EXPECT_EQ(image.Height(), 10);
}

TEST_F(Program, ACropHasThePixelsOfTheWholePicture) {
  WriteScene("tiny.pbrt");
  ASSERT_EQ(Run("tiny.pbrt -o whole.exr --integrator path --passes 2 --quiet").exitCode, 0);
  ASSERT_EQ(Run("tiny.pbrt -o part.exr --integrator path --passes 2 --crop 0.25,0.75,0.25,1 --quiet").exitCode, 0);
  const Image whole = ReadImage(Path("whole.exr")), part = ReadImage(Path("part.exr"));
  ASSERT_EQ(part.Width(), 12);
  for (int y = 0; y < part.Height(); ++y)
    for (int x = 0; x < part.Width(); ++x)
      EXPECT_EQ(part.ColorAt(x, y), whole.ColorAt(x + part.origin.x, y + part.origin.y)) << x << ' ' << y;
}

TEST_F(Program, ATimeBudgetIsKeptAndRecorded) {
  WriteScene("tiny.pbrt");
  const ProgramResult result = Run("tiny.pbrt -o a.exr --time 0.2");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const ImageMetadata metadata = ReadExrMetadata(Path("a.exr"));
  EXPECT_GE(std::get<int>(metadata.at("passes")), 1);
  EXPECT_GT(std::get<double>(metadata.at("seconds")), 0);
}

TEST_F(Program, SecondsAreRecordedForPassesWhereAsked) {
  WriteScene("tiny.pbrt");
  ASSERT_EQ(Run("tiny.pbrt -o a.exr --passes 1 --record-seconds").exitCode, 0);
  ASSERT_EQ(Run("tiny.pbrt -o b.exr --passes 1").exitCode, 0);
  EXPECT_TRUE(ReadExrMetadata(Path("a.exr")).contains("seconds"));
  EXPECT_FALSE(ReadExrMetadata(Path("b.exr")).contains("seconds"));
}

TEST_F(Program, ASignalEndsTheRenderAndThePictureIsWritten) {
  WriteScene("tiny.pbrt");
  for (const int signal : {SIGINT, SIGTERM}) {
    // After the first pass: before it there is no picture to write.
    std::filesystem::remove(Path("stderr.txt"));
    const ProgramResult result = RunAndSignal("tiny.pbrt -o a.exr --time 600", signal, " %: 1 pass, ");
    EXPECT_EQ(result.exitCode, 128 + signal) << result.err;
    ASSERT_TRUE(Exists("a.exr")) << result.err;
    EXPECT_GE(std::get<int>(ReadExrMetadata(Path("a.exr")).at("passes")), 1);
    EXPECT_TRUE(Contains(result.err, "to go on, give the same command with --resume (it reads a.exr.checkpoint)\n"));
    EXPECT_TRUE(Exists("a.exr.checkpoint"));
    std::filesystem::remove(Path("a.exr"));
  }
}

TEST_F(Program, WarnsOfOptionsThatTheIntegratorHasNoUseFor) {
  WriteScene("tiny.pbrt");
  const auto warnings = [&](const std::string& options) {
    const ProgramResult result = Run("tiny.pbrt --quiet --passes 1 -o a.exr --integrator " + options);
    EXPECT_EQ(result.exitCode, 0);
    return result.err;
  };
  const std::string path = warnings("path --photons 5 --radius 2 --kernel cone --no-guide --direct mis");
  EXPECT_EQ(
      path,
      "tiny.pbrt: warning: --photons is for light_tracing, photon_mapping, sppm, hybrid; it has no effect on path\n"
      "tiny.pbrt: warning: --no-guide is for light_tracing, photon_mapping, sppm, hybrid; it has no effect on path\n"
      "tiny.pbrt: warning: --radius is for photon_mapping, sppm, hybrid; it has no effect on path\n"
      "tiny.pbrt: warning: --kernel is for photon_mapping, sppm, hybrid; it has no effect on path\n");
  const std::string light = warnings("light_tracing --direct bsdf --light-samples 16 --radius 2 --kernel cone");
  for (const char* option : {"--direct", "--light-samples", "--radius", "--kernel"})
    EXPECT_TRUE(Contains(light, std::string("tiny.pbrt: warning: ") + option + " is for ")) << option;
  EXPECT_EQ(std::ranges::count(light, '\n'), 4);
  EXPECT_EQ(warnings("sppm --photons 500 --radius 0.2 --kernel cone --no-guide --direct light --light-samples 2"), "");
  EXPECT_EQ(warnings("path --camera-samples 2 --direct light --light-samples 2"), "");
  EXPECT_TRUE(Contains(Run("info tiny.pbrt --integrator path --photons 5").err, "warning: --photons is for "));
  // Of several integrators one that takes it is enough.
  const std::string study = " --time 0.02 --seeds 1 --photons 500 --quiet -o out";
  EXPECT_EQ(Run("converge tiny.pbrt --integrators path,light_tracing" + study).err, "");
  EXPECT_TRUE(Contains(Run("converge tiny.pbrt --integrators path" + study).err, "warning: --photons is for "));
}

// A denoiser would read a variance of 0 as converged.
TEST_F(Program, TheVarianceOfOnePassIsRefusedOrWarnedOf) {
  WriteScene("tiny.pbrt");
  const std::string warning = "warning: the layer of variance is 0 all over: one pass does not tell it, two do\n";
  const std::string render = "tiny.pbrt --quiet --integrator path --aov variance ";
  EXPECT_EQ(Run(render + "--time 0.000001 -o a.exr").err, warning);
  EXPECT_EQ(Run(render + "--passes 2 -o a.exr").err, "");
  EXPECT_EQ(Run(render + "--passes 0:1 -o a.dapple").err, "") << "a part is no picture yet";
  EXPECT_EQ(Run("merge a.dapple -o a.exr").err, warning);
  EXPECT_EQ(Run("merge a.dapple -o a.png").err, "") << "no layer, no warning";
  Write("one.pbrt",
        "Sampler \"independent\" \"integer pixelsamples\" 1\nWorldBegin\nLightSource \"infinite\"\nMaterial "
        "\"diffuse\"\n");
  const ProgramResult one = Run("one.pbrt --quiet --integrator path --aov variance -o b.exr");
  EXPECT_EQ(one.exitCode, 1);
  EXPECT_EQ(one.err,
            "one.pbrt: error: --aov variance needs two passes at least, and the scene's samples a pixel make one: see "
            "--passes\n");
  EXPECT_FALSE(Exists("b.exr"));
}

TEST_F(Program, TimesBeyondAllClocksAreShownAsTheyAre) {
  WriteScene("tiny.pbrt");
  const ProgramResult result =
      RunAndSignal("tiny.pbrt --integrator path -o a.exr --time 1e300", SIGTERM, " %: 1 pass, ");
  EXPECT_EQ(result.exitCode, 128 + SIGTERM);
  EXPECT_TRUE(Contains(result.err, ", 1e+300 s left"));
}

TEST_F(Program, WarnsOnceOfASceneInWhichNothingEmitsLight) {
  const std::string dark =
      "Film \"rgb\" \"integer xresolution\" [4] \"integer yresolution\" [4]\nCamera \"perspective\"\n"
      "WorldBegin\nShape \"sphere\"\n";
  Write("none.pbrt", dark);
  Write("black.pbrt", dark + "LightSource \"point\" \"rgb I\" [0 0 0]\n");
  for (const char* scene : {"none.pbrt", "black.pbrt"}) {
    const ProgramResult result = Run(std::string(scene) + " --quiet");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_TRUE(BeginsWith(result.err, std::string(scene) + ": warning: "));
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  }
}

TEST_F(Program, WarnsOfAnIntegratorThatItLacksUnlessAnotherIsAskedFor) {
  WriteScene("tiny.pbrt");
  Write("bdpt.pbrt", "Integrator \"bdpt\"\n" + Read("tiny.pbrt"));
  for (const std::string command : {"info bdpt.pbrt", "render bdpt.pbrt --quiet --passes 1"}) {
    const ProgramResult result = Run(command);
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.err,
              "bdpt.pbrt:1:1: warning: integrator \"bdpt\" is not one of Dapple's (path, light_tracing, "
              "photon_mapping, sppm, hybrid); "
              "what the scene holds decides: hybrid\n");
    EXPECT_EQ(Run(command + " --integrator path").err, "");
  }
}

TEST_F(Program, InfoSaysWhatIsThereAndWhatFollows) {
  WriteScene("tiny.pbrt");
  const ProgramResult result = Run("info tiny.pbrt");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  for (const char* text :
       {"pbrt version 4: ", "2 shapes", "1 point", "24 x 16 pixels", "light 0: point, power 377 377 377 W",
        "hybrid: by a pilot ", "of the light seen comes in ways that paths find seldom",
        "4 passes (the scene's samples a pixel)", "skips"})
    EXPECT_TRUE(Contains(result.out, text));
  EXPECT_FALSE(Exists("tiny.exr")) << "info renders nothing";
  EXPECT_TRUE(Contains(Run("info tiny.pbrt --integrator path").out,
                       "photons and photon maps: the algorithm follows paths from the camera only"));
  Write("mirror.pbrt", "WorldBegin LightSource \"point\" Material \"conductor\" Shape \"sphere\"");
  EXPECT_TRUE(Contains(Run("info mirror.pbrt --integrator sppm").out,
                       "photons and photon maps: none could come to anything here"));
  EXPECT_TRUE(Contains(Run("info tiny.pbrt --integrator path --passes 7").out, "7 passes (asked for)"));
  EXPECT_TRUE(Contains(Run("info tiny.pbrt --pbrt-version 4").out, "pbrt version 4: asked for"));
}

/// The numbers of a CSV file's column.
std::vector<double> ColumnOf(const std::string& csv, const std::string& column) {
  std::istringstream lines(csv);
  std::string line, cell;
  std::getline(lines, line);
  std::istringstream header(line);
  int index = 0;
  while (std::getline(header, cell, ',') && cell != column) ++index;
  std::vector<double> numbers;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    for (int i = 0; i <= index; ++i) std::getline(cells, cell, ',');
    numbers.push_back(std::stod(cell));
  }
  return numbers;
}

TEST_F(Program, EmittedRaysCarryThePowerOfTheLights) {
  // A point light of 4 pi I = 377 W and, two-sided, a square of side 2: 2 pi L A = 50.3 W (green).
  WriteScene("tiny.pbrt");
  Write("two.pbrt", Read("tiny.pbrt") +
                        "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"bool twosided\" true\n"
                        "Shape \"bilinearmesh\" \"point3 P\" [0 5 0  2 5 0  0 5 2  2 5 2]\n");
  const ProgramResult result = Run("emit two.pbrt --rays 4000 --seed 5 -o rays.csv");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_TRUE(BeginsWith(result.out, "rays.csv\nrays      4000 rays of 2 lights\n"));
  const std::string csv = Read("rays.csv");
  const std::vector<double> flux = ColumnOf(csv, "flux_g"), light = ColumnOf(csv, "light");
  ASSERT_EQ(flux.size(), 4000u);
  double sum = 0, squares = 0;
  for (const double f : flux) sum += f, squares += f * f;
  const double power = 4 * 3.14159265 * 30 + 2 * 3.14159265 * 4 * 2;
  const double standardError = std::sqrt(std::max(0.0, squares - sum * sum / 4000));
  EXPECT_NEAR(sum, power, 4 * standardError + 1e-5 * power);
  EXPECT_LT(standardError, 0.01 * power);
  EXPECT_GT(std::ranges::count(light, 1.0), 300);
  // The same seed, the same file; another light, another file.
  ASSERT_EQ(Run("emit two.pbrt --rays 4000 --seed 5 -o again.csv --threads 1").exitCode, 0);
  EXPECT_EQ(Read("again.csv"), csv);
  ASSERT_EQ(Run("emit two.pbrt --rays 100 --light 1 -o one.json").exitCode, 0);
  const auto json = nlohmann::json::parse(Read("one.json"));
  for (const auto& row : json["data"]) EXPECT_EQ(row[1], "area");
  ASSERT_EQ(Run("emit two.pbrt --rays 100 -o rays.ply").exitCode, 0);
  EXPECT_TRUE(BeginsWith(Read("rays.ply"), "ply\n"));
}

TEST_F(Program, EmitSaysWhatItCannotDo) {
  WriteScene("tiny.pbrt");
  const auto error = [&](const std::string& arguments) {
    const ProgramResult result = Run("emit tiny.pbrt " + arguments);
    EXPECT_EQ(result.exitCode, 1);
    return result.err;
  };
  EXPECT_EQ(error("--light 1 -o a.csv"),
            "tiny.pbrt: error: light 1 is not there: expected one of 0 to 0, as `dapple info` lists them\n");
  EXPECT_TRUE(BeginsWith(error("-o no/a.csv"), "no/a.csv: error: the folder 'no' does not exist"));
  Write("dark.pbrt", "Camera \"perspective\"\nWorldBegin\nShape \"sphere\"\n");
  EXPECT_TRUE(Contains(Run("emit dark.pbrt -o a.csv").err,
                       "dark.pbrt: error: none of the scene's lights emits anything: there are no rays\n"));
  EXPECT_FALSE(Exists("a.csv"));
}

TEST_F(Program, EnvmapTellsAndDrawsWhatAMapIsLike) {
  Image map = Image::Rgb(16, 8);
  for (float& value : map.Values()) value = 2;
  map.SetColor(3, 4, Color(-1, 2, 2));
  WriteExr(Path("map.exr"), map);
  const ProgramResult result =
      Run("envmap map.exr --pdf-image density.png --samples 200 --sample-image samples.png --seed 3");
  ASSERT_EQ(result.exitCode, 0) << result.err;
  for (const char* text : {"image     16 x 8 pixels, channels R G B\n", "latitude-longitude (the image is not square)",
                           "repaired  1 pixel (", "greatest 2 2 2\n", "integral  ", "density.png\nsamples.png\n"}) {
    EXPECT_TRUE(Contains(result.out, text));
  }
  // Nearly even: the density is that of the sphere, of one colour, and all its rows are alike but for their length.
  const Image density = ReadImage(Path("density.png")), samples = ReadImage(Path("samples.png"));
  EXPECT_GT(density.Width(), samples.Width());
  EXPECT_EQ(density.Height(), samples.Height());
  EXPECT_EQ(samples.Width(), 2 * samples.Height());
  for (const Vec2i& p : {Vec2i(900, 10), Vec2i(700, 256), Vec2i(900, 500)}) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(density.At(p.x, p.y, c), density.At(600, 100, c), 0.02f);
  }
  int red = 0;
  for (int y = 0; y < samples.Height(); ++y)
    for (int x = 0; x < samples.Width(); ++x) red += samples.At(x, y, 0) > 0.9f && samples.At(x, y, 1) < 0.1f ? 1 : 0;
  EXPECT_GT(red, 200 * 5);
  EXPECT_LT(red, 200 * 14);
}

TEST_F(Program, EnvmapSaysWhatItCannotDo) {
  WriteExr(Path("map.exr"), Image::Rgb(16, 8));
  const auto error = [&](const std::string& arguments) {
    const ProgramResult result = Run("envmap " + arguments);
    EXPECT_EQ(result.exitCode, 1);
    return result.err;
  };
  EXPECT_TRUE(BeginsWith(error("map.exr --mapping equalarea"),
                         "map.exr: error: environment map of 16 x 8 pixels: expected a square image"));
  EXPECT_TRUE(BeginsWith(error("map.exr --pdf-image a.png"), "map.exr: error: the map is black"));
  EXPECT_TRUE(BeginsWith(error("map.exr --pdf-image no/a.png"), "no/a.png: error: the folder 'no' does not exist"));
  EXPECT_TRUE(BeginsWith(error("none.exr"), "none.exr: error: "));
  EXPECT_EQ(Run("envmap map.exr").exitCode, 0);
}

// The scenes behind the pictures of the documentation.
TEST_F(Program, ScenesOfTheDocumentationAreReadWithoutAWord) {
  for (const std::string light : {"point", "spot", "distant", "projection", "goniometric", "area"}) {
    const ProgramResult result = Run("info " DAPPLE_SOURCE_DIR "/docs/scenes/light-" + light + ".pbrt");
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_TRUE(Contains(result.out, "light 0: " + light + ", power "));
  }
}

// So many beside one of the BSDF are what the table of a compensated environment is made for, whoever says so.
TEST_F(Program, LightSamplesOfTheCommandLineCountForCompensation) {
  Image sky = Image::Rgb(8, 4);
  for (size_t i = 0; i < sky.Values().size(); ++i) sky.Values()[i] = static_cast<float>(1 + i % 7);
  WriteExr(Path("sky.exr"), sky);
  const auto render = [&](const std::string& samples, const std::string& options) {
    Write("sky.pbrt",
          "LookAt 0 -4 1  0 0 0  0 0 1 Camera \"perspective\" Film \"image\" \"integer xresolution\" [8] "
          "\"integer yresolution\" [8] WorldBegin LightSource \"infinite\" \"string mapname\" \"sky.exr\" "
          "\"string sampling\" \"compensated\" " +
              samples + " Shape \"sphere\" WorldEnd");
    const ProgramResult result = Run("sky.pbrt --integrator path --passes 2 --quiet -o a.exr " + options);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    const Image image = ReadImage(Path("a.exr"));
    return std::vector<float>(image.Values().begin(), image.Values().end());
  };
  const auto ofLight = render("\"integer samples\" [16]", "");
  EXPECT_EQ(render("", "--light-samples 16"), ofLight);
  EXPECT_NE(render("", ""), ofLight);
}

TEST_F(Program, WarnsOfAMisspelledIntegratorWithTheNearestOne) {
  WriteScene("tiny.pbrt");
  const auto warning = [&](const std::string& name) {
    Write("named.pbrt", "Integrator \"" + name + "\"\n" + Read("tiny.pbrt"));
    return Run("info named.pbrt").err;
  };
  EXPECT_TRUE(Contains(warning("pth"), "what the scene holds decides: hybrid; did you mean \"path\"?\n"));
  for (const std::string name : {"bdpt", "mlt", "directlighting", "whitted", "ao", "ambientocclusion", "simplepath",
                                 "simplevolpath", "lightpath", "randomwalk", "function"})
    EXPECT_FALSE(Contains(warning(name), "did you mean")) << name;
}

// What a file gives for an algorithm holds for that one, and for no other that the command line may ask for.
TEST_F(Program, RadiusAndPhotonsOfTheFileHoldForTheIntegratorThatItNames) {
  WriteScene("tiny.pbrt");
  const std::string tiny = Read("tiny.pbrt"), plan = " --passes 1 --quiet -o a.exr";
  const auto render = [&](const std::string& options) {
    const ProgramResult result = Run(options + plan);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    const Image image = ReadImage(Path("a.exr"));
    return std::vector<float>(image.Values().begin(), image.Values().end());
  };
  for (const std::string name : {"hybrid", "photon_mapping", "sppm", "light_tracing"}) {
    Write("plain.pbrt", "Integrator \"" + name + "\"\n" + tiny);
    Write("tuned.pbrt",
          "Integrator \"" + name + "\" \"float radius\" [0.5] \"integer photonsperiteration\" [300]\n" + tiny);
    const std::string same = name == "light_tracing" ? " --photons 300" : " --photons 300 --radius 0.5";
    EXPECT_EQ(render("tuned.pbrt"), render("plain.pbrt" + same)) << name;
    EXPECT_NE(render("tuned.pbrt"), render("plain.pbrt")) << name;
    const std::string other = name == "sppm" ? " --integrator hybrid" : " --integrator sppm";
    EXPECT_EQ(render("tuned.pbrt" + other), render("plain.pbrt" + other)) << name;
  }
}

}  // namespace
}  // namespace dapple
