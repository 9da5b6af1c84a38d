// Piecewise-constant distributions in one and two dimensions, discrete or over [0, 1): draw, density, inverse.
//
// Sums are kept in double precision. Cells of weight zero are never drawn, whatever the random number; the density that
// a draw reports is bit for bit what `Pdf` gives for its result; the inverse returns the random number to within
// rounding.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "src/base/vec.h"

namespace dapple {

/// A cell drawn from a discrete distribution.
struct DiscreteSample {
  int index = -1;          ///< -1 where all weights are zero
  double probability = 0;  ///< of this cell
  double u = 0;            ///< the random number, stretched from the cell's share to [0, 1)
};

/// A point drawn from a density over [0, 1).
struct ContinuousSample {
  double x = 0;
  double pdf = 0;  ///< per unit length
  int index = -1;  ///< of the cell in which x lies
};

/// n cells of equal width over [0, 1), cell i of a density proportional to weight i.
class Distribution1D {
 public:
  Distribution1D() = default;
  /// `weights` are finite and not negative; their sum may be zero (then nothing can be drawn) but must be finite.
  explicit Distribution1D(std::span<const double> weights);
  explicit Distribution1D(std::span<const float> weights);

  int Size() const { return cdf_.empty() ? 0 : static_cast<int>(cdf_.size()) - 1; }
  /// Sum of the weights.
  double Sum() const { return sum_; }
  bool IsZero() const { return sum_ == 0; }

  DiscreteSample SampleDiscrete(double u) const;
  double Probability(int index) const {
    return cdf_[static_cast<size_t>(index) + 1] - cdf_[static_cast<size_t>(index)];
  }
  /// The random number with which `SampleDiscrete` gives `index` and leaves `u`.
  double InvertDiscrete(int index, double u) const;

  ContinuousSample SampleContinuous(double u) const;
  /// Density at x in [0, 1], per unit length.
  double Pdf(double x) const;
  double Invert(double x) const;
  /// The cell that holds x in [0, 1]; x = 1 belongs to the last.
  int CellOf(double x) const;

  int64_t MemoryBytes() const;

 private:
  std::vector<double> cdf_;      // cdf_[0] = 0, cdf_[n] = 1
  std::vector<uint32_t> guide_;  // where to look in it
  double sum_ = 0;
};

/// A point drawn from a density over the unit square.
struct ContinuousSample2D {
  Vec2d p;
  double pdf = 0;  ///< per unit area
  Vec2i cell{-1, -1};
};

/// A cell drawn from a discrete distribution in two dimensions.
struct DiscreteSample2D {
  Vec2i cell{-1, -1};      ///< -1 where all weights are zero
  double probability = 0;  ///< of this cell
  Vec2d u;                 ///< the random numbers, stretched from the cell's share to [0, 1)^2
};

/// width x height cells of equal size over [0, 1)^2; weight of cell (x, y) is at weights[y width + x].
/// y is drawn by the rows' sums from u.y, then x within the row from u.x.
class Distribution2D {
 public:
  Distribution2D() = default;
  Distribution2D(std::span<const float> weights, int width, int height);
  Distribution2D(std::span<const double> weights, int width, int height);

  int Width() const { return width_; }
  int Height() const { return marginal_.Size(); }
  /// Sum of the weights.
  double Sum() const { return marginal_.Sum(); }
  bool IsZero() const { return marginal_.IsZero(); }

  DiscreteSample2D SampleDiscrete(const Vec2d& u) const;
  double Probability(const Vec2i& cell) const;
  /// The random numbers with which `SampleDiscrete` gives `cell` and leaves `u`.
  Vec2d InvertDiscrete(const Vec2i& cell, const Vec2d& u) const;

  // A row cut to the columns from `first` to before `last`, of which one at least has a weight.
  /// The sum of their weights as a share of the whole; of any columns.
  double RowShare(int y, int first, int last) const;
  /// A column of them; its probability is within the part.
  DiscreteSample SampleRow(int y, int first, int last, double u) const;
  /// The random number with which `SampleRow` gives the column of `cell` and leaves `u`.
  double InvertRow(const Vec2i& cell, int first, int last, double u) const;

  ContinuousSample2D Sample(const Vec2d& u) const;
  /// Density at p in [0, 1]^2, per unit area.
  double Pdf(const Vec2d& p) const;
  Vec2d Invert(const Vec2d& p) const;

  int64_t MemoryBytes() const;

 private:
  template <typename T>
  void Build(std::span<const T> weights, int width, int height);
  Vec2i CellOf(const Vec2d& p) const;
  std::span<const double> RowCdf(int y) const {
    const size_t stride = static_cast<size_t>(width_) + 1;
    return {cdf_.data() + static_cast<size_t>(y) * stride, stride};
  }

  std::span<const uint32_t> RowGuide(int y) const {
    return {guide_.data() + static_cast<size_t>(y) * guideLength_, guideLength_};
  }

  int width_ = 0;
  size_t guideLength_ = 0;   // of one row
  std::vector<double> cdf_;  // one row of width + 1 entries after the other
  std::vector<uint32_t> guide_;
  Distribution1D marginal_;
};

}  // namespace dapple
