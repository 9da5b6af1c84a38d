#include "src/io/pbrt_parser.h"

#include <gtest/gtest.h>

#include "tests/io/reader_test_support.h"

namespace dapple {
namespace {

SceneDescription Parse(const std::string& text, Diagnostics& diagnostics, int version = 0) {
  return ParsePbrtString(text, "a.pbrt", "", {version}, diagnostics);
}

SceneDescription Parse(const std::string& text, int version = 0) {
  WarningList warnings;
  SceneDescription scene = Parse(text, warnings.diagnostics, version);
  EXPECT_TRUE(warnings.lines.empty()) << warnings.lines[0];
  return scene;
}

SceneDescription World(const std::string& text, int version = 4) {
  return Parse("WorldBegin\n" + text + (version == 3 ? "\nWorldEnd" : ""), version);
}

std::string ErrorOf(const std::string& text, int version = 0) {
  return MessageOf([&] { Parse(text, version); });
}

std::vector<std::string> WarningsOf(const std::string& text, int version = 0) {
  WarningList warnings;
  Parse(text, warnings.diagnostics, version);
  return warnings.lines;
}

// What is in a scene.

TEST(PbrtParser, OptionsOfTheWholeScene) {
  const SceneDescription scene = Parse(R"(
    LookAt 1 2 3  1 2 10  0 1 0
    Camera "perspective" "float fov" [39]
    Film "rgb" "integer xresolution" 64
    Sampler "zsobol" "integer pixelsamples" 4
    Integrator "sppm" "float radius" .5
    PixelFilter "box" "float xradius" .5
    Accelerator "bvh" "integer maxnodeprims" 4
    Option "integer seed" 7
    Option "bool disablepixeljitter" true
    WorldBegin)");
  EXPECT_EQ(scene.camera.type, "perspective");
  EXPECT_EQ(scene.camera.params.GetFloat("fov", 0), 39);
  EXPECT_EQ(scene.camera.location.ToString(), "a.pbrt:3:5");
  EXPECT_EQ(scene.camera.cameraFromWorld.Point({1, 2, 3}), Vec3d(0, 0, 0));
  EXPECT_EQ(scene.film.type, "rgb");
  EXPECT_EQ(scene.film.params.GetInt("xresolution", 0), 64);
  EXPECT_EQ(scene.sampler.type, "zsobol");
  EXPECT_EQ(scene.integrator.type, "sppm");
  EXPECT_EQ(scene.pixelFilter.type, "box");
  EXPECT_EQ(scene.accelerator.type, "bvh");
  EXPECT_EQ(scene.options.GetInt("seed", 0), 7);
  EXPECT_TRUE(scene.options.GetBool("disablepixeljitter", false));
  EXPECT_TRUE(scene.film.IsGiven());
}

TEST(PbrtParser, WhatIsNotGivenIsSeen) {
  const SceneDescription scene = World("");
  EXPECT_FALSE(scene.camera.IsGiven());
  EXPECT_FALSE(scene.film.IsGiven());
  EXPECT_TRUE(scene.shapes.empty());
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(scene.materials[0].type, "diffuse");
}

TEST(PbrtParser, ShapesCarryTheStateAtTheirPlace) {
  const SceneDescription scene = World(R"(
    Shape "sphere"
    AttributeBegin
      Material "conductor" "float roughness" .1
      AreaLightSource "diffuse" "rgb L" [1 2 3]
      ReverseOrientation
      Translate 1 2 3
      Shape "disk" "float radius" 2
    AttributeEnd
    Shape "sphere" "float radius" 3)");
  ASSERT_EQ(scene.shapes.size(), 3u);
  const ShapeDescription& disk = scene.shapes[1];
  EXPECT_EQ(disk.type, "disk");
  EXPECT_EQ(disk.params.GetFloat("radius", 0), 2);
  EXPECT_EQ(disk.worldFromShape, Transform::Translate({1, 2, 3}));
  EXPECT_TRUE(disk.reverseOrientation);
  EXPECT_EQ(scene.materials.at(disk.material).type, "conductor");
  EXPECT_EQ(scene.areaLights.at(disk.areaLight).type, "diffuse");
  for (const int i : {0, 2}) {
    const ShapeDescription& sphere = scene.shapes[static_cast<std::size_t>(i)];
    EXPECT_TRUE(sphere.worldFromShape.IsIdentity());
    EXPECT_FALSE(sphere.reverseOrientation);
    EXPECT_EQ(sphere.material, 0);
    EXPECT_EQ(sphere.areaLight, -1);
  }
}

TEST(PbrtParser, ReverseOrientationTwiceIsNone) {
  EXPECT_FALSE(World("ReverseOrientation ReverseOrientation Shape \"sphere\"").shapes[0].reverseOrientation);
}

TEST(PbrtParser, LightsKeepTheirTransform) {
  const SceneDescription scene = World("Translate 0 0 5 LightSource \"point\" \"rgb I\" [1 1 1]");
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].type, "point");
  EXPECT_EQ(scene.lights[0].worldFromLight.Point({0, 0, 0}), Vec3d(0, 0, 5));
  EXPECT_EQ(scene.lights[0].location.ToString(), "a.pbrt:2:17");
}

