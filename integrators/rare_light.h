// What part of a picture's light do paths from the camera find seldom, and would photons find it better? A pilot.
//
// Camera paths of a grid over the picture tell how bright and how noisy it is by path tracing. Light paths tell what
// arrives at the surfaces that those see; and of each, the densities of all ways in which path tracing could have found
// it are known, by the weights that join path tracing and photons (merging_weights.h). A light path that carries the
// share c of a place's radiance, at the density p over that of a photon there, would bring a camera path c / p when it
// is found: far more than the place's radiance where it is found seldom. Its second moment, c^2 / p, is the noise that
// it makes; with photons gathered too it is c^2 / (p + eta). So the noise of paths is known of light that none of them
// has found; and where p is zero, none ever will.
#pragma once

#include <cstdint>

#include "integrators/integrator.h"

namespace dapple {

struct RareLight {
  double share = 0;      ///< of the light that the camera sees, what paths find seldom; in [0, 1]
  double lostShare = 0;  ///< of the same, what no path could find: that of a point through smooth glass, say
  // Relative variances of a pixel by one camera path each, in the mean over the picture.
  double noise = 0;        ///< by path tracing, of all light that paths find well
  double rareNoise = 0;    ///< by path tracing, of the rest
  double photonNoise = 0;  ///< of the rest, where photons of a pass are gathered too

  PilotUse pilot;  ///< that found out

  /// By how much photons lower the variance of a picture of as many passes: from 1 to `kMostGain`.
  double Gain() const;
  static constexpr double kMostGain = 1e6;
};

/// Traces `kRareLightPaths` light paths and as many camera paths, whatever the picture's size. The result depends on
/// scene, options and seed alone. The scene emits light.
RareLight FindRareLight(const Scene& scene, const IntegratorOptions& options, uint64_t seed);

inline constexpr int kRareLightPaths = 1 << 14;

}  // namespace dapple
