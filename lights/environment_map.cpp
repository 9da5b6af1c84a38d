#include "lights/environment_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "lights/equal_area_mapping.h"
#include "lights/light_math.h"
#include "src/base/error.h"
#include "src/base/numerics.h"
#include "src/base/parallel.h"
#include "src/sampling/warps.h"

namespace dapple {

namespace {

constexpr int64_t kRowsPerChunk = 16;
/// Into so many parts a side of the square is cut at least to integrate radiance times a factor.
constexpr double kFactorSteps = 1024;

bool IsRadiance(const Color& c) { return c.IsFinite() && c.r >= 0 && c.g >= 0 && c.b >= 0; }

/// The pixel that continues the image beyond its border, by less than its size.
Vec2i Wrapped(EnvironmentMapping mapping, int x, int y, int width, int height) {
  if (mapping == EnvironmentMapping::LatLong) {
    return {(x + width) % width, std::clamp(y, 0, height - 1)};
  }
  // Each edge of the octahedral square is glued to itself, mirrored at its middle.
  if (x < 0 || x >= width) {
    x = x < 0 ? -1 - x : 2 * width - 1 - x;
    y = height - 1 - y;
  }
  if (y < 0 || y >= height) {
    y = y < 0 ? -1 - y : 2 * height - 1 - y;
    x = width - 1 - x;
  }
  return {x, y};
}

/// The cell that holds `x` texels from the edge of a row of `size`, and the place within it: the first and last cell
/// are half as wide.
std::pair<int, double> CellAt(double x, int size) {
  const int cell = std::clamp(static_cast<int>(x + 0.5), 0, size);
  const double t = cell == 0 ? 2 * x : (cell == size ? 2 * (x - size) + 1 : x + 0.5 - cell);
  return {cell, std::clamp(t, 0.0, 1.0)};
}

/// (1 - cos theta) / 2 of a unit vector, without cancellation near +z.
double HaversineOf(const Vec3d& w) { return w.z > 0 ? (w.x * w.x + w.y * w.y) / (2 * (1 + w.z)) : (1 - w.z) / 2; }

}  // namespace

Vec2d EnvironmentSquareAt(EnvironmentMapping mapping, const Vec3d& w) {
  if (mapping == EnvironmentMapping::EqualArea) return EqualAreaSphereToSquare(w);
  return {TurnOf(w.x, w.y), Atan2(std::sqrt(w.x * w.x + w.y * w.y), w.z) / kPiD};
}

Vec3d EnvironmentDirectionAt(EnvironmentMapping mapping, const Vec2d& p) {
  if (mapping == EnvironmentMapping::EqualArea) return EqualAreaSquareToSphere(p);
  const double theta = kPiD * p.y, phi = 2 * kPiD * p.x;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

EnvironmentMap::EnvironmentMap(const Image& image, EnvironmentMapping mapping, const Color& scale)
    : mapping_(mapping), width_(image.Width()), height_(image.Height()) {
  if (width_ < 1 || height_ < 1) throw Error("environment map without pixels: expected at least one");
  if (mapping == EnvironmentMapping::EqualArea && width_ != height_) {
    throw Error("environment map of " + std::to_string(width_) + " x " + std::to_string(height_) +
                " pixels: expected a square image in the equal-area mapping");
  }
  FillLattice(image, scale);
  FillHaversines();
  // A black map is sampled by nobody.
  if (std::all_of(lattice_.begin(), lattice_.end(), [](const Color& c) { return c.IsBlack(); })) return;
  base_ = MakeDensity(0);
  integral_ = IntegrateRadiance();
}

Image EnvironmentMap::Repair(const Image& image, int64_t* repairedPixels) {
  float largest = 0;
  for (int y = 0; y < image.Height(); ++y) {
    for (int x = 0; x < image.Width(); ++x) {
      const Color c = image.ColorAt(x, y);
      for (int i = 0; i < Color::kComponents; ++i) {
        if (std::isfinite(c[i])) largest = std::max(largest, c[i]);
      }
    }
  }
  Image repaired = Image::Rgb(image.Width(), image.Height());
  *repairedPixels = 0;
  for (int y = 0; y < image.Height(); ++y) {
    for (int x = 0; x < image.Width(); ++x) {
      Color c = image.ColorAt(x, y);
      if (!IsRadiance(c)) {
        // std::max keeps its first argument where the second is NaN.
        c = Map(c, [largest](float v) { return std::min(std::max(0.f, v), largest); });
        ++*repairedPixels;
      }
      repaired.SetColor(x, y, c);
    }
  }
  return repaired;
}

void EnvironmentMap::FillLattice(const Image& image, const Color& scale) {
  const auto texel = [&](int x, int y) {
    const Vec2i p = Wrapped(mapping_, x, y, width_, height_);
    return Map(image.ColorAt(p.x, p.y) * scale, [](float v) { return std::min(v, std::numeric_limits<float>::max()); });
  };
  lattice_.resize(static_cast<size_t>(width_ + 2) * static_cast<size_t>(height_ + 2));
  ParallelForChunks(height_ + 2, kRowsPerChunk, [&](int64_t begin, int64_t end) {
    for (int j = static_cast<int>(begin); j < end; ++j) {
      // The first and last lines are the square's edges, half-way between a texel and the one that continues it.
      const bool yEdge = j == 0 || j == height_ + 1;
      for (int i = 0; i < width_ + 2; ++i) {
        const bool xEdge = i == 0 || i == width_ + 1;
        const int x0 = i - 1, y0 = j - 1;
        const int x1 = i == 0 ? 0 : (xEdge ? width_ - 1 : x0), y1 = j == 0 ? 0 : (yEdge ? height_ - 1 : y0);
        Color value = texel(x1, y1);
        if (xEdge) value = value * 0.5f + texel(x0, y1) * 0.5f;
        if (yEdge) {
          Color beyond = texel(x1, y0);
          if (xEdge) beyond = beyond * 0.5f + texel(x0, y0) * 0.5f;
          value = value * 0.5f + beyond * 0.5f;
        }
        lattice_[static_cast<size_t>(j) * static_cast<size_t>(width_ + 2) + static_cast<size_t>(i)] = value;
      }
    }
  });
}

void EnvironmentMap::FillHaversines() {
  if (mapping_ != EnvironmentMapping::LatLong) return;
  for (int j = 0; j < height_ + 2; ++j) haversine_.push_back(Sqr(std::sin(kPiD / 2 * LatticeY(j))));
  haversine_.back() = 1;
}

std::vector<double> EnvironmentMap::CellWeights(double threshold) const {
  const int columns = width_ + 1, rows = height_ + 1;
  std::vector<double> weights(static_cast<size_t>(columns) * static_cast<size_t>(rows));
  ParallelForChunks(rows, kRowsPerChunk, [&](int64_t begin, int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      const Vec2d integrals = RowIntegrals(y);
      for (int x = 0; x < columns; ++x) {
        const double halfWidth = (LatticeX(x + 1) - LatticeX(x)) / 2;
        double w[4];
        Weights({x, y}, threshold, w);
        weights[static_cast<size_t>(y) * static_cast<size_t>(columns) + static_cast<size_t>(x)] =
            halfWidth * (integrals.x * (w[0] + w[1]) + integrals.y * (w[2] + w[3]));
      }
    }
  });
  return weights;
}

EnvironmentDensity EnvironmentMap::MakeDensity(double threshold) const {
  const Vec2i cells = Cells();
  return {Distribution2D(std::span<const double>(CellWeights(threshold)), cells.x, cells.y), threshold};
}

double EnvironmentMap::MeanImportance() const { return base_.table.Sum() / (4 * kPiD); }

Color EnvironmentMap::IntegrateRadiance() const {
  std::vector<Vec3d> rowIntegrals(static_cast<size_t>(height_ + 1));
  ParallelForChunks(height_ + 1, kRowsPerChunk, [&](int64_t begin, int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      const Vec2d integrals = RowIntegrals(y);
      Vec3d sum(0);
      for (int x = 0; x <= width_; ++x) {
        const double halfWidth = (LatticeX(x + 1) - LatticeX(x)) / 2;
        for (int i = 0; i < Color::kComponents; ++i) {
          const auto corner = [&](int dx, int dy) { return static_cast<double>(Corner(x + dx, y + dy)[i]); };
          sum[i] +=
              halfWidth * (integrals.x * (corner(0, 0) + corner(1, 0)) + integrals.y * (corner(0, 1) + corner(1, 1)));
        }
      }
      rowIntegrals[static_cast<size_t>(y)] = sum;
    }
  });
  Vec3d integral(0);
  for (const Vec3d& row : rowIntegrals) integral += row;
  return FiniteColor(integral);
}

