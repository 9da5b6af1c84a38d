#include "src/sampling/distribution.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace dapple {

namespace {

constexpr double kBelowOne = 0x1.fffffffffffffp-1;

/// Running sums of the weights as shares of the whole, which is returned; all zero where that is zero.
template <typename T>
double BuildCdf(std::span<const T> weights, std::span<double> cdf) {
  cdf[0] = 0;
  for (size_t i = 0; i < weights.size(); ++i) {
    assert(weights[i] >= 0 && std::isfinite(weights[i]));
    cdf[i + 1] = cdf[i] + static_cast<double>(weights[i]);
  }
  const double sum = cdf.back();
  assert(std::isfinite(sum));
  if (sum == 0) return 0;
  // Dividing (not multiplying by the reciprocal) makes every entry behind the last weight exactly one, and keeps equal
  // sums equal: a zero cell has no interval at all. The probability is the interval that u really falls in, so that
  // density, draw and inverse speak of the same numbers.
  for (double& entry : cdf) entry /= sum;
  return sum;
}

double CellProbability(std::span<const double> cdf, int cell) {
  return cdf[static_cast<size_t>(cell) + 1] - cdf[static_cast<size_t>(cell)];
}

/// The length of the guide to a table: it cuts [0, 1) into a power of two of equal steps, some cells for each. None
/// where the table is so short that all of it is near.
size_t GuideLength(size_t cells) { return cells < 16 ? 0 : std::bit_ceil(cells / 4) + 1; }

/// Entry k is the cell that holds k / steps; it bounds the search and changes nothing of its result.
void BuildGuide(std::span<const double> cdf, std::span<uint32_t> guide) {
  if (guide.empty()) return;
  const size_t last = cdf.size() - 2;
  size_t cell = 0;
  for (size_t k = 0; k < guide.size(); ++k) {
    const double step = static_cast<double>(k) / static_cast<double>(guide.size() - 1);
    while (cell < last && cdf[cell + 1] <= step) ++cell;
    guide[k] = static_cast<uint32_t>(cell);
  }
}

/// The cell whose interval holds u in [0, 1]; the cdf is not all zero.
DiscreteSample FindCell(std::span<const double> cdf, std::span<const uint32_t> guide, double u) {
  u = std::clamp(u, 0.0, kBelowOne);
  size_t low = 0, high = cdf.size() - 2;
  if (!guide.empty()) {
    const size_t k = static_cast<size_t>(u * static_cast<double>(guide.size() - 1));
    low = guide[k];
    high = guide[k + 1];
  }
  // The first entry above u: its cell's interval [cdf_i, cdf_i+1) holds u and is not empty.
  const auto above = std::upper_bound(cdf.begin() + static_cast<ptrdiff_t>(low) + 1,
                                      cdf.begin() + static_cast<ptrdiff_t>(high) + 1, u);
  const int cell = static_cast<int>(above - cdf.begin()) - 1;
  const double probability = CellProbability(cdf, cell);
  const double within = (u - cdf[static_cast<size_t>(cell)]) / probability;
  return {cell, probability, std::min(within, kBelowOne)};
}

double InvertCell(std::span<const double> cdf, int cell, double u) {
  return cdf[static_cast<size_t>(cell)] + u * CellProbability(cdf, cell);
}

int CellAt(double x, int size) { return std::clamp(static_cast<int>(x * size), 0, size - 1); }

/// The point at the share `u` of a cell. Rounding may carry it over the cell's border, where the density is another.
double PointInCell(int cell, double u, int size) {
  double x = std::min((cell + u) / size, kBelowOne);
  while (CellAt(x, size) < cell) x = std::nextafter(x, 2.0);
  while (CellAt(x, size) > cell) x = std::nextafter(x, -1.0);
  return x;
}

double ShareOfCell(double x, int cell, int size) { return std::clamp(x * size - cell, 0.0, 1.0); }

template <typename T>
int64_t BytesOf(const std::vector<T>& v) {
  return static_cast<int64_t>(v.size() * sizeof(T));
}

}  // namespace

int64_t Distribution1D::MemoryBytes() const { return BytesOf(cdf_) + BytesOf(guide_); }

int64_t Distribution2D::MemoryBytes() const { return marginal_.MemoryBytes() + BytesOf(cdf_) + BytesOf(guide_); }

Distribution1D::Distribution1D(std::span<const double> weights)
    : cdf_(weights.size() + 1), guide_(GuideLength(weights.size())), sum_(BuildCdf(weights, std::span<double>(cdf_))) {
  BuildGuide(cdf_, guide_);
}

Distribution1D::Distribution1D(std::span<const float> weights)
    : cdf_(weights.size() + 1), guide_(GuideLength(weights.size())), sum_(BuildCdf(weights, std::span<double>(cdf_))) {
  BuildGuide(cdf_, guide_);
}

DiscreteSample Distribution1D::SampleDiscrete(double u) const {
  if (IsZero()) return {};
  return FindCell(cdf_, guide_, u);
}

