#include "src/io/parameters.h"

#include <gtest/gtest.h>

#include "src/io/pbrt_parameters.h"
#include "tests/io/reader_test_support.h"

namespace dapple {
namespace {

/// Parameters from text in "a.pbrt".
ParameterList Parse(std::string_view text, Diagnostics& diagnostics) {
  PbrtLexer lexer(text, std::make_shared<const std::string>("a.pbrt"));
  PbrtVersionVotes votes;
  return ParseParameters(lexer, RgbSpace::Srgb, votes, diagnostics);
}

ParameterList Parse(std::string_view text) {
  WarningList warnings;
  ParameterList list = Parse(text, warnings.diagnostics);
  EXPECT_TRUE(warnings.lines.empty()) << warnings.lines[0];
  return list;
}

std::string ErrorOf(std::string_view text) {
  return MessageOf([&] { Parse(text); });
}

TEST(Parameters, OneValueOfEachType) {
  const ParameterList list = Parse(
      R"("float f" 1.5 "integer i" [-7] "bool b" "true" "bool c" false "string s" ["x y"] "point2 p" [1 2] "vector2 v" [3 4]
         "point3 q" [1 2 3] "vector3 w" [4 5 6] "normal n" [7 8 9])");
  EXPECT_EQ(list.GetFloat("f", 0), 1.5);
  EXPECT_EQ(list.GetInt("i", 0), -7);
  EXPECT_TRUE(list.GetBool("b", false));
  EXPECT_FALSE(list.GetBool("c", true));
  EXPECT_EQ(list.GetString("s", ""), "x y");
  EXPECT_EQ(list.GetPoint2Array("p", 1), (std::vector<Vec2>{{1, 2}}));
  EXPECT_EQ(list.Find("v", ParameterType::Vector2)->numbers, (std::vector<double>{3, 4}));
  EXPECT_EQ(list.GetPoint3("q", {}), Vec3d(1, 2, 3));
  EXPECT_EQ(list.GetVector3("w", {}), Vec3d(4, 5, 6));
  EXPECT_EQ(list.GetNormalArray("n", 1), (std::vector<Vec3>{{7, 8, 9}}));
}

TEST(Parameters, FallbacksWhereAbsent) {
  const ParameterList list;
  EXPECT_EQ(list.GetFloat("f", 1.5), 1.5);
  EXPECT_EQ(list.GetInt("i", 3), 3);
  EXPECT_TRUE(list.GetBool("b", true));
  EXPECT_EQ(list.GetString("s", "d"), "d");
  EXPECT_EQ(list.GetPoint3("q", {1, 2, 3}), Vec3d(1, 2, 3));
  EXPECT_TRUE(list.GetFloatArray("a").empty());
  EXPECT_TRUE(list.GetFloatArray("a", 4).empty());
  EXPECT_EQ(list.Find("x"), nullptr);
  EXPECT_FALSE(list.Has("x"));
}

TEST(Parameters, ArraysOfEachType) {
  const ParameterList list = Parse(
      R"("float f" [1 2 3] "integer i" [0 1 2147483647 -2147483648] "string s" ["a" "b"] "point2 uv" [0 .5 1 2]
         "point P" [10000000.0625 2 3 4 5 6] "normal N" [0 0 1] "vector S" [1 0 0])");
  EXPECT_EQ(list.GetFloatArray("f"), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(list.GetIntArray("i"), (std::vector<int>{0, 1, 2147483647, -2147483647 - 1}));
  EXPECT_EQ(list.GetStringArray("s", 2), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(list.GetPoint2Array("uv"), (std::vector<Vec2>{{0, .5f}, {1, 2}}));
  EXPECT_EQ(list.GetPoint3Array("P"), (std::vector<Vec3d>{{10000000.0625, 2, 3}, {4, 5, 6}}));  // not as float
  EXPECT_EQ(list.GetNormalArray("N"), (std::vector<Vec3>{{0, 0, 1}}));
  EXPECT_EQ(list.GetVector3Array("S"), (std::vector<Vec3>{{1, 0, 0}}));
}

TEST(Parameters, FloatsServeAsPoint2AsVersion3WritesThem) {
  EXPECT_EQ(Parse("\"float uv\" [0 1 2 3]").GetPoint2Array("uv"), (std::vector<Vec2>{{0, 1}, {2, 3}}));
  EXPECT_EQ(MessageOf([] { Parse("\"float uv\" [0 1 2]").GetPoint2Array("uv"); }),
            "a.pbrt:1:1: error: parameter \"uv\" has 3 numbers, expected a multiple of 2");
  EXPECT_EQ(MessageOf([] { Parse("\"point3 uv\" [0 1 2]").GetPoint2Array("uv"); }),
            "a.pbrt:1:1: error: parameter \"uv\" is \"point3\", expected \"point2\"");
}

TEST(Parameters, RawColoursSpectraAndTextures) {
  const ParameterList list = Parse(
      R"("rgb a" [.1 .2 .3] "color b" [1 1 1] "xyz c" [1 2 3] "spectrum d" [400 1 700 2] "spectrum e" "metal-Au-eta"
         "spectrum f" ["a.spd"] "blackbody g" [5500 1] "blackbody h" 3000 "texture i" "wood")");
  EXPECT_EQ(list.Find("a")->type, ParameterType::Rgb);
  EXPECT_EQ(list.Find("a")->numbers, (std::vector<double>{.1, .2, .3}));
  EXPECT_EQ(list.Find("b")->type, ParameterType::Rgb);
  EXPECT_EQ(list.Find("c")->type, ParameterType::Xyz);
  EXPECT_EQ(list.Find("d")->Count(), 2);
  EXPECT_EQ(list.Find("e")->strings, std::vector<std::string>{"metal-Au-eta"});
  EXPECT_TRUE(list.Find("e")->numbers.empty());
  EXPECT_EQ(list.Find("f")->strings, std::vector<std::string>{"a.spd"});
  EXPECT_EQ(list.Find("g")->numbers, (std::vector<double>{5500, 1}));
  EXPECT_EQ(list.Find("h")->numbers, std::vector<double>{3000});
  EXPECT_EQ(list.Find("i")->type, ParameterType::Texture);
  EXPECT_EQ(list.Find("i")->strings, std::vector<std::string>{"wood"});
}

TEST(Parameters, BlanksWithinTheDeclarationDoNotCount) {
  EXPECT_EQ(Parse("\" float\t  radius \" 2").GetFloat("radius", 0), 2);
}

TEST(Parameters, WrongTypeIsAnErrorAtTheParameter) {
  const ParameterList list = Parse("\n  \"string radius\" \"big\"\n\"float n\" 1 \"integer f\" 1");
  EXPECT_EQ(MessageOf([&] { list.GetFloat("radius", 1); }),
            "a.pbrt:2:3: error: parameter \"radius\" is \"string\", expected \"float\"");
  EXPECT_EQ(MessageOf([&] { list.GetInt("n", 1); }),
            "a.pbrt:3:1: error: parameter \"n\" is \"float\", expected \"integer\"");
  EXPECT_EQ(MessageOf([&] { list.GetFloat("f", 1); }),
            "a.pbrt:3:13: error: parameter \"f\" is \"integer\", expected \"float\"");
  EXPECT_THROW(list.GetBool("n", true), Error);
  EXPECT_THROW(list.GetString("n", ""), Error);
  EXPECT_THROW(list.GetPoint3Array("n"), Error);
  EXPECT_THROW(list.Find("n", ParameterType::Rgb), Error);
}

TEST(Parameters, WrongCountIsAnErrorAtTheParameter) {
  const ParameterList list = Parse("\"float crop\" [0 1 2] \"point3 P\" [1 2 3 4 5 6]");
  EXPECT_EQ(MessageOf([&] { list.GetFloatArray("crop", 4); }),
            "a.pbrt:1:1: error: parameter \"crop\" has 3 values, expected 4");
  EXPECT_EQ(MessageOf([&] { list.GetFloat("crop", 4); }),
            "a.pbrt:1:1: error: parameter \"crop\" has 3 values, expected 1");
  EXPECT_EQ(MessageOf([&] { list.GetPoint3("P", {}); }),
            "a.pbrt:1:22: error: parameter \"P\" has 2 values, expected 1");
}

TEST(Parameters, NumbersBeyondFloatDoNotBecomeInfinite) {
  const ParameterList list = Parse("\"point3 P\" [0 1e300 0] \"normal N\" [0 1e300 0] \"point2 uv\" [0 -1e39]");
  EXPECT_EQ(list.GetPoint3Array("P")[0].y, 1e300);
  EXPECT_EQ(MessageOf([&] { list.GetNormalArray("N"); }),
            "a.pbrt:1:24: error: parameter \"N\" has the value 1e+300, beyond the range of float");
  EXPECT_EQ(MessageOf([&] { list.GetPoint2Array("uv"); }),
            "a.pbrt:1:47: error: parameter \"uv\" has the value -1e+39, beyond the range of float");
}

TEST(ParseParameters, MalformedDeclarations) {
  EXPECT_EQ(ErrorOf("\"radius\" 1"), "a.pbrt:1:1: error: expected a parameter \"type name\", found \"radius\"");
  EXPECT_EQ(ErrorOf("\"\" 1"), "a.pbrt:1:1: error: expected a parameter \"type name\", found \"\"");
  EXPECT_EQ(ErrorOf("\"float a b\" 1"), "a.pbrt:1:1: error: expected a parameter \"type name\", found \"float a b\"");
  EXPECT_EQ(
      ErrorOf("\"flaot radius\" 1"),
      "a.pbrt:1:1: error: unknown parameter type \"flaot\"; did you mean \"float\"?; known are integer, float, bool, "
      "string, point2, vector2, point3, point, vector3, vector, normal, normal3, rgb, color, xyz, spectrum, "
      "blackbody, texture");
}

TEST(ParseParameters, ValuesOfTheWrongKind) {
  EXPECT_EQ(ErrorOf("\"float r\" \"2\""),
            "a.pbrt:1:11: error: parameter \"r\" of type \"float\" takes numbers, found the string \"2\"");
  EXPECT_EQ(ErrorOf("\"float r\" [1 nan]"),
            "a.pbrt:1:14: error: parameter \"r\" of type \"float\" takes numbers, found \"nan\"");
  EXPECT_EQ(ErrorOf("\"float r\" [1 [2]]"),
            "a.pbrt:1:14: error: parameter \"r\" of type \"float\" takes numbers, found \"[\"");
  EXPECT_EQ(ErrorOf("\"string s\" [\"a\" 2]"),
            "a.pbrt:1:17: error: parameter \"s\" of type \"string\" takes strings, found the number \"2\"");
  EXPECT_EQ(ErrorOf("\"bool b\" 1"),
            "a.pbrt:1:10: error: parameter \"b\" of type \"bool\" takes true or false, found the number \"1\"");
  EXPECT_EQ(ErrorOf("\"bool b\" \"yes\""),
            "a.pbrt:1:10: error: parameter \"b\" of type \"bool\" takes true or false, found the string \"yes\"");
  EXPECT_EQ(
      ErrorOf("\"spectrum s\" [400 1 \"a.spd\"]"),
      "a.pbrt:1:21: error: parameter \"s\" of type \"spectrum\" takes numbers or strings, found the string \"a.spd\"");
  EXPECT_EQ(
      ErrorOf("\"spectrum s\" [\"a.spd\" 400 1]"),
      "a.pbrt:1:23: error: parameter \"s\" of type \"spectrum\" takes numbers or strings, found the number \"400\"");
  EXPECT_EQ(ErrorOf("\"float r\""),
            "a.pbrt:1:10: error: parameter \"r\" of type \"float\" takes numbers, found the end of the file");
  EXPECT_EQ(ErrorOf("\"float r\" ]"),
            "a.pbrt:1:11: error: parameter \"r\" of type \"float\" takes numbers, found \"]\"");
}

TEST(ParseParameters, CountsThatTheTypeCannotHave) {
  EXPECT_EQ(ErrorOf("\"point3 P\" [1 2]"),
            "a.pbrt:1:1: error: parameter \"P\" of type \"point3\" has 2 numbers, expected a multiple of 3");
  EXPECT_EQ(ErrorOf("\"rgb L\" 1"),
            "a.pbrt:1:1: error: parameter \"L\" of type \"rgb\" has 1 number, expected a multiple of 3");
  EXPECT_EQ(ErrorOf("\"point2 p\" [1 2 3]"),
            "a.pbrt:1:1: error: parameter \"p\" of type \"point2\" has 3 numbers, expected a multiple of 2");
  EXPECT_EQ(ErrorOf("\"spectrum s\" [400 1 500]"),
            "a.pbrt:1:1: error: parameter \"s\" of type \"spectrum\" has 3 numbers, expected a multiple of 2");
  EXPECT_EQ(ErrorOf("\"float f\" []"), "a.pbrt:1:1: error: parameter \"f\" has no values");
  EXPECT_EQ(ErrorOf("\"string s\" [ ]"), "a.pbrt:1:1: error: parameter \"s\" has no values");
  EXPECT_EQ(ErrorOf("\"texture t\" [\"a\" \"b\"]"), "a.pbrt:1:1: error: parameter \"t\" has 2 textures, expected 1");
  EXPECT_EQ(ErrorOf("\n\"float f\" [1 2"), "a.pbrt:2:11: error: the \"[\" is not closed");
}

TEST(ParseParameters, IntegersAreWholeAndOf32Bits) {
  EXPECT_EQ(ErrorOf("\"integer i\" [1 1.5]"),
            "a.pbrt:1:1: error: value 2 of parameter \"i\" is 1.5, expected a 32-bit integer");
  EXPECT_EQ(ErrorOf("\"integer i\" 2147483648"),
            "a.pbrt:1:1: error: value 1 of parameter \"i\" is 2147483648, expected a 32-bit integer");
  EXPECT_EQ(Parse("\"integer i\" 1e3").GetInt("i", 0), 1000);
}

TEST(ParseParameters, TheLastOfTwoCountsWithAWarning) {
  WarningList warnings;
  const ParameterList list = Parse("\"float r\" 1\n\"float r\" 2", warnings.diagnostics);
  EXPECT_EQ(list.GetFloat("r", 0), 2);
  EXPECT_EQ(warnings.lines,
            std::vector<std::string>{"a.pbrt:2:1: warning: parameter \"r\" is given twice; the last one counts"});
}

TEST(ParseParameters, EndlessListsAreRefused) {
  std::string text;
  for (int i = 0; i < 1000; ++i) text += "\"float p" + std::to_string(i) + "\" 1 ";
  EXPECT_NE(ErrorOf(text).find("error: more than 256 parameters in one statement"), std::string::npos);
}

TEST(ReportUnused, NamesWhatNobodyAskedForAndTheNearestKnownName) {
  const ParameterList list = Parse("\"float raduis\" 1\n \"float zmin\" 0 \"integer other\" 2 \"float quiet\" 1");
  list.GetFloat("radius", 1);
  list.GetFloat("zmin", 0);
  WarningList warnings;
  list.ReportUnused(warnings.diagnostics, {"quiet"});
  EXPECT_EQ(warnings.lines,
            (std::vector<std::string>{"a.pbrt:1:1: warning: unknown parameter \"raduis\"; did you mean \"radius\"?",
                                      "a.pbrt:2:17: warning: unknown parameter \"other\""}));
}

TEST(ReportUnused, IgnoredAndInheritedParametersAreNoMistake) {
  ParameterList list = Parse("\"float a\" 1");
  list.IgnoreAll();
  list.AddDefaults(Parse("\"float b\" 2"));
  WarningList warnings;
  list.ReportUnused(warnings.diagnostics);
  EXPECT_TRUE(warnings.lines.empty());
}

TEST(AddDefaults, OwnParametersComeFirst) {
  ParameterList list = Parse("\"float a\" 1");
  list.AddDefaults(Parse("\"float a\" 2 \"float b\" 3"));
  EXPECT_EQ(list.GetFloat("a", 0), 1);
  EXPECT_EQ(list.GetFloat("b", 0), 3);
  EXPECT_EQ(list.All().size(), 2u);
}

TEST(Parameters, LocationOfIsNoLookUp) {
  const ParameterList list = Parse("  \"float a\" 1");
  EXPECT_EQ(list.LocationOf("a", {}).ToString(), "a.pbrt:1:3");
  EXPECT_EQ(list.LocationOf("b", FileLocation("f")).ToString(), "f");
  WarningList warnings;
  list.ReportUnused(warnings.diagnostics);
  EXPECT_EQ(warnings.lines.size(), 1u);
}

}  // namespace
}  // namespace dapple
