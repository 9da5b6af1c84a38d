// The ray tracer: Embree behind one file, so that another version can take its place.
//
// Built once from shapes and instances, immutable, shared by all threads. Triangle meshes are traced by Embree itself,
// all other shapes through `Shape::Intersect`.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "src/base/error.h"
#include "src/geometry/shape.h"

namespace dapple {

/// Decides at a hit whether the surface is there, as an alpha texture does. Called from many threads.
class HitFilter {
 public:
  virtual ~HitFilter() = default;
  /// False: the ray goes on as if the surface had a hole there. A pure function of its arguments.
  virtual bool Accepts(const Shape& shape, const PrimitiveHit& hit, const Ray& ray) const = 0;
};

/// One shape as the accelerator takes it; nothing is owned.
struct GeometryEntry {
  const Shape* shape = nullptr;
  const HitFilter* filter = nullptr;  ///< null: opaque everywhere
  bool castsShadow = true;            ///< false: `Occluded` does not see it
};

/// A set of shapes, by index, that stands in the scene once for each instance.
struct GeometryGroup {
  std::vector<int> shapes;
};

struct GeometryInstance {
  int group = 0;
  Transform groupToRender;
  FileLocation location = {};  ///< for messages
};

class Accelerator {
 public:
  /// `shapes` that belong to no group stand in the scene themselves; others only through `instances`.
  /// Throws `Error` where Embree fails (memory), the geometry is not finite, or an instance is too flat to be traced.
  Accelerator(std::vector<GeometryEntry> shapes, std::vector<GeometryGroup> groups,
              std::vector<GeometryInstance> instances);
  ~Accelerator();
  Accelerator(const Accelerator&) = delete;
  Accelerator& operator=(const Accelerator&) = delete;

  /// The nearest surface along the ray, ready for shading.
  std::optional<SurfaceInteraction> Intersect(const Ray& ray) const;
  /// True where anything that casts shadows lies between 0 and tMax.
  bool Occluded(const Ray& ray) const;

  /// Of all that can be hit; empty where there is nothing.
  Bounds3 Bounds() const;
  /// Bytes that Embree holds.
  int64_t MemoryBytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace dapple
