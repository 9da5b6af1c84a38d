#include "lights/emission_disk.h"

#include "src/sampling/warps.h"

namespace dapple {

EmissionDisk::EmissionDisk(const SceneExtent& extent, const Vec3& w)
    // A little farther out than the sphere around the scene, so that a point in which they touch is still ahead.
    : center(extent.center + w * (extent.radius * 1.001f)),
      frame(Frame::FromZ(w)),
      radius(extent.radius),
      area(kPiD * Sqr(static_cast<double>(extent.radius))) {}

Vec3 EmissionDisk::Sample(const Vec2d& u) const {
  const Vec2d d = SampleDiskConcentric(u) * static_cast<double>(radius);
  return ToFloat(ToDouble(center) + ToDouble(frame.s) * d.x + ToDouble(frame.t) * d.y);
}

double EmissionDisk::Pdf(const Vec3& p) const {
  const double margin = 1e-5 + 1e-6 * static_cast<double>(Length(center) / radius);
  return Project(p).length() <= 1 + margin ? 1 / area : 0;
}

Vec2d EmissionDisk::Invert(const Vec3& p) const {
  const Vec2d d = Project(p);
  return InvertDiskConcentric(d / std::max(1.0, d.length()));
}

Vec2d EmissionDisk::Project(const Vec3& p) const {
  const Vec3d offset = (ToDouble(p) - ToDouble(center)) / static_cast<double>(radius);
  return {Dot(offset, ToDouble(frame.s)), Dot(offset, ToDouble(frame.t))};
}

}  // namespace dapple