Vec2d EnvironmentMap::StripIntegrals(double low, double high) const {
  if (mapping_ == EnvironmentMapping::EqualArea) return Vec2d(2 * kPiD * (high - low));
  // With m the middle and d half the height in theta: the integrals of (1/2 -+ (theta - m) / (2 d)) sin theta.
  const double m = kPiD * (low + high) / 2, d = kPiD * (high - low) / 2;
  const double even = std::sin(m) * std::sin(d), odd = std::cos(m) * (std::sin(d) - d * std::cos(d)) / d;
  return Vec2d(even - odd, even + odd) * (2 * kPiD);
}

Color EnvironmentMap::IntegralTimes(const std::function<double(const Vec3d& w)>& factor) const {
  std::vector<Vec3d> rows(static_cast<size_t>(height_) + 1, Vec3d(0));
  ParallelFor(height_ + 1, [&](int64_t row) {
    const int y = static_cast<int>(row);
    const double low = LatticeY(y), high = LatticeY(y + 1);
    const int strips = static_cast<int>(std::ceil((high - low) * kFactorSteps));
    for (int i = 0; i < strips; ++i)
      rows[static_cast<size_t>(y)] += StripTimes(y, Lerp(static_cast<double>(i) / strips, low, high),
                                                 Lerp(static_cast<double>(i + 1) / strips, low, high), factor);
  });
  Vec3d sum(0);
  for (const Vec3d& row : rows) sum += row;
  return FiniteColor(sum);
}

