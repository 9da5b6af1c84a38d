// How next-event estimation draws directions toward an environment: strategies, each with its density and inverse.
//
// pbrt: `"string sampling"` of `LightSource "infinite"`, an extension of Dapple's.
//   "uniform"      evenly over the sphere
//   "cosine"       by the cosine at the receiver: its upper hemisphere, or both where light passes through
//   "importance"   by radiance, from the map's own table, which emission uses too; the default
//   "irradiance"   by radiance times the cosine at the receiver
//   "compensated"  by radiance less about its mean, where positive: what BSDF sampling finds well is left to it
//   "structured"   by strata of radiance and solid angle, so that dim wide parts get more than their share
//   "product"      by radiance times what the receiver scatters of it
// `docs/environment.md` compares them.
#pragma once

#include <memory>

#include "lights/environment_map.h"
#include "lights/light.h"
#include "lights/light_frame.h"

namespace dapple {

enum class EnvironmentSampling { Uniform, Cosine, Importance, Irradiance, Compensated, Structured, Product };

/// Directions are unit vectors in render space; densities are per solid angle.
class EnvironmentStrategy {
 public:
  virtual ~EnvironmentStrategy() = default;

  /// A direction; its density, as it is rounded, is `Pdf`'s.
  virtual Vec3 Sample(const LightContext& at, const LiRandom& u) const = 0;
  /// `place` is that of `wi` in the map.
  virtual double Pdf(const LightContext& at, const Vec3& wi, const EnvironmentPlace& place) const = 0;
  /// The random numbers with which `Sample` gives `wi`.
  virtual LiRandom Invert(const LightContext& at, const Vec3& wi) const = 0;

  /// As of `Light`.
  virtual void PrepareChoice(double /*probability*/) {}

  /// Beside those of the map.
  virtual TableUse Tables() const { return {}; }

  /// As of `Light`.
  virtual bool WantsReceiver() const { return false; }
  virtual std::shared_ptr<const ReceiverTable> PrepareReceiver(const Bsdf& /*bsdf*/, const Vec3& /*wo*/) const {
    return nullptr;
  }
};

/// A light, its map (not black) and how that is turned; all must outlive the strategies.
struct EnvironmentSpace {
  const Light* light;
  const EnvironmentMap& map;
  const LightFrame& frame;

  // By a table of the map's cells; strategies that have nothing better to go by take the map's own, `map.Density()`.
  Vec3 Sample(const EnvironmentDensity& density, const LiRandom& u) const {
    return frame.ToRender(map.Sample(density, u.direction));
  }
  double Pdf(const EnvironmentDensity& density, const EnvironmentPlace& place) const {
    return map.DensityAt(density, place);
  }
  LiRandom Invert(const EnvironmentDensity& density, const Vec3& wi) const {
    LiRandom u;
    u.direction = map.Invert(density, frame.ToLight(wi));
    return u;
  }
};

/// Null for `Importance`, which is the map's own.
std::unique_ptr<EnvironmentStrategy> MakeStrategy(EnvironmentSampling sampling, const EnvironmentSpace& space);

}  // namespace dapple