TEST(PbrtParser, NamedMaterialsByNameAndInOrder) {
  const SceneDescription scene = World(R"(
    MakeNamedMaterial "gold" "string type" "conductor" "float roughness" .2
    NamedMaterial "gold" Shape "sphere"
    NamedMaterial "later" Shape "sphere"
    MakeNamedMaterial "later" "string type" "dielectric")");
  EXPECT_EQ(scene.materials.at(scene.shapes[0].material).name, "gold");
  EXPECT_EQ(scene.materials.at(scene.shapes[0].material).type, "conductor");
  EXPECT_EQ(scene.materials.at(scene.shapes[1].material).type, "dielectric");
  const std::unordered_map<std::string_view, int> expected = {{"gold", scene.shapes[0].material},
                                                              {"later", scene.shapes[1].material}};
  EXPECT_EQ(scene.MaterialsByName(), expected);
}

TEST(PbrtParser, NamesOfABlockEndWithItWhereAnOuterOneIsThere) {
  WarningList warnings;
  const SceneDescription scene = Parse(R"(WorldBegin
    MakeNamedMaterial "m" "string type" "matte"
    Texture "t" "float" "constant" "float value" 1
    AttributeBegin
      MakeNamedMaterial "m" "string type" "mirror"
      Texture "t" "float" "constant" "float value" 2
      NamedMaterial "m" Shape "sphere" "texture alpha" "t"
    AttributeEnd
    NamedMaterial "m" Shape "sphere" "texture alpha" "t"
    WorldEnd)",
                                       warnings.diagnostics);
  EXPECT_EQ(scene.materials.at(scene.shapes[0].material).type, "mirror");
  EXPECT_EQ(scene.shapes[0].params.Find("alpha")->floatTexture, 1);
  EXPECT_EQ(scene.materials.at(scene.shapes[1].material).type, "matte");
  EXPECT_EQ(scene.shapes[1].params.Find("alpha")->floatTexture, 0);
  EXPECT_EQ(warnings.lines,
            (std::vector<std::string>{
                "a.pbrt:5:7: warning: material \"m\" is defined again; the new one counts from here on",
                "a.pbrt:6:7: warning: texture \"t\" is defined again; the new one counts from here on"}));
}

TEST(PbrtParser, NamesOfAClosedBlockAreStillFound) {
  const SceneDescription scene = World(R"(
    AttributeBegin MakeNamedMaterial "m" "string type" "conductor" AttributeEnd
    NamedMaterial "m" Shape "sphere")");
  EXPECT_EQ(scene.materials.at(scene.shapes[0].material).type, "conductor");
}

TEST(PbrtParser, TexturesAreReferredToByIndex) {
  const SceneDescription scene = World(R"(
    Translate 1 0 0
    Texture "a" "spectrum" "imagemap" "string filename" "a.png"
    Texture "a" "float" "constant"
    Texture "b" "spectrum" "scale" "texture tex" "a" "texture scale" "late"
    Material "diffuse" "texture reflectance" "b" "texture displacement" "late"
    Texture "late" "float" "constant"
    Shape "sphere")");
  ASSERT_EQ(scene.textures.size(), 4u);
  EXPECT_TRUE(scene.textures[0].isSpectrum);
  EXPECT_FALSE(scene.textures[1].isSpectrum);
  EXPECT_EQ(scene.textures[0].type, "imagemap");
  EXPECT_EQ(scene.textures[0].name, "a");
  EXPECT_EQ(scene.textures[0].worldFromTexture, Transform::Translate({1, 0, 0}));
  const ParameterList& b = scene.textures[2].params;
  EXPECT_EQ(b.Find("tex")->spectrumTexture, 0);
  EXPECT_EQ(b.Find("tex")->floatTexture, 1);
  EXPECT_EQ(b.Find("scale")->floatTexture, -1);  // textures refer backwards only, so never in circles
  const ParameterList& material = scene.materials[1].params;
  EXPECT_EQ(material.Find("reflectance")->spectrumTexture, 2);
  EXPECT_EQ(material.Find("reflectance")->floatTexture, -1);
  EXPECT_EQ(material.Find("displacement")->floatTexture, 3);
}

