// Guided emission: what a pilot learned of which emitted photons come to something, as a bend of the unit cube of
// random numbers from which all emission is drawn.
//
// Each light keeps two tables, over the two random numbers of its origins and over those of its directions, and a share
// of the photons. A tenth of each is spread evenly, so that what the pilot missed is still found. The tables bend the
// cube before the light turns it into a ray, so densities and inverses stay exact whatever was learned.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "lights/light.h"
#include "src/sampling/distribution.h"

namespace dapple {

/// One emitted photon of a pilot.
struct PilotPhoton {
  int light = -1;
  Vec2d position{0, 0}, direction{0, 0};  ///< the light's own random numbers
  bool deltaPos = false, deltaDir = false;
  double weight = 0;  ///< 1 / (density with which the cube was drawn), for photons that came to something; 0 for others
};

class EmissionGuide {
 public:
  /// Bends nothing; lights are chosen by power.
  EmissionGuide() = default;
  /// `power`: of each light, not negative. `pilot` holds all photons of the pilot, useful or not.
  EmissionGuide(std::span<const double> power, std::span<const PilotPhoton> pilot);

  bool IsEmpty() const { return lights_.empty(); }

  /// Which light, by what was learned; `u` is left over. Only where not empty.
  DiscreteSample PickLight(double u) const { return byUse_.SampleDiscrete(u); }
  double LightProbability(int light) const { return byUse_.Probability(light); }
  double InvertLight(int light, double u) const { return byUse_.InvertDiscrete(light, u); }

  /// The bent random numbers of a light's origin and direction, and the densities with which they are drawn.
  struct Bent {
    Vec2d position{0, 0}, direction{0, 0};
    double pdfPosition = 1, pdfDirection = 1;
  };
  Bent Bend(int light, const Vec2d& position, const Vec2d& direction) const;
  /// The densities, and the numbers before bending, of a light's own numbers.
  Bent Unbend(int light, const Vec2d& position, const Vec2d& direction) const;

  int64_t MemoryBytes() const;

 private:
  struct LightTables {
    Distribution2D position, direction;  // without cells: even
  };

  std::vector<LightTables> lights_;
  Distribution1D byUse_;
};

}  // namespace dapple
