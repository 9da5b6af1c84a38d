// Building and querying the photon map: the forest of Dapple against one nanoflann tree and a hashed grid of the same
// photons, and forests of other shapes.
//
// Photons lie on the walls of a box, with a dense caustic on its floor. Gathers stand at photons' places, in the order
// in which a picture's tiles ask for them (ordered) or at random; their radius gives about the stated number of
// photons.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <random>
#include <tuple>

#include <benchmark/benchmark.h>

#include "bench/hash_grid.h"
#include "src/photons/photon_forest.h"

namespace dapple {
namespace {

std::vector<Vec3> MakeBoxPhotons(size_t count) {
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

/// The photons, and below what is built of them, are kept from one case to the next.
const std::vector<Vec3>& BoxPhotons(size_t count) {
  static std::map<size_t, std::vector<Vec3>> photons;
  std::vector<Vec3>& wanted = photons[count];
  if (wanted.empty()) wanted = MakeBoxPhotons(count);
  return wanted;
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

template <typename Visitor>
struct PassOn {
  float radiusSquared;
  Visitor& visit;
  float worstDist() const { return radiusSquared; }
  bool full() const { return true; }
  bool addPoint(float distanceSquared, uint32_t i) {
    visit(i, distanceSquared);
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

/// One nanoflann tree with the forest's interface.
class SingleForest {
 public:
  explicit SingleForest(const std::vector<Vec3>& photons)
      : cloud_(std::make_unique<Cloud>(Cloud{photons.data(), photons.size()})),
        tree_(std::make_unique<SingleTree>(3, *cloud_)) {}

  template <typename Visitor>
  void ForEachWithin(const Vec3& p, float radius, Visitor&& visit) const {
    PassOn<Visitor> result{radius * radius, visit};
    tree_->findNeighbors(result, &p.x, {});
  }

 private:
  std::unique_ptr<Cloud> cloud_;
  std::unique_ptr<SingleTree> tree_;
};

void BuildForest(benchmark::State& state) {
  const std::vector<Vec3>& photons = BoxPhotons(static_cast<size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(PhotonForest(photons));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void BuildSingleTree(benchmark::State& state) {
  const std::vector<Vec3>& photons = BoxPhotons(static_cast<size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(SingleForest(photons));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

void BuildHashGrid(benchmark::State& state) {
  const std::vector<Vec3>& photons = BoxPhotons(static_cast<size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(HashGrid(photons, 2 * RadiusFor(photons.size(), 10)));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}

template <typename Map>
void Gather(benchmark::State& state, const Map& map, const std::vector<Vec3>& photons, double wanted, bool ordered) {
  const float radius = RadiusFor(photons.size(), wanted);
  const std::vector<Vec3> places = GatherPlaces(photons, ordered);
  int64_t found = 0;
  float sum = 0;
  for (auto _ : state)
    for (const Vec3& p : places)
      map.ForEachWithin(p, radius, [&](uint32_t, float distanceSquared) {
        sum += distanceSquared;
        ++found;
      });
  benchmark::DoNotOptimize(sum);
  const auto gathers = state.iterations() * static_cast<int64_t>(places.size());
  state.counters["photons/gather"] = static_cast<double>(found) / static_cast<double>(gathers);
  state.counters["time/gather"] =
      benchmark::Counter(static_cast<double>(gathers), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Arguments: photons, wanted photons a gather, ordered.
template <typename Map>
void GatherKept(benchmark::State& state) {
  static std::map<int64_t, Map> maps;
  const std::vector<Vec3>& photons = BoxPhotons(static_cast<size_t>(state.range(0)));
  const auto map = maps.try_emplace(state.range(0), photons).first;
  Gather(state, map->second, photons, static_cast<double>(state.range(1)), state.range(2) != 0);
}

void GatherHashGrid(benchmark::State& state) {
  static std::map<std::pair<int64_t, int64_t>, HashGrid> grids;
  const std::vector<Vec3>& photons = BoxPhotons(static_cast<size_t>(state.range(0)));
  const double wanted = static_cast<double>(state.range(1));
  const auto grid = grids.try_emplace({state.range(0), state.range(1)}, photons, 2 * RadiusFor(photons.size(), wanted));
  Gather(state, grid.first->second, photons, wanted, state.range(2) != 0);
}

/// Arguments: bucket size, leaf size, wanted photons a gather; a million photons, gathers in order.
void GatherShape(benchmark::State& state) {
  static std::map<std::pair<int64_t, int64_t>, PhotonForest> forests;
  const std::vector<Vec3>& photons = BoxPhotons(1000000);
  const ForestShape shape{static_cast<size_t>(state.range(0)), static_cast<size_t>(state.range(1))};
  const auto forest =
      forests.try_emplace({state.range(0), state.range(1)}, photons, PhotonForest::Follower(), shape).first;
  Gather(state, forest->second, photons, static_cast<double>(state.range(2)), true);
  state.counters["bytes/photon"] = static_cast<double>(forest->second.MemoryBytes()) / 1e6;
}

void BuildShape(benchmark::State& state) {
  const std::vector<Vec3>& photons = BoxPhotons(1000000);
  const ForestShape shape{static_cast<size_t>(state.range(0)), static_cast<size_t>(state.range(1))};
  for (auto _ : state) benchmark::DoNotOptimize(PhotonForest(photons, {}, shape));
}

void GatherForest(benchmark::State& state) { GatherKept<PhotonForest>(state); }
void GatherSingleTree(benchmark::State& state) { GatherKept<SingleForest>(state); }

#define DAPPLE_BUILD_BENCHMARK(function) \
  BENCHMARK(function)->RangeMultiplier(10)->Range(10000, 10000000)->Unit(benchmark::kMillisecond)->UseRealTime()
#define DAPPLE_GATHER_BENCHMARK(function)                                             \
  BENCHMARK(function)                                                                 \
      ->ArgNames({"photons", "wanted", "ordered"})                                    \
      ->ArgsProduct({{10000, 100000, 1000000, 10000000}, {1, 10, 100, 1000}, {0, 1}}) \
      ->Unit(benchmark::kMillisecond)

DAPPLE_BUILD_BENCHMARK(BuildSingleTree);
DAPPLE_BUILD_BENCHMARK(BuildForest);
DAPPLE_BUILD_BENCHMARK(BuildHashGrid);
DAPPLE_GATHER_BENCHMARK(GatherSingleTree);
DAPPLE_GATHER_BENCHMARK(GatherForest);
DAPPLE_GATHER_BENCHMARK(GatherHashGrid);
BENCHMARK(BuildShape)
    ->ArgNames({"bucket", "leaf"})
    ->ArgsProduct({{512, 1024, 2048, 8192, 32768}, {12, 16, 24}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(GatherShape)
    ->ArgNames({"bucket", "leaf", "wanted"})
    ->ArgsProduct({{512, 1024, 2048, 8192, 32768}, {12, 16, 24}, {1, 10, 100}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace dapple
