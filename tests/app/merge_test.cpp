// A render in parts: ranges of passes, rendered apart and joined, are the file of one render; or it is told what is
// wrong with them.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <link.h>

#include "integrators/integrator.h"
#include "src/image/image_io.h"
#include "tests/app/program.h"

namespace dapple {
namespace {

using Merge = ProgramTest;

class MergeByIntegrator : public ProgramTest, public testing::WithParamInterface<std::string_view> {};

TEST_P(MergeByIntegrator, RangesOfPassesJoinToTheFileOfOneRender) {
  WriteScene("tiny.pbrt");
  const std::string common =
      "tiny.pbrt --quiet --photons 2000 --no-guide --radius 0.2 --integrator " + std::string(GetParam());
  ASSERT_EQ(Run(common + " --passes 7 -o whole.exr").exitCode, 0);
  for (const char* range : {"0:3", "3:4", "4:7"}) {
    const ProgramResult result = Run(common + " --threads 3 --passes " + range);
    ASSERT_EQ(result.exitCode, 0) << result.err;
  }
  const ProgramResult merged = Run("merge tiny.4-7.dapple tiny.0-3.dapple tiny.3-4.dapple -o joined.exr");
  ASSERT_EQ(merged.exitCode, 0) << merged.err;
  EXPECT_TRUE(Read("joined.exr") == Read("whole.exr"));
  // And in two steps.
  ASSERT_EQ(Run("merge tiny.4-7.dapple tiny.0-3.dapple -o some.dapple").exitCode, 0);
  ASSERT_EQ(Run("merge some.dapple tiny.3-4.dapple --passes 7 -o again.exr").exitCode, 0);
  EXPECT_TRUE(Read("again.exr") == Read("whole.exr"));
}

std::vector<std::string_view> Names() { return IntegratorNames(); }

INSTANTIATE_TEST_SUITE_P(All, MergeByIntegrator, testing::ValuesIn(Names()),
                         [](const auto& instance) { return std::string(instance.param); });

TEST_F(Merge, TellsWhatIsMissingAndWhatIsDouble) {
  WriteScene("tiny.pbrt");
  for (const char* range : {"0:2", "1:3", "4:6"})
    ASSERT_EQ(Run(std::string("tiny.pbrt --quiet --integrator path --passes ") + range).exitCode, 0);
  const auto error = [&](const std::string& arguments) {
    const ProgramResult result = Run("merge -o out.exr " + arguments);
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_FALSE(Exists("out.exr"));
    return result.err;
  };
  EXPECT_EQ(error("tiny.0-2.dapple tiny.4-6.dapple"),
            "error: passes are missing: 2 to 3; those given are 0 to 1, 4 to 5\n");
  EXPECT_EQ(error("tiny.0-2.dapple --passes 8"), "error: passes are missing: 2 to 7; those given are 0 to 1\n");
  EXPECT_EQ(error("tiny.0-2.dapple --passes 1"), "error: too many passes: expected 0 to 0; those given are 0 to 1\n");
  EXPECT_EQ(error("tiny.0-2.dapple tiny.1-3.dapple"),
            "tiny.1-3.dapple: error: double: pass 1 in it and in those before it\n");
  EXPECT_EQ(error("tiny.0-2.dapple tiny.0-2.dapple"),
            "tiny.0-2.dapple: error: double: passes 0 to 1 in it and in those before it\n");
}

TEST_F(Merge, RefusesPartsOfAnotherRenderAndSaysWhatDiffers) {
  WriteScene("tiny.pbrt");
  Write("same.pbrt", "# a comment, and another name\n" + Read("tiny.pbrt"));
  Write("moved.pbrt", Read("tiny.pbrt") + "Translate 0 0.1 0\nShape \"sphere\" \"float radius\" 0.1\n");
  ASSERT_EQ(Run("tiny.pbrt --quiet --integrator path --passes 0:1 -o first.dapple").exitCode, 0);
  const auto difference = [&](const std::string& arguments) {
    const ProgramResult part = Run(arguments + " --quiet --passes 1:2 -o second.dapple");
    EXPECT_EQ(part.exitCode, 0) << part.err;
    const ProgramResult result = Run("merge first.dapple second.dapple -o out.exr");
    EXPECT_EQ(Exists("out.exr"), result.exitCode == 0);
    const std::string beginning = "second.dapple: error: it is of another render than those before it: ";
    return result.err.starts_with(beginning) ? result.err.substr(beginning.size()) : result.err;
  };
  EXPECT_EQ(difference("tiny.pbrt --integrator path --seed 3"), "seed 3, not 0\n");
  EXPECT_EQ(difference("tiny.pbrt --integrator path --max-depth 4"), "max-depth 4, not 32\n");
  EXPECT_EQ(difference("tiny.pbrt --integrator path --direct light"), "direct light, not mis\n");
  EXPECT_EQ(difference("tiny.pbrt --integrator path --resolution 20x16"),
            "resolution 20x16, not 24x16; crop 0,20,0,16, not 0,24,0,16\n");
  EXPECT_EQ(difference("tiny.pbrt --integrator sppm --photons 100"),
            "integrator sppm, not path; photons 100, not automatic\n");
  EXPECT_EQ(difference("moved.pbrt --integrator path"), "the scene's content\n");
  EXPECT_EQ(difference("same.pbrt --integrator path"), "");
}

/// The file that the loader takes for a library of that name.
std::string BytesOfLibrary(const char* name) {
  void* const library = dlopen(name, RTLD_NOW);
  link_map* map = nullptr;
  if (!library || dlinfo(library, RTLD_DI_LINKMAP, &map) != 0) return "";
  std::ifstream file(map->l_name, std::ios::binary);
  dlclose(library);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A part rendered with a library of another build, and one with a library that has no build id, are told.
TEST_F(Merge, AnotherLibraryOfTheSameNameIsADifference) {
  const std::string library = BytesOfLibrary("libz.so.1");
  const std::string head("\4\0\0\0\24\0\0\0\3\0\0\0GNU\0", 16);  // of the note that holds a build id of 20 bytes
  const size_t note = library.find(head);
  if (note == std::string::npos) GTEST_SKIP() << "this system's libz.so.1 has no build id of 20 bytes";
  std::filesystem::create_directory(Path("lib"));
  WriteScene("tiny.pbrt");
  const auto render = [&](const std::string& arguments, const std::string& bytes) {
    Write("lib/libz.so.1", bytes);
    const std::string folder = Path("lib");
    const ProgramResult result =
        Run("tiny.pbrt --quiet --integrator path " + arguments, [&] { setenv("LD_LIBRARY_PATH", folder.c_str(), 1); });
    ASSERT_EQ(result.exitCode, 0) << result.err;
  };
  std::string other = library, nameless = library;
  other[note + head.size()] ^= 1;
  nameless[note + 8] = 99;
  ASSERT_EQ(Run("tiny.pbrt --quiet --integrator path --passes 0:1 -o first.dapple").exitCode, 0);
  render("--passes 1:2 -o copied.dapple", library);
  render("--passes 1:2 -o other.dapple", other);
  render("--passes 1:2 -o nameless.dapple", nameless);
  render("--passes 0:1 -o also-nameless.dapple", nameless);
  EXPECT_EQ(Run("merge first.dapple copied.dapple -o out.exr").exitCode, 0);
  EXPECT_EQ(Run("merge also-nameless.dapple nameless.dapple -o out.exr").exitCode, 0);
  for (const std::string part : {"other.dapple", "nameless.dapple"}) {
    const std::string end =
        ": error: it is of another render than those before it: the installed shared libraries libz.so.1\n";
    EXPECT_EQ(Run("merge first.dapple " + part + " -o out.exr").err, part + end);
  }
}

// No direction is drawn toward lights: how it would be is no difference, and none in the picture.
TEST_F(Merge, SamplingOfAnEnvironmentThatNothingAsksIsNoDifference) {
  WriteScene("point.pbrt");
  const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]";
  Write("plain.pbrt", Read("point.pbrt") + sky + "\n");
  Write("named.pbrt", Read("point.pbrt") + sky + " \"string sampling\" \"importance\"\n");
  for (const std::string how :
       {"--integrator light_tracing --no-guide --photons 2000", "--integrator path --direct bsdf"}) {
    const std::string options = how + " --quiet --passes ";
    ASSERT_EQ(Run("plain.pbrt " + options + "2 -o whole.exr").exitCode, 0);
    ASSERT_EQ(Run("plain.pbrt " + options + "0:1 -o first.dapple").exitCode, 0);
    ASSERT_EQ(Run("named.pbrt " + options + "1:2 -o second.dapple").exitCode, 0);
    const ProgramResult merged = Run("merge first.dapple second.dapple -o joined.exr");
    EXPECT_EQ(merged.exitCode, 0) << merged.err;
    EXPECT_TRUE(Read("joined.exr") == Read("whole.exr")) << how;
  }
}

TEST_F(Merge, RefusesFilesThatAreNoParts) {
  std::filesystem::create_directory(Path("folder.dapple"));
  EXPECT_EQ(Run("merge folder.dapple -o a.exr").err,
            "folder.dapple: error: expected the state of a render; this is a folder\n");
  WriteScene("tiny.pbrt");
  ASSERT_EQ(Run("tiny.pbrt --quiet --integrator path --passes 0:1 -o part.dapple").exitCode, 0);
  const std::string part = Read("part.dapple");
  const auto error = [&](const std::string& content) {
    Write("bad.dapple", content);
    const ProgramResult result = Run("merge part.dapple bad.dapple -o out.exr");
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(BeginsWith(result.err, "bad.dapple: error: "));
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  };
  error("");
  error("dapple render state 2\n");
  error("dapple render state 2\n{}\n");
  error(Read("tiny.pbrt"));
  error(part.substr(0, part.size() / 2));
  error(part + "more");
  std::string broken = part;
  broken[part.size() / 2] ^= 1;
  error(broken);
  EXPECT_TRUE(BeginsWith(Run("merge none.dapple -o out.exr").err, "none.dapple: error: no such file"));
  EXPECT_FALSE(Exists("out.exr"));
}

}  // namespace
}  // namespace dapple