TEST(PbrtParser, AttributesAreDefaultsOfWhatFollows) {
  const SceneDescription scene = World(R"(
    Attribute "shape" "float radius" 2 "float alpha" .5
    Attribute "light" "float scale" 3
    Attribute "material" "float roughness" .25
    Attribute "texture" "float scale" 9
    Attribute "medium" "float g" 0
    Shape "sphere"
    Shape "sphere" "float radius" 7
    AttributeBegin
      Attribute "shape" "float radius" 4
      Shape "sphere"
    AttributeEnd
    Shape "sphere"
    LightSource "point"
    AreaLightSource "diffuse"
    Material "conductor"
    Texture "t" "float" "constant")");
  const std::vector<double> radii = {2, 7, 4, 2};
  for (std::size_t i = 0; i < radii.size(); ++i) {
    EXPECT_EQ(scene.shapes[i].params.GetFloat("radius", 0), radii[i]);
    EXPECT_EQ(scene.shapes[i].params.GetFloat("alpha", 0), .5);
  }
  EXPECT_EQ(scene.lights[0].params.GetFloat("scale", 0), 3);
  EXPECT_EQ(scene.areaLights[0].params.GetFloat("scale", 0), 3);
  EXPECT_EQ(scene.materials[1].params.GetFloat("roughness", 0), .25);
  EXPECT_EQ(scene.textures[0].params.GetFloat("scale", 0), 9);
}

TEST(PbrtParser, ColorSpaceIsOfTheBlock) {
  const SceneDescription scene = World(R"(
    AttributeBegin ColorSpace "rec2020" LightSource "point" "rgb I" [1 1 1] AttributeEnd
    LightSource "point" "rgb I" [1 1 1])");
  EXPECT_EQ(scene.lights[0].params.Find("I")->rgbSpace, RgbSpace::Rec2020);
  EXPECT_EQ(scene.lights[1].params.Find("I")->rgbSpace, RgbSpace::Srgb);
  EXPECT_EQ(
      ErrorOf("ColorSpace \"cmyk\""),
      "a.pbrt:1:1: error: unknown colour space \"cmyk\", expected \"srgb\", \"dci-p3\", \"rec2020\" or \"aces2065-1\"");
}

TEST(PbrtParser, ObjectsAndInstances) {
  const SceneDescription scene = World(R"(
    Scale 2 2 2
    ObjectInstance "late"
    ObjectBegin "pair"
      Translate 1 0 0 Shape "sphere"
      Material "conductor" Shape "disk"
    ObjectEnd
    ObjectBegin "late" ObjectEnd
    Translate 0 5 0
    ObjectInstance "pair"
    Shape "sphere")");
  ASSERT_EQ(scene.objects.size(), 2u);
  ASSERT_EQ(scene.objects[0].shapes.size(), 2u);
  EXPECT_EQ(scene.objects[0].name, "pair");
  // The transform at the definition is part of the shape's own, that at the instance goes before it.
  EXPECT_EQ(scene.objects[0].shapes[0].worldFromShape.Point({0, 0, 0}), Vec3d(2, 0, 0));
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.instances[0].object, 1);
  EXPECT_EQ(scene.instances[1].object, 0);
  EXPECT_EQ(scene.instances[1].worldFromInstance.Point({0, 0, 0}), Vec3d(0, 10, 0));
  EXPECT_EQ(scene.instances[1].location.ToString(), "a.pbrt:11:5");
  ASSERT_EQ(scene.shapes.size(), 1u);
  EXPECT_EQ(scene.shapes[0].worldFromShape.Point({0, 0, 0}), Vec3d(0, 10, 0));  // ObjectEnd restored the state
  EXPECT_EQ(scene.shapes[0].material, 0);
}

