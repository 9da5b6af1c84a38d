// The transform statements, against matrices worked out by hand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "src/base/numerics.h"
#include "src/io/pbrt_parser.h"
#include "tests/io/reader_test_support.h"

namespace dapple {
namespace {

/// Transform of the first shape behind the statements.
Transform After(const std::string& statements) {
  WarningList warnings;
  const SceneDescription scene =
      ParsePbrtString("WorldBegin " + statements + " Shape \"sphere\"", "a.pbrt", "", {4}, warnings.diagnostics);
  EXPECT_TRUE(warnings.lines.empty()) << warnings.lines[0];
  return scene.shapes.at(0).worldFromShape;
}

SceneDescription Parse(const std::string& text, Diagnostics& diagnostics) {
  return ParsePbrtString(text, "a.pbrt", "", {4}, diagnostics);
}

void ExpectNear(const Vec3d& a, const Vec3d& b) { EXPECT_LT(Distance(a, b), 1e-12) << a << " is not " << b; }

TEST(PbrtTransform, StatementsMultiplyFromTheRight) {
  // The last statement acts on the shape first.
  ExpectNear(After("Translate 1 2 3 Scale 2 3 4").Point({1, 1, 1}), {3, 5, 7});
  ExpectNear(After("Scale 2 3 4 Translate 1 2 3").Point({1, 1, 1}), {4, 9, 16});
}

TEST(PbrtTransform, RotateTurnsCounterClockwise) {
  ExpectNear(After("Rotate 90 0 0 1").Point({1, 0, 0}), {0, 1, 0});
  ExpectNear(After("Rotate 90 1 0 0").Point({0, 1, 0}), {0, 0, 1});
  ExpectNear(After("Rotate 90 0 5 0").Point({0, 0, 1}), {1, 0, 0});
  ExpectNear(After("Rotate 120 1 1 1").Point({1, 0, 0}), {0, 1, 0});
  ExpectNear(After("Rotate 90 0 0 1e-300").Point({1, 0, 0}), {0, 1, 0});
  ExpectNear(After("Rotate 90 0 0 1e300").Point({1, 0, 0}), {0, 1, 0});
}

TEST(PbrtTransform, MatricesStandColumnByColumn) {
  const std::string matrix = "[1 2 3 0  4 5 6 0  7 8 10 0  11 12 13 1]";
  ExpectNear(After("Transform " + matrix).Point({0, 0, 0}), {11, 12, 13});
  ExpectNear(After("Transform " + matrix).Vector({1, 0, 0}), {1, 2, 3});
  ExpectNear(After("Scale 2 2 2 ConcatTransform " + matrix).Point({0, 1, 0}), {30, 34, 38});
  ExpectNear(After("Scale 2 2 2 Transform " + matrix).Point({0, 1, 0}), {15, 17, 19});
  ExpectNear(After("Transform 1 2 3 0  4 5 6 0  7 8 10 0  11 12 13 1").Point({0, 0, 0}), {11, 12, 13});
}

TEST(PbrtTransform, OfAMatrixTheLastNumberDividesTheOthers) {
  const Transform halved = After("Transform [2 0 0 0  0 4 0 0  0 0 6 0  8 10 12 2]");
  ExpectNear(halved.Point({1, 1, 1}), {5, 7, 9});
  ExpectNear(halved.Vector({1, 1, 1}), {1, 2, 3});
}

TEST(PbrtTransform, OfAProjectionTheAffinePartRemains) {
  for (const char* directive : {"Transform", "ConcatTransform"}) {
    WarningList warnings;
    const SceneDescription scene =
        Parse(fmt::format("WorldBegin\n{} [2 0 0 0.5  0 1 0 0  0 0 1 1  3 0 0 1] Shape \"sphere\"", directive),
              warnings.diagnostics);
    ASSERT_EQ(warnings.lines.size(), 1u);
    EXPECT_EQ(warnings.lines[0],
              "a.pbrt:2:1: warning: projections are not supported: the matrix's last row is 0.5 0 1 1, expected 0 0 0 "
              "1; its first three numbers are ignored");
    ExpectNear(scene.shapes.at(0).worldFromShape.Point({1, 1, 1}), {5, 1, 1});
  }
}

TEST(PbrtTransform, IdentityForgets) { EXPECT_TRUE(After("Translate 1 2 3 Identity").IsIdentity()); }

TEST(PbrtTransform, LookAtTakesTheWorldToTheCamera) {
  const Transform cameraFromWorld = After("LookAt 0 -3.9 1  0 0 1  0 0 1");
  ExpectNear(cameraFromWorld.Point({0, -3.9, 1}), {0, 0, 0});
  ExpectNear(cameraFromWorld.Point({0, 0, 1}), {0, 0, 3.9});
  ExpectNear(cameraFromWorld.Vector({0, 0, 1}), {0, 1, 0});
  ExpectNear(cameraFromWorld.Vector({1, 0, 0}), {-1, 0, 0});  // pbrt's camera x is up x view: a left-handed system
}

TEST(PbrtTransform, DoublePrecisionSurvivesFarFromTheOrigin) {
  ExpectNear(After("Translate 10000000.015625 0 0 Translate -10000000 0 0").Point({0, 0, 0}), {0.015625, 0, 0});
}

TEST(PbrtTransform, NamedCoordinateSystems) {
  ExpectNear(After("Translate 1 0 0 CoordinateSystem \"here\" Scale 5 5 5 CoordSysTransform \"here\"").Point({0, 0, 0}),
             {1, 0, 0});
  EXPECT_TRUE(After("Translate 1 0 0 CoordSysTransform \"world\"").IsIdentity());
  // Names outlive the block.
  ExpectNear(After("AttributeBegin Translate 1 0 0 CoordinateSystem \"here\" AttributeEnd CoordSysTransform \"here\"")
                 .Point({0, 0, 0}),
             {1, 0, 0});
}

TEST(PbrtTransform, TheCameraIsACoordinateSystem) {
  WarningList warnings;
  const SceneDescription scene = Parse(
      "LookAt 1 2 3  1 2 10  0 1 0 Camera \"perspective\" WorldBegin CoordSysTransform \"camera\" LightSource "
      "\"point\"",
      warnings.diagnostics);
  ExpectNear(scene.lights[0].worldFromLight.Point({0, 0, 0}), {1, 2, 3});
  ExpectNear(scene.camera.cameraFromWorld.Point({1, 2, 3}), {0, 0, 0});
}

TEST(PbrtTransform, WorldBeginForgetsTheCamerasTransform) {
  WarningList warnings;
  EXPECT_TRUE(
      Parse("Translate 1 2 3 WorldBegin Shape \"sphere\"", warnings.diagnostics).shapes[0].worldFromShape.IsIdentity());
}

TEST(PbrtTransform, UnknownCoordinateSystemsWarn) {
  WarningList warnings;
  const SceneDescription scene =
      Parse("WorldBegin Translate 1 0 0\nCoordSysTransform \"wrold\" Shape \"sphere\"", warnings.diagnostics);
  ExpectNear(scene.shapes[0].worldFromShape.Point({0, 0, 0}), {1, 0, 0});
  EXPECT_EQ(warnings.lines,
            std::vector<std::string>{"a.pbrt:2:1: warning: no coordinate system is named \"wrold\"; the "
                                     "transform stays; did you mean \"world\"?"});
}

TEST(PbrtTransform, MotionGivesOneWarningAndTheStartIsUsed) {
  WarningList warnings;
  const SceneDescription scene = Parse(R"(TransformTimes 0 1 WorldBegin
    AttributeBegin
    Translate 1 0 0
    ActiveTransform EndTime
    Translate 5 0 0
    Scale 2 2 2
    ActiveTransform All
    Translate 1 0 0
    Shape "sphere"
    ActiveTransform EndTime
    AttributeEnd
    Translate 0 1 0
    Shape "sphere")",
                                       warnings.diagnostics);
  ExpectNear(scene.shapes[0].worldFromShape.Point({0, 0, 0}), {2, 0, 0});
  ExpectNear(scene.shapes[1].worldFromShape.Point({0, 0, 0}), {0, 1, 0});  // which times are active is of the block
  EXPECT_EQ(warnings.lines,
            std::vector<std::string>{
                "a.pbrt:5:5: warning: motion is not supported; the transform at the start time is used"});
}

TEST(PbrtTransform, WithoutMovingStatementsThereIsNoMotion) {
  ExpectNear(After("ActiveTransform StartTime ActiveTransform All Translate 1 0 0").Point({0, 0, 0}), {1, 0, 0});
}

TEST(PbrtTransform, TransformsWithoutAnInverse) {
  const auto error = [](const std::string& text) {
    WarningList warnings;
    return MessageOf([&] { Parse(text, warnings.diagnostics); });
  };
  EXPECT_EQ(error("\nRotate 30 0 0 0"),
            "a.pbrt:2:1: error: Rotate around the axis 0 0 0, expected an axis of some length");
  const std::string noView =
      "a.pbrt:1:1: error: LookAt gives no view: expected a target away from the eye, and an up vector across the view";
  EXPECT_EQ(error("LookAt 1 2 3  1 2 3  0 1 0"), noView);
  EXPECT_EQ(error("LookAt 0 0 0  0 0 1  0 0 2"), noView);
  EXPECT_EQ(error("LookAt 0 0 0  0 0 1  0 0 0"), noView);
  EXPECT_EQ(error("Scale 0 1 1\nCamera \"perspective\""), "a.pbrt:2:1: error: the camera's transform has no inverse");
  EXPECT_EQ(error("Scale 1e300 1 1\nScale 1e300 1 1"),
            "a.pbrt:2:1: error: the transform is beyond the range of double");
}

TEST(PbrtTransform, WhatHasNoExtentIsLeftOutWithAWarning) {
  WarningList warnings;
  const SceneDescription scene = Parse(
      "WorldBegin Scale 0 0 0\nShape \"sphere\"\nLightSource \"point\"\nObjectInstance \"none\"", warnings.diagnostics);
  EXPECT_TRUE(scene.shapes.empty());
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_EQ(warnings.lines,
            (std::vector<std::string>{"a.pbrt:2:1: warning: the shape is left out: its transform has no inverse",
                                      "a.pbrt:3:1: warning: the light is left out: its transform has no inverse",
                                      "a.pbrt:4:1: warning: the instance is left out: its transform has no inverse"}));
}

TEST(PbrtTransform, AScaleOfZeroThatIsNotUsedHarmsNothing) {
  EXPECT_TRUE(After("AttributeBegin Scale 0 0 0 AttributeEnd").IsIdentity());
}

}  // namespace
}  // namespace dapple
