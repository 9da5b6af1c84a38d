// Texture statements, seen from the surfaces that carry them.
#include "src/base/numerics.h"
#include "src/image/image_io.h"
#include "tests/io/build_test_support.h"

namespace dapple {
namespace {

/// The reflectance at (x, y) of a square (u = (x + 1) / 2, v = (y + 1) / 2) that carries the spectrum texture "t".
Color Seen(const std::string& texture, int version, double x, double y, const std::filesystem::path& folder = "") {
  const std::string material = version == 3 ? "Material \"matte\" \"texture Kd\" \"t\"\n"
                                            : "Material \"diffuse\" \"texture reflectance\" \"t\"\n";
  const auto scene = CleanWorld(texture + "\n" + material + Square(version), version, folder);
  const Vec3 w(0, 0, -1);
  return BsdfAtXY(*scene, x, y).Eval(w, w, TransportMode::Radiance) * kPi;
}

TEST(BuildTextures, ConstantScaleAndMix) {
  ExpectColor(Seen(R"(Texture "t" "spectrum" "constant" "rgb value" [.1 .2 .3])", 4, 0, 0), Color(.1f, .2f, .3f));
  const std::string a = R"(Texture "a" "spectrum" "constant" "rgb value" [.1 .2 .4]
  )";
  ExpectColor(Seen(a + R"(Texture "t" "spectrum" "scale" "texture tex" "a" "float scale" 2)", 4, 0, 0),
              Color(.2f, .4f, .8f));
  ExpectColor(Seen(a + R"(Texture "t" "spectrum" "scale" "texture tex1" "a" "rgb tex2" [2 1 .5])", 3, 0, 0),
              Color(.2f, .2f, .2f));
  ExpectColor(
      Seen(a + R"(Texture "t" "spectrum" "mix" "texture tex1" "a" "rgb tex2" [1 1 1] "float amount" .25)", 4, 0, 0),
      Color(.325f, .4f, .55f));
  // Defaults: half of 0 and half of 1.
  ExpectColor(Seen(R"(Texture "t" "color" "mix")", 3, 0, 0), Color(.5f));
}

TEST(BuildTextures, ImagesStandUprightAndAreDecoded) {
  const TestFolder folder;
  Image image = Image::Rgb(2, 2);
  const Color topLeft(0.8f, 0.1f, 0.2f), bottomRight(0.1f, 0.7f, 0.3f);
  for (int c = 0; c < 3; ++c) image.At(0, 0, c) = topLeft[c], image.At(1, 1, c) = bottomRight[c];
  WriteExr((folder.Path() / "i.exr").string(), image);
  WritePng((folder.Path() / "i.png").string(), image);
  const std::string map = R"(Texture "t" "spectrum" "imagemap" "string filename" "i.)";
  for (int version : {3, 4}) {
    ExpectColor(Seen(map + "exr\"", version, -0.5, 0.5, folder.Path()), topLeft, 1e-3);
    ExpectColor(Seen(map + "exr\"", version, 0.5, -0.5, folder.Path()), bottomRight, 1e-3);
    // sRGB is undone.
    ExpectColor(Seen(map + "png\"", version, -0.5, 0.5, folder.Path()), topLeft, 0.03);
  }
  // Not so when the file says that it is linear.
  EXPECT_GT(Seen(map + "png\" \"bool gamma\" \"false\"", 3, -0.5, 0.5, folder.Path()).g, 0.3f);
  EXPECT_GT(Seen(map + "png\" \"string encoding\" \"linear\"", 4, -0.5, 0.5, folder.Path()).g, 0.3f);
  ExpectColor(Seen(map + "png\" \"string encoding\" \"gamma 2.2\"", 4, -0.5, 0.5, folder.Path()), topLeft, 0.1);
  ExpectColor(Seen(map + "exr\" \"float scale\" 0.5", 4, -0.5, 0.5, folder.Path()), topLeft * 0.5f, 1e-3);
  ExpectColor(Seen(map + "exr\" \"bool invert\" true", 4, -0.5, 0.5, folder.Path()), Color(1) - topLeft, 1e-3);
}

