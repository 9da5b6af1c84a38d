// An image around the scene: radiance by direction, and directions drawn by it. In the map's own space.
//
// The lookup is bilinear between texel centres. The square is cut where that lookup changes its formula: at the lines
// through the texel centres (and at the square's edges). So in each of the (width + 1) x (height + 1) cells the
// radiance is a bilinear function of its four corners, and directions are drawn from the bilinear function with the
// largest components of the same corners. The density is thus positive exactly where the radiance is, and close to it
// in shape: for an equal-area gray map in proportion to it; for LatLong the radiance is linear in theta within a cell
// and the density in cos theta, which differ noticeably in the cells at the poles only.
//
// Why so. With a bilinear lookup and a density constant over texels, the density is zero next to a bright texel among
// black ones, where the lookup is not: light is lost. A table of the texels' filtered means mends that, but its density
// differs from the radiance by up to the contrast of neighbours. Radiance constant over texels, looked up at the
// nearest one, would fit its table exactly, and show its squares in every mirror and as steps in every shadow. The
// exact sampler of the bilinear function costs one quadratic equation more for each of both coordinates.
//
// Other densities over the same cells (next-event strategies) are made from the functions of the second half.
#pragma once

#include <functional>
#include <vector>

#include "lights/light.h"
#include "src/base/color.h"
#include "src/image/image.h"
#include "src/sampling/distribution.h"
#include "src/sampling/table_use.h"

namespace dapple {

enum class EnvironmentMapping {
  /// u = phi / (2 pi), v = theta / pi, for w = (sin theta cos phi, sin theta sin phi, cos theta): pbrt-v3. Rows wrap
  /// around; the first and last row reach up to the poles.
  LatLong,
  /// Square image, `EqualAreaSquareToSphere`: pbrt-v4. Across an edge, the lookup goes on where the sphere does.
  EqualArea,
};

/// Where the image shows the unit direction `w`, in [0, 1]^2 from its upper left corner; and the direction shown there.
Vec2d EnvironmentSquareAt(EnvironmentMapping mapping, const Vec3d& w);
Vec3d EnvironmentDirectionAt(EnvironmentMapping mapping, const Vec2d& p);

/// A density of directions over the cells of a map, bilinear in each: as importance at the corners of the cells, less
/// `threshold`, and 0 where that is negative.
struct EnvironmentDensity {
  Distribution2D table;
  double threshold = 0;
};

/// A direction as a cell of the map and a place in it: `t` within the cell for the lookup, `s` for densities. For
/// LatLong s.y is linear in cos theta, so that a density per solid angle has no 1 / sin theta in it.
struct EnvironmentPlace {
  Vec2i cell;
  Vec2d t, s;
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
  bool IsBlack() const { return base_.table.IsZero(); }
  /// `w` of any length but zero.
  Color Radiance(const Vec3d& w) const { return RadianceAt(PlaceOf(w)); }
  Color RadianceAt(const EnvironmentPlace& place) const;
  /// Radiance and density in one lookup.
  RadianceWithPdf Evaluate(const Vec3d& w) const;
  /// A unit direction; its density is `Evaluate`'s. The map must not be black.
  Vec3d Sample(const Vec2d& u) const;
  /// The random numbers with which `Sample` gives the direction `w`, of any length but zero. The map must not be black.
  Vec2d Invert(const Vec3d& w) const;
  /// The integral of the radiance over all directions (of the lookup, exactly).
  Color Integral() const { return integral_; }
  /// The integral of the radiance times `factor` over all directions; `factor` takes unit vectors and should vary
  /// little over a thousandth of a turn: then the error is of second order in that.
  Color IntegralTimes(const std::function<double(const Vec3d& w)>& factor) const;
  /// Of the tables; the image is not kept.
  int64_t MemoryBytes() const;
  /// None where the map is black.
  TableUse Tables() const { return IsBlack() ? TableUse() : TableUse::Of(MemoryBytes()); }

  /// Columns and rows of cells.
  Vec2i Cells() const { return {width_ + 1, height_ + 1}; }
  EnvironmentMapping Mapping() const { return mapping_; }
  /// `w` of any length whose square is neither zero nor infinite.
  EnvironmentPlace PlaceOf(const Vec3d& w) const;
  /// The unit direction of the place `s` in [0, 1]^2 of a cell.
  Vec3d DirectionOf(const Vec2i& cell, const Vec2d& s) const;
  /// In steradians.
  double CellSolidAngle(const Vec2i& cell) const;
  /// Integrals over the cells (solid angle) of the importance less `threshold`, 0 where negative; row by row.
  std::vector<double> CellWeights(double threshold) const;
  /// The largest component of the radiance integrated over all directions, and divided by 4 pi.
  double MeanImportance() const;

  /// The map's own, of threshold 0: `Evaluate`'s.
  const EnvironmentDensity& Density() const { return base_; }
  /// Of a table that is zero nothing can be drawn.
  EnvironmentDensity MakeDensity(double threshold) const;
  /// A unit direction; its density per solid angle is `DensityAt`'s.
  Vec3d Sample(const EnvironmentDensity& density, const Vec2d& u) const;
  double DensityAt(const EnvironmentDensity& density, const EnvironmentPlace& place) const;
  Vec2d Invert(const EnvironmentDensity& density, const Vec3d& w) const;

  // Within a cell: bilinear between the importance at its corners less a threshold.
  Vec2d SampleInCell(const Vec2i& cell, const Vec2d& u, double threshold = 0) const;
  /// The density of the place `s` of a cell, per solid angle of that cell.
  double PdfInCell(const Vec2i& cell, const Vec2d& s, double threshold = 0) const;
  Vec2d InvertInCell(const Vec2i& cell, const Vec2d& s, double threshold = 0) const;

 private:
  void FillLattice(const Image& image, const Color& scale);
  void FillHaversines();
  Color IntegrateRadiance() const;
  /// The integrals over the strip `low` < v < `high` of the two functions that are linear in v, 1 at one border and 0
  /// at the other; and over the cells of row y.
  Vec2d StripIntegrals(double low, double high) const;
  Vec2d RowIntegrals(int y) const { return StripIntegrals(LatticeY(y), LatticeY(y + 1)); }
  /// The part of `IntegralTimes` between those lines, which lie in row y of cells.
  Vec3d StripTimes(int y, double low, double high, const std::function<double(const Vec3d& w)>& factor) const;
  /// The direction of a point of the square.
  Vec3d DirectionAt(const Vec2d& p) const;
  /// Importance, less `threshold`, at the four corners of a cell: (0,0), (1,0), (0,1), (1,1).
  void Weights(const Vec2i& cell, double threshold, double (&w)[4]) const;
  const Color& Corner(int x, int y) const {
    return lattice_[static_cast<size_t>(y) * static_cast<size_t>(width_ + 2) + static_cast<size_t>(x)];
  }
  double LatticeX(int i) const;
  double LatticeY(int j) const;

  EnvironmentMapping mapping_;
  int width_, height_;             // of the image
  std::vector<Color> lattice_;     // the lookup at the corners of the cells, (width + 2) x (height + 2)
  std::vector<double> haversine_;  // LatLong: (1 - cos theta) / 2 at the borders of the rows of cells
  EnvironmentDensity base_;
  Color integral_;
};

}  // namespace dapple