double Distribution1D::InvertDiscrete(int index, double u) const { return InvertCell(cdf_, index, u); }

ContinuousSample Distribution1D::SampleContinuous(double u) const {
  if (IsZero()) return {};
  const DiscreteSample cell = FindCell(cdf_, guide_, u);
  return {PointInCell(cell.index, cell.u, Size()), cell.probability * Size(), cell.index};
}

int Distribution1D::CellOf(double x) const { return CellAt(x, Size()); }

double Distribution1D::Pdf(double x) const { return IsZero() ? 0 : Probability(CellOf(x)) * Size(); }

double Distribution1D::Invert(double x) const {
  const int cell = CellOf(x);
  return InvertDiscrete(cell, ShareOfCell(x, cell, Size()));
}

Distribution2D::Distribution2D(std::span<const float> weights, int width, int height) { Build(weights, width, height); }

Distribution2D::Distribution2D(std::span<const double> weights, int width, int height) {
  Build(weights, width, height);
}

template <typename T>
void Distribution2D::Build(std::span<const T> weights, int width, int height) {
  assert(weights.size() == static_cast<size_t>(width) * static_cast<size_t>(height));
  const size_t rowLength = static_cast<size_t>(width);
  width_ = width;
  cdf_.resize((rowLength + 1) * static_cast<size_t>(height));
  guideLength_ = GuideLength(rowLength);
  guide_.resize(guideLength_ * static_cast<size_t>(height));
  std::vector<double> sums(static_cast<size_t>(height));
  for (size_t y = 0; y < sums.size(); ++y) {
    const std::span<double> cdf(cdf_.data() + y * (rowLength + 1), rowLength + 1);
    sums[y] = BuildCdf(weights.subspan(y * rowLength, rowLength), cdf);
    BuildGuide(cdf, std::span<uint32_t>(guide_.data() + y * guideLength_, guideLength_));
  }
  marginal_ = Distribution1D(std::span<const double>(sums));
}

DiscreteSample2D Distribution2D::SampleDiscrete(const Vec2d& u) const {
  if (IsZero()) return {};
  const DiscreteSample y = marginal_.SampleDiscrete(u.y);
  const DiscreteSample x = FindCell(RowCdf(y.index), RowGuide(y.index), u.x);
  return {Vec2i(x.index, y.index), x.probability * y.probability, Vec2d(x.u, y.u)};
}

double Distribution2D::Probability(const Vec2i& cell) const {
  return CellProbability(RowCdf(cell.y), cell.x) * marginal_.Probability(cell.y);
}

double Distribution2D::RowShare(int y, int first, int last) const {
  const std::span<const double> cdf = RowCdf(y);
  return (cdf[static_cast<size_t>(last)] - cdf[static_cast<size_t>(first)]) * marginal_.Probability(y);
}

DiscreteSample Distribution2D::SampleRow(int y, int first, int last, double u) const {
  const std::span<const double> part =
      RowCdf(y).subspan(static_cast<size_t>(first), static_cast<size_t>(last - first) + 1);
  const double sum = part.back() - part.front();
  // Rounding must not reach beyond the part.
  const double target = std::min(part.front() + u * sum, std::nextafter(part.back(), 0.0));
  DiscreteSample drawn = FindCell(part, {}, target);
  drawn.index += first;
  drawn.probability /= sum;
  return drawn;
}

double Distribution2D::InvertRow(const Vec2i& cell, int first, int last, double u) const {
  const std::span<const double> cdf = RowCdf(cell.y);
  const double begin = cdf[static_cast<size_t>(first)];
  return std::clamp((InvertCell(cdf, cell.x, u) - begin) / (cdf[static_cast<size_t>(last)] - begin), 0.0, 1.0);
}

Vec2d Distribution2D::InvertDiscrete(const Vec2i& cell, const Vec2d& u) const {
  return {InvertCell(RowCdf(cell.y), cell.x, u.x), marginal_.InvertDiscrete(cell.y, u.y)};
}

ContinuousSample2D Distribution2D::Sample(const Vec2d& u) const {
  const DiscreteSample2D drawn = SampleDiscrete(u);
  if (drawn.cell.x < 0) return {};
  const Vec2d p(PointInCell(drawn.cell.x, drawn.u.x, Width()), PointInCell(drawn.cell.y, drawn.u.y, Height()));
  return {p, drawn.probability * Width() * Height(), drawn.cell};
}

double Distribution2D::Pdf(const Vec2d& p) const { return IsZero() ? 0 : Probability(CellOf(p)) * Width() * Height(); }

Vec2d Distribution2D::Invert(const Vec2d& p) const {
  const Vec2i cell = CellOf(p);
  return InvertDiscrete(cell, Vec2d(ShareOfCell(p.x, cell.x, Width()), ShareOfCell(p.y, cell.y, Height())));
}

Vec2i Distribution2D::CellOf(const Vec2d& p) const { return {CellAt(p.x, Width()), CellAt(p.y, Height())}; }

}  // namespace dapple