// Piece by piece of the strip, each as long as the factor may be taken for a linear function: its value at the mean
// place of the radiance counts.
Vec3d EnvironmentMap::StripTimes(int y, double low, double high,
                                 const std::function<double(const Vec3d& w)>& factor) const {
  const Vec2d integrals = StripIntegrals(low, high);
  const double y0 = LatticeY(y), y1 = LatticeY(y + 1);
  const float tLow = static_cast<float>((low - y0) / (y1 - y0)), tHigh = static_cast<float>((high - y0) / (y1 - y0));
  Vec3d sum(0), radiance(0);
  Vec3d place(0);  // x, y times weight, weight
  double length = 0;
  const auto finish = [&] {
    if (place.z > 0) sum += radiance * factor(DirectionAt({place.x / place.z, place.y / place.z}));
    radiance = place = Vec3d(0);
    length = 0;
  };
  for (int x = 0; x <= width_; ++x) {
    const double x0 = LatticeX(x), x1 = LatticeX(x + 1);
    const int pieces = static_cast<int>(std::ceil((x1 - x0) * kFactorSteps));
    for (int i = 0; i < pieces; ++i) {
      const double s0 = static_cast<double>(i) / pieces, s1 = static_cast<double>(i + 1) / pieces;
      const auto corner = [&](double s, float t) {
        return Lerp(t, Lerp(static_cast<float>(s), Corner(x, y), Corner(x + 1, y)),
                    Lerp(static_cast<float>(s), Corner(x, y + 1), Corner(x + 1, y + 1)));
      };
      const Color c[4] = {corner(s0, tLow), corner(s1, tLow), corner(s0, tHigh), corner(s1, tHigh)};
      const double halfWidth = (x1 - x0) * (s1 - s0) / 2;
      const double top = halfWidth * integrals.x, bottom = halfWidth * integrals.y;
      double w[4];
      for (int k = 0; k < 4; ++k) w[k] = (k < 2 ? top : bottom) * Importance(c[k]);
      const double weight = w[0] + w[1] + w[2] + w[3];
      if (weight == 0) continue;
      for (int k = 0; k < Color::kComponents; ++k)
        radiance[k] += top * static_cast<double>(c[0][k] + c[1][k]) + bottom * static_cast<double>(c[2][k] + c[3][k]);
      // Where a linear function weighs its interval, its mean place is a third or two of the way.
      const double xMean = Lerp((1 + (w[1] + w[3]) / weight) / 3, Lerp(s0, x0, x1), Lerp(s1, x0, x1));
      const double yMean = Lerp((1 + (w[2] + w[3]) / weight) / 3, low, high);
      place += Vec3d(xMean, yMean, 1) * weight;
      length += 2 * halfWidth;
      if (length * kFactorSteps > 0.5) finish();
    }
  }
  finish();
  return sum;
}

Vec3d EnvironmentMap::DirectionAt(const Vec2d& p) const {
  return mapping_ == EnvironmentMapping::LatLong ? SampleSphere({Sqr(std::sin(kPiD / 2 * p.y)), p.x})
                                                 : EqualAreaSquareToSphere(p);
}

double EnvironmentMap::CellSolidAngle(const Vec2i& cell) const {
  const double width = LatticeX(cell.x + 1) - LatticeX(cell.x);
  if (mapping_ == EnvironmentMapping::EqualArea) {
    return 4 * kPiD * width * (LatticeY(cell.y + 1) - LatticeY(cell.y));
  }
  const size_t j = static_cast<size_t>(cell.y);
  return 4 * kPiD * width * (haversine_[j + 1] - haversine_[j]);
}

void EnvironmentMap::Weights(const Vec2i& cell, double threshold, double (&w)[4]) const {
  const auto at = [&](int dx, int dy) {
    return std::max(0.0, Importance(Corner(cell.x + dx, cell.y + dy)) - threshold);
  };
  w[0] = at(0, 0), w[1] = at(1, 0), w[2] = at(0, 1), w[3] = at(1, 1);
}

