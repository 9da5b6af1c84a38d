// What a scene file says about how it is rendered; the command line may say otherwise.
#pragma once

#include <optional>
#include <string>

#include "src/base/error.h"
#include "src/base/vec.h"
#include "src/image/film.h"
#include "src/image/filter.h"

namespace dapple {

/// Plain values; what is absent in the file has its default here, or is absent here too.
struct RenderSettings {
  // Film.
  Vec2i resolution{1280, 720};
  FileLocation resolutionLocation;  ///< where the file says so; no file: it does not
  PixelBounds crop;                 ///< in pixels
  Filter filter = Filter::Box();
  /// Factor of the image's values before it is written (pbrt-v3's film scale; v4's exposuretime * iso / 100).
  float exposure = 1;
  std::string outputFile;  ///< as the scene names it; may be empty

  // Integrator; absent: the integrator's own default.
  std::string integrator;              ///< as the scene names it; may be one that Dapple lacks
  FileLocation integratorLocation;     ///< where it does
  std::optional<int> samplesPerPixel;  ///< pbrt's sampler
  std::optional<int> iterations;       ///< sppm passes
  std::optional<int> maxDepth;         ///< scattering events on a path
  std::optional<int> photonsPerIteration;
  std::optional<double> radius;  ///< starting radius in scene units
  std::optional<int> seed;
};

}  // namespace dapple
