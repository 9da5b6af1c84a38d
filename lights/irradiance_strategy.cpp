#include "lights/irradiance_strategy.h"

#include <algorithm>
#include <cmath>

#include "src/base/numerics.h"
#include "src/base/octahedral.h"
#include "src/base/parallel.h"

namespace dapple {

namespace {

/// At most so many groups, and so many bins of normals along a side of the octahedral square.
constexpr Vec2i kMostGroups(32, 16);
constexpr int kBinsAcross = 16;

/// Near the horizon a group counts with so much of the largest cosine that there may be.
constexpr double kLeastShare = 0.25;

int BinAlong(float x) { return std::clamp(static_cast<int>((x + 1) / 2 * kBinsAcross), 0, kBinsAcross - 1); }

/// The bin of a normal of any length but zero.
size_t BinOf(const Vec3d& n) {
  const Vec2 p = OctahedralSquare(ToFloat(n));
  return static_cast<size_t>(BinAlong(p.y) * kBinsAcross + BinAlong(p.x));
}

double AngleBetween(const Vec3d& a, const Vec3d& b) { return 2 * std::asin(std::min(1.0, Length(a - b) / 2)); }

}  // namespace

IrradianceStrategy::IrradianceStrategy(const EnvironmentSpace& space) : space_(space) {
  const Vec2i cells = space.map.Cells();
  groupSize_ = {(cells.x + kMostGroups.x - 1) / kMostGroups.x, (cells.y + kMostGroups.y - 1) / kMostGroups.y};
  groups_ = {(cells.x + groupSize_.x - 1) / groupSize_.x, (cells.y + groupSize_.y - 1) / groupSize_.y};
  FillRows();
  FillBins();
}

void IrradianceStrategy::FillRows() {
  const Distribution2D& table = space_.map.Density().table;
  rows_.resize(static_cast<size_t>(groups_.x * groups_.y));
  ParallelFor(groups_.y, [&](int64_t y) {
    const int first = static_cast<int>(y) * groupSize_.y, last = std::min(first + groupSize_.y, table.Height());
    for (int x = 0; x < groups_.x; ++x) {
      const Vec2i group(x, static_cast<int>(y)), columns = ColumnsOf(group);
      std::vector<double> weights;
      for (int row = first; row < last; ++row) weights.push_back(table.RowShare(row, columns.x, columns.y));
      rows_[IndexOf(group)] = Distribution1D(std::span<const double>(weights));
    }
  });
}

IrradianceStrategy::Cone IrradianceStrategy::ConeOf(const Vec2i& group, const std::vector<double>& cellWeights) const {
  const Vec2i cells = space_.map.Cells(), columns = ColumnsOf(group);
  const int first = group.y * groupSize_.y, last = std::min(first + groupSize_.y, cells.y);
  std::vector<Vec3d> directions;
  Vec3d sum(0);
  for (int y = first; y < last; ++y)
    for (int x = columns.x; x < columns.y; ++x) {
      const double weight = cellWeights[static_cast<size_t>(y) * static_cast<size_t>(cells.x) + static_cast<size_t>(x)];
      if (weight == 0) continue;
      directions.push_back(space_.map.DirectionOf({x, y}, {0.5, 0.5}));
      sum += directions.back() * weight;
    }
  Cone cone;
  // What cancels out lies all around: no axis is better than another then.
  cone.axis = LengthSquared(sum) > 0 ? Normalize(sum) : Vec3d(0, 0, 1);
  for (const Vec3d& w : directions) cone.radius = std::max(cone.radius, AngleBetween(cone.axis, w));
  // And from the middle of a cell to its end: no cell of the group reaches much farther than the largest at its
  // corners.
  double reach = 0;
  for (int y : {first, last - 1})
    for (int x : {columns.x, columns.y - 1})
      for (double sx : {0., 1.})
        for (double sy : {0., 1.})
          reach = std::max(reach, AngleBetween(space_.map.DirectionOf({x, y}, {0.5, 0.5}),
                                               space_.map.DirectionOf({x, y}, {sx, sy})));
  cone.radius += 1.25 * reach;
  return cone;
}

void IrradianceStrategy::FillBins() {
  const std::vector<double> cellWeights = space_.map.CellWeights(0);
  std::vector<Cone> cones(rows_.size());
  ParallelFor(groups_.y, [&](int64_t y) {
    for (int x = 0; x < groups_.x; ++x) {
      const Vec2i group(x, static_cast<int>(y));
      if (LightOf(group) > 0) cones[IndexOf(group)] = ConeOf(group, cellWeights);
    }
  });
  bins_.resize(kBinsAcross * kBinsAcross);
  ParallelFor(static_cast<int64_t>(bins_.size()), [&](int64_t bin) {
    const int index = static_cast<int>(bin);
    const auto corner = [&](double x, double y) {
      const auto along = [](double i) { return static_cast<float>(2 * i / kBinsAcross - 1); };
      return ToDouble(OctahedralDirection({along(index % kBinsAcross + x), along(index / kBinsAcross + y)}));
    };
    Cone normals{corner(0.5, 0.5)};
    for (double x : {0., 0.5, 1.})
      for (double y : {0., 0.5, 1.})
        normals.radius = std::max(normals.radius, AngleBetween(normals.axis, corner(x, y)));
    normals.radius *= 1.05;
    std::vector<double> weights(cones.size());
    for (int y = 0; y < groups_.y; ++y)
      for (int x = 0; x < groups_.x; ++x) {
        const Cone& light = cones[IndexOf({x, y})];
        const double angle = AngleBetween(normals.axis, light.axis);
        // No direction is nearer to a normal: above the horizon of some of them there is light while this is.
        const double least = std::max(0.0, angle - normals.radius - light.radius);
        if (least >= kPiD / 2) continue;
        weights[IndexOf({x, y})] = LightOf({x, y}) * std::max(std::cos(angle), kLeastShare * std::cos(least));
      }
    bins_[static_cast<size_t>(index)] = Distribution2D(std::span<const double>(weights), groups_.x, groups_.y);
  });
}

const Distribution2D* IrradianceStrategy::TableFor(const LightContext& at) const {
  if (at.transmissive || LengthSquared(at.n) == 0) return nullptr;
  const Distribution2D& table = bins_[BinOf(space_.frame.ToLight(at.n))];
  return table.IsZero() ? nullptr : &table;
}

Vec3 IrradianceStrategy::Sample(const LightContext& at, const LiRandom& u) const {
  const Distribution2D* const table = TableFor(at);
  if (!table) return space_.Sample(space_.map.Density(), u);
  const DiscreteSample2D group = table->SampleDiscrete(u.direction);
  const DiscreteSample row = rows_[IndexOf(group.cell)].SampleDiscrete(group.u.y);
  const int y = group.cell.y * groupSize_.y + row.index;
  const Vec2i columns = ColumnsOf(group.cell);
  const DiscreteSample column = space_.map.Density().table.SampleRow(y, columns.x, columns.y, group.u.x);
  const Vec2i cell(column.index, y);
  return space_.frame.ToRender(space_.map.DirectionOf(cell, space_.map.SampleInCell(cell, Vec2d(column.u, row.u))));
}

double IrradianceStrategy::Pdf(const LightContext& at, const Vec3&, const EnvironmentPlace& place) const {
  const double byRadiance = space_.Pdf(space_.map.Density(), place);
  const Distribution2D* const table = TableFor(at);
  if (!table || byRadiance == 0) return byRadiance;
  const Vec2i group = GroupOf(place.cell);
  return byRadiance * (table->Probability(group) / LightOf(group));
}

LiRandom IrradianceStrategy::Invert(const LightContext& at, const Vec3& wi) const {
  const Distribution2D* const table = TableFor(at);
  if (!table) return space_.Invert(space_.map.Density(), wi);
  LiRandom u;
  const EnvironmentPlace place = space_.map.PlaceOf(space_.frame.ToLight(wi));
  if (space_.Pdf(space_.map.Density(), place) == 0) return u;
  const Vec2i group = GroupOf(place.cell), columns = ColumnsOf(group);
  const Vec2d inCell = space_.map.InvertInCell(place.cell, place.s);
  const double x = space_.map.Density().table.InvertRow(place.cell, columns.x, columns.y, inCell.x);
  const double y = rows_[IndexOf(group)].InvertDiscrete(place.cell.y - group.y * groupSize_.y, inCell.y);
  u.direction = table->InvertDiscrete(group, {x, y});
  return u;
}

TableUse IrradianceStrategy::Tables() const {
  int64_t bytes = 0;
  for (const Distribution1D& rows : rows_) bytes += rows.MemoryBytes();
  for (const Distribution2D& bin : bins_) bytes += bin.MemoryBytes();
  return TableUse::Of(bytes);
}

}  // namespace dapple
