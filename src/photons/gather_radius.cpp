#include "src/photons/gather_radius.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "src/base/hash.h"
#include "src/base/parallel.h"
#include "src/photons/light_path.h"
#include "src/photons/photon_forest.h"

namespace dapple {

namespace {

constexpr auto kNarrowest = static_cast<float>(GatherRadius::kMinPixels / GatherRadius::kMaxPixels);

/// About as many as a pass has, within bounds.
int64_t PilotPathsFor(int64_t pathsOfPass) { return std::clamp<int64_t>(pathsOfPass, 1 << 13, 1 << 15); }

/// Where light paths of the pilot leave photons.
struct Landings {
  std::vector<Vec3> positions;
  int64_t rays = 0;
};

Landings ShootPilot(const Scene& scene, const EmissionSampler& emission, int64_t paths, int maxDepth, bool causticsOnly,
                    uint64_t seed) {
  Landings all;
  ForEachLightPath<Landings>(
      emission, seed, 0, paths,
      [&](const EmissionSample& emitted, const Sampler& sampler, Landings& chunk) {
        const LightPathEnd end = TraceLightPath(scene, emitted, sampler, maxDepth, [&](const LightVertex& v) {
          if (v.scattered > 0 && !v.bsdf.IsPurelySpecular() && (v.isCaustic || !causticsOnly))
            chunk.positions.push_back(v.hit.p);
        });
        chunk.rays += end.segments;
      },
      [&](const Landings& chunk, int64_t) {
        all.positions.insert(all.positions.end(), chunk.positions.begin(), chunk.positions.end());
        all.rays += chunk.rays;
      });
  return all;
}

}  // namespace

GatherRadius::GatherRadius(const Scene& scene, const EmissionSampler& emission, int64_t paths, const Options& options)
    : scale_(static_cast<float>(options.scale)), grid_(scene, kMaxPixels) {
  if (options.fixed) {
    fixed_ = static_cast<float>(*options.fixed);
    if (!options.forecastsPhotons) return;
  }
  const int64_t pilotPaths = PilotPathsFor(paths);
  constexpr uint64_t kPilot = 3;
  Landings landings =
      ShootPilot(scene, emission, pilotPaths, options.maxDepth, options.causticsOnly, Hash(options.seed, kPilot));
  pilot_ = {pilotPaths, landings.rays};
  Fill(Learn(std::move(landings.positions), static_cast<double>(paths) / static_cast<double>(pilotPaths)));
}

std::vector<GatherRadius::Finding> GatherRadius::Learn(std::vector<Vec3> positions, double toPass) const {
  const PhotonForest forest(std::move(positions));
  const auto count = static_cast<int64_t>(forest.Size());
  constexpr int64_t kChunk = 1024;
  std::vector<Finding> findings(forest.Size());
  ParallelForChunks(count, kChunk, [&](int64_t begin, int64_t end) {
    std::vector<float> squared;
    for (int64_t i = begin; i < end; ++i)
      findings[static_cast<size_t>(i)] = FindingAt(forest, forest.Position(static_cast<uint32_t>(i)), toPass, &squared);
  });
  // No radius reaches a place of much narrower radius; densities from 16 photons make radii uncertain by an eighth.
  constexpr float kSameRadius = 1.25f;
  std::vector<float> shortened(findings.size());
  ParallelForChunks(count, kChunk, [&](int64_t begin, int64_t end) {
    for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
      const Finding& here = findings[i];
      float radius = here.radius;
      shortened[i] = radius;
      // Nothing is much narrower than the narrowest; and there photons may be without number.
      if (radius <= kSameRadius * kNarrowest * grid_.Width(here.p)) continue;
      forest.ForEachWithin(here.p, radius, [&](uint32_t j, float distanceSquared) {
        radius = std::min(radius, std::max(kSameRadius * findings[j].radius, std::sqrt(distanceSquared)));
      });
      shortened[i] = radius;
    }
  });
  for (size_t i = 0; i < findings.size(); ++i) findings[i].radius = shortened[i];
  return findings;
}

GatherRadius::Finding GatherRadius::FindingAt(const PhotonForest& forest, const Vec3& p, double toPass,
                                              std::vector<float>* squared) const {
  // So many photons, and the one in the middle, say how dense they are.
  constexpr size_t kCounted = 16;
  const float widest = grid_.Width(p);
  forest.FindNearest(p, widest, kCounted + 1, squared);
  // The outermost is on the rim, or none is. Many in one place have no end of density.
  const float radiusSquared = squared->size() > kCounted ? squared->front() : Sqr(widest);
  const double area = kPiD * static_cast<double>(std::max(radiusSquared, Sqr(widest) * 1e-6f));
  const double inside = static_cast<double>(std::min(squared->size(), kCounted)) - 1;
  const auto density = static_cast<float>(std::max(0.0, inside) * toPass / area);
  const float wanted = density > 0 ? std::sqrt(static_cast<float>(kPhotons) * kInvPi / density) : widest;
  return {p, density, std::clamp(wanted, kNarrowest * widest, widest)};
}

void GatherRadius::Fill(std::span<const Finding> findings) {
  struct Sums {
    uint64_t key = 0;
    double density = 0, radius = 0;
    int64_t count = 0;
  };
  // `kLevels` cells a finding at most, in a table that is at least half empty.
  std::vector<Sums> sums(std::bit_ceil(2 * kLevels * findings.size() + 1));
  size_t cells = 0;
  for (const Finding& finding : findings) {
    for (int level = 0; level < kLevels; ++level) {
      const uint64_t key = KeyOf(finding.p, level);
      Sums& cell = SlotOf(sums, key);
      cells += cell.key == 0 ? 1 : 0;
      cell.key = key;
      cell.density += static_cast<double>(finding.density);
      cell.radius += static_cast<double>(finding.radius);
      ++cell.count;
    }
  }
  // Many findings share a cell: a small table stays in the cache.
  cells_.assign(std::bit_ceil(2 * cells + 1), {});
  for (const Sums& cell : sums) {
    if (cell.key == 0) continue;
    const auto mean = [&](double sum) { return static_cast<float>(sum / static_cast<double>(cell.count)); };
    SlotOf(cells_, cell.key) = {cell.key, mean(cell.density), mean(cell.radius)};
  }
}

GatherForecast GatherRadius::At(const Vec3& p) const {
  const Cell* cell = nullptr;
  for (int level = 0; level < kLevels && !cell; ++level) {
    const Cell& slot = SlotOf(cells_, KeyOf(p, level));
    if (slot.key != 0) cell = &slot;
  }
  GatherForecast forecast;
  if (fixed_) {
    forecast.radius = *fixed_;
  } else {
    forecast.radius = (cell ? cell->radius : grid_.Width(p)) * scale_;
  }
  if (cell) forecast.photons = cell->density * kPi * Sqr(forecast.radius);
  return forecast;
}

}  // namespace dapple
