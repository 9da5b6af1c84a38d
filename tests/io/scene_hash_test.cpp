#include "src/io/scene_hash.h"

#include <map>

#include <gtest/gtest.h>

#include "src/io/pbrt_parser.h"
#include "tests/image/temporary_folder.h"

namespace dapple {
namespace {

SceneContent ContentOf(const std::string& text, const std::string& folder = "") {
  Diagnostics diagnostics([](const std::string& line) { ADD_FAILURE() << line; });
  return HashSceneContent(ParsePbrtString(text, "test.pbrt", folder, {.pbrtVersion = 3}, diagnostics));
}

std::string HashOf(const std::string& text) { return ContentOf(text).hash; }

constexpr const char* kScene =
    "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" [40]\n"
    "Film \"image\" \"integer xresolution\" [8] \"string filename\" [\"a.exr\"]\nSampler \"halton\"\n"
    "WorldBegin\nLightSource \"point\"\nMaterial \"matte\" \"color Kd\" [0.5 0.5 0.5]\n"
    "Translate 1 0 0\nShape \"sphere\" \"float radius\" [2]\nWorldEnd\n";

std::string Changed(const std::string& from, const std::string& to) {
  std::string text = kScene;
  const size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  return text.replace(place, from.size(), to);
}

TEST(SceneHash, IsThatOfWhatThePictureFollowsFrom) {
  std::map<std::string, std::string> seen{{HashOf(kScene), "the scene itself"}};
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"0 0 5", "0 0 6"},
                                                        {"[40]", "[41]"},
                                                        {"[8]", "[9]"},
                                                        {"\"point\"", "\"distant\""},
                                                        {"\"matte\"", "\"plastic\""},
                                                        {"0.5 0.5 0.5", "0.5 0.5 0.50000001"},
                                                        {"Translate 1", "Translate 2"},
                                                        {"Translate 1", "ReverseOrientation Translate 1"},
                                                        {"\"float radius\"", "\"float zmax\""},
                                                        {"WorldEnd", "Shape \"sphere\"\nWorldEnd"},
                                                        {"WorldBegin", "PixelFilter \"gaussian\"\nWorldBegin"}}) {
    const auto [entry, isNew] = seen.emplace(HashOf(Changed(from, to)), to);
    EXPECT_TRUE(isNew) << to << " as " << entry->second;
  }
}

TEST(SceneHash, DoesNotCareForWhatThePictureDoesNotFollowFrom) {
  const std::string hash = HashOf(kScene);
  EXPECT_EQ(HashOf(std::string("# a comment\n\n") + kScene), hash);
  EXPECT_EQ(HashOf(Changed("a.exr", "b.exr")), hash);
  EXPECT_EQ(HashOf(Changed("\"halton\"", "\"halton\" \"integer pixelsamples\" 99")), hash);
  EXPECT_EQ(HashOf(Changed("[40]", "[4e1]")), hash);
}

// How directions toward it are drawn is no part of the content, and is told by itself.
TEST(SceneHash, SamplingOfEnvironmentsIsToldApart) {
  const auto parse = [](const std::string& lights) {
    Diagnostics diagnostics([](const std::string& line) { ADD_FAILURE() << line; });
    return ParsePbrtString("WorldBegin\n" + lights + "\nWorldEnd\n", "test.pbrt", "", {.pbrtVersion = 3}, diagnostics);
  };
  const std::string sky = "LightSource \"infinite\" \"string mapname\" \"sky.exr\" ";
  const std::string cosine = "\"string sampling\" \"cosine\"\n";
  const std::string gray = "LightSource \"exinfinite\"\n";
  EXPECT_EQ(HashSceneContent(parse(sky + cosine)).hash, HashSceneContent(parse(sky)).hash);
  EXPECT_NE(HashSceneContent(parse(sky + "\"integer samples\" 4\n")).hash, HashSceneContent(parse(sky)).hash);
  EXPECT_EQ(DescribeEnvironmentSampling(parse(sky + cosine + gray + sky)), "cosine,uniform light,importance");
  EXPECT_EQ(DescribeEnvironmentSampling(parse("LightSource \"point\"")), "none");
}

/// Whether the hash of a scene with `statements`, which name "hashed.png", follows from what is in that file.
bool FollowsFromTheFile(const std::string& statements) {
  const TemporaryFolder folder;
  const std::string text = Changed("Material", statements + "\nMaterial");
  const auto hash = [&](const std::string& content) {
    const std::string path = folder.Write("hashed.png", content);
    const SceneContent scene = ContentOf(text, std::filesystem::path(path).parent_path().string());
    EXPECT_EQ(scene.files, std::vector<std::string>{path}) << statements;
    return scene.hash;
  };
  const std::string one = hash("one"), two = hash("two");
  const std::string large = hash(std::string(3 << 20, 'a')), otherEnd = hash(std::string((3 << 20) - 1, 'a') + 'b');
  EXPECT_EQ(hash("one"), one) << statements;
  EXPECT_EQ(one == two, large == otherEnd) << statements;
  return one != two;
}

const std::string kTexture = "Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"hashed.png\"\n";
const std::string kMatte = "\"string type\" \"matte\" \"texture Kd\" \"t\"\n";
const std::string kMesh = "Shape \"plymesh\" \"string filename\" \"hashed.png\"\n";

TEST(SceneHash, HoldsTheContentOfFilesThatAreUsed) {
  const std::string sphere = "Shape \"sphere\"\n", named = "MakeNamedMaterial \"a\" " + kMatte;
  for (const std::string& statements :
       {kMesh, std::string("LightSource \"infinite\" \"string mapname\" \"hashed.png\""),
        kTexture + "Material \"matte\" \"texture Kd\" \"t\"\n" + sphere,
        kTexture + named + "NamedMaterial \"a\"\n" + sphere,
        kTexture +
            "Texture \"u\" \"color\" \"scale\" \"texture tex1\" \"t\"\nMaterial \"matte\" \"texture Kd\" \"u\"\n" +
            sphere,
        kTexture + named +
            "MakeNamedMaterial \"b\" \"string type\" \"mix\" \"string namedmaterial1\" \"a\"\n"
            "Material \"mix\" \"string namedmaterial2\" \"b\"\n" +
            sphere,
        "ObjectBegin \"o\"\n" + kMesh + "ObjectEnd\nObjectInstance \"o\""})
    EXPECT_TRUE(FollowsFromTheFile(statements)) << statements;
}

// They are not opened, and the builder does not look at them either.
TEST(SceneHash, DoesNotHoldTheContentOfFilesThatAreNotUsed) {
  for (const std::string& statements :
       {kTexture, kTexture + "Material \"matte\" \"texture Kd\" \"t\"", kTexture + "MakeNamedMaterial \"a\" " + kMatte,
        kTexture + "Texture \"u\" \"color\" \"scale\" \"texture tex1\" \"t\"",
        "ObjectBegin \"o\"\n" + kMesh + "ObjectEnd"})
    EXPECT_FALSE(FollowsFromTheFile(statements)) << statements;
}

// The builder tells where such a file is needed.
TEST(SceneHash, LeavesFilesThatCannotBeRead) {
  const std::string statement = "LightSource \"infinite\" \"string mapname\" ";
  for (const char* file : {"\"/proc/self/mem\"", "\"/dev/zero\"", "\"/\""})
    EXPECT_NE(HashOf(Changed("Material", statement + file + "\nMaterial")), HashOf(kScene)) << file;
}

}  // namespace
}  // namespace dapple