double EnvironmentMap::LatticeX(int i) const { return i == 0 ? 0 : (i > width_ ? 1 : (i - 0.5) / width_); }
double EnvironmentMap::LatticeY(int j) const { return j == 0 ? 0 : (j > height_ ? 1 : (j - 0.5) / height_); }

EnvironmentPlace EnvironmentMap::PlaceOf(const Vec3d& w) const {
  const Vec3d unit = w * (1 / std::sqrt(Dot(w, w)));
  const Vec2d p = EnvironmentSquareAt(mapping_, unit);
  EnvironmentPlace place;
  std::tie(place.cell.x, place.t.x) = CellAt(p.x * width_, width_);
  std::tie(place.cell.y, place.t.y) = CellAt(p.y * height_, height_);
  place.s = place.t;
  if (mapping_ == EnvironmentMapping::LatLong) {
    const size_t j = static_cast<size_t>(place.cell.y);
    const double share = (HaversineOf(unit) - haversine_[j]) / (haversine_[j + 1] - haversine_[j]);
    place.s.y = std::clamp(share, 0.0, 1.0);
  }
  return place;
}

Vec3d EnvironmentMap::DirectionOf(const Vec2i& cell, const Vec2d& s) const {
  const double x = Lerp(s.x, LatticeX(cell.x), LatticeX(cell.x + 1));
  if (mapping_ == EnvironmentMapping::EqualArea) {
    return EqualAreaSquareToSphere({x, Lerp(s.y, LatticeY(cell.y), LatticeY(cell.y + 1))});
  }
  const size_t j = static_cast<size_t>(cell.y);
  const double haversine = std::min(Lerp(s.y, haversine_[j], haversine_[j + 1]), 1.0);
  const double sinTheta = 2 * SafeSqrt(haversine * (1 - haversine)), phi = 2 * kPiD * x;
  return {sinTheta * std::cos(phi), sinTheta * std::sin(phi), 1 - 2 * haversine};
}

Color EnvironmentMap::RadianceAt(const EnvironmentPlace& place) const {
  const Vec2i& c = place.cell;
  return Bilinear({Corner(c.x, c.y), Corner(c.x + 1, c.y), Corner(c.x, c.y + 1), Corner(c.x + 1, c.y + 1)}, place.t);
}

RadianceWithPdf EnvironmentMap::Evaluate(const Vec3d& w) const {
  const EnvironmentPlace place = PlaceOf(w);
  return {RadianceAt(place), DensityAt(base_, place)};
}

Vec3d EnvironmentMap::Sample(const Vec2d& u) const { return Sample(base_, u); }

Vec2d EnvironmentMap::Invert(const Vec3d& w) const { return Invert(base_, w); }

Vec3d EnvironmentMap::Sample(const EnvironmentDensity& density, const Vec2d& u) const {
  const DiscreteSample2D drawn = density.table.SampleDiscrete(u);
  return DirectionOf(drawn.cell, SampleInCell(drawn.cell, drawn.u, density.threshold));
}

double EnvironmentMap::DensityAt(const EnvironmentDensity& density, const EnvironmentPlace& place) const {
  if (density.table.IsZero()) return 0;
  const double probability = density.table.Probability(place.cell);
  return probability == 0 ? 0 : probability * PdfInCell(place.cell, place.s, density.threshold);
}

Vec2d EnvironmentMap::Invert(const EnvironmentDensity& density, const Vec3d& w) const {
  const EnvironmentPlace place = PlaceOf(w);
  if (density.table.Probability(place.cell) == 0) return density.table.InvertDiscrete(place.cell, Vec2d(0));
  return density.table.InvertDiscrete(place.cell, InvertInCell(place.cell, place.s, density.threshold));
}

Vec2d EnvironmentMap::SampleInCell(const Vec2i& cell, const Vec2d& u, double threshold) const {
  double weights[4];
  Weights(cell, threshold, weights);
  return SampleBilinear(u, weights);
}

double EnvironmentMap::PdfInCell(const Vec2i& cell, const Vec2d& s, double threshold) const {
  double weights[4];
  Weights(cell, threshold, weights);
  return BilinearPdf(s, weights) / CellSolidAngle(cell);
}

Vec2d EnvironmentMap::InvertInCell(const Vec2i& cell, const Vec2d& s, double threshold) const {
  double weights[4];
  Weights(cell, threshold, weights);
  return InvertBilinear(s, weights);
}

int64_t EnvironmentMap::MemoryBytes() const {
  return base_.table.MemoryBytes() +
         static_cast<int64_t>(lattice_.size() * sizeof(Color) + haversine_.size() * sizeof(double));
}

}  // namespace dapple