TEST(BuildTextures, MappingsOfBothVersions) {
  const std::string checks = R"("spectrum" "checkerboard" "rgb tex1" [1 1 1] "rgb tex2" [0 0 0] )";
  // Scale and delta of (u, v).
  const std::string uv = "Texture \"t\" " + checks + "\"float uscale\" [4] \"float vscale\" [1] \"float udelta\" [1]";
  ExpectColor(Seen(uv, 4, -0.9, 0), Color(0));
  ExpectColor(Seen(uv, 4, -0.4, 0), Color(1));
  // Planar: v1 . p + udelta in the world (v3) or in the texture's space (v4).
  const std::string vector = "\"string mapping\" \"planar\" \"VECTOR v1\" [1 0 0] \"VECTOR v2\" [0 1 0]";
  const auto planar = [&](const char* type) {
    std::string text = "Scale 2 2 2\nTexture \"t\" " + checks + vector + "\nIdentity";
    for (size_t at; (at = text.find("VECTOR")) != std::string::npos;) text.replace(at, 6, type);
    return text;
  };
  const auto tiled = [&](const char* type, double x) {
    const int version = std::string(type) == "vector" ? 3 : 4;
    const std::string material = version == 3 ? "Material \"matte\" \"texture Kd\" \"t\"\n"
                                              : "Material \"diffuse\" \"texture reflectance\" \"t\"\n";
    const auto scene = CleanWorld("AttributeBegin\n" + planar(type) + "\nAttributeEnd\nAttributeBegin Scale 4 4 1\n" +
                                      material + Square(version) + "AttributeEnd",
                                  version);
    const Vec3 w(0, 0, -1);
    return BsdfAtXY(*scene, x, 0.5).Eval(w, w, TransportMode::Radiance).r * kPi;
  };
  EXPECT_NEAR(tiled("vector", 1.5), 0, 1e-4) << "cells of one unit of the world";
  EXPECT_NEAR(tiled("vector", 2.5), 1, 1e-4);
  EXPECT_NEAR(tiled("vector3", 1.5), 1, 1e-4) << "cells of two units";
  EXPECT_NEAR(tiled("vector3", 2.5), 0, 1e-4);
}

TEST(BuildTextures, ImagesAreOpenedOnceAndOnlyIfUsed) {
  const TestFolder folder;
  // Not an image; nobody refers to it.
  folder.Write("broken.png", "no image");
  CleanWorld("Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"broken.png\"\n" + Square(4), 4, folder.Path());
  const std::string error = MessageOf([&] {
    BuildWorld(
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"broken.png\"\n"
        "Material \"diffuse\" \"texture reflectance\" \"t\"\n" +
            Square(4),
        4, folder.Path());
  });
  EXPECT_EQ(error.substr(0, 18), "a.pbrt:5:35: error") << error;
}

TEST(BuildTextures, UnsupportedOnesAreGrayWithAWarning) {
  const Built built = BuildWorld(
      "Texture \"t\" \"spectrum\" \"marble\" \"float scale\" 2\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" +
          Square(4),
      4);
  ASSERT_EQ(built.warnings.size(), 1u);
  EXPECT_EQ(built.warnings[0].substr(0, 20), "a.pbrt:5:1: warning:");
  const Vec3 w(0, 0, -1);
  ExpectColor(BsdfAtXY(*built.scene, 0.1, 0.2).Eval(w, w, TransportMode::Radiance), Color(0.5f * kInvPi));
}

