#include "src/photons/emission_guide.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "src/base/grid.h"
#include "src/base/numerics.h"

namespace dapple {

namespace {

constexpr int kCells = 64;  // a side
constexpr double kEvenShare = 0.1;
/// So many lights have tables: those of which the pilot found the most photons of use.
constexpr size_t kMostGuided = 512;

/// The table of least variance: where a share q of the photons is of use, density goes with sqrt(q).
class Histogram {
 public:
  void Add(const Vec2d& u, double weight) {
    if (!sums_) sums_.emplace(kCells, kCells);
    sums_->At(static_cast<int>(u.x * kCells), static_cast<int>(u.y * kCells)) += weight;
  }

  Distribution2D ToTable() const {
    if (!sums_) return {};
    // Neighbours of a useful cell are likely useful too.
    std::vector<double> weights = Smoothed(*sums_).values;
    double sum = 0;
    for (double& weight : weights) sum += weight = std::sqrt(weight);
    if (!(sum > 0)) return {};
    // What the pilot missed in one table it has often met in the other: an even share in each keeps such photons light.
    for (double& weight : weights)
      weight = (1 - kEvenShare) * weight / sum + kEvenShare / static_cast<double>(weights.size());
    return {std::span<const double>(weights), kCells, kCells};
  }

 private:
  std::optional<Grid> sums_;
};

std::vector<size_t> GuidedLights(size_t lights, std::span<const PilotPhoton> pilot) {
  std::vector<int> ofUse(lights);
  for (const PilotPhoton& photon : pilot)
    if (photon.light >= 0 && photon.weight > 0) ++ofUse[static_cast<size_t>(photon.light)];
  std::vector<size_t> guided;
  for (size_t i = 0; i < lights; ++i)
    if (ofUse[i] > 0) guided.push_back(i);
  if (guided.size() <= kMostGuided) return guided;
  std::nth_element(guided.begin(), guided.begin() + kMostGuided, guided.end(),
                   [&](size_t a, size_t b) { return ofUse[a] != ofUse[b] ? ofUse[a] > ofUse[b] : a < b; });
  guided.resize(kMostGuided);
  return guided;
}

bool HasCells(const Distribution2D& table) { return table.Height() > 0; }

}  // namespace

EmissionGuide::EmissionGuide(std::span<const double> power, std::span<const PilotPhoton> pilot, int64_t cameraRays)
    : pilot_{static_cast<int64_t>(pilot.size()), cameraRays} {
  struct Learned {
    Histogram position, direction;
    double emitted = 0, useful = 0;
    bool isGuided = false;
  };
  std::vector<Learned> learned(power.size());
  for (const size_t light : GuidedLights(power.size(), pilot)) learned[light].isGuided = true;
  for (const PilotPhoton& photon : pilot) {
    pilot_.rays += photon.rays;
    if (photon.light < 0) continue;
    Learned& light = learned[static_cast<size_t>(photon.light)];
    light.emitted += 1;
    if (photon.weight == 0) continue;
    light.useful += photon.weight;
    if (!light.isGuided) continue;
    if (!photon.deltaPos) light.position.Add(photon.position, photon.weight);
    if (!photon.deltaDir) light.direction.Add(photon.direction, photon.weight);
  }

  std::vector<double> use(power.size());
  double totalPower = 0, totalUse = 0;
  for (size_t i = 0; i < power.size(); ++i) {
    use[i] = learned[i].emitted > 0 ? power[i] * std::sqrt(learned[i].useful / learned[i].emitted) : 0;
    totalPower += power[i];
    totalUse += use[i];
  }
  if (!(totalUse > 0) || !std::isfinite(totalPower)) return;
  for (size_t i = 0; i < power.size(); ++i)
    use[i] = (1 - kEvenShare) * use[i] / totalUse + kEvenShare * power[i] / totalPower;
  byUse_ = Distribution1D(std::span<const double>(use));
  lights_.reserve(power.size());
  for (const Learned& light : learned) lights_.push_back({light.position.ToTable(), light.direction.ToTable()});
}

bool EmissionGuide::Bends(int light) const {
  const LightTables& tables = lights_[static_cast<size_t>(light)];
  return HasCells(tables.position) || HasCells(tables.direction);
}

EmissionGuide::Bent EmissionGuide::Bend(int light, const LeRandom& u) const {
  const LightTables& tables = lights_[static_cast<size_t>(light)];
  Bent bent{u, 1};
  const bool isEven = u.part < kEvenShare;
  bent.own.part = isEven ? u.part / kEvenShare : (u.part - kEvenShare) / (1 - kEvenShare);
  if (!isEven && HasCells(tables.position)) bent.own.position = tables.position.Sample(u.position).p;
  if (!isEven && HasCells(tables.direction)) bent.own.direction = tables.direction.Sample(u.direction).p;
  bent.pdf = Pdf(light, bent.own);
  return bent;
}

double EmissionGuide::Pdf(int light, const LeRandom& own) const {
  const LightTables& tables = lights_[static_cast<size_t>(light)];
  const double position = HasCells(tables.position) ? tables.position.Pdf(own.position) : 1;
  const double direction = HasCells(tables.direction) ? tables.direction.Pdf(own.direction) : 1;
  return kEvenShare + (1 - kEvenShare) * position * direction;
}

LeRandom EmissionGuide::Unbend(int light, const LeRandom& own) const {
  const LightTables& tables = lights_[static_cast<size_t>(light)];
  LeRandom u = own;
  // Lights that make no use of it give 0, which must not fall across the border of the two kinds by rounding.
  constexpr double kMargin = 1e-9;
  const double part = std::clamp(own.part, kMargin, 1 - kMargin);
  u.part = kEvenShare + part * (1 - kEvenShare);
  if (HasCells(tables.position)) u.position = tables.position.Invert(own.position);
  if (HasCells(tables.direction)) u.direction = tables.direction.Invert(own.direction);
  return u;
}

int64_t EmissionGuide::MostMemoryBytes(int64_t lights) {
  constexpr int64_t kTableBytes = 12 * kCells * kCells;  // with the sums over its rows
  constexpr int64_t kLightBytes = 256;
  return kLightBytes * lights + 2 * kTableBytes * std::min(lights, int64_t{kMostGuided});
}

int64_t EmissionGuide::MemoryBytes() const {
  int64_t bytes = byUse_.MemoryBytes();
  for (const LightTables& light : lights_) bytes += light.position.MemoryBytes() + light.direction.MemoryBytes();
  return bytes;
}

}  // namespace dapple
