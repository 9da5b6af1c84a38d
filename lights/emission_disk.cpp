#include "lights/emission_disk.h"

#include "src/base/frame.h"
#include "src/base/parallel.h"
#include "src/geometry/outline.h"
#include "src/sampling/warps.h"

namespace dapple {

namespace {

constexpr int kCells = 32;  // of the grid, along each edge of a side of the cube
/// By what share of a radius a circle may be too large where there is one for each direction of the grid, and where
/// there is one for all emission.
constexpr double kTolerance = 5e-4, kSmallestTolerance = 1e-6;

/// The margin of all disks: 16 roundings to float of the scene's largest coordinate. Hits are floats, off the surface
/// by a few roundings, and so are the origins of emitted rays.
double MarginOf(const SceneExtent& extent) {
  return 0x1p-20 * (static_cast<double>(MaxAbsComponent(extent.center)) + static_cast<double>(extent.radius));
}

/// The disk around the line through `axis` along the unit vector `w`.
EmissionDisk DiskAround(const Vec3d& axis, double radius, const Vec3d& w, const Vec3d& sphereCenter,
                        double sphereRadius, double margin) {
  EmissionDisk disk;
  // A little farther out than the sphere around the scene, so that a point in which they touch is still ahead.
  const double out = Dot(sphereCenter - axis, w) + 1.001 * sphereRadius + 2 * margin;
  disk.center = axis + w * out;
  CoordinateSystem(w, &disk.s, &disk.t);
  disk.radius = radius + margin;
  disk.rounding = margin;
  return disk;
}

/// Where a direction meets the cube [-1, 1]^3.
struct CubePlace {
  int side = 0;      ///< 0, 1, 2: x, y or z is the largest component
  double scale = 1;  ///< that component: w is `scale` times a point of the side where it is 1
  Vec2d p;           ///< the other two components of that point, in cyclic order
};

CubePlace PlaceOf(const Vec3d& w) {
  const double x = std::abs(w.x), y = std::abs(w.y), z = std::abs(w.z);
  const int side = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
  const double scale = w[side];
  return {side, scale, {w[(side + 1) % 3] / scale, w[(side + 2) % 3] / scale}};
}

/// The point of a side at p.
Vec3d CubePoint(int side, const Vec2d& p) {
  Vec3d q(0);
  q[side] = 1, q[(side + 1) % 3] = p.x, q[(side + 2) % 3] = p.y;
  return q;
}

size_t GridIndex(int side, int row, int column) {
  return static_cast<size_t>((side * (kCells + 1) + row) * (kCells + 1) + column);
}

double GridLine(int i) { return 2.0 * i / kCells - 1; }

}  // namespace

double EmissionDisk::Area() const { return kPiD * Sqr(radius); }

Vec3 EmissionDisk::Sample(const Vec2d& u) const {
  const Vec2d d = SampleDiskConcentric(u) * radius;
  return ToFloat(center + s * d.x + t * d.y);
}

double EmissionDisk::Pdf(const Vec3& p) const {
  constexpr double kPointRounding = 0x1p-22;
  const double limit = radius + rounding + kPointRounding * static_cast<double>(MaxAbsComponent(p));
  return Project(p).length2() <= Sqr(limit) ? 1 / Area() : 0;
}

Vec2d EmissionDisk::Invert(const Vec3& p) const {
  const Vec2d d = Project(p) / radius;
  return InvertDiskConcentric(d / std::max(1.0, d.length()));
}

Vec2d EmissionDisk::Project(const Vec3& p) const {
  const Vec3d offset = ToDouble(p) - center;
  return {Dot(offset, s), Dot(offset, t)};
}

EmissionDisks::EmissionDisks(const SceneExtent& extent)
    : center_(ToDouble(extent.center)), sphereRadius_(extent.radius), margin_(MarginOf(extent)) {
  if (extent.outline && !extent.outline->IsEmpty()) FillGrid(*extent.outline);
}

void EmissionDisks::FillGrid(const Outline& outline) {
  grid_.resize(GridIndex(3, 0, 0));
  ParallelFor(3 * (kCells + 1), [&](int64_t line) {
    const int side = static_cast<int>(line) / (kCells + 1), row = static_cast<int>(line) % (kCells + 1);
    for (int column = 0; column <= kCells; ++column) {
      const Vec3d q = CubePoint(side, {GridLine(column), GridLine(row)});
      const double length = Length(q);
      const EnclosingCylinder cylinder = outline.CylinderAlong(q / length, kTolerance);
      grid_[GridIndex(side, row, column)] = {Cross(cylinder.center - center_, q), cylinder.radius * length};
    }
  });
}

EmissionDisks::Cylinder EmissionDisks::Along(const Vec3d& w) const {
  if (grid_.empty()) return {Vec3d(0), sphereRadius_};
  const CubePlace place = PlaceOf(w);
  const Vec2d p = (place.p + Vec2d(1)) * (0.5 * kCells);
  const int column = std::min(static_cast<int>(p.x), kCells - 1), row = std::min(static_cast<int>(p.y), kCells - 1);
  const double x = p.x - column, y = p.y - row;
  const Cylinder* const low = &grid_[GridIndex(place.side, row, column)];
  const Cylinder* const high = &grid_[GridIndex(place.side, row + 1, column)];
  // The four weights give the point of the side as the mean of the corners, as the proof wants it.
  const double weights[4] = {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
  const Vec3d moment = low[0].moment * weights[0] + low[1].moment * weights[1] + high[0].moment * weights[2] +
                       high[1].moment * weights[3];
  const double radius = low[0].radius * weights[0] + low[1].radius * weights[1] + high[0].radius * weights[2] +
                        high[1].radius * weights[3];
  return {moment * place.scale, radius * std::abs(place.scale)};
}

EmissionDisk EmissionDisks::Toward(const Vec3& w) const {
  const Vec3d unit = Normalize(ToDouble(w));
  const Cylinder cylinder = Along(unit);
  // The point of the axis nearest to the centre.
  return DiskAround(center_ + Cross(unit, cylinder.moment), cylinder.radius, unit, center_, sphereRadius_, margin_);
}

double EmissionDisks::Area(const Vec3d& w) const { return kPiD * Sqr(Along(w).radius + margin_); }

// Over the sides of the cube, with a solid angle of dA / |q|^3, by the 3 x 3 points of Gauss in each cell.
double EmissionDisks::AreaIntegral() const {
  if (grid_.empty()) return 4 * kPiD * Area({0, 0, 1});
  constexpr double kNodes[3] = {-0.7745966692414834, 0, 0.7745966692414834};
  constexpr double kWeights[3] = {5. / 9, 8. / 9, 5. / 9};
  constexpr double kHalf = 1.0 / kCells;
  double sum = 0;
  for (int side = 0; side < 3; ++side)
    for (int cell = 0; cell < kCells * kCells; ++cell)
      for (int i = 0; i < 9; ++i) {
        const Vec2d p(GridLine(cell % kCells) + kHalf * (1 + kNodes[i % 3]),
                      GridLine(cell / kCells) + kHalf * (1 + kNodes[i / 3]));
        const Vec3d q = CubePoint(side, p);
        const double length = Length(q);
        sum += kWeights[i % 3] * kWeights[i / 3] * Area(q / length) / (length * length * length);
      }
  return 2 * sum * Sqr(kHalf);
}

EmissionDisk EmissionDisks::Smallest(const SceneExtent& extent, const Vec3& w) {
  const Vec3d unit = Normalize(ToDouble(w)), center = ToDouble(extent.center);
  EnclosingCylinder cylinder{center, static_cast<double>(extent.radius)};
  if (extent.outline && !extent.outline->IsEmpty()) cylinder = extent.outline->CylinderAlong(unit, kSmallestTolerance);
  return DiskAround(cylinder.center, cylinder.radius, unit, center, static_cast<double>(extent.radius),
                    MarginOf(extent));
}

}  // namespace dapple