TEST(PbrtParser, ObjectsDefinedAgainServeTheInstancesBehind) {
  WarningList warnings;
  const SceneDescription scene = Parse(
      "WorldBegin ObjectBegin \"o\" ObjectEnd ObjectInstance \"o\"\nObjectBegin \"o\" ObjectEnd ObjectInstance \"o\"",
      warnings.diagnostics);
  EXPECT_EQ(scene.instances[0].object, 0);
  EXPECT_EQ(scene.instances[1].object, 1);
  EXPECT_EQ(warnings.lines.size(), 1u);
}

// Blocks and order.

TEST(PbrtParser, ErrorsOfOrder) {
  EXPECT_EQ(ErrorOf("\nShape \"sphere\""), "a.pbrt:2:1: error: Shape before WorldBegin, expected behind it");
  EXPECT_EQ(ErrorOf("WorldBegin\nFilm \"rgb\""),
            "a.pbrt:2:1: error: Film behind WorldBegin (a.pbrt:1:1), expected before it");
  EXPECT_EQ(ErrorOf("WorldBegin WorldBegin"),
            "a.pbrt:1:12: error: WorldBegin behind WorldBegin (a.pbrt:1:1), expected before it");
  for (const std::string word : {"AttributeBegin", "AttributeEnd", "TransformBegin", "TransformEnd", "ObjectBegin",
                                 "ObjectEnd", "ObjectInstance", "Material", "NamedMaterial", "Texture", "LightSource",
                                 "AreaLightSource", "ReverseOrientation", "WorldEnd", "Import"})
    EXPECT_EQ(ErrorOf(word), "a.pbrt:1:1: error: " + word + " before WorldBegin, expected behind it");
  for (const std::string word : {"Camera", "Sampler", "Integrator", "Accelerator", "PixelFilter", "TransformTimes"})
    EXPECT_EQ(ErrorOf("WorldBegin " + word),
              "a.pbrt:1:12: error: " + word + " behind WorldBegin (a.pbrt:1:1), expected before it");
}

TEST(PbrtParser, SomeStatementsStandOnBothSides) {
  const SceneDescription scene = Parse(R"(
    MakeNamedMaterial "m" "string type" "conductor" Attribute "shape" "float radius" 5 ColorSpace "srgb"
    WorldBegin NamedMaterial "m" Shape "sphere")");
  EXPECT_EQ(scene.materials.at(scene.shapes[0].material).name, "m");
  EXPECT_EQ(scene.shapes[0].params.GetFloat("radius", 0), 5);
}

TEST(PbrtParser, BlocksThatDoNotMatch) {
  EXPECT_EQ(ErrorOf("WorldBegin\n AttributeEnd"), "a.pbrt:2:2: error: AttributeEnd without AttributeBegin");
  EXPECT_EQ(ErrorOf("WorldBegin\n TransformEnd"), "a.pbrt:2:2: error: TransformEnd without TransformBegin");
  EXPECT_EQ(ErrorOf("WorldBegin\n ObjectEnd"), "a.pbrt:2:2: error: ObjectEnd without ObjectBegin");
  EXPECT_EQ(ErrorOf("WorldBegin AttributeBegin\nTransformEnd"),
            "a.pbrt:2:1: error: TransformEnd within the block of AttributeBegin at a.pbrt:1:12; expected AttributeEnd");
  EXPECT_EQ(ErrorOf("WorldBegin TransformBegin\nAttributeEnd"),
            "a.pbrt:2:1: error: AttributeEnd within the block of TransformBegin at a.pbrt:1:12; expected TransformEnd");
  EXPECT_EQ(ErrorOf("WorldBegin ObjectBegin \"o\"\nAttributeEnd"),
            "a.pbrt:2:1: error: AttributeEnd within the block of ObjectBegin at a.pbrt:1:12; expected ObjectEnd");
  EXPECT_EQ(ErrorOf("WorldBegin ObjectBegin \"o\" ObjectBegin \"p\""),
            "a.pbrt:1:28: error: ObjectBegin within the object \"o\" (a.pbrt:1:12), expected ObjectEnd first");
  EXPECT_EQ(ErrorOf("WorldBegin ObjectBegin \"o\" ObjectInstance \"o\""),
            "a.pbrt:1:28: error: ObjectInstance within an object, expected ObjectEnd first");
}

