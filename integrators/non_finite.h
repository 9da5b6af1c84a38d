// Values that are infinite or no numbers: left out of the picture, and counted where they arose.
//
// Walks ask `Finite` of each contribution before they add it. Only where one is not finite is its cause looked for.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "src/scene/scene.h"

namespace dapple {

/// What gave a value that is not finite.
struct NonFiniteSource {
  enum class Kind {
    Light,       ///< its radiance, or the density of its samples
    Material,    ///< the value or the sample of its BSDF
    Integrator,  ///< weights and sums of values that were finite
  };
  Kind kind = Kind::Integrator;
  int index = 0;  ///< of the light in `Scene::Lights()`, of the material in the scene's

  static NonFiniteSource Light(int index) { return {Kind::Light, index}; }
  static NonFiniteSource Material(int index) { return {Kind::Material, index}; }
  /// The material of the surface at `hit`.
  static NonFiniteSource MaterialAt(const Scene& scene, const SurfaceInteraction& hit);
  static NonFiniteSource Integrator() { return {}; }
  auto operator<=>(const NonFiniteSource&) const = default;
};

/// "light 2 (point)", as `dapple info` numbers lights; "material \"glass\" (scene.pbrt:12:1)"; "the integrator". One
/// line.
std::string NameOf(const NonFiniteSource& source, const Scene& scene);

/// How many contributions were left out, by what gave them.
class NonFiniteCounts {
 public:
  void Add(const NonFiniteSource& source, int64_t count = 1) { counts_[source] += count; }
  NonFiniteCounts& operator+=(const NonFiniteCounts& other);
  int64_t Total() const;
  const std::map<NonFiniteSource, int64_t>& BySource() const { return counts_; }

 private:
  std::map<NonFiniteSource, int64_t> counts_;
};

/// `value`, or black where it is not finite, which is then counted for `findSource()`.
template <typename FindSource>
Color Finite(const Color& value, NonFiniteCounts* counts, FindSource&& findSource) {
  if (value.IsFinite()) [[likely]]
    return value;
  counts->Add(findSource());
  return Color();
}

/// The source of light scattered at `hit` from a way where `scatter()`, the BSDF's part alone, may be the cause.
template <typename Scatter>
NonFiniteSource SourceAt(const Scene& scene, const SurfaceInteraction& hit, Scatter&& scatter) {
  return scatter().IsFinite() ? NonFiniteSource::Integrator() : NonFiniteSource::MaterialAt(scene, hit);
}

}  // namespace dapple
