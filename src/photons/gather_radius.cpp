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

/// Where the light paths of the pilot leave photons.
std::vector<Vec3> ShootPilot(const Scene& scene, const EmissionSampler& emission, int maxDepth, uint64_t seed) {
  using Positions = std::vector<Vec3>;
  const auto chunks =
      ForEachLightPath<Positions>(emission, seed, 0, GatherRadius::kPilotPaths,
                                  [&](const EmissionSample& emitted, const Sampler& sampler, Positions& chunk) {
                                    TraceLightPath(scene, emitted, sampler, maxDepth, [&](const LightVertex& v) {
                                      if (v.scattered > 0 && !v.bsdf.IsPurelySpecular()) chunk.push_back(v.hit.p);
                                    });
                                  });
  Positions all;
  for (const Positions& chunk : chunks) all.insert(all.end(), chunk.begin(), chunk.end());
  return all;
}

}  // namespace

GatherRadius::GatherRadius(const Scene& scene, const EmissionSampler& emission, int64_t paths, const Options& options)
    : scale_(static_cast<float>(options.scale)), camera_(scene.GetCamera().Position()), unit_(scene.Extent().radius) {
  if (options.fixed) fixed_ = static_cast<float>(*options.fixed);
  if (paths == 0) return;
  const Vec2i& resolution = scene.Settings().resolution;
  const Vec2 middle(static_cast<float>(resolution.x) / 2, static_cast<float>(resolution.y) / 2);
  const CameraRay camera = scene.GetCamera().GenerateRay(middle, Vec2d(0.5), 0.5);
  widestAtLens_ = camera.footprintAtLens * static_cast<float>(kMaxPixels);
  widestSpread_ = camera.footprintSpread * static_cast<float>(kMaxPixels);
  constexpr uint64_t kPilot = 3;
  const std::vector<Vec3> positions = ShootPilot(scene, emission, options.maxDepth, Hash(options.seed, kPilot));
  Fill(positions, DensitiesAt(positions, static_cast<double>(paths)));
}

std::vector<float> GatherRadius::DensitiesAt(const std::vector<Vec3>& positions, double pathsOfPass) const {
  const double toPass = pathsOfPass / kPilotPaths;
  // So many photons, and the one in the middle, say how dense they are.
  constexpr size_t kCounted = 16;
  std::vector<Vec3> points = positions;
  const PhotonForest forest(std::move(points));
  std::vector<float> densities(positions.size());
  ParallelForChunks(static_cast<int64_t>(positions.size()), 1024, [&](int64_t begin, int64_t end) {
    std::vector<float> squared;
    for (int64_t i = begin; i < end; ++i) {
      const Vec3& p = positions[static_cast<size_t>(i)];
      const float widest = Widest(p);
      forest.FindNearest(p, widest, kCounted + 1, &squared);
      // The outermost is on the rim, or none is. Many in one place have no end of density.
      const float radiusSquared = squared.size() > kCounted ? squared.front() : Sqr(widest);
      const double area = kPiD * static_cast<double>(std::max(radiusSquared, Sqr(widest) * 1e-6f));
      const double inside = static_cast<double>(std::min(squared.size(), kCounted)) - 1;
      densities[static_cast<size_t>(i)] = static_cast<float>(std::max(0.0, inside) * toPass / area);
    }
  });
  return densities;
}

void GatherRadius::Fill(const std::vector<Vec3>& positions, const std::vector<float>& densities) {
  // Two cells a photon at most, in a table that is at least half empty.
  cells_.assign(std::bit_ceil(4 * positions.size() + 1), {});
  for (size_t i = 0; i < positions.size(); ++i) {
    for (const Level level : {Level::Fine, Level::Coarse}) {
      const uint64_t key = KeyOf(positions[i], level);
      size_t slot = key & (cells_.size() - 1);
      while (cells_[slot].key != 0 && cells_[slot].key != key) slot = (slot + 1) & (cells_.size() - 1);
      cells_[slot].key = key;
      cells_[slot].sum += static_cast<double>(densities[i]);
      ++cells_[slot].count;
    }
  }
}

float GatherRadius::Widest(const Vec3& p) const {
  return std::max(widestAtLens_ + widestSpread_ * Distance(p, camera_), unit_ * 1e-9f);
}

uint64_t GatherRadius::KeyOf(const Vec3& p, Level level) const {
  // A power of two, so that neighbours at nearly the same distance share a grid.
  const int exponent = std::ilogb(Widest(p) / unit_) + (level == Level::Coarse ? 2 : 0);
  const Vec3d fromCamera = (ToDouble(p) - ToDouble(camera_)) / static_cast<double>(unit_);
  const auto coordinate = [&](double x) { return static_cast<int64_t>(std::floor(std::ldexp(x, -exponent))); };
  const uint64_t key = Hash(static_cast<uint64_t>(exponent), level == Level::Coarse, coordinate(fromCamera.x),
                            coordinate(fromCamera.y), coordinate(fromCamera.z));
  return key | 1;
}

const GatherRadius::Cell* GatherRadius::Find(uint64_t key) const {
  for (size_t slot = key & (cells_.size() - 1);; slot = (slot + 1) & (cells_.size() - 1)) {
    if (cells_[slot].key == key) return &cells_[slot];
    if (cells_[slot].key == 0) return nullptr;
  }
}

GatherForecast GatherRadius::At(const Vec3& p) const {
  const float widest = Widest(p);
  const Cell* cell = Find(KeyOf(p, Level::Fine));
  if (!cell) cell = Find(KeyOf(p, Level::Coarse));
  const float density = cell ? static_cast<float>(cell->sum / static_cast<double>(cell->count)) : 0;
  GatherForecast forecast;
  if (fixed_) {
    forecast.radius = *fixed_;
  } else {
    const float wanted = density > 0 ? std::sqrt(static_cast<float>(kPhotons) * kInvPi / density) : widest;
    constexpr float kNarrowest = static_cast<float>(kMinPixels / kMaxPixels);
    forecast.radius = std::clamp(wanted, kNarrowest * widest, widest) * scale_;
  }
  forecast.photons = density * kPi * Sqr(forecast.radius);
  return forecast;
}

}  // namespace dapple
