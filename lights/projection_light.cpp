#include "lights/projection_light.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/base/numerics.h"
#include "src/base/parallel.h"
#include "src/sampling/warps.h"

namespace dapple {

namespace {

constexpr int64_t kRowsPerChunk = 16;

/// cos^3 of the direction through the point `p` of the plane: solid angle over area there.
double SolidAngleDensity(const Vec2d& p) {
  const double squared = 1 / (1 + p.x * p.x + p.y * p.y);
  return squared * std::sqrt(squared);
}

/// The borders of the cells along an axis on which `texels` texels reach from -extent to extent: their centres, the
/// ends, and steps between them over which cos^3 (of scale sqrt(1 + x^2), which is what asinh evens out) is nearly
/// linear.
std::vector<double> CellBorders(int texels, double extent) {
  constexpr double kLongestStep = 1.0 / 20;
  std::vector<double> borders{-extent};
  for (int i = 0; i <= texels; ++i) {
    const double from = borders.back();
    const double to = i == texels ? extent : ((2 * i + 1.0) / texels - 1) * extent;
    const double low = std::asinh(from), high = std::asinh(to);
    const int steps = std::max(1, static_cast<int>(std::ceil((high - low) / kLongestStep)));
    for (int step = 1; step < steps; ++step) {
      borders.push_back(std::sinh(Lerp(static_cast<double>(step) / steps, low, high)));
    }
    borders.push_back(to);
  }
  return borders;
}

/// The cell that holds x, and the place of x in it.
int FindCell(const std::vector<double>& borders, double x, double* place) {
  const auto above = std::upper_bound(borders.begin() + 1, borders.end() - 1, x);
  const double low = *(above - 1), high = *above;
  *place = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return static_cast<int>(above - borders.begin()) - 1;
}

}  // namespace

ProjectionMap::ProjectionMap(const Image& image, double fovDegrees, const Color& scale)
    : width_(image.Width()), height_(image.Height()) {
  if (width_ < 1 || height_ < 1) throw Error("projected image without pixels: expected at least one");
  if (!(fovDegrees >= kNarrowestFov && fovDegrees < 180)) {
    throw Error(fmt::format("field of view of a projection is {} degrees, expected at least {} and less than 180",
                            fovDegrees, kNarrowestFov));
  }
  const double shorter = std::tan(Radians(fovDegrees) / 2), aspect = static_cast<double>(width_) / height_;
  extent_ = Vec2d(std::max(1.0, aspect), std::max(1.0, 1 / aspect)) * shorter;
  columns_ = CellBorders(width_, extent_.x);
  rows_ = CellBorders(height_, extent_.y);
  FillTexels(image, scale);
  // A black map is sampled by nobody.
  if (std::any_of(texels_.begin(), texels_.end(), [](const Color& c) { return !c.IsBlack(); })) BuildTable();
}

void ProjectionMap::FillTexels(const Image& image, const Color& scale) {
  texels_.reserve(static_cast<size_t>(width_) * static_cast<size_t>(height_));
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) texels_.push_back(FiniteColor(image.ColorAt(x, y) * scale, 1));
  }
}

void ProjectionMap::BuildTable() {
  const size_t columns = columns_.size() - 1, rows = rows_.size() - 1;
  std::vector<double> weights(columns * rows);
  std::vector<Vec3d> rowIntegrals(rows, Vec3d(0));
  ParallelForChunks(static_cast<int64_t>(rows), kRowsPerChunk, [&](int64_t begin, int64_t end) {
    for (size_t y = static_cast<size_t>(begin); y < static_cast<size_t>(end); ++y) {
      for (size_t x = 0; x < columns; ++x) {
        const Vec2i cell(static_cast<int>(x), static_cast<int>(y));
        const Vec2d size = CellSize(cell);
        double w[4];
        Weights(cell, w);
        weights[y * columns + x] = (w[0] + w[1] + w[2] + w[3]) / 4 * size.x * size.y;
        rowIntegrals[y] += CellIntegral(cell);
      }
    }
  });
  table_ = Distribution2D(std::span<const double>(weights), static_cast<int>(columns), static_cast<int>(rows));
  Vec3d integral(0);
  for (const Vec3d& row : rowIntegrals) integral += row;
  integral_ = FiniteColor(integral);
}