TEST(PbrtParser, BlocksAreNotNestedForEver) {
  const auto nested = [](int depth) {
    std::string text = "WorldBegin\n";
    for (int i = 0; i < depth; ++i) text += "AttributeBegin\n";
    return text;
  };
  EXPECT_EQ(ErrorOf(nested(10000)), "a.pbrt:10001:1: error: AttributeBegin without AttributeEnd");
  EXPECT_EQ(ErrorOf(nested(5000000)), "a.pbrt:10002:1: error: blocks are more than 10000 deep");
}

TEST(PbrtParser, OpenBlocksAtTheEnd) {
  EXPECT_EQ(ErrorOf("WorldBegin AttributeBegin\n AttributeBegin AttributeEnd", 4),
            "a.pbrt:1:12: error: AttributeBegin without AttributeEnd");
  EXPECT_EQ(ErrorOf("WorldBegin ObjectBegin \"o\"", 4), "a.pbrt:1:12: error: ObjectBegin without ObjectEnd");
  EXPECT_EQ(WarningsOf("WorldBegin AttributeBegin\n TransformBegin WorldEnd"),
            (std::vector<std::string>{"a.pbrt:1:12: warning: AttributeBegin without AttributeEnd",
                                      "a.pbrt:2:2: warning: TransformBegin without TransformEnd"}));
  EXPECT_EQ(ErrorOf("Camera \"perspective\""),
            "a.pbrt:1:1: error: the scene has no WorldBegin, expected one before its shapes and lights");
  EXPECT_EQ(ErrorOf(""), "a.pbrt: error: the scene has no WorldBegin, expected one before its shapes and lights");
  EXPECT_EQ(ErrorOf("\nWorldBegin", 3),
            "a.pbrt:2:1: error: WorldBegin without WorldEnd, which pbrt-v3 files have at their end");
}

TEST(PbrtParser, BehindWorldEndNothingIsRead) {
  WarningList warnings;
  const SceneDescription scene = Parse("WorldBegin\nWorldEnd # c\nFilm \"image\" [[[", warnings.diagnostics);
  EXPECT_FALSE(scene.film.IsGiven());
  EXPECT_EQ(warnings.lines, std::vector<std::string>{"a.pbrt:3:1: warning: what stands behind WorldEnd is not read"});
}

TEST(PbrtParser, TransformBlocksSaveTheTransformInVersion3AndAllInVersion4) {
  const std::string text = R"(WorldBegin
    TransformBegin Material "%" Translate 1 0 0 TransformEnd Shape "sphere" %%)";
  const auto with = [&](const std::string& material, const std::string& end) {
    std::string result = text;
    result.replace(result.find("%%"), 2, end);
    return result.replace(result.find('%'), 1, material);
  };
  const SceneDescription v3 = Parse(with("mirror", "WorldEnd"));
  EXPECT_EQ(v3.version, 3);
  EXPECT_TRUE(v3.shapes[0].worldFromShape.IsIdentity());
  EXPECT_EQ(v3.materials.at(v3.shapes[0].material).type, "mirror");
  const SceneDescription v4 = Parse(with("conductor", ""));
  EXPECT_EQ(v4.version, 4);
  EXPECT_TRUE(v4.shapes[0].worldFromShape.IsIdentity());
  EXPECT_EQ(v4.shapes[0].material, 0);
}

// Statements that are malformed.

TEST(PbrtParser, UnknownDirectives) {
  EXPECT_EQ(ErrorOf("Sacle 1 1 1"), "a.pbrt:1:1: error: unknown directive \"Sacle\"; did you mean \"Scale\"?");
  EXPECT_EQ(ErrorOf("attributebegin"),
            "a.pbrt:1:1: error: unknown directive \"attributebegin\"; did you mean \"AttributeBegin\"?");
  EXPECT_EQ(ErrorOf("Bananas"), "a.pbrt:1:1: error: unknown directive \"Bananas\"");
  EXPECT_EQ(ErrorOf("  12"), "a.pbrt:1:3: error: expected a directive, found the number \"12\"");
  EXPECT_EQ(ErrorOf("Identity \"float x\" 1"),
            "a.pbrt:1:10: error: expected a directive, found the string \"float x\"");
  EXPECT_EQ(ErrorOf("Scale 1 1 1 1"), "a.pbrt:1:13: error: expected a directive, found the number \"1\"");
  EXPECT_EQ(ErrorOf(std::string("\0\0", 2)), "a.pbrt:1:1: error: unknown directive \"\\x00\\x00\"");
}

