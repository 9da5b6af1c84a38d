#include "src/photons/gather_guide.h"

#include <bit>
#include <numeric>

#include "src/base/numerics.h"
#include "src/photons/light_path.h"

namespace dapple {

namespace {

/// The cell of `shares`, which need not sum to one, that holds `u` times their sum; `u` is stretched to the cell.
template <typename Shares>
size_t Choose(const Shares& shares, size_t count, double* u) {
  double sum = 0;
  for (size_t i = 0; i < count; ++i) sum += static_cast<double>(shares[i]);
  double left = *u * sum;
  size_t chosen = 0;
  for (size_t i = 0; i < count; ++i) {
    if (!(shares[i] > 0)) continue;
    chosen = i;
    if (left < static_cast<double>(shares[i])) break;
    left -= static_cast<double>(shares[i]);
  }
  *u = std::clamp(left / static_cast<double>(shares[chosen]), 0.0, 1 - 0x1p-32);
  return chosen;
}

/// The axis along which `n` is longest.
int LongestAxis(const Vec3& n) {
  const Vec3 a(std::abs(n.x), std::abs(n.y), std::abs(n.z));
  return a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
}

}  // namespace

DirectionTable::DirectionTable(const std::array<double, kCells>& flux, double squares) {
  const double sum = std::accumulate(flux.begin(), flux.end(), 0.0);
  double moment = 0;
  for (size_t i = 0; i < kCells; ++i) {
    const double share = flux[i] / sum;
    cells_[i] = static_cast<float>(share);
    rings_[i / kSectors] += cells_[i];
    moment += kCells * share * share;
  }
  // The relative variance of one sample that the cosine draws, without what the noise of so few photons adds: of even
  // light, kCells - 1 times the sum of their squared shares.
  const double variance = std::max(0.0, moment - 1 - (kCells - 1) * squares / Sqr(sum));
  // Less than that is not worth the time.
  constexpr double kLeastShare = 0.05;
  const double share = 0.5 * variance / (1 + variance);
  share_ = share < kLeastShare ? 0 : static_cast<float>(share);
}

size_t DirectionTable::CellOf(const Vec3& w) {
  const float sinSquared = Sqr(w.x) + Sqr(w.y);
  const size_t ring = std::min(static_cast<size_t>(sinSquared * kRings), size_t{kRings - 1});
  // Octants, from the signs and the order of x and y.
  static_assert(kSectors == 8);
  const bool isSteep = std::abs(w.y) > std::abs(w.x);
  const size_t quadrant = w.y >= 0 ? (w.x >= 0 ? 0 : 1) : (w.x >= 0 ? 3 : 2);
  return ring * kSectors + 2 * quadrant + (isSteep != (quadrant % 2 == 1) ? 1 : 0);
}

Vec3 DirectionTable::Sample(const Vec2d& u) const {
  double uRing = u.x, uSector = u.y;
  const size_t ring = Choose(rings_, kRings, &uRing);
  const size_t sector = Choose(&cells_[ring * kSectors], kSectors, &uSector);
  const double sinSquared = (static_cast<double>(ring) + uRing) / kRings;
  const double phi = 2 * kPiD * (static_cast<double>(sector) + uSector) / kSectors;
  const double sine = std::sqrt(sinSquared);
  return {static_cast<float>(sine * std::cos(phi)), static_cast<float>(sine * std::sin(phi)),
          static_cast<float>(std::sqrt(1 - sinSquared))};
}

float DirectionTable::Pdf(const Vec3& w) const { return w.z > 0 ? cells_[CellOf(w)] * (kCells * kInvPi) * w.z : 0; }

GatherGuide::GatherGuide(const Scene& scene, const EmissionSampler& emission, int maxDepth, uint64_t seed)
    : grid_(scene, kPixels), pilot_{.lightPaths = 1 << 15} {
  constexpr uint64_t kPilot = 6;
  struct Chunk {
    std::vector<Photon> photons;
    int64_t rays = 0;
  };
  std::vector<Photon> all;
  ForEachLightPath<Chunk>(
      emission, Hash(seed, kPilot), 0, pilot_.lightPaths,
      [&](const EmissionSample& emitted, const Sampler& sampler, Chunk& chunk) {
        const LightPathEnd end = TraceLightPath(scene, emitted, sampler, maxDepth, [&](const LightVertex& v) {
          if (v.scattered == 0 || v.isCaustic || v.bsdf.IsPurelySpecular()) return;
          const Vec3 n = FaceForward(v.hit.ng, v.hit.wo);
          const float flux = v.flux.Luminance();
          if (flux > 0)
            chunk.photons.push_back(
                {v.hit.p, n, static_cast<uint32_t>(DirectionTable::CellOf(FrameAround(n).ToLocal(v.hit.wo))), flux});
        });
        chunk.rays += end.segments;
      },
      [&](const Chunk& chunk, int64_t) {
        all.insert(all.end(), chunk.photons.begin(), chunk.photons.end());
        pilot_.rays += chunk.rays;
      });
  Learn(all);
}

void GatherGuide::Learn(const std::vector<Photon>& photons) {
  struct Cube {
    uint64_t key = 0;
    int64_t photons = 0;
    size_t sum = 0;  // its number, from 1; 0: none
  };
  struct Sum {
    std::array<double, DirectionTable::kCells> flux{};
    double squares = 0;
  };
  std::vector<Place> places;
  std::vector<Cube*> cubeOf(photons.size());
  for (int level = 0; level < kLevels; ++level) {
    std::vector<Cube> cubes(std::bit_ceil(2 * photons.size() + 1));
    for (size_t i = 0; i < photons.size(); ++i) {
      const uint64_t key = KeyOf(photons[i].p, photons[i].n, level);
      cubeOf[i] = &SlotOf(cubes, key);
      cubeOf[i]->key = key;
      ++cubeOf[i]->photons;
    }
    std::vector<Sum> sums;
    for (size_t i = 0; i < photons.size(); ++i) {
      Cube& cube = *cubeOf[i];
      if (cube.photons < kPhotons) continue;
      if (cube.sum == 0) {
        sums.emplace_back();
        cube.sum = sums.size();
      }
      const double flux = static_cast<double>(photons[i].flux);
      sums[cube.sum - 1].flux[photons[i].cell] += flux;
      sums[cube.sum - 1].squares += Sqr(flux);
    }
    for (const Cube& cube : cubes) {
      if (cube.sum == 0) continue;
      places.push_back({cube.key, static_cast<uint32_t>(tables_.size())});
      tables_.emplace_back(sums[cube.sum - 1].flux, sums[cube.sum - 1].squares);
    }
  }
  places_.assign(std::bit_ceil(2 * places.size() + 1), {});
  for (const Place& place : places) SlotOf(places_, place.key) = place;
}

Frame GatherGuide::FrameAround(const Vec3& n) {
  Vec3 tangent(0);
  tangent[(LongestAxis(n) + 1) % 3] = 1;
  return Frame::FromZX(n, tangent);
}

uint64_t GatherGuide::KeyOf(const Vec3& p, const Vec3& n, int level) const {
  // Surfaces that face one of six ways.
  const int axis = LongestAxis(n);
  return grid_.KeyOf(p, level, 6 * level + 2 * axis + (n[axis] > 0 ? 1 : 0));
}

const DirectionTable* GatherGuide::At(const Vec3& p, const Vec3& n) const {
  if (tables_.empty()) return nullptr;
  for (int level = 0; level < kLevels; ++level) {
    const Place& place = SlotOf(places_, KeyOf(p, n, level));
    if (place.key != 0) return &tables_[place.table];
  }
  return nullptr;
}

int64_t GatherGuide::MemoryBytes() const {
  if (tables_.empty()) return 0;
  return static_cast<int64_t>(tables_.capacity() * sizeof(DirectionTable) + places_.capacity() * sizeof(Place));
}

}  // namespace dapple
