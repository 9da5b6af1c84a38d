#include "integrators/non_finite.h"

#include <algorithm>

#include <fmt/format.h>

namespace dapple {

NonFiniteSource NonFiniteSource::MaterialAt(const Scene& scene, const SurfaceInteraction& hit) {
  return Material(scene.Primitives()[static_cast<size_t>(hit.shape)].material);
}

std::string NameOf(const NonFiniteSource& source, const Scene& scene) {
  switch (source.kind) {
    case NonFiniteSource::Kind::Light:
      return fmt::format("light {} ({})", source.index, scene.Lights()[static_cast<size_t>(source.index)]->Name());
    case NonFiniteSource::Kind::Material: {
      // A name in a scene's file may hold anything.
      std::string name = "material " + scene.MaterialName(source.index);
      std::replace_if(
          name.begin(), name.end(), [](unsigned char c) { return c < ' '; }, ' ');
      return name;
    }
    case NonFiniteSource::Kind::Integrator:
      break;
  }
  return "the integrator";
}

NonFiniteCounts& NonFiniteCounts::operator+=(const NonFiniteCounts& other) {
  for (const auto& [source, count] : other.counts_) Add(source, count);
  return *this;
}

int64_t NonFiniteCounts::Total() const {
  int64_t total = 0;
  for (const auto& [source, count] : counts_) total += count;
  return total;
}

}  // namespace dapple