TEST(PbrtParser, ArgumentsThatAreMissing) {
  EXPECT_EQ(ErrorOf("Translate 1 2 Scale"), "a.pbrt:1:15: error: Translate: expected 3 numbers, found \"Scale\"");
  EXPECT_EQ(ErrorOf("Rotate 1 2"), "a.pbrt:1:11: error: Rotate: expected 4 numbers, found the end of the file");
  EXPECT_EQ(ErrorOf("LookAt 1 2 3 \"x\""), "a.pbrt:1:14: error: LookAt: expected 9 numbers, found the string \"x\"");
  EXPECT_EQ(ErrorOf("Transform [1 0 0 0]"), "a.pbrt:1:19: error: Transform: expected 16 numbers, found \"]\"");
  EXPECT_EQ(ErrorOf("Scale [1 1 1 1]"),
            "a.pbrt:1:14: error: Scale: expected \"]\" behind 3 numbers, found the number \"1\"");
  EXPECT_EQ(ErrorOf("Film 3"), "a.pbrt:1:6: error: Film: expected the type of film in quotes, found the number \"3\"");
  EXPECT_EQ(ErrorOf("WorldBegin Texture \"t\""),
            "a.pbrt:1:23: error: Texture: expected \"float\" or \"spectrum\" in quotes, found the end of the file");
  EXPECT_EQ(ErrorOf("WorldBegin Texture \"t\" \"flaot\" \"x\""),
            "a.pbrt:1:12: error: texture \"t\" of \"flaot\", expected \"float\" or \"spectrum\"");
  EXPECT_EQ(ErrorOf("MakeNamedMaterial \"m\""),
            "a.pbrt:1:1: error: material \"m\" has no type, expected a parameter \"string type\"");
  EXPECT_EQ(ErrorOf("Attribute \"shapes\""),
            "a.pbrt:1:1: error: Attribute \"shapes\", expected \"shape\", \"light\", \"material\", \"medium\" or "
            "\"texture\"; did you mean \"shape\"?");
  EXPECT_EQ(ErrorOf("ActiveTransform Sometimes"),
            "a.pbrt:1:17: error: ActiveTransform: expected StartTime, EndTime or All, found \"Sometimes\"");
}

TEST(PbrtParser, NamesThatAreNotThere) {
  EXPECT_EQ(
      ErrorOf(
          "WorldBegin MakeNamedMaterial \"gold\" \"string type\" \"conductor\"\nNamedMaterial \"glod\" Shape \"disk\""),
      "a.pbrt:2:1: error: no material is named \"glod\"; did you mean \"gold\"?");
  EXPECT_EQ(ErrorOf("WorldBegin ObjectBegin \"tree\" ObjectEnd\nObjectInstance \"treee\""),
            "a.pbrt:2:1: error: no object is named \"treee\"; did you mean \"tree\"?");
}

TEST(PbrtParser, MediaGiveOneWarning) {
  EXPECT_EQ(
      WarningsOf("MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nWorldBegin\nMediumInterface \"fog\" \"\"\n"
                 "Shape \"sphere\""),
      std::vector<std::string>{
          "a.pbrt:1:1: warning: participating media are not supported; the scene is rendered without them"});
  EXPECT_TRUE(WarningsOf("MediumInterface \"\" \"\"\nMediumInterface \"\" WorldBegin").empty());
}

// Included files.

TEST(PbrtParser, IncludedFilesAreReadInPlace) {
  const TestFolder folder;
  folder.Write("geometry/ball.pbrt", "Shape \"sphere\" Translate 1 0 0 Include \"deep.pbrt.gz\"");
  folder.Write("geometry/deep.pbrt.gz", Gzip("Shape \"disk\" AttributeBegin"));
  folder.Write("geometry/main.pbrt", "not this one");
  const auto path =
      folder.Write("main.pbrt.gz", Gzip("WorldBegin Include \"geometry/ball.pbrt\" Shape \"cylinder\" AttributeEnd"));
  WarningList warnings;
  const SceneDescription scene = ParsePbrtFile(path, {}, warnings.diagnostics);
  ASSERT_EQ(scene.shapes.size(), 3u);
  EXPECT_EQ(scene.shapes[0].type, "sphere");
  EXPECT_EQ(scene.shapes[1].type, "disk");
  EXPECT_EQ(scene.shapes[1].location.ToString(), (folder.Path() / "geometry/deep.pbrt.gz").string() + ":1:1");
  EXPECT_EQ(scene.shapes[2].type, "cylinder");
  EXPECT_EQ(scene.shapes[2].worldFromShape.Point({0, 0, 0}), Vec3d(1, 0, 0));  // Include changes the state
  EXPECT_EQ(scene.file, path);
  EXPECT_EQ(scene.folder, folder.Path());
}

