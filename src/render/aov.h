// What denoisers and compositing want beside the radiance (arbitrary output variables): what the camera's own rays meet
// first, and how noisy each pixel is.
//
// First hits are found by rays of their own, one a pixel and pass, so every integrator has them, and none is changed by
// them. An integrator whose passes have one camera path a pixel looks through the same rays. Their sums lie in the film
// (`Film::AddExtras`), exact as all of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "integrators/integrator.h"
#include "src/image/film.h"
#include "src/scene/scene.h"

namespace dapple {

/// Which layers a picture has beside its own. Means are over a pixel's samples with equal weights: a filter's negative
/// lobes, good for radiance, would give depths that lie nowhere.
struct AovSet {
  bool albedo = false;    ///< albedo.R, G, B: `Bsdf::Albedo`, reflectance and transmittance; 0 where nothing is
  bool normal = false;    ///< N.X, Y, Z: the shading normal toward the viewer, in the file's world; 0 where nothing is
  bool depth = false;     ///< Z: `Camera::Depth`; of what is there, +infinity where nothing is
  bool position = false;  ///< P.X, Y, Z: in the file's world; of what is there, 0 where nothing is
  bool variance = false;  ///< variance.R, G, B: of the pixel's mean, from the half-images: (h0 - h1)^2 n0 n1 / n^2

  bool IsEmpty() const { return *this == AovSet(); }
  friend bool operator==(const AovSet&, const AovSet&) = default;
};

/// The layers that a text names, as in "albedo,normal", in any order; "none" are none. Nothing where a name is unknown.
std::optional<AovSet> ParseAovs(const std::string& text);
/// The same text for the same set, which `ParseAovs` reads.
std::string ToString(const AovSet& aovs);

/// The extra channels of a film that has these layers.
std::vector<std::string> FilmChannels(const AovSet& aovs);

/// Adds what the camera's rays of this pass meet first to the film's extra channels, which `FilmChannels` named.
PassStats RecordFirstHits(const Scene& scene, uint64_t seed, int pass, Film& film);

/// The mean of the film's passes, times the exposure (of `RenderSettings`), with these layers behind it by the names
/// above.
Image ToPicture(const Film& film, float exposure, const AovSet& aovs = {});

}  // namespace dapple
