// Guided emission: what a pilot learned of which emitted photons come to something, as a bend of the unit cube of
// random numbers from which all emission is drawn.
//
// Each light has a share of the photons and, unless hundreds of others are of more use, two tables: over the two random
// numbers of its origins and over those of its directions. A tenth of each table is spread evenly, a tenth of the
// lights' shares goes by power, and a tenth of a light's photons ignore its tables, so that what the pilot missed is
// still found, and no photon weighs more than 100 times what it would without a guide (10 by the choice of its light,
// 10 by the tables).
//
// The bend happens before the light turns the cube into a ray, so the density of what is drawn is exact whatever was
// learned. Asked of a ray, which is rounded to float, it may be that of the neighbour where the ray lies on the border
// of two cells.
#pragma once

#include <span>
#include <vector>

#include "lights/light.h"
#include "src/photons/pilot_use.h"
#include "src/sampling/distribution.h"

namespace dapple {

/// One emitted photon of a pilot.
struct PilotPhoton {
  int light = -1;
  Vec2d position{0, 0}, direction{0, 0};  ///< the light's own random numbers
  bool deltaPos = false, deltaDir = false;
  double weight = 0;  ///< how often it was of use, over the density with which the cube was drawn
  int rays = 0;       ///< that it took
};

class EmissionGuide {
 public:
  /// Bends nothing; lights are chosen by power.
  EmissionGuide() = default;
  /// `power`: of each light, not negative. `pilot` holds all photons of the pilot, useful or not; `cameraRays` is what
  /// else it traced.
  EmissionGuide(std::span<const double> power, std::span<const PilotPhoton> pilot, int64_t cameraRays = 0);

  bool IsEmpty() const { return lights_.empty(); }

  /// Which light, by what was learned, with its discrete probability; `u` in [0, 1) is left over. Only where not empty.
  DiscreteSample PickLight(double u) const { return byUse_.SampleDiscrete(u); }
  double LightProbability(int light) const { return byUse_.Probability(light); }
  double InvertLight(int light, double u) const { return byUse_.InvertDiscrete(light, u); }

  /// A light's own random numbers, and the density in the unit cube of position and direction with which they are
  /// drawn: 1 is even.
  struct Bent {
    LeRandom own;
    double pdf = 1;
  };
  /// Whether it has tables: else `Bend` changes nothing but `part`.
  bool Bends(int light) const;
  /// Bends the random numbers of a light: `u.part` decides whether the tables are followed, and is used up to there.
  Bent Bend(int light, const LeRandom& u) const;
  /// The density of `Bent` with which `Bend` gives them.
  double Pdf(int light, const LeRandom& own) const;
  /// Random numbers that `Bend` turns into `own`: of the two that do, those that follow the tables.
  LeRandom Unbend(int light, const LeRandom& own) const;

  int64_t MemoryBytes() const;
  /// What a guide of so many lights takes at most; while it learns it takes as much again.
  static int64_t MostMemoryBytes(int64_t lights);
  /// Of the pilot that taught it; none without one.
  const PilotUse& Pilot() const { return pilot_; }

 private:
  struct LightTables {
    Distribution2D position, direction;  // without cells: even
  };

  std::vector<LightTables> lights_;
  Distribution1D byUse_;
  PilotUse pilot_;
};

}  // namespace dapple
