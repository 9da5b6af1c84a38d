// Which version of the format a text is in.
#include "src/io/pbrt_version.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "src/io/pbrt_parser.h"
#include "tests/io/reader_test_support.h"

namespace dapple {
namespace {

SceneDescription Parse(const std::string& text, int version = 0) {
  WarningList warnings;
  return ParsePbrtString(text, "a.pbrt", "", {version}, warnings.diagnostics);
}

/// The version that a word speaks for, 0 for none.
int VersionOf(WordKind kind, const std::string& word) {
  PbrtVersionVotes votes;
  votes.Saw(kind, word, {});
  if (votes.Reason(3) != "nothing in the file tells the version") return 3;
  return votes.Reason(4) != "nothing in the file tells the version" ? 4 : 0;
}

/// The warnings on the way, a line each.
std::string WarningsOf(const std::string& text, int version = 0) {
  WarningList warnings;
  ParsePbrtString(text, "a.pbrt", "", {version}, warnings.diagnostics);
  std::string lines;
  for (const std::string& line : warnings.lines) lines += line + "\n";
  return lines;
}

TEST(PbrtVersion, WorldEndDecidesOverHabits) {
  const SceneDescription scene = Parse(
      "WorldBegin\nTexture \"t\" \"spectrum\" \"constant\"\nShape \"sphere\" \"point3 P\" [0 0 0] \"vector3 v\" [0 0 "
      "0] \"point2 uv\" [0 0] \"bool b\" true\nWorldEnd");
  EXPECT_EQ(scene.version, 3);
  EXPECT_EQ(scene.versionReason, "WorldEnd (a.pbrt:4:1)");
}

TEST(PbrtVersion, NamesOutweighAStrayWorldEnd) {
  const std::string names[] = {"Film \"rgb\" WorldBegin",
                               "Sampler \"zsobol\" WorldBegin",
                               "ColorSpace \"rec2020\" WorldBegin",
                               "Option \"integer seed\" 1 WorldBegin",
                               "WorldBegin Material \"diffuse\"",
                               "WorldBegin Attribute \"shape\" \"float radius\" 1",
                               "WorldBegin LightSource \"infinite\" \"string filename\" \"x.exr\""};
  for (const std::string& text : names) EXPECT_EQ(Parse(text + " WorldEnd").version, 4) << text;
  EXPECT_EQ(WarningsOf("Film \"rgb\"\nWorldBegin\nMaterial \"diffuse\"\nWorldEnd"),
            "a.pbrt:4:1: warning: WorldEnd is of pbrt-v3, but the file is read as version 4 because of film \"rgb\" "
            "(a.pbrt:1:1), material \"diffuse\" (a.pbrt:3:1); --pbrt-version 3 reads it as version 3\n");
}

TEST(PbrtVersion, NamesOfVersion4InAFileOfVersion3AreTold) {
  const std::string text =
      "Film \"image\"\nWorldBegin\nMaterial \"matte\"\nLightSource \"infinite\" \"string filename\" \"x\"\nWorldEnd";
  EXPECT_EQ(Parse(text).version, 3);
  EXPECT_EQ(
      WarningsOf(text),
      "a.pbrt:4:24: warning: light's \"filename\" is of pbrt-v4, but the file is read as version 3 because of film "
      "\"image\" (a.pbrt:1:1), material \"matte\" (a.pbrt:3:1), WorldEnd (a.pbrt:5:1); --pbrt-version 4 reads it as "
      "version 4\n");
}

TEST(PbrtVersion, OnlyContradictionsAreTold) {
  EXPECT_EQ(WarningsOf("Film \"image\" WorldBegin Material \"matte\" Shape \"sphere\" \"point3 P\" [0 0 0] WorldEnd"),
            "");
  EXPECT_EQ(WarningsOf("Film \"rgb\" WorldBegin LightSource \"infinite\" \"integer samples\" 4 \"bool b\" \"true\""),
            "");
  EXPECT_EQ(WarningsOf("Film \"rgb\" WorldBegin Material \"diffuse\" \"color reflectance\" [1 1 1]"), "");
  // Whoever says the version is not told.
  EXPECT_EQ(WarningsOf("Film \"rgb\" WorldBegin WorldEnd", 4), "");
  EXPECT_EQ(WarningsOf("Film \"rgb\" WorldBegin WorldEnd", 3), "");
}

TEST(PbrtVersion, WithoutWorldEndItIsVersion4) {
  const SceneDescription scene =
      Parse("Film \"rgb\"\nWorldBegin Material \"diffuse\" Attribute \"shape\" \"float radius\" 2");
  EXPECT_EQ(scene.version, 4);
  EXPECT_EQ(scene.versionReason,
            "Attribute (a.pbrt:2:31), film \"rgb\" (a.pbrt:1:1), material \"diffuse\" (a.pbrt:2:12)");
}

TEST(PbrtVersion, SilenceIsVersion4) {
  const SceneDescription scene = Parse("WorldBegin Shape \"sphere\"");
  EXPECT_EQ(scene.version, 4);
  EXPECT_EQ(scene.versionReason, "WorldBegin without WorldEnd (a.pbrt:1:1)");
  PbrtVersionVotes votes;
  EXPECT_EQ(votes.Version(), 4);
  EXPECT_EQ(votes.Reason(4), "nothing in the file tells the version");
}

TEST(PbrtVersion, TheWordsOfVersion3WithoutWorldEndAreATruncatedFile) {
  EXPECT_EQ(MessageOf([] { Parse("Film \"image\"\nWorldBegin Material \"matte\" \"color Kd\" [1 1 1]"); }),
            "a.pbrt:2:1: error: WorldBegin without WorldEnd, which pbrt-v3 files have at their end");
}

TEST(PbrtVersion, TheUserDecidesWhereAsked) {
  EXPECT_EQ(Parse("WorldBegin Material \"diffuse\" WorldEnd", 3).version, 3);
  const SceneDescription scene = Parse("WorldBegin Material \"matte\" WorldEnd", 4);
  EXPECT_EQ(scene.version, 4);
  EXPECT_EQ(scene.versionReason, "asked for");
}

TEST(PbrtVersion, IncludedFilesSpeakToo) {
  const TestFolder folder;
  folder.Write("part.pbrt", "Material \"matte\" \"color Kd\" [1 1 1] WorldEnd");
  WarningList warnings;
  EXPECT_EQ(
      ParsePbrtString("WorldBegin Include \"part.pbrt\"", "a.pbrt", folder.Path(), {}, warnings.diagnostics).version,
      3);
}

TEST(PbrtVersion, EachWordCountsOnce) {
  PbrtVersionVotes votes;
  for (int i = 0; i < 100; ++i) votes.Saw(WordKind::ParameterType, "point3", {});
  EXPECT_EQ(votes.Version(), 4);
  votes.Saw(WordKind::Material, "matte", {});
  EXPECT_EQ(votes.Version(), 3);
  votes.Saw(WordKind::Material, "diffuse", {});
  EXPECT_EQ(votes.Version(), 4);
}

TEST(PbrtVersion, ATieIsVersion4) {
  PbrtVersionVotes votes;
  votes.Saw(WordKind::Material, "matte", {});
  votes.Saw(WordKind::Material, "diffuse", {});
  EXPECT_EQ(votes.Version(), 4);
}

TEST(PbrtVersion, WordsThatOneVersionKnows) {
  for (const char* material :
       {"matte", "glass", "metal", "mirror", "plastic", "substrate", "uber", "translucent", "disney", "fourier"})
    EXPECT_EQ(VersionOf(WordKind::Material, material), 3) << material;
  for (const char* material : {"diffuse", "coateddiffuse", "coatedconductor", "conductor", "dielectric",
                               "thindielectric", "diffusetransmission", "measured", "interface"})
    EXPECT_EQ(VersionOf(WordKind::Material, material), 4) << material;
  for (const char* material : {"mix", "hair", "subsurface", ""}) EXPECT_EQ(VersionOf(WordKind::Material, material), 0);
  EXPECT_EQ(VersionOf(WordKind::Film, "image"), 3);
  for (const char* film : {"rgb", "gbuffer", "spectral"}) EXPECT_EQ(VersionOf(WordKind::Film, film), 4);
  for (const char* type : {"point", "vector", "color", "xyz"}) EXPECT_EQ(VersionOf(WordKind::ParameterType, type), 3);
  for (const char* type : {"point2", "vector2", "point3", "vector3"})
    EXPECT_EQ(VersionOf(WordKind::ParameterType, type), 4);
  for (const char* type : {"float", "integer", "normal", "rgb", "spectrum", "string", "texture", "bool"})
    EXPECT_EQ(VersionOf(WordKind::ParameterType, type), 0);
  for (const char* word : {"Attribute", "Option", "ColorSpace", "Import"})
    EXPECT_EQ(VersionOf(WordKind::Directive, word), 4);
  EXPECT_EQ(VersionOf(WordKind::TextureValue, "color"), 3);
  EXPECT_EQ(VersionOf(WordKind::TextureValue, "spectrum"), 4);
  EXPECT_EQ(VersionOf(WordKind::LightParameter, "mapname"), 3);
  EXPECT_EQ(VersionOf(WordKind::LightParameter, "filename"), 4);
}

TEST(PbrtVersion, FormsOfValuesSpeakToo) {
  const auto reason = [](const std::string& text) {
    return Parse("WorldBegin LightSource \"infinite\" " + text, 0).versionReason;
  };
  EXPECT_NE(reason("\"bool b\" true").find("bare true or false (a.pbrt:1:44)"), std::string::npos);
  EXPECT_NE(reason("\"bool b\" \"true\" WorldEnd").find("quoted true or false"), std::string::npos);
  EXPECT_NE(reason("\"blackbody L\" 5000").find("plain blackbody"), std::string::npos);
  EXPECT_NE(reason("\"blackbody L\" [5000 1] WorldEnd").find("scaled blackbody"), std::string::npos);
  EXPECT_NE(reason("\"string filename\" \"x.exr\"").find("light's \"filename\""), std::string::npos);
}

/// Every scene in the folder of references, where that is known: "-v3" and "-v4" in the names tell the version.
TEST(PbrtVersion, ReferenceScenes) {
  const char* folder = std::getenv("DAPPLE_REFERENCES");
  if (!folder) GTEST_SKIP() << "DAPPLE_REFERENCES is not set";
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".pbrt") continue;
    WarningList warnings;
    const SceneDescription scene = ParsePbrtFile(entry.path(), {}, warnings.diagnostics);
    const bool isVersion3 = entry.path().stem().string().find("-v3") != std::string::npos;
    EXPECT_EQ(scene.version, isVersion3 ? 3 : 4) << entry.path();
    EXPECT_TRUE(warnings.lines.empty()) << warnings.lines[0];
    EXPECT_FALSE(scene.shapes.empty());
    ++count;
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace dapple
