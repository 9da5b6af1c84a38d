// What an environment image is like: how bright, how uneven, where its light comes from.
#pragma once

#include <optional>

#include "lights/environment_map.h"

namespace dapple {

/// Of the pixels as they are in the file (not of the lookup between them); luminance decides what is bright. Shares are
/// of the solid angle of the sphere unless said otherwise, in [0, 1].
struct EnvironmentStatistics {
  Color least, greatest;      ///< of each component
  Color mean;                 ///< over the sphere
  double leastLuminance = 0;  ///< above 0; 0 where all is black
  double greatestLuminance = 0;
  Vec2i brightestPixel{0, 0};
  Vec3d brightestDirection{0, 0, 1};  ///< of its middle, in the map's space
  double blackShare = 0;
  /// What the brightest hundredth of the sphere contributes to the integral of the luminance L.
  double lightOfBrightestHundredth = 0;
  /// (integral of L)^2 / (4 pi integral of L^2): the share of the sphere from which light of even radiance would be as
  /// concentrated; 1 for an even map.
  double effectiveShare = 0;
};

/// The solid angle of a pixel in row `y`.
double EnvironmentPixelSolidAngle(EnvironmentMapping mapping, int width, int height, int y);

/// `image` as `EnvironmentMap` takes it.
EnvironmentStatistics MeasureEnvironment(const Image& image, EnvironmentMapping mapping);

}  // namespace dapple
