// Rays per second of `Accelerator` against bare Embree calls on the same rays: what Dapple's interaction, with its
// normals, derivatives and error bound, costs on top. Rays are coherent (a camera's) or incoherent (between random
// points of the surface); the bumpy mesh has 200,000 triangles; the 1,000 spheres are Embree's own in the bare scene.
#include <random>

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include "src/geometry/accelerator.h"
#include "src/geometry/sphere.h"
#include "src/geometry/triangle_mesh.h"

namespace dapple {
namespace {

constexpr int kRays = 1 << 16;

double Uniform(std::mt19937_64* engine) { return static_cast<double>((*engine)() >> 11) * 0x1p-53; }

/// A unit ball with bumps: 2 * 316^2 triangles with vertex normals and uvs.
TriangleMesh BumpyBall() {
  constexpr int kSteps = 316;
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uvs;
  std::vector<int> indices;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const double theta = kPiD * i / kSteps, phi = 2 * kPiD * j / kSteps;
      const Vec3d n(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      positions.push_back(ToFloat(n * (1 + 0.03 * std::sin(20 * theta) * std::sin(30 * phi))));
      normals.push_back(ToFloat(n));
      uvs.push_back({static_cast<float>(j) / kSteps, static_cast<float>(i) / kSteps});
    }
  }
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const int a = i * (kSteps + 1) + j, b = a + 1, c = a + kSteps + 1, d = c + 1;
      indices.insert(indices.end(), {a, c, d, a, d, b});
    }
  }
  return {positions, normals, uvs, indices};
}

struct Ball {
  Vec3d centre;
  double radius;
};

std::vector<Ball> Balls() {
  std::mt19937_64 engine(1);
  std::vector<Ball> balls;
  for (int i = 0; i < 1000; ++i) {
    const double x = Uniform(&engine), y = Uniform(&engine), z = Uniform(&engine);
    balls.push_back({Vec3d(x, y, z) * 2.0 - Vec3d(1), 0.03 + 0.05 * Uniform(&engine)});
  }
  return balls;
}

std::vector<Ray> CoherentRays() {
  std::vector<Ray> rays;
  constexpr int kSide = 256;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const Vec3d d(2.4 * (x + 0.5) / kSide - 1.2, 2.4 * (y + 0.5) / kSide - 1.2, -3);
      rays.push_back({{0, 0, 4}, ToFloat(Normalize(d)), kInfinity, {}});
    }
  return rays;
}

/// Between random points of the ball of radius 1.5, so that most cross what stands inside.
std::vector<Ray> IncoherentRays() {
  std::mt19937_64 engine(2);
  const auto point = [&] {
    const double z = 2 * Uniform(&engine) - 1, phi = 2 * kPiD * Uniform(&engine), r = std::sqrt(1 - z * z);
    return Vec3d(r * std::cos(phi), r * std::sin(phi), z) * 1.5;
  };
  std::vector<Ray> rays;
  for (int i = 0; i < kRays; ++i) {
    const Vec3d o = point();
    rays.push_back({ToFloat(o), ToFloat(Normalize(point() - o)), kInfinity, {}});
  }
  return rays;
}

std::vector<Ray> Rays(bool isCoherent) { return isCoherent ? CoherentRays() : IncoherentRays(); }

/// A bare scene of Embree with the flags that `Accelerator` uses.
class BareScene {
 public:
  BareScene() : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
  }
  ~BareScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  BareScene(const BareScene&) = delete;
  BareScene& operator=(const BareScene&) = delete;

  void Add(const TriangleMesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.VertexData(), 0,
                               mesh.VertexStride() * sizeof(float), static_cast<size_t>(mesh.VertexCount()));
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.Indices().data(), 0,
                               3 * sizeof(int), mesh.Indices().size() / 3);
    Attach(geometry);
  }
  void Add(const std::vector<Ball>& balls) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                                               4 * sizeof(float), balls.size()));
    for (const Ball& ball : balls) {
      for (int axis = 0; axis < 3; ++axis) *vertex++ = static_cast<float>(ball.centre[axis]);
      *vertex++ = static_cast<float>(ball.radius);
    }
    Attach(geometry);
  }
  void Commit() { rtcCommitScene(scene_); }

  bool Intersect(const Ray& ray, RTCRayHit* found) const {
    RTCIntersectContext context{};
    rtcInitIntersectContext(&context);
    found->ray = {ray.o.x, ray.o.y, ray.o.z, 0, ray.d.x, ray.d.y, ray.d.z, 0, ray.tMax, ~0u, 0, 0};
    found->hit.geomID = RTC_INVALID_GEOMETRY_ID;
    found->hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, found);
    return found->hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  bool Occluded(const Ray& ray) const {
    RTCIntersectContext context{};
    rtcInitIntersectContext(&context);
    RTCRay shadow = {ray.o.x, ray.o.y, ray.o.z, 0, ray.d.x, ray.d.y, ray.d.z, 0, ray.tMax, ~0u, 0, 0};
    rtcOccluded1(scene_, &context, &shadow);
    return shadow.tfar < 0;
  }

 private:
  void Attach(RTCGeometry geometry) {
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }

  RTCDevice device_;
  RTCScene scene_;
};

