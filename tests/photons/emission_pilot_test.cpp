// What the pilot of guided emission learns of each light: how much of what it sends comes to something.
#include "src/photons/emission_pilot.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

using testing_support::SceneFromText;

std::string Lamp(double radiance, const std::string& center) {
  return fmt::format(
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [{0} {0} {0}] Material \"matte\" \"rgb Kd\" [0 0 0] "
      "Translate {1} Shape \"sphere\" \"float radius\" [0.1] AttributeEnd ",
      radiance, center);
}

/// The learned shares of the lights of a room with walls as thin as sheets, a camera and a lamp in it, above a floor
/// that another lamp lights from outside, which is `brighter` times as bright.
std::vector<double> SharesOfLamps(double brighter) {
  const auto scene = SceneFromText(
      "LookAt 0 -0.9 0  0 1 0  0 0 1 Camera \"perspective\" \"float fov\" [60] "
      "Film \"image\" \"integer xresolution\" [64] \"integer yresolution\" [64] WorldBegin " +
      Lamp(1, "0 0 0.5") + Lamp(brighter, "0 3 0") +
      "Material \"matte\" \"rgb Kd\" [.7 .7 .7] "
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-9 -9 -2 9 -9 -2 9 9 -2 -9 9 -2] "
      "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  1 6 2 1 5 6  2 3 7 2 7 6  3 "
      "0 4 3 4 7] "
      "\"point P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1  -1 -1 1 1 -1 1 1 1 1 -1 1 1] WorldEnd");
  const EmissionGuide guide = LearnEmissionGuide(*scene, 8, 0, 1);
  EXPECT_FALSE(guide.IsEmpty());
  return {guide.LightProbability(0), guide.LightProbability(1)};
}

TEST(EmissionPilot, ALightBehindAWallKeepsATenthOfItsShareByPower) {
  for (const double brighter : {1., 9., 99.}) {
    const std::vector<double> shares = SharesOfLamps(brighter);
    EXPECT_NEAR(shares[1], 0.1 * brighter / (1 + brighter), 1e-9) << brighter;
    EXPECT_NEAR(shares[0] + shares[1], 1, 1e-9) << brighter;
  }
}

}  // namespace
}  // namespace dapple
