#include "src/geometry/accelerator.h"

#include <atomic>
#include <mutex>
#include <string>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "src/base/error.h"
#include "src/base/parallel.h"
#include "src/geometry/affine.h"
#include "src/geometry/surface_math.h"
#include "src/geometry/triangle_mesh.h"

namespace dapple {
namespace {

/// Embree ignores what lies beyond this without a word.
constexpr float kLargestCoordinate = 1.8e18f;

/// The next higher one cuts triangles where that makes a better tree, and which threads cut first may decide which of
/// two triangles in one place is found. For robust scenes Embree 3 builds the same tree at both: it costs nothing.
constexpr RTCBuildQuality kBuildQuality = RTC_BUILD_QUALITY_MEDIUM;

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct ReleaseGeometry {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using SceneHandle = std::unique_ptr<RTCSceneTy, ReleaseScene>;
using GeometryHandle = std::unique_ptr<RTCGeometryTy, ReleaseGeometry>;

/// Embree's device, with its errors and its memory counted.
class Device {
 public:
  Device() : handle_(rtcNewDevice(kConfiguration)) {
    if (!handle_)
      throw Error(fmt::format("Embree does not start (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
    rtcSetDeviceErrorFunction(Handle(), OnError, this);
    rtcSetDeviceMemoryMonitorFunction(Handle(), OnMemory, this);
  }
  ~Device() { rtcSetDeviceErrorFunction(Handle(), nullptr, nullptr); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  RTCDevice Handle() const { return handle_.get(); }
  int64_t MemoryBytes() const { return memoryBytes_; }
  /// Throws what Embree has complained of since the last call.
  void Check() {
    const std::lock_guard lock(mutex_);
    if (error_.empty()) return;
    const std::string message = std::move(error_);
    error_.clear();
    throw Error(fmt::format("Embree cannot build the scene: {}", message));
  }

 private:
#ifdef DAPPLE_PORTABLE
  static constexpr const char* kConfiguration = "isa=avx2";  // the same arithmetic on every machine
#else
  static constexpr const char* kConfiguration = "";
#endif

  static void OnError(void* self, RTCError, const char* message) {
    auto* device = static_cast<Device*>(self);
    const std::lock_guard lock(device->mutex_);
    if (device->error_.empty()) device->error_ = message ? message : "unknown error";
  }
  static bool OnMemory(void* self, ssize_t bytes, bool) {
    static_cast<Device*>(self)->memoryBytes_ += bytes;
    return true;
  }

  std::mutex mutex_;
  std::string error_;
  std::atomic<int64_t> memoryBytes_ = 0;
  std::unique_ptr<RTCDeviceTy, ReleaseDevice> handle_;  // last: it reports to the others while it goes
};

/// Embree also takes hits at its nearest distance itself; rays here do not see what they start on.
constexpr float kNearest = std::numeric_limits<float>::min();

/// What callbacks learn of the ray beside Embree's own fields.
struct Context {
  explicit Context(const Ray& r) : ray(&r) { rtcInitIntersectContext(&embree); }
  RTCIntersectContext embree{};  // first, so that a pointer to it is a pointer to this
  const Ray* ray;
};

/// Embree's ray (in the space of the group), with the path's state.
Ray RayOf(const RTCRay& ray, const RTCIntersectContext* context) {
  const PathState& state = reinterpret_cast<const Context*>(context)->ray->state;
  return {{ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tfar, state};
}

/// The first hit that the entry's filter lets stand; count 0 where there is none.
PrimitiveHits FirstAccepted(const GeometryEntry& entry, const Ray& ray, unsigned primitive) {
  const PrimitiveHits all = entry.shape->IntersectAll(ray, static_cast<int>(primitive));
  for (int i = 0; i < all.count; ++i)
    if (!entry.filter || entry.filter->Accepts(*entry.shape, all.hits[i], ray)) return {1, {all.hits[i], {}}};
  return {};
}

void BoundShape(const RTCBoundsFunctionArguments* args) {
  const auto& entry = *static_cast<const GeometryEntry*>(args->geometryUserPtr);
  const Bounds3 bounds = entry.shape->PrimitiveBounds(static_cast<int>(args->primID));
  // Larger than rounding in the boxes' own intersection, which Embree does in float.
  constexpr float kMargin = 0x1p-20f;
  const Vec3 size = bounds.size();
  const auto margin = [&](int axis) {
    return kMargin * std::max({std::abs(bounds.min[axis]), std::abs(bounds.max[axis]), MaxAbsComponent(size)});
  };
  *args->bounds_o = {bounds.min.x - margin(0), bounds.min.y - margin(1), bounds.min.z - margin(2), 0,
                     bounds.max.x + margin(0), bounds.max.y + margin(1), bounds.max.z + margin(2), 0};
}

void IntersectShape(const RTCIntersectFunctionNArguments* args) {
  if (!args->valid[0]) return;
  const auto& entry = *static_cast<const GeometryEntry*>(args->geometryUserPtr);
  auto* rayHit = reinterpret_cast<RTCRayHit*>(args->rayhit);  // rays come one by one
  const PrimitiveHits found = FirstAccepted(entry, RayOf(rayHit->ray, args->context), args->primID);
  if (found.count == 0) return;
  rayHit->ray.tfar = found.hits[0].t;
  rayHit->hit.u = found.hits[0].b1;
  rayHit->hit.v = found.hits[0].b2;
  rayHit->hit.primID = args->primID;
  rayHit->hit.geomID = args->geomID;
  rayHit->hit.instID[0] = args->context->instID[0];
}

void OccludeShape(const RTCOccludedFunctionNArguments* args) {
  if (!args->valid[0]) return;
  const auto& entry = *static_cast<const GeometryEntry*>(args->geometryUserPtr);
  auto* ray = reinterpret_cast<RTCRay*>(args->ray);
  if (!entry.castsShadow) return;
  if (FirstAccepted(entry, RayOf(*ray, args->context), args->primID).count > 0) ray->tfar = -kInfinity;
}

void FilterTriangle(const RTCFilterFunctionNArguments* args) {
  const auto& entry = *static_cast<const GeometryEntry*>(args->geometryUserPtr);
  const Ray ray = RayOf(*reinterpret_cast<const RTCRay*>(args->ray), args->context);
  const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
  const PrimitiveHit primitiveHit = {ray.tMax, hit.u, hit.v, static_cast<int>(hit.primID)};
  if (!entry.filter->Accepts(*entry.shape, primitiveHit, ray)) args->valid[0] = 0;
}

void FilterAll(const RTCFilterFunctionNArguments* args) { args->valid[0] = 0; }

GeometryHandle MakeTriangles(RTCDevice device, const TriangleMesh& mesh, const GeometryEntry& entry) {
  GeometryHandle geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.VertexData(), 0,
                             mesh.VertexStride() * sizeof(float), static_cast<size_t>(mesh.VertexCount()));
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.Indices().data(), 0,
                             3 * sizeof(int), mesh.Indices().size() / 3);
  if (entry.filter) rtcSetGeometryIntersectFilterFunction(geometry.get(), FilterTriangle);
  if (entry.filter) rtcSetGeometryOccludedFilterFunction(geometry.get(), FilterTriangle);
  if (!entry.castsShadow) rtcSetGeometryOccludedFilterFunction(geometry.get(), FilterAll);
  return geometry;
}

/// `entry` must outlive the geometry.
GeometryHandle MakeGeometry(RTCDevice device, const GeometryEntry& entry) {
  GeometryHandle geometry;
  if (const auto* mesh = dynamic_cast<const TriangleMesh*>(entry.shape)) {
    geometry = MakeTriangles(device, *mesh, entry);
  } else {
    geometry.reset(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(entry.shape->PrimitiveCount()));
    rtcSetGeometryBoundsFunction(
        geometry.get(), [](const RTCBoundsFunctionArguments* args) { BoundShape(args); }, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), IntersectShape);
    rtcSetGeometryOccludedFunction(geometry.get(), OccludeShape);
  }
  rtcSetGeometryUserData(geometry.get(), const_cast<GeometryEntry*>(&entry));
  rtcSetGeometryBuildQuality(geometry.get(), kBuildQuality);
  rtcCommitGeometry(geometry.get());
  return geometry;
}

/// Throws where a vertex or bound is NaN, infinite or beyond what Embree takes.
void CheckFinite(const Shape& shape, int index) {
  constexpr int64_t kChunk = 1 << 14;
  std::atomic<bool> isFinite = true;
  ParallelForChunks(shape.PrimitiveCount(), kChunk, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
      const Bounds3 bounds = shape.PrimitiveBounds(static_cast<int>(i));
      for (int axis = 0; axis < 3; ++axis)
        if (!(bounds.min[axis] >= -kLargestCoordinate && bounds.max[axis] <= kLargestCoordinate)) isFinite = false;
    }
  });
  if (!isFinite)
    throw Error(fmt::format("shape {}: a position is not finite, or beyond {:.1g}: expected finite coordinates", index,
                            kLargestCoordinate));
}

/// A placed group: what turns an interaction of its space into one of render space.
class Placement {
 public:
  explicit Placement(const Transform& groupToRender)
      : groupToRender_(groupToRender), inverse_(groupToRender.Inverse()) {}

