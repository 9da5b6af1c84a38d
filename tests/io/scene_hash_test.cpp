#include "src/io/scene_hash.h"

#include <fstream>
#include <map>

#include <gtest/gtest.h>

#include "src/io/pbrt_parser.h"

namespace dapple {
namespace {

std::string HashOf(const std::string& text) {
  Diagnostics diagnostics([](const std::string& line) { ADD_FAILURE() << line; });
  return HashSceneContent(ParsePbrtString(text, "test.pbrt", testing::TempDir(), {.pbrtVersion = 3}, diagnostics)).hash;
}

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
    return ParsePbrtString("WorldBegin\n" + lights + "\nWorldEnd\n", "test.pbrt", testing::TempDir(),
                           {.pbrtVersion = 3}, diagnostics);
  };
  const std::string sky = "LightSource \"infinite\" \"string mapname\" \"sky.exr\" ";
  const std::string cosine = "\"string sampling\" \"cosine\"\n";
  const std::string gray = "LightSource \"exinfinite\"\n";
  EXPECT_EQ(HashSceneContent(parse(sky + cosine)).hash, HashSceneContent(parse(sky)).hash);
  EXPECT_NE(HashSceneContent(parse(sky + "\"integer samples\" 4\n")).hash, HashSceneContent(parse(sky)).hash);
  EXPECT_EQ(DescribeEnvironmentSampling(parse(sky + cosine + gray + sky)), "cosine,uniform light,importance");
  EXPECT_EQ(DescribeEnvironmentSampling(parse("LightSource \"point\"")), "none");
}

TEST(SceneHash, HoldsTheContentOfFiles) {
  const std::string text =
      Changed("Material", "Texture \"t\" \"color\" \"imagemap\" \"string filename\" \"hashed.png\"\nMaterial");
  const auto write = [](const std::string& content) {
    std::ofstream(testing::TempDir() + "/hashed.png", std::ios::binary) << content;
  };
  write("one");
  const std::string one = HashOf(text);
  write("two");
  const std::string two = HashOf(text);
  write(std::string(3 << 20, 'a'));
  const std::string large = HashOf(text);
  write(std::string((3 << 20) - 1, 'a') + 'b');
  EXPECT_NE(one, two);
  EXPECT_NE(large, HashOf(text));
  write("one");
  EXPECT_EQ(HashOf(text), one);
}

}  // namespace
}  // namespace dapple