Vec3d ProjectionMap::CellIntegral(const Vec2i& cell) const {
  // Gauss's three points both ways: cells are so small that cos^3 is a polynomial of degree 5 to 1e-9.
  constexpr double kAt[] = {0.1127016653792583, 0.5, 0.8872983346207417}, kWeight[] = {5. / 18, 8. / 18, 5. / 18};
  const Vec2d low = CornerOf(cell.x, cell.y), size = CellSize(cell);
  Color corners[4];
  for (int i = 0; i < 4; ++i) corners[i] = ColorAt(CornerOf(cell.x + (i & 1), cell.y + (i >> 1)));
  Vec3d sum(0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Vec2d s(kAt[i], kAt[j]);
      const double weight = kWeight[i] * kWeight[j] * SolidAngleDensity(low + s * size);
      const Color c = Bilinear(corners, s);
      sum += Vec3d(c.r, c.g, c.b) * weight;
    }
  }
  return sum * (size.x * size.y);
}

std::optional<Vec2d> ProjectionMap::OnPlane(const Vec3d& w) const {
  if (!(w.z > 0)) return std::nullopt;
  const Vec2d p(w.x / w.z, -w.y / w.z);
  if (!(std::abs(p.x) <= extent_.x && std::abs(p.y) <= extent_.y)) return std::nullopt;
  return p;
}

ProjectionMap::Place ProjectionMap::PlaceOf(const Vec2d& p) const {
  Place place;
  place.cell.x = FindCell(columns_, p.x, &place.s.x);
  place.cell.y = FindCell(rows_, p.y, &place.s.y);
  return place;
}

Color ProjectionMap::ColorAt(const Vec2d& p) const {
  const double x = (p.x / extent_.x + 1) / 2 * width_ - 0.5, y = (p.y / extent_.y + 1) / 2 * height_ - 0.5;
  const double x0 = std::floor(x), y0 = std::floor(y);
  const auto texel = [&](int dx, int dy) {
    const int i = std::clamp(static_cast<int>(x0) + dx, 0, width_ - 1);
    const int j = std::clamp(static_cast<int>(y0) + dy, 0, height_ - 1);
    return texels_[static_cast<size_t>(j) * static_cast<size_t>(width_) + static_cast<size_t>(i)];
  };
  return Bilinear({texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1)}, Vec2d(x - x0, y - y0));
}

void ProjectionMap::Weights(const Vec2i& cell, double (&w)[4]) const {
  for (int i = 0; i < 4; ++i) {
    const Vec2d corner = CornerOf(cell.x + (i & 1), cell.y + (i >> 1));
    w[i] = Importance(ColorAt(corner)) * SolidAngleDensity(corner);
  }
}

Color ProjectionMap::Radiance(const Vec3d& w) const {
  const std::optional<Vec2d> p = OnPlane(w);
  return p ? ColorAt(*p) : Color();
}

ProjectionValue ProjectionMap::Evaluate(const Vec3d& w) const {
  ProjectionValue value;
  const std::optional<Vec2d> p = OnPlane(w);
  if (!p || IsBlack()) return value;
  value.L = ColorAt(*p);
  const Place place = PlaceOf(*p);
  const double probability = table_.Probability(place.cell);
  if (probability == 0) return value;
  const Vec2d size = CellSize(place.cell);
  double weights[4];
  Weights(place.cell, weights);
  value.pdf = probability / (size.x * size.y) * BilinearPdf(place.s, weights) / SolidAngleDensity(*p);
  return value;
}

Vec3d ProjectionMap::Sample(const Vec2d& u) const {
  const DiscreteSample2D drawn = table_.SampleDiscrete(u);
  double weights[4];
  Weights(drawn.cell, weights);
  Vec2d p = CornerOf(drawn.cell.x, drawn.cell.y) + SampleBilinear(drawn.u, weights) * CellSize(drawn.cell);
  // So far from the edge that the direction, rounded to float, still meets the image.
  for (int axis = 0; axis < 2; ++axis) {
    const double inside = std::max(extent_[axis] - 2.5e-7 * (1 + p.x * p.x + p.y * p.y), extent_[axis] / 2);
    p[axis] = std::clamp(p[axis], -inside, inside);
  }
  return Normalize(Vec3d(p.x, -p.y, 1));
}

Vec2d ProjectionMap::Invert(const Vec3d& w) const {
  const Vec2d p(w.x / w.z, -w.y / w.z);
  const Place place = PlaceOf(p);
  if (table_.Probability(place.cell) == 0) return table_.InvertDiscrete(place.cell, Vec2d(0));
  double weights[4];
  Weights(place.cell, weights);
  return table_.InvertDiscrete(place.cell, InvertBilinear(place.s, weights));
}

TableUse ProjectionMap::Tables() const {
  if (IsBlack()) return {};
  return TableUse::Of(table_.MemoryBytes() + static_cast<int64_t>(texels_.size() * sizeof(Color) +
                                                                  (columns_.size() + rows_.size()) * sizeof(double)));
}

}  // namespace dapple
