// Sums of cell weights over ever larger squares of cells, and draws that go down them: hierarchical warping.
//
// Clarberg, Jarosz, Akenine-Moller and Jensen 2005, "Wavelet importance sampling": the unit square is split by the
// weights of a node's four quarters, first in y, then in x, and again within the quarter that was drawn. The density is
// the product of the shares on the way. They are reckoned from the four weights as stored, so that draw, density and
// inverse are exact although sums are stored as float.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "src/base/vec.h"

namespace dapple {

/// One of four quarters (0,0), (1,0), (0,1), (1,1), numbered 0 to 3, with its share of the square.
struct QuarterSample {
  int quarter = 0;
  double probability = 0;
};

/// A quarter of probability in proportion to `weights` (not negative, not all zero); `*u` is stretched from its share
/// to [0, 1)^2.
QuarterSample SampleQuarter(const double (&weights)[4], Vec2d* u);
/// The discrete probability with which `SampleQuarter` gives that quarter.
double QuarterProbability(const double (&weights)[4], int quarter);
/// The random numbers with which `SampleQuarter` gives that quarter and leaves `u`.
Vec2d InvertQuarter(const double (&weights)[4], int quarter, const Vec2d& u);

/// A square of 2^level x 2^level cells; those beyond the border weigh nothing.
struct PyramidNode {
  int level = 0;
  Vec2i at{0, 0};  ///< in units of its size

  PyramidNode Child(int quarter) const { return {level - 1, {2 * at.x + (quarter & 1), 2 * at.y + (quarter >> 1)}}; }
};

/// A cell drawn below a node.
struct PyramidSample {
  Vec2i cell;
  double probability = 0;  ///< of the cell, once the node is drawn
};

class WeightPyramid {
 public:
  WeightPyramid() = default;
  /// The weight of cell (x, y) is at weights[y width + x]: finite, not negative, not all zero. What is positive stays
  /// so.
  WeightPyramid(std::span<const double> weights, int width, int height);

  /// The node that holds all cells.
  PyramidNode Root() const { return {static_cast<int>(levels_.size()) - 1, {0, 0}}; }
  /// Nodes of a level that hold any cell.
  Vec2i Size(int level) const { return levels_[static_cast<size_t>(level)].size; }
  int64_t MemoryBytes() const;
  /// The sum below a node as a share of the largest cell's weight; 0 beyond the border.
  double Weight(const PyramidNode& node) const {
    const Level& level = levels_[static_cast<size_t>(node.level)];
    if (node.at.x >= level.size.x || node.at.y >= level.size.y) return 0;
    return static_cast<double>(level.weights[static_cast<size_t>(node.at.y) * static_cast<size_t>(level.size.x) +
                                             static_cast<size_t>(node.at.x)]);
  }

  /// A cell below `node` (of a weight above zero); `*u` is stretched from the cell's share to [0, 1)^2.
  PyramidSample Sample(PyramidNode node, Vec2d* u) const;
  /// The probability of `cell` once the node of `level` above it is drawn.
  double Probability(int level, const Vec2i& cell) const;
  /// The random numbers with which `Sample` from the node of `level` above `cell` gives it and leaves `u`.
  Vec2d Invert(int level, const Vec2i& cell, Vec2d u) const;

 private:
  struct Level {
    Vec2i size;
    std::vector<float> weights;
  };

  void WeightsBelow(const PyramidNode& node, double (&weights)[4]) const;

  std::vector<Level> levels_;
};

/// The node of `level` above a cell, and which quarter of it the cell lies in.
inline PyramidNode NodeAbove(int level, const Vec2i& cell) { return {level, {cell.x >> level, cell.y >> level}}; }
inline int QuarterOf(int level, const Vec2i& cell) {
  return ((cell.x >> (level - 1)) & 1) | (((cell.y >> (level - 1)) & 1) << 1);
}

}  // namespace dapple