TEST(PbrtParser, ImportedFilesKeepTheirStateToThemselves) {
  const TestFolder folder;
  folder.Write(
      "part.pbrt",
      "Translate 1 0 0 Material \"mirror\" MakeNamedMaterial \"m\" \"string type\" \"conductor\" Shape \"sphere\"");
  WarningList warnings;
  const SceneDescription scene = ParsePbrtString(
      "WorldBegin Scale 2 2 2 Import \"part.pbrt\" Shape \"disk\" NamedMaterial \"m\" "
      "Shape \"cylinder\"",
      "a.pbrt", folder.Path(), {}, warnings.diagnostics);
  ASSERT_EQ(scene.shapes.size(), 3u);
  EXPECT_EQ(scene.shapes[0].worldFromShape.Point({0, 0, 0}), Vec3d(2, 0, 0));
  EXPECT_EQ(scene.shapes[1].worldFromShape.Point({0, 0, 0}), Vec3d(0, 0, 0));
  EXPECT_EQ(scene.shapes[1].material, 0);
  EXPECT_EQ(scene.materials.at(scene.shapes[2].material).type, "conductor");
  EXPECT_EQ(scene.version, 4);
}

TEST(PbrtParser, BlocksDoNotCrossTheBorderOfAnImport) {
  const TestFolder folder;
  const auto open = folder.Write("open.pbrt", "Identity\nAttributeBegin");
  const auto shut = folder.Write("shut.pbrt", "AttributeEnd");
  const auto parse = [&](const std::string& text) {
    WarningList warnings;
    return MessageOf([&] { ParsePbrtString(text, "a.pbrt", folder.Path(), {}, warnings.diagnostics); });
  };
  EXPECT_EQ(parse("WorldBegin Import \"open.pbrt\""),
            open.string() + ":2:1: error: AttributeBegin without AttributeEnd");
  EXPECT_EQ(
      parse("WorldBegin AttributeBegin Import \"shut.pbrt\""),
      shut.string() +
          ":1:1: error: AttributeEnd within the block of Import at a.pbrt:1:27; expected end of the imported file");
}

TEST(PbrtParser, IncludesThatFail) {
  const TestFolder folder;
  const auto parse = [&](const std::string& text) {
    WarningList warnings;
    return MessageOf([&] { ParsePbrtString(text, "a.pbrt", folder.Path(), {}, warnings.diagnostics); });
  };
  const std::string missing = (folder.Path() / "gone.pbrt").string();
  EXPECT_EQ(parse("\n Include \"gone.pbrt\""), "a.pbrt:2:2: error: no file \"" + missing + "\"");
  const auto loop = folder.Write("loop.pbrt", "\nInclude \"other.pbrt\"");
  const auto other = folder.Write("other.pbrt", "Include \"./loop.pbrt\"");
  const std::string named = (folder.Path() / "./loop.pbrt").string();
  EXPECT_EQ(parse("Include \"loop.pbrt\""), other.string() + ":1:1: error: " + named + " includes itself");
  for (int i = 0; i < 100; ++i)
    folder.Write("deep" + std::to_string(i) + ".pbrt", "Include \"deep" + std::to_string(i + 1) + ".pbrt\"");
  EXPECT_NE(parse("Include \"deep0.pbrt\"").find("error: files are included more than 64 deep"), std::string::npos);
  for (int i = 0; i < 60; ++i) {
    const std::string next = "Include \"twice" + std::to_string(i + 1) + ".pbrt\"\n";
    folder.Write("twice" + std::to_string(i) + ".pbrt", next + next);
  }
  folder.Write("twice60.pbrt", "");
  EXPECT_NE(parse("Include \"twice0.pbrt\"").find("error: more than 100000 files are included"), std::string::npos);
  EXPECT_NE(parse("Include \"" + std::string(5000, 'x') + "\"").find("error: no file"), std::string::npos);
  EXPECT_EQ(parse("Include x"), "a.pbrt:1:9: error: Include: expected a file name in quotes, found \"x\"");
  folder.Write("bad.pbrt", "\n\n   Oops");
  EXPECT_EQ(parse("Include \"bad.pbrt\""),
            (folder.Path() / "bad.pbrt").string() + ":3:4: error: unknown directive \"Oops\"");
}

