// What a command writes must not replace what it reads, nor something else that it writes: told before any work.
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "src/image/image_io.h"
#include "src/render/snapshots.h"
#include "tests/app/program.h"
#include "tests/image/test_images.h"

namespace dapple {
namespace {

class NamedFilesTest : public ProgramTest {
 protected:
  /// Runs it; it must change no file.
  std::string ErrorOf(const std::string& arguments, int exitCode) const {
    const auto contents = [&] {
      std::string all;
      for (const std::string& name : Files()) all += name + Read(name);
      return all;
    };
    const std::string before = contents();
    const ProgramResult result = Run(arguments);
    EXPECT_EQ(result.exitCode, exitCode) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_TRUE(contents() == before) << arguments;
    return result.err;
  }
};

TEST_F(NamedFilesTest, TwoOutputsOfARenderAreNotOneFile) {
  WriteScene("tiny.pbrt");
  const std::string render = "tiny.pbrt --integrator path --passes 1 ";
  EXPECT_TRUE(
      BeginsWith(ErrorOf(render + "-o a.exr --stats a.exr", 2), "error: --output and --stats are one file: 'a.exr'\n"));
  EXPECT_TRUE(BeginsWith(ErrorOf(render + "-o a.exr --stats ./b/../a.exr", 2), "error: --output and --stats are "));
  EXPECT_TRUE(BeginsWith(ErrorOf(render + "-o a.exr -o ./a.exr", 2), "error: two of --output are one file"));
  EXPECT_TRUE(
      BeginsWith(ErrorOf(render + "-o a.exr --stats a.exr.checkpoint", 2), "error: the checkpoint and --stats"));
  EXPECT_TRUE(BeginsWith(ErrorOf(render + "-o a.exr --stats a.exr.checkpoint.old", 2),
                         "error: the older checkpoint and --stats"));
  EXPECT_TRUE(BeginsWith(ErrorOf(render + "--stats tiny.exr", 1), "tiny.pbrt: error: --output and --stats are "));
  EXPECT_EQ(Run(render + "-o a.exr -o a.png --stats a.json --quiet").exitCode, 0);
}

TEST_F(NamedFilesTest, ASnapshotReplacesNothing) {
  WriteScene("tiny.pbrt");
  const std::string render = "tiny.pbrt --integrator path --passes 2 --snapshots 1 -o a.exr ";
  EXPECT_TRUE(BeginsWith(ErrorOf(render + "-o ./a.00001.exr", 2),
                         "error: --output is what a snapshot of 'a.exr' will be called: './a.00001.exr'\n"));
  EXPECT_TRUE(BeginsWith(ErrorOf(render + "--stats a.123456.exr", 2), "error: --stats is what a snapshot of 'a.exr'"));
  ASSERT_EQ(Run(render + "--quiet --stats a.00001.json").exitCode, 0);
  Write("textured.pbrt", Read("tiny.pbrt") +
                             "Texture \"map\" \"spectrum\" \"imagemap\" \"string filename\" \"a.00001.exr\"\n"
                             "Material \"diffuse\" \"texture reflectance\" \"map\"\nShape \"sphere\"\n");
  EXPECT_TRUE(BeginsWith(ErrorOf("textured.pbrt --snapshots 1 -o a.exr", 1),
                         "textured.pbrt: error: what the scene is read from is what a snapshot of 'a.exr' will be "));
  std::filesystem::create_directory(Path("other"));
  EXPECT_EQ(Run("textured.pbrt --quiet --passes 2 --snapshots 1 -o other/a.exr -o a.png").exitCode, 0);
  EXPECT_EQ(Run("textured.pbrt --quiet --passes 2 -o a.exr").exitCode, 0) << "no snapshots, no clash";
}

TEST_F(NamedFilesTest, SnapshotsHaveTheNumberOfPassesInTheirNames) {
  EXPECT_EQ(SnapshotName("b/a.exr", 7), "b/a.00007.exr");
  for (const int passes : {1, 99999, 100000, 2147483647})
    EXPECT_EQ(SnapshotPasses("b/a.exr", SnapshotName("c/a.exr", passes)), passes);
  for (const char* name : {"a.exr", "a.0007.exr", "a.000007.exr", "a.00000.exr", "a.-0001.exr", "a.00007.png",
                           "b.00007.exr", "a.00007", "a.99999999999.exr", "a", ""})
    EXPECT_EQ(SnapshotPasses("b/a.exr", name), std::nullopt) << name;
}

TEST_F(NamedFilesTest, AnOutputIsNotAFileOfTheScene) {
  WriteScene("tiny.pbrt");
  ASSERT_EQ(Run("tiny.pbrt --quiet --integrator path --passes 1 -o map.exr").exitCode, 0);
  Write("moved.pbrt", "Translate 0 0 0\n");
  Write("more.pbrt", "Include \"moved.pbrt\" Shape \"sphere\" \"float radius\" 0.1\n");
  Write("textured.pbrt", Read("tiny.pbrt") + "Include \"more.pbrt\"\n" +
                             "Texture \"map\" \"spectrum\" \"imagemap\" \"string filename\" \"map.exr\"\n"
                             "Material \"diffuse\" \"texture reflectance\" \"map\"\nShape \"sphere\"\n");
  std::filesystem::create_symlink("map.exr", Path("link.exr"));
  const std::string render = "textured.pbrt --integrator path --passes 1 ";
  EXPECT_TRUE(BeginsWith(ErrorOf(render + "--stats textured.pbrt", 2),
                         "error: the scene and --stats are one file: 'textured.pbrt'\n"));
  EXPECT_EQ(ErrorOf(render + "-o map.exr", 1),
            "textured.pbrt: error: what the scene is read from and --output are one file: 'map.exr'\n");
  EXPECT_TRUE(BeginsWith(ErrorOf(render + "-o link.exr", 1), "textured.pbrt: error: what the scene is read from"));
  EXPECT_TRUE(BeginsWith(ErrorOf(render + "--stats more.pbrt", 1), "textured.pbrt: error: what the scene is read"));
  EXPECT_TRUE(BeginsWith(ErrorOf(render + "--stats moved.pbrt", 1), "textured.pbrt: error: what the scene is read"));
  EXPECT_EQ(Run(render + "--quiet -o a.exr").exitCode, 0);
  EXPECT_EQ(Run(render + "--quiet -o a.exr").exitCode, 0) << "its own picture may be replaced";
}

TEST_F(NamedFilesTest, RaysDoNotReplaceAMesh) {
  Write("a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  Write("mesh.pbrt", "WorldBegin\nLightSource \"point\"\nShape \"plymesh\" \"string filename\" \"a.ply\"\n");
  EXPECT_TRUE(BeginsWith(ErrorOf("emit mesh.pbrt -o a.ply", 1), "mesh.pbrt: error: what the scene is read from and"));
}

TEST_F(NamedFilesTest, PicturesOfImagesAreNeitherOneNorTheImages) {
  for (const char* name : {"ref.exr", "a.exr", "b.exr"}) WriteExr(Path(name), Constant(16, 8, Color(1)));
  EXPECT_TRUE(BeginsWith(ErrorOf("envmap ref.exr --pdf-image same.png --sample-image same.png", 2),
                         "error: --pdf-image and --sample-image are one file: 'same.png'\n"));
  EXPECT_TRUE(BeginsWith(ErrorOf("envmap ref.exr --pdf-image ref.exr", 2), "error: the image and --pdf-image are one"));
  EXPECT_TRUE(BeginsWith(ErrorOf("compare ref.exr a.exr b.exr -d same.png -d same.png", 2),
                         "error: two of --difference are one file: 'same.png'\n"));
  EXPECT_TRUE(BeginsWith(ErrorOf("compare ref.exr a.exr -d ref.exr", 2), "error: the reference and --difference are"));
  EXPECT_TRUE(BeginsWith(ErrorOf("compare ref.exr a.exr -d a.exr", 2), "error: an image and --difference are one"));
}

TEST_F(NamedFilesTest, ScenesOfOneNameHaveNoTwoReferences) {
  WriteScene("tiny.pbrt");
  std::filesystem::create_directory(Path("other"));
  WriteScene("other/tiny.pbrt");
  const std::string error = Run("converge tiny.pbrt other/tiny.pbrt --integrators path --time 0.02 -o out").err;
  EXPECT_TRUE(BeginsWith(error, "error: the reference of tiny.pbrt and the reference of other/tiny.pbrt are one file"));
}

}  // namespace
}  // namespace dapple