TEST(BuildTextures, ErrorsHaveAPlace) {
  const auto error = [](const std::string& texture) {
    return WorldError("Texture \"t\" " + texture + "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" + Square(4),
                      4);
  };
  EXPECT_EQ(error("\"spectrum\" \"imagemap\"").substr(0, 17), "a.pbrt:5:1: error");
  EXPECT_NE(error("\"spectrum\" \"chekerboard\"").find("did you mean \"checkerboard\"?"), std::string::npos);
  EXPECT_EQ(error("\"spectrum\" \"checkerboard\" \"string mapping\" \"planer\"").substr(0, 18), "a.pbrt:5:39: error");
  EXPECT_EQ(error("\"spectrum\" \"checkerboard\" \"integer dimension\" 4").substr(0, 18), "a.pbrt:5:39: error");
}

TEST(BuildTextures, OneThatIsNotThereYetIsToldApartFromOneThatIsNowhere) {
  const auto error = [](const std::string& textures) {
    return WorldError(textures + "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" + Square(4), 4);
  };
  EXPECT_EQ(error(R"(Texture "t" "spectrum" "scale" "texture tex" "t")"),
            "a.pbrt:5:32: error: texture \"t\" names itself");
  EXPECT_EQ(error(R"(Texture "t" "spectrum" "scale" "texture tex" "u"
Texture "u" "spectrum" "constant")"),
            "a.pbrt:5:32: error: texture \"u\" is defined further down (a.pbrt:6:1), expected before the texture that "
            "names it");
  EXPECT_EQ(error(R"(Texture "t" "spectrum" "scale" "texture tex" "u"
Texture "u" "spectrum" "scale" "texture tex" "t")")
                .substr(0, 68),
            "a.pbrt:5:32: error: texture \"u\" is defined further down (a.pbrt:6:1)");
  EXPECT_EQ(error(R"(Texture "tt" "spectrum" "constant" Texture "t" "spectrum" "scale" "texture tex" "ttt")"),
            "a.pbrt:5:67: error: no spectrum texture is named \"ttt\" here; did you mean \"tt\"?");
  // What stands before under the same name is meant.
  EXPECT_EQ(
      error("Texture \"t\" \"spectrum\" \"constant\"\nTexture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"t\""),
      "no error");
}

/// The error of a scene that shows "tN", a checkerboard at the end of N others that each name the one before, in the
/// parameters that `named` makes of its name.
template <typename Named>
std::string ChainError(int last, const Named& named) {
  std::string textures = "Texture \"t0\" \"spectrum\" \"checkerboard\"\n", shown;
  for (int i = 1; i <= last; ++i)
    textures += "Texture \"t" + std::to_string(i) + "\" \"spectrum\" \"checkerboard\" " +
                named("\"t" + std::to_string(i - 1) + "\"") + "\n";
  // From the first on, so that each finds the one that it names built.
  for (int i = 0; i <= last; ++i)
    shown += "Material \"diffuse\" \"texture reflectance\" \"t" + std::to_string(i) + "\"\n" + Square(4);
  const std::string top =
      "Material \"diffuse\" \"texture reflectance\" \"t" + std::to_string(last) + "\"\n" + Square(4);
  const std::string upward = WorldError(textures + shown, 4), downward = WorldError(textures + top, 4);
  EXPECT_EQ(upward == "no error", downward == "no error") << upward << "\n" << downward;
  return upward;
}

TEST(BuildTextures, NameEachOtherSoDeepAndNoDeeper) {
  const auto once = [](const std::string& below) { return "\"texture tex1\" " + below; };
  EXPECT_EQ(ChainError(255, once), "no error");
  EXPECT_EQ(ChainError(256, once), "a.pbrt:261:42: error: textures name each other more than 256 deep");
}

TEST(BuildTextures, NameEachOtherSoOftenAndNoMore) {
  const auto twice = [](const std::string& below) {
    return "\"texture tex1\" " + below + " \"texture tex2\" " + below;
  };
  EXPECT_EQ(ChainError(15, twice), "no error") << "2^16 - 1 evaluations";
  EXPECT_EQ(ChainError(16, twice),
            "a.pbrt:21:62: error: textures name each other so often that one look at this one may take more than 65536 "
            "evaluations, expected fewer");
}

}  // namespace
}  // namespace dapple