TEST(PbrtParser, FileNamesResolveBesideTheSceneThenBesideTheFileThatNamesThem) {
  const TestFolder folder;
  folder.Write("both.spd", "");
  folder.Write("sub/both.spd", "");
  folder.Write("sub/own.spd", "");
  folder.Write("sub/part.pbrt", "LightSource \"point\"");
  const auto path = folder.Write("main.pbrt", "WorldBegin Include \"sub/part.pbrt\"");
  WarningList warnings;
  const SceneDescription scene = ParsePbrtFile(path, {}, warnings.diagnostics);
  const FileLocation& inPart = scene.lights[0].location;
  EXPECT_EQ(scene.ResolvePath("both.spd", inPart), folder.Path() / "both.spd");
  EXPECT_EQ(scene.ResolvePath("own.spd", inPart), folder.Path() / "sub/own.spd");
  EXPECT_EQ(scene.ResolvePath("none.spd", inPart), folder.Path() / "none.spd");
  EXPECT_EQ(scene.ResolvePath("/x/y.spd", inPart), "/x/y.spd");
}

TEST(PbrtParser, AMissingSceneIsAnError) {
  WarningList warnings;
  EXPECT_EQ(MessageOf([&] { ParsePbrtFile("/nowhere/a.pbrt", {}, warnings.diagnostics); }),
            "/nowhere/a.pbrt: error: no file \"/nowhere/a.pbrt\"");
}

// Any text.

TEST(PbrtParser, AnyOrderOfWordsEndsInASceneOrAnError) {
  const std::vector<std::string> words = {"WorldBegin",
                                          "WorldEnd",
                                          "AttributeBegin",
                                          "AttributeEnd",
                                          "TransformBegin",
                                          "TransformEnd",
                                          "ObjectBegin",
                                          "\"o\"",
                                          "ObjectEnd",
                                          "ObjectInstance",
                                          "Shape",
                                          "\"sphere\"",
                                          "Material",
                                          "NamedMaterial",
                                          "MakeNamedMaterial",
                                          "Texture",
                                          "\"float\"",
                                          "\"float radius\"",
                                          "\"string type\"",
                                          "\"texture alpha\"",
                                          "1",
                                          "-2.5",
                                          "[",
                                          "]",
                                          "true",
                                          "Scale",
                                          "0",
                                          "1e300",
                                          "Rotate",
                                          "Identity",
                                          "CoordinateSystem",
                                          "CoordSysTransform",
                                          "Attribute",
                                          "\"shape\"",
                                          "ColorSpace",
                                          "\"rec2020\"",
                                          "Include",
                                          "Import",
                                          "LookAt",
                                          "ActiveTransform",
                                          "EndTime",
                                          "Camera",
                                          "LightSource",
                                          "AreaLightSource",
                                          "MediumInterface",
                                          "\"\"",
                                          "ReverseOrientation"};
  unsigned state = 99;
  const auto next = [&](std::size_t bound) {
    state = state * 1664525u + 1013904223u;
    return (state >> 12) % bound;
  };
  int scenes = 0;
  for (int round = 0; round < 30000; ++round) {
    std::string text = round % 2 == 0 ? "WorldBegin " : "";
    for (std::size_t i = next(12); i > 0; --i) text += words[next(words.size())] + " ";
    WarningList warnings;
    try {
      const SceneDescription scene = Parse(text, warnings.diagnostics);
      ++scenes;
      for (const ShapeDescription& shape : scene.shapes) {
        ASSERT_GE(shape.material, 0);
        ASSERT_LT(static_cast<std::size_t>(shape.material), scene.materials.size());
      }
      for (const InstanceDescription& instance : scene.instances) {
        ASSERT_GE(instance.object, 0);
        ASSERT_LT(static_cast<std::size_t>(instance.object), scene.objects.size());
      }
    } catch (const Error&) {
    }
  }
  EXPECT_GT(scenes, 100);
}

TEST(PbrtParser, TheNearestColourSpaceIsNamed) {
  const std::string error = ErrorOf("ColorSpace \"rec202\"");
  EXPECT_NE(error.find("or \"aces2065-1\"; did you mean \"rec2020\"?"), std::string::npos) << error;
}

}  // namespace
}  // namespace dapple