  void ToRender(const Bounds3& primitiveBounds, SurfaceInteraction* interaction) const;

 private:
  float PointError(const Vec3d& p, const Vec3d& n, const Vec3d& groupNormal, double normalLength, float groupError,
                   const Bounds3& primitiveBounds) const;

  Affine groupToRender_, inverse_;
};

/// Beside the shape's own error: Embree takes rays into the group's space in float, with a float inverse of its own, so
/// that it sees the surface where it is only to a few roundings of origin and translation.
float Placement::PointError(const Vec3d& p, const Vec3d& n, const Vec3d& groupNormal, double normalLength,
                            float groupError, const Bounds3& primitiveBounds) const {
  constexpr double kRoundings = 4;
  const double reach = Length(groupToRender_.Vector(ToDouble(primitiveBounds.size())));
  double transformed = 0;
  for (int i = 0; i < 3; ++i) {
    double sum = 0;
    for (int j = 0; j < 3; ++j)
      sum += std::abs(inverse_.At(i, j)) * (std::abs(p[j]) + std::abs(groupToRender_.translation[j]) + reach);
    transformed += std::abs(groupNormal[i]) * sum;
  }
  return RoundUp((groupError + kRoundings * kFloatRounding * transformed) / normalLength +
                 RoundingAlong(n, p, Vec3d(0)));
}

void Placement::ToRender(const Bounds3& primitiveBounds, SurfaceInteraction* interaction) const {
  const Vec3d groupNormal = ToDouble(interaction->ng);
  const Vec3d normal = inverse_.Transposed(groupNormal);
  const double normalLength = Length(normal);
  const Vec3d n = normal / normalLength;
  const Vec3d p = groupToRender_.Point(ToDouble(interaction->p));
  interaction->pError = PointError(p, n, groupNormal, normalLength, interaction->pError, primitiveBounds);
  interaction->p = ToFloat(p);
  interaction->ng = ToFloat(n);

  const Vec3d shadingNormal = inverse_.Transposed(ToDouble(interaction->ns));
  interaction->ns = ToFloat(Normalize(shadingNormal));
  for (Vec3* derivative : {&interaction->dndu, &interaction->dndv})
    *derivative = ToFloat(NormalizedDerivative(shadingNormal, inverse_.Transposed(ToDouble(*derivative))));
  for (Vec3* vector : {&interaction->dpdu, &interaction->dpdv, &interaction->dpdus, &interaction->dpdvs})
    *vector = ToFloat(groupToRender_.Vector(ToDouble(*vector)));
}

}  // namespace

struct Accelerator::State {
  Device device;
  std::vector<GeometryEntry> shapes;
  std::vector<GeometryGroup> groups;
  std::vector<GeometryInstance> instances;
  std::vector<Placement> placements;
  std::vector<int> topShapes;     ///< by Embree's number: the shapes that stand in the scene themselves
  std::vector<int> topInstances;  ///< after them: the instances
  std::vector<SceneHandle> groupScenes;
  SceneHandle scene;