/// Calls `trace` (true: a hit) for one ray after another and counts rays per second.
template <typename Trace>
void Measure(benchmark::State& state, const std::vector<Ray>& rays, Trace trace) {
  int64_t hits = 0, count = 0;
  for ([[maybe_unused]] auto _ : state) {
    for (const Ray& ray : rays) hits += trace(ray) ? 1 : 0;
    count += static_cast<int64_t>(rays.size());
  }
  state.SetItemsProcessed(count);
  state.counters["hit share"] = static_cast<double>(hits) / static_cast<double>(count);
}

std::vector<std::unique_ptr<Shape>> Shapes(bool isMesh) {
  std::vector<std::unique_ptr<Shape>> shapes;
  if (isMesh) {
    shapes.push_back(std::make_unique<TriangleMesh>(BumpyBall()));
    return shapes;
  }
  for (const Ball& ball : Balls())
    shapes.push_back(std::make_unique<Sphere>(Transform::Translate(ball.centre), false, ball.radius));
  return shapes;
}

void BM_Dapple(benchmark::State& state, bool isMesh, bool isCoherent, bool isShadow) {
  const auto shapes = Shapes(isMesh);
  std::vector<GeometryEntry> entries;
  entries.reserve(shapes.size());
  for (const auto& shape : shapes) entries.push_back({shape.get()});
  const Accelerator accelerator(entries, {}, {});
  Measure(state, Rays(isCoherent), [&](const Ray& ray) {
    if (isShadow) return accelerator.Occluded(ray);
    const auto found = accelerator.Intersect(ray);
    benchmark::DoNotOptimize(found);
    return found.has_value();
  });
}

void BM_Embree(benchmark::State& state, bool isMesh, bool isCoherent, bool isShadow) {
  const TriangleMesh mesh = BumpyBall();
  BareScene scene;
  if (isMesh) {
    scene.Add(mesh);
  } else {
    scene.Add(Balls());
  }
  scene.Commit();
  Measure(state, Rays(isCoherent), [&](const Ray& ray) {
    if (isShadow) return scene.Occluded(ray);
    RTCRayHit found{};
    const bool isHit = scene.Intersect(ray, &found);
    benchmark::DoNotOptimize(found);
    return isHit;
  });
}

/// Bare Embree, and the least that any shading reads of a hit: its vertices, here for a normal. What this costs beyond
/// BM_Embree is waiting for memory.
void BM_EmbreeAndVertices(benchmark::State& state, bool isCoherent) {
  const TriangleMesh mesh = BumpyBall();
  BareScene scene;
  scene.Add(mesh);
  scene.Commit();
  Measure(state, Rays(isCoherent), [&](const Ray& ray) {
    RTCRayHit found{};
    if (!scene.Intersect(ray, &found)) return false;
    const int* corner = &mesh.Indices()[3 * static_cast<size_t>(found.hit.primID)];
    const Vec3 p0 = mesh.Position(corner[0]), p1 = mesh.Position(corner[1]), p2 = mesh.Position(corner[2]);
    benchmark::DoNotOptimize(Normalize(Cross(p1 - p0, p2 - p0)));
    return true;
  });
}

BENCHMARK_CAPTURE(BM_EmbreeAndVertices, mesh_coherent, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(BM_EmbreeAndVertices, mesh_incoherent, false)->Unit(benchmark::kMillisecond);

#define DAPPLE_RAY_BENCH(name, isMesh, isCoherent, isShadow)                                       \
  BENCHMARK_CAPTURE(BM_Embree, name, isMesh, isCoherent, isShadow)->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(BM_Dapple, name, isMesh, isCoherent, isShadow)->Unit(benchmark::kMillisecond)

DAPPLE_RAY_BENCH(mesh_coherent, true, true, false);
DAPPLE_RAY_BENCH(mesh_incoherent, true, false, false);
DAPPLE_RAY_BENCH(mesh_incoherent_shadow, true, false, true);
DAPPLE_RAY_BENCH(spheres_coherent, false, true, false);
DAPPLE_RAY_BENCH(spheres_incoherent, false, false, false);
DAPPLE_RAY_BENCH(spheres_incoherent_shadow, false, false, true);

}  // namespace
}  // namespace dapple
