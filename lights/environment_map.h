// An image around the scene: radiance by direction, and directions drawn by it. In the map's own space.
//
// The lookup is bilinear between texel centres. The square is cut where that lookup changes its formula: at the lines
// through the texel centres (and at the square's edges). So in each of the (width + 1) x (height + 1) cells the
// radiance is a bilinear function of its four corners, and directions are drawn from the bilinear function with the
// largest components of the same corners. The density is thus positive exactly where the radiance is, and close to it
// in shape: for an equal-area gray map in proportion to it; for LatLong the radiance is linear in theta within a cell
// and the density in cos theta, which differ noticeably in the cells at the poles only.
#pragma once

#include <vector>

#include "src/base/color.h"
#include "src/image/image.h"
#include "src/sampling/distribution.h"

namespace dapple {

enum class EnvironmentMapping {
  /// u = phi / (2 pi), v = theta / pi, for w = (sin theta cos phi, sin theta sin phi, cos theta): pbrt-v3. Rows wrap
  /// around; the first and last row reach up to the poles.
  LatLong,
  /// Square image, `EqualAreaSquareToSphere`: pbrt-v4. Across an edge, the lookup goes on where the sphere does.
  EqualArea,
};

/// Radiance from a direction with the density at which that direction is drawn.
struct EnvironmentValue {
  Color L;
  double pdf = 0;  ///< per solid angle
};

class EnvironmentMap {
 public:
  /// `image` has at least one pixel, its colours are finite and not negative (see `Repair`); square for EqualArea.
  /// Colours are multiplied by `scale`, and cut where they leave the range of float.
  EnvironmentMap(const Image& image, EnvironmentMapping mapping, const Color& scale);

  /// `image` as R, G, B with what is no radiance mended: NaN and negative values become 0, infinities the largest
  /// finite value of the image. `*repairedPixels` is the number of pixels that were changed.
  static Image Repair(const Image& image, int64_t* repairedPixels);

  /// No radiance anywhere: nothing can be drawn.
  bool IsBlack() const { return table_.IsZero(); }
  /// `w` of any length but zero.
  Color Radiance(const Vec3d& w) const;
  /// Radiance and density in one lookup.
  EnvironmentValue Evaluate(const Vec3d& w) const;
  /// A unit direction; its density is `Evaluate`'s. The map must not be black.
  Vec3d Sample(const Vec2d& u) const;
  /// The random numbers with which `Sample` gives the direction `w`, of any length but zero. The map must not be black.
  Vec2d Invert(const Vec3d& w) const;
  /// The integral of the radiance over all directions (of the lookup, exactly).
  Color Integral() const { return integral_; }
  /// Of the tables; the image is not kept.
  int64_t MemoryBytes() const;

 private:
  /// A direction as a cell and a place in it: `t` within the cell for the lookup, `s` for the density. For LatLong s.y
  /// is linear in cos theta, so that the density per solid angle has no 1 / sin theta in it.
  struct Place {
    Vec2i cell;
    Vec2d t, s;
  };

  Place PlaceOf(const Vec3d& w) const;
  Vec3d DirectionOf(const Vec2i& cell, const Vec2d& s) const;
  void FillLattice(const Image& image, const Color& scale);
  void BuildTable();
  /// The integrals over the cells of row y of the two functions that are linear in v, 1 at one border and 0 at the
  /// other.
  Vec2d RowIntegrals(int y) const;
  double CellSolidAngle(const Vec2i& cell) const;
  /// Importance at the four corners of a cell: (0,0), (1,0), (0,1), (1,1).
  void Weights(const Vec2i& cell, double (&w)[4]) const;
  const Color& Corner(int x, int y) const {
    return lattice_[static_cast<size_t>(y) * static_cast<size_t>(width_ + 2) + static_cast<size_t>(x)];
  }
  double LatticeX(int i) const;
  double LatticeY(int j) const;

  EnvironmentMapping mapping_;
  int width_, height_;             // of the image
  std::vector<Color> lattice_;     // the lookup at the corners of the cells, (width + 2) x (height + 2)
  std::vector<double> haversine_;  // LatLong: (1 - cos theta) / 2 at the borders of the rows of cells
  Distribution2D table_;
  Color integral_;
};

}  // namespace dapple