  SceneHandle NewScene() const {
    SceneHandle handle(rtcNewScene(device.Handle()));
    rtcSetSceneFlags(handle.get(), RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(handle.get(), kBuildQuality);
    return handle;
  }
  SceneHandle BuildScene(const std::vector<int>& members);
  void BuildGroups();
  void BuildTop();
  void CheckInstanceScales() const;
  SurfaceInteraction Interact(const Ray& ray, const RTCRayHit& found) const;
};

SceneHandle Accelerator::State::BuildScene(const std::vector<int>& members) {
  SceneHandle handle = NewScene();
  for (size_t i = 0; i < members.size(); ++i)
    rtcAttachGeometryByID(handle.get(), MakeGeometry(device.Handle(), shapes[members[i]]).get(),
                          static_cast<unsigned>(i));
  return handle;
}

void Accelerator::State::BuildGroups() {
  for (const GeometryGroup& group : groups) {
    groupScenes.push_back(BuildScene(group.shapes));
    rtcCommitScene(groupScenes.back().get());
    device.Check();
  }
}

void Accelerator::State::BuildTop() {
  std::vector<char> isInGroup(shapes.size(), 0);
  for (const GeometryGroup& group : groups)
    for (const int index : group.shapes) isInGroup[index] = 1;
  for (size_t i = 0; i < shapes.size(); ++i)
    if (!isInGroup[i] && shapes[i].shape->PrimitiveCount() > 0) topShapes.push_back(static_cast<int>(i));

  scene = BuildScene(topShapes);
  for (size_t i = 0; i < instances.size(); ++i) {
    const Transform& transform = instances[i].groupToRender;
    if (transform.IsSingular())
      throw Error(instances[i].location, "the instance's transform is singular, expected one that can be inverted");
    GeometryHandle geometry(rtcNewGeometry(device.Handle(), RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(geometry.get(), groupScenes[instances[i].group].get());
    float columns[12];
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row) columns[3 * column + row] = static_cast<float>(transform.At(row, column));
    rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene.get(), geometry.get(), static_cast<unsigned>(topShapes.size() + topInstances.size()));
    topInstances.push_back(static_cast<int>(i));
  }
  rtcCommitScene(scene.get());
  device.Check();
  CheckInstanceScales();
}

// Embree takes rays into an instance's space in float and stops the program where they leave its range: instances so
// thin that rays of this scene would are refused.
void Accelerator::State::CheckInstanceScales() const {
  constexpr double kMaxReach = 1e16;
  RTCBounds box;
  rtcGetSceneBounds(scene.get(), &box);
  const double reach = std::max({std::abs(box.lower_x), std::abs(box.lower_y), std::abs(box.lower_z),
                                 std::abs(box.upper_x), std::abs(box.upper_y), std::abs(box.upper_z)});
  for (const int i : topInstances) {
    const Transform inverse = instances[i].groupToRender.Inverse();
    for (int row = 0; row < 3; ++row) {
      double extent = std::abs(inverse.At(row, 3));
      for (int column = 0; column < 3; ++column) extent += std::abs(inverse.At(row, column)) * reach;
      if (!(extent < kMaxReach))
        throw Error(
            instances[i].location,
            fmt::format("the instance is too flat in a scene that reaches {:.1g} far; expected scales above {:.1g}",
                        reach, reach / kMaxReach));
    }
  }
}

Accelerator::Accelerator(std::vector<GeometryEntry> shapes, std::vector<GeometryGroup> groups,
                         std::vector<GeometryInstance> instances)
    : state_(std::make_unique<State>()) {
  for (size_t i = 0; i < shapes.size(); ++i) CheckFinite(*shapes[i].shape, static_cast<int>(i));
  state_->shapes = std::move(shapes);
  state_->groups = std::move(groups);
  state_->instances = std::move(instances);
  for (const GeometryInstance& instance : state_->instances) state_->placements.emplace_back(instance.groupToRender);
  state_->BuildGroups();
  state_->BuildTop();
}

Accelerator::~Accelerator() = default;

SurfaceInteraction Accelerator::State::Interact(const Ray& ray, const RTCRayHit& found) const {
  const unsigned instanceId = found.hit.instID[0];
  const bool isInstanced = instanceId != RTC_INVALID_GEOMETRY_ID;
  const int instance = isInstanced ? topInstances[instanceId - topShapes.size()] : -1;
  const int index =
      isInstanced ? groups[instances[instance].group].shapes[found.hit.geomID] : topShapes[found.hit.geomID];
  const Shape& shape = *shapes[index].shape;
  const PrimitiveHit hit = {found.ray.tfar, found.hit.u, found.hit.v, static_cast<int>(found.hit.primID)};
  SurfaceInteraction interaction = shape.Interact(ray, hit);
  if (isInstanced) placements[instance].ToRender(shape.PrimitiveBounds(hit.primitive), &interaction);
  interaction.shape = index;
  interaction.instance = instance;
  interaction.state = ray.state;
  return interaction;
}

namespace {

/// Embree's own limit: it stops the program at rays beyond. They hit nothing.
bool IsTraceable(const Ray& ray) {
  constexpr float kLargest = 1.8e18f;
  return MaxAbsComponent(ray.o) < kLargest && MaxAbsComponent(ray.d) < kLargest && ray.tMax > 0;
}

}  // namespace

std::optional<SurfaceInteraction> Accelerator::Intersect(const Ray& ray) const {
  if (!IsTraceable(ray)) return std::nullopt;
  Context context(ray);
  RTCRayHit found{};
  found.ray = {ray.o.x, ray.o.y, ray.o.z, kNearest, ray.d.x, ray.d.y, ray.d.z, 0, ray.tMax, ~0u, 0, 0};
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  found.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(state_->scene.get(), &context.embree, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return state_->Interact(ray, found);
}

bool Accelerator::Occluded(const Ray& ray) const {
  if (!IsTraceable(ray)) return false;
  Context context(ray);
  RTCRay shadow = {ray.o.x, ray.o.y, ray.o.z, kNearest, ray.d.x, ray.d.y, ray.d.z, 0, ray.tMax, ~0u, 0, 0};
  rtcOccluded1(state_->scene.get(), &context.embree, &shadow);
  return shadow.tfar < 0;
}

Bounds3 Accelerator::Bounds() const {
  if (state_->topShapes.empty() && state_->topInstances.empty()) return {};
  RTCBounds bounds{};
  rtcGetSceneBounds(state_->scene.get(), &bounds);
  if (!(bounds.lower_x <= bounds.upper_x)) return {};
  return {{bounds.lower_x, bounds.lower_y, bounds.lower_z}, {bounds.upper_x, bounds.upper_y, bounds.upper_z}};
}

int64_t Accelerator::MemoryBytes() const { return state_->device.MemoryBytes(); }

}  // namespace dapple
