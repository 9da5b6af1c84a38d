// Cameras, both sides: rays that leave the lens for a film position, and importance that a point in the scene receives.
//
// Film positions are continuous pixel coordinates: pixel (x, y) covers [x, x+1) x [y, y+1), y grows downward.
// Importance `We` is normalised so that one unit of it over a pixel's footprint measures what `GenerateRay` measures:
// the value of the pixel is the integral of We L over lens area and projected solid angle, for a box filter of one
// pixel.
#pragma once

#include <array>
#include <optional>

#include "src/base/color.h"
#include "src/geometry/interaction.h"
#include "src/geometry/ray.h"

namespace dapple {

/// A ray that leaves the camera.
struct CameraRay {
  Ray ray;
  /// Footprint of one pixel's step: the width, at distance t along the ray, is about footprintAtLens + t *
  /// footprintSpread.
  float footprintAtLens = 0;
  float footprintSpread = 0;
};

/// How a point in the scene is joined to the camera.
struct WiSample {
  Vec2 film;       ///< where on the film its light lands; may lie outside the image
  float We = 0;    ///< importance per pixel, see above
  Vec3 wi;         ///< unit direction from the point to the lens
  Vec3 lens;       ///< the point on the lens
  double pdf = 0;  ///< per solid angle at the point; 1 for a pinhole (discrete), see `isDelta`
  bool isDelta = false;
};

/// The densities of a ray that leaves the camera.
struct WePdf {
  double position = 0;   ///< per lens area; 1 for a pinhole (discrete)
  double direction = 0;  ///< per solid angle, for film positions drawn uniformly over the whole image; 1 where discrete
};

/// No filter reaches farther (Filter's radii are at most 64 pixels), so no point that lands farther out is joined.
inline constexpr float kFilmMargin = 64;

/// Immutable and shared by all threads; made for one image resolution.
class Camera {
 public:
  virtual ~Camera() = default;

  /// The ray through a film position; `uLens` in [0,1)^2 draws the point on the lens, `uTime` the moment.
  virtual CameraRay GenerateRay(const Vec2& film, const Vec2d& uLens, double uTime) const = 0;

  /// Joins `p` to the lens. The contribution of a light path to the film at `film` is throughput * We / pdf (spread by
  /// the filter), where throughput ends with the surface's Eval toward wi. Nothing where the camera cannot see `p`.
  virtual std::optional<WiSample> Sample_Wi(const Vec3& p, const Vec2d& uLens) const = 0;
  /// Positions around the picture whose rays go the same way as that of `film` within it; returns how many. Near the
  /// border a filter reaches over to them, so light that lands on `film` lands there too.
  static constexpr int kMostRepeats = 8;
  virtual int FilmRepeats(const Vec2& /*film*/, std::array<Vec2, kMostRepeats>* /*repeats*/) const { return 0; }

  /// Importance carried along a ray that leaves the lens, and its film position; zero outside the image.
  virtual float We(const Ray& ray, Vec2* film) const = 0;
  /// The densities with which `GenerateRay` draws the ray for uniform film positions over the image.
  virtual WePdf Pdf_We(const Ray& ray) const = 0;

  /// Where the camera stands (render space).
  virtual Vec3 Position() const = 0;

  /// How deep a point (render space) lies in the picture, in units of camera space: its z there, along the view. Of
  /// cameras that look all around: its distance.
  virtual float Depth(const Vec3& p) const = 0;
};

}  // namespace dapple
