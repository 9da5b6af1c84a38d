// How fast lights are chosen and sampled: one draw an iteration, random numbers from a table.
#include <cmath>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#include "lights/area_light.h"
#include "lights/environment_light.h"
#include "lights/light_picker.h"
#include "lights/point_light.h"
#include "lights/spot_light.h"
#include "src/geometry/sphere.h"
#include "src/geometry/triangle_mesh.h"

namespace dapple {
namespace {

/// Points of a rank-one lattice: spread over the square, in no order that a cache could like.
Vec2d Point(int i) {
  const double x = i * 0.7548776662466927, y = i * 0.5698402909980532;
  return {x - std::floor(x), y - std::floor(y)};
}

LeRandom EmissionNumbers(int i) {
  LeRandom u;
  u.part = Point(i + 7).y;
  u.position = Point(i);
  u.direction = Point(3 * i + 1);
  return u;
}

LiRandom DirectionNumbers(int i) { return {Point(i + 7).y, Point(i)}; }

Image Sky(int width) {
  Image image = Image::Rgb(width, width / 2);
  for (int y = 0; y < image.Height(); ++y) {
    for (int x = 0; x < width; ++x) image.SetColor(x, y, Color(0.5f + 0.5f * std::sin(static_cast<float>(x * y))));
  }
  image.SetColor(width / 3, width / 8, Color(10000));
  return image;
}

void EnvironmentBuild(benchmark::State& state) {
  const Image image = Sky(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    const EnvironmentMap map(image, EnvironmentMapping::LatLong, Color(1));
    benchmark::DoNotOptimize(map.Integral());
  }
}
BENCHMARK(EnvironmentBuild)->Arg(1024)->Arg(4096)->Unit(benchmark::kMillisecond);

void EnvironmentDirection(benchmark::State& state) {
  const EnvironmentLight light(Sky(static_cast<int>(state.range(0))), Transform(), Color(1),
                               EnvironmentMapping::LatLong);
  const LightContext at(Vec3(0));
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(light.Sample_Li(at, DirectionNumbers(i++)));
}
BENCHMARK(EnvironmentDirection)->Arg(64)->Arg(1024)->Arg(4096);

void EnvironmentLookup(benchmark::State& state) {
  const EnvironmentLight light(Sky(1024), Transform(), Color(1), EnvironmentMapping::LatLong);
  int i = 0;
  for (auto _ : state) {
    const Vec2d p = Point(i++);
    const Vec3 w = Normalize(Vec3(static_cast<float>(p.x) - 0.5f, static_cast<float>(p.y) - 0.5f, 0.25f));
    benchmark::DoNotOptimize(light.Le(Ray{Vec3(0), w}));
    benchmark::DoNotOptimize(light.Pdf_Li(LightContext(Vec3(0)), w, nullptr));
  }
}
BENCHMARK(EnvironmentLookup);

void EnvironmentRay(benchmark::State& state) {
  EnvironmentLight light(Sky(1024), Transform(), Color(1), EnvironmentMapping::LatLong);
  light.Prepare({Vec3(0), 1});
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(light.Sample_Le(EmissionNumbers(i++)));
}
BENCHMARK(EnvironmentRay);

void SpotRay(benchmark::State& state) {
  const SpotFalloff falloff = state.range(0) == 3 ? SpotFalloff::PbrtV3 : SpotFalloff::PbrtV4;
  const SpotLight light(Vec3(0), Vec3(0, 0, 1), Color(1), 30, 10, falloff);
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(light.Sample_Le(EmissionNumbers(i++)));
}
BENCHMARK(SpotRay)->Arg(3)->Arg(4);

void SphereDirection(benchmark::State& state) {
  const Sphere sphere(Transform::Translate({0, 0, 5}), false, 1);
  const AreaLight light(&sphere, Color(1), false);
  const LightContext at(Vec3(0));
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(light.Sample_Li(at, DirectionNumbers(i++)));
}
BENCHMARK(SphereDirection);

TriangleMesh Strip(int triangles) {
  std::vector<Vec3> positions;
  std::vector<int> indices;
  for (int i = 0; i < triangles + 2; ++i)
    positions.emplace_back(static_cast<float>(i / 2), static_cast<float>(i % 2), 0.f);
  for (int i = 0; i < triangles; ++i) indices.insert(indices.end(), {i, i + 1 + i % 2, i + 2 - i % 2});
  return TriangleMesh(std::move(positions), {}, {}, std::move(indices));
}

void MeshDirection(benchmark::State& state) {
  const TriangleMesh mesh = Strip(static_cast<int>(state.range(0)));
  const AreaLight light(&mesh, Color(1), true);
  const LightContext at(Vec3(0, 0, 5));
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(light.Sample_Li(at, DirectionNumbers(i++)));
}
BENCHMARK(MeshDirection)->Arg(2)->Arg(100000);

void MeshRay(benchmark::State& state) {
  const TriangleMesh mesh = Strip(static_cast<int>(state.range(0)));
  const AreaLight light(&mesh, Color(1), true);
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(light.Sample_Le(EmissionNumbers(i++)));
}
BENCHMARK(MeshRay)->Arg(2)->Arg(100000);

void PickFor(benchmark::State& state) {
  std::vector<std::unique_ptr<Light>> lights;
  for (int i = 0; i < state.range(0); ++i) {
    lights.push_back(std::make_unique<PointLight>(Vec3(static_cast<float>(i), 0, 1), Color(1)));
  }
  const LightPicker picker(lights);
  const LightContext at(Vec3(0), Vec3(0, 0, 1), false);
  int i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(picker.PickFor(at, Point(i++).x));
}
BENCHMARK(PickFor)->Arg(1)->Arg(4)->Arg(32)->Arg(100000);

}  // namespace
}  // namespace dapple
