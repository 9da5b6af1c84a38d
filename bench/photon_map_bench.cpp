// Building and querying the photon map: the forest of Dapple against one nanoflann tree over the same photons.
//
// Photons lie on the walls of a box, with a dense caustic on its floor. Gathers stand at photons' places, in the order
// in which a picture's tiles ask for them (ordered) or at random; their radius gives about the stated number of
// photons.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <tuple>

#include <benchmark/benchmark.h>

#include "src/photons/photon_forest.h"

namespace dapple {
namespace {

std::vector<Vec3> BoxPhotons(size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::normal_distribution<float> normal(0, 0.05f);
  std::vector<Vec3> points(count);
  for (size_t i = 0; i < count; ++i) {
    const float u = uniform(random), v = uniform(random);
    switch (i % 6) {
      case 0:
        points[i] = {-1, u, v};
        break;
      case 1:
        points[i] = {1, u, v};
        break;
      case 2:
        points[i] = {u, 1, v};
        break;
      case 3:
        points[i] = {u, v, 1};
        break;
      case 4:
        points[i] = {u, v, -1};
        break;
      default:
        points[i] = {0.4f + normal(random), normal(random), -1};
    }
  }
  return points;
}

struct Cloud {
  const Vec3* points;
  size_t count;
  size_t kdtree_get_point_count() const { return count; }
  float kdtree_get_pt(uint32_t i, int axis) const { return points[i][axis]; }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using SingleTree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud, float, uint32_t>,
                                                       Cloud, 3, uint32_t>;

struct Accumulate {
  float radiusSquared;
  double sum = 0;
  int64_t found = 0;
  float worstDist() const { return radiusSquared; }
  bool full() const { return true; }
  bool addPoint(float distanceSquared, uint32_t) {
    sum += distanceSquared;
    ++found;
    return true;
  }
};

/// Places to gather at: a random choice of the photons, in tiles of a picture or shuffled.
std::vector<Vec3> GatherPlaces(const std::vector<Vec3>& photons, bool ordered) {
  constexpr size_t kPlaces = 20000;
  std::vector<Vec3> places;
  std::mt19937 random(2);
  std::sample(photons.begin(), photons.end(), std::back_inserter(places), kPlaces, random);
  if (ordered) {
    const auto cell = [](float x) { return std::floor(x * 16); };
    std::sort(places.begin(), places.end(), [&](const Vec3& a, const Vec3& b) {
      return std::tuple(cell(a.z), cell(a.y), cell(a.x), a.z, a.y, a.x) <
             std::tuple(cell(b.z), cell(b.y), cell(b.x), b.z, b.y, b.x);
    });
  } else {
    std::shuffle(places.begin(), places.end(), random);
  }
  return places;
}

/// The radius of a disk on a wall that holds about `wanted` of the photons (a sixth on each wall of area 4).
float RadiusFor(size_t count, double wanted) {
  return static_cast<float>(std::sqrt(wanted / (static_cast<double>(count) / 6 / 4 * 3.14159265)));
}

void BuildForest(benchmark::State& state) {
  const std::vector<Vec3> photons = BoxPhotons(static_cast<size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(PhotonForest(photons));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void BuildSingleTree(benchmark::State& state) {
  const std::vector<Vec3> photons = BoxPhotons(static_cast<size_t>(state.range(0)));
  const Cloud cloud{photons.data(), photons.size()};
  for (auto _ : state) benchmark::DoNotOptimize(std::make_unique<SingleTree>(3, cloud));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void GatherForest(benchmark::State& state) {
  const std::vector<Vec3> photons = BoxPhotons(static_cast<size_t>(state.range(0)));
  const float radius = RadiusFor(photons.size(), static_cast<double>(state.range(1)));
  const std::vector<Vec3> places = GatherPlaces(photons, state.range(2) != 0);
  const PhotonForest forest(photons);
  int64_t found = 0;
  double sum = 0;
  for (auto _ : state)
    for (const Vec3& p : places)
      forest.ForEachWithin(p, radius, [&](uint32_t, float distanceSquared) {
        sum += distanceSquared;
        ++found;
      });
  benchmark::DoNotOptimize(sum);
  const auto gathers = state.iterations() * static_cast<int64_t>(places.size());
  state.SetItemsProcessed(gathers);
  state.counters["photons/gather"] = static_cast<double>(found) / static_cast<double>(gathers);
}

void GatherSingleTree(benchmark::State& state) {
  const std::vector<Vec3> photons = BoxPhotons(static_cast<size_t>(state.range(0)));
  const float radius = RadiusFor(photons.size(), static_cast<double>(state.range(1)));
  const std::vector<Vec3> places = GatherPlaces(photons, state.range(2) != 0);
  const Cloud cloud{photons.data(), photons.size()};
  const SingleTree tree(3, cloud);
  Accumulate result{radius * radius};
  for (auto _ : state)
    for (const Vec3& p : places) tree.findNeighbors(result, &p.x, {});
  benchmark::DoNotOptimize(result.sum);
  const auto gathers = state.iterations() * static_cast<int64_t>(places.size());
  state.SetItemsProcessed(gathers);
  state.counters["photons/gather"] = static_cast<double>(result.found) / static_cast<double>(gathers);
}

BENCHMARK(BuildForest)->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(BuildSingleTree)->Arg(10000)->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(GatherForest)
    ->ArgNames({"photons", "wanted", "ordered"})
    ->ArgsProduct({{100000, 1000000}, {1, 10, 100}, {0, 1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(GatherSingleTree)
    ->ArgNames({"photons", "wanted", "ordered"})
    ->ArgsProduct({{100000, 1000000}, {1, 10, 100}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace dapple
