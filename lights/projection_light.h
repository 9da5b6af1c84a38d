// A projection light: a point light that throws an image, as a slide projector does.
//
// pbrt: `LightSource "projection"`, at the origin of its space, looking along +z. Colours of the image are intensities:
// the image on a wall across the axis falls off by cos^3 toward its corners (and with the squared distance).
//
// | parameter | version | meaning | default |
// |---|---|---|---|
// | "I" | 3 | colour of the intensity, W / sr, by which the image is multiplied | 1 |
// | "scale" | 3: colour, 4: number | another factor | 1 |
// | "fov" | 3, 4 | the angle that the shorter side of the image covers, degrees | 3: 45, 4: 90 |
// | "mapname" | 3 | image, its left is -x, its top is -y (pbrt-v3 throws it upside down) | white square |
// | "filename" | 4 | image, its left is -x, its top is +y | - |
// | "power" | 4 | the flux (by luminance) of all of the image; replaces the image's own | - |
//
// The image is looked up bilinearly, as pbrt-v3 does, with its edge pixels continued to its edges; the nearest pixel of
// pbrt-v4 would draw the pixels as squares on the wall and give the emission's density a jump at each.
#pragma once

#include <vector>

#include "lights/image_point_light.h"
#include "src/image/image.h"
#include "src/sampling/distribution.h"

namespace dapple {

/// Intensity in a direction with the density at which that direction is drawn.
struct ProjectionValue {
  Color L;         ///< intensity, W / sr; black beside the image
  double pdf = 0;  ///< per solid angle
};

/// An image on the plane z = 1 as seen from the origin, its left at -x and its top at +y; directions are drawn by it.
///
/// A patch of the plane in the direction w covers the solid angle cos^3 theta times its area. So rays of equal flux
/// have the density image times cos^3 on the plane. It is drawn from its piecewise bilinear interpolant: the plane is
/// cut where the lookup changes its formula (lines through the pixels' centres) and where cos^3 bends (at equal steps
/// of asinh, small enough that the interpolant is within 1 %). The density per solid angle is that of the interpolant,
/// exactly, over cos^3.
class ProjectionMap {
 public:
  /// `image` has at least one pixel, its colours are finite and not negative; they are multiplied by `scale`, and cut
  /// where they leave the range of float. `fovDegrees` in [kNarrowestFov, 180), of the image's shorter side; throws
  /// `Error` for others.
  ProjectionMap(const Image& image, double fovDegrees, const Color& scale);

  /// Narrower ones are not resolved by float directions.
  static constexpr double kNarrowestFov = 1e-4;

  /// No intensity anywhere: nothing can be drawn.
  bool IsBlack() const { return table_.IsZero(); }
  /// Intensity; `w` of any length but zero.
  Color Radiance(const Vec3d& w) const;
  /// Intensity and density in one lookup.
  ProjectionValue Evaluate(const Vec3d& w) const;
  /// A unit direction; its density is `Evaluate`'s. The map must not be black.
  Vec3d Sample(const Vec2d& u) const;
  /// The random numbers with which `Sample` gives the direction `w`, which meets the image. The map must not be black.
  Vec2d Invert(const Vec3d& w) const;
  /// The integral of the intensity over all directions (of the lookup, to 1e-9 of it).
  Color Integral() const { return integral_; }
  /// None where the map is black.
  TableUse Tables() const;

 private:
  /// A point of the plane as a cell and a place in it.
  struct Place {
    Vec2i cell;
    Vec2d s;
  };

  /// Where `w` meets the plane, y downward as in the image; nothing beside the image.
  std::optional<Vec2d> OnPlane(const Vec3d& w) const;
  Place PlaceOf(const Vec2d& p) const;
  Color ColorAt(const Vec2d& p) const;
  void FillTexels(const Image& image, const Color& scale);
  void BuildTable();
  Vec2d CornerOf(int column, int row) const {
    return {columns_[static_cast<size_t>(column)], rows_[static_cast<size_t>(row)]};
  }
  Vec2d CellSize(const Vec2i& cell) const { return CornerOf(cell.x + 1, cell.y + 1) - CornerOf(cell.x, cell.y); }
  /// Importance times cos^3 at the four corners of a cell: (0,0), (1,0), (0,1), (1,1).
  void Weights(const Vec2i& cell, double (&w)[4]) const;
  /// The integral of the lookup over the solid angle of a cell.
  Vec3d CellIntegral(const Vec2i& cell) const;

  int width_, height_;                  // of the image
  Vec2d extent_;                        // half of its size on the plane
  std::vector<Color> texels_;           // scaled
  std::vector<double> columns_, rows_;  // borders of the cells on the plane
  Distribution2D table_;
  Color integral_;
};

class ProjectionLight final : public ImagePointLight<ProjectionMap> {
 public:
  /// `mapToRender` turns the map's space to render space; `image`, `fovDegrees` and `scale` as `ProjectionMap` takes
  /// them.
  ProjectionLight(const Vec3& position, const Transform& mapToRender, const Image& image, double fovDegrees,
                  const Color& scale)
      : ImagePointLight(position, mapToRender, ProjectionMap(image, fovDegrees, scale)) {}

  std::string_view Name() const override { return "projection"; }
};

}  // namespace dapple
