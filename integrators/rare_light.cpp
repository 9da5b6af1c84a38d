#include "integrators/rare_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "integrators/light_walk.h"
#include "integrators/path.h"
#include "integrators/photon_shooting.h"
#include "src/base/hash.h"
#include "src/photons/same_surface.h"

namespace dapple {

namespace {

/// A pixel of the pilot's grid: what path tracing makes of it, and the first surface there that is no mirror or glass.
struct Place {
  double radiance = 0, variance = 0;  // of common light, by one path; the mean of the colour's components
  // What light paths are gathered by; without `bsdf` the camera sees no such surface.
  std::optional<Bsdf> bsdf;
  SurfaceInteraction hit;
  Color throughput{1};
  float reach = 0;       // a pixel of the grid there
  int64_t rays = 0;      // that told all this
  double mergeArea = 0;  // of a gather in a pixel of the picture
};

/// What light paths bring to a place that camera paths find seldom: sums over them.
struct Arrivals {
  double light = 0, lightSquared = 0;  // of c, and of c^2
  double lost = 0;                     // of c where p is zero
  double byPaths = 0;                  // of c^2 / p
  double byBoth = 0;                   // of c^2 / (p + eta)

  Arrivals& operator+=(const Arrivals& a) {
    light += a.light, lightSquared += a.lightSquared, lost += a.lost, byPaths += a.byPaths, byBoth += a.byBoth;
    return *this;
  }
};

constexpr int kGridPixels = 1024;
constexpr int kPathsPerPixel = 16;

/// Light is rare that brings so many times a place's radiance to the path that finds it, and nothing to others.
constexpr double kSeldom = 16;

/// What paths through one point of the picture find, but for the brightest, which may have found rare light.
class CommonLight {
 public:
  void Add(double radiance) {
    ++count_;
    brightest_ = std::max(brightest_, radiance);
    sum_ += radiance;
    sumOfSquares_ += radiance * radiance;
  }
  double Mean() const { return std::max(0.0, sum_ - brightest_) / (count_ - 1); }
  double Variance() const {
    return std::max(0.0, sumOfSquares_ - brightest_ * brightest_ - (count_ - 1) * Mean() * Mean()) / (count_ - 2);
  }

 private:
  int count_ = 0;
  double brightest_ = 0, sum_ = 0, sumOfSquares_ = 0;
};

/// Goes on through mirrors and glass.
void FindSurface(const Scene& scene, const CameraRay& camera, float pixels, Sampler sampler, Place* place) {
  constexpr int kMostBounces = 16;
  Ray ray = camera.ray;
  float distance = 0;
  for (int bounce = 1; bounce <= kMostBounces;) {
    ++place->rays;
    const std::optional<SurfaceInteraction> hit = scene.Intersect(ray);
    if (!hit) return;
    distance += hit->t;
    const Material* material = scene.MaterialAt(*hit);
    if (!material) {
      ray = SpawnRay(*hit, ray.d);
      continue;
    }
    const Bsdf bsdf = material->GetBsdf(*hit);
    if (bsdf.IsBlack()) return;
    if (!bsdf.IsPurelySpecular()) {
      const float width = camera.footprintAtLens + camera.footprintSpread * distance;
      place->hit = *hit;
      place->bsdf = bsdf;
      place->reach = pixels * width;
      // Rare light that matters is dense, as in caustics: there radii are narrow.
      place->mergeArea = 0.75 * kPiD * Sqr(GatherRadius::kMinPixels * static_cast<double>(width));
      return;
    }
    sampler.StartBlock(bounce++);
    const double uLobe = sampler.Get1D();
    const std::optional<BsdfSample> next = bsdf.Sample(hit->wo, uLobe, sampler.Get2D(), TransportMode::Radiance);
    if (!next) return;
    place->throughput *= next->weight;
    ray = SpawnRay(*hit, next->wi);
  }
}

std::vector<Place> LookFromCamera(const Scene& scene, const IntegratorOptions& options, uint64_t seed) {
  PathIntegrator paths(options);
  paths.Prepare(scene, seed);
  // Of the whole picture, so that a crop of it is rendered the same way.
  const Vec2i& resolution = scene.Settings().resolution;
  const double step = std::sqrt(static_cast<double>(resolution.x) * resolution.y / kGridPixels);
  const int columns = std::max(1, static_cast<int>(resolution.x / step)),
            rows = std::max(1, static_cast<int>(resolution.y / step));
  std::vector<Place> places(static_cast<size_t>(columns) * static_cast<size_t>(rows));
  ParallelForChunks(static_cast<int64_t>(places.size()), 16, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
      Place& place = places[static_cast<size_t>(i)];
      PassStats stats;
      const Vec2i cell(static_cast<int>(i) % columns, static_cast<int>(i) / columns);
      CommonLight common;
      for (int k = 0; k < kPathsPerPixel; ++k) {
        Sampler sampler = Sampler::ForPixel(seed, cell, 0, k, kPathsPerPixel);
        // The grid's pixel is as wide as `step` of the picture's; what changes within it is no noise: one point of it.
        const Vec2 film(static_cast<float>((cell.x + 0.5) * resolution.x / columns),
                        static_cast<float>((cell.y + 0.5) * resolution.y / rows));
        const Vec2d uLens = sampler.Get2D();
        const CameraRay camera = scene.GetCamera().GenerateRay(film, uLens, sampler.Get1D());
        if (k == 0) FindSurface(scene, camera, static_cast<float>(step), sampler, &place);
        common.Add(static_cast<double>(paths.Radiance(CameraWalk(camera.ray), sampler, stats).Average()));
      }
      place.rays += stats.Rays();
      place.radiance = common.Mean();
      place.variance = common.Variance();
    }
  });
  return places;
}

/// Places by where they are.
struct PlaceMap {
  PhotonMap<uint32_t> map;
  float longestReach = 0;
};

PlaceMap MapOf(std::vector<Place>* places) {
  std::vector<Vec3> positions;
  std::vector<uint32_t> indices;
  std::vector<float> reaches;
  for (size_t i = 0; i < places->size(); ++i) {
    const Place& place = (*places)[i];
    if (!place.bsdf) continue;
    positions.push_back(place.hit.p);
    indices.push_back(static_cast<uint32_t>(i));
    reaches.push_back(place.reach);
  }
  PlaceMap result;
  if (positions.empty()) return result;
  // Far places would reach over all others.
  const auto middle = reaches.begin() + static_cast<ptrdiff_t>(reaches.size() / 2);
  std::nth_element(reaches.begin(), middle, reaches.end());
  result.longestReach = 4 * *middle;
  for (Place& place : *places) place.reach = std::min(place.reach, result.longestReach);
  result.map = PhotonMap<uint32_t>(std::move(positions), std::move(indices));
  return result;
}

/// Adds what the light path brings to the places around the vertex. `paths` as `LightWalk::Arrive` gives it.
void Arrive(const std::vector<Place>& places, const PlaceMap& map, const LightVertex& vertex, double paths,
            double lightPaths, double darkest, std::vector<Arrivals>* arrivals) {
  map.map.ForEachWithin(vertex.hit.p, map.longestReach, [&](const Vec3&, uint32_t index, float distanceSquared) {
    const Place& place = places[index];
    if (!(distanceSquared < Sqr(place.reach))) return;
    const Vec3& wi = vertex.hit.wo;
    const GatherSite site(place.hit.p, place.hit.ng, place.hit.wo, place.reach, place.bsdf->Flags().HasTransmission());
    if (!IsOnSameSurface(site, vertex.hit.p, distanceSquared, vertex.hit.ng, wi)) return;
    const float cosine = AbsDot(place.hit.ns, wi);
    if (!(cosine > 0)) return;
    const Color value =
        place.throughput * place.bsdf->Eval(place.hit.wo, wi, TransportMode::Radiance) * ShadedFlux(vertex);
    const double c = static_cast<double>(value.Average() / cosine);
    const double density = paths * static_cast<double>(place.bsdf->Pdf(place.hit.wo, wi, TransportMode::Radiance));
    if (!(c > kSeldom * (place.radiance + darkest) * density)) return;
    Arrivals& at = (*arrivals)[index];
    at.light += c;
    at.lightSquared += c * c;
    if (density == 0) at.lost += c;
    at.byPaths += density > 0 ? c * c / density : std::numeric_limits<double>::infinity();
    at.byBoth += c * c / (density + lightPaths * place.mergeArea);
  });
}

/// Adds what it traces to `*pilot`.
std::vector<Arrivals> ShootLight(const Scene& scene, const IntegratorOptions& options, uint64_t seed,
                                 const std::vector<Place>& places, const PlaceMap& map, double darkest,
                                 PilotUse* pilot) {
  constexpr uint64_t kShooting = 5;
  const EmissionSampler emission(scene, GuideOf(scene, options, 0, seed));
  const PassForecast forecast = ForecastPhotonPass(scene, options, 0, seed);
  const auto lightPaths = static_cast<double>(forecast.lightPaths);
  const auto noMerging = [](const Vec3&) { return MergeSite(); };
  struct Chunk {
    std::vector<Arrivals> arrivals;
    int64_t rays = 0;
  };
  std::vector<Arrivals> sums(places.size());
  *pilot += forecast.pilot + PilotUse{kRareLightPaths, 0};
  ForEachLightPath<Chunk>(
      emission, Hash(seed, kShooting), 0, kRareLightPaths,
      [&](const EmissionSample& emitted, const Sampler& sampler, Chunk& chunk) {
        chunk.arrivals.resize(places.size());
        LightWalk walk(scene, options.direct, emitted, noMerging);
        const auto visit = [&](const LightVertex& vertex) {
          const double paths = walk.Arrive(vertex).paths;
          if (vertex.scattered > 0 && !vertex.bsdf.IsPurelySpecular())
            Arrive(places, map, vertex, paths, lightPaths, darkest, &chunk.arrivals);
        };
        const auto scatter = [&](const LightVertex& vertex, const BsdfSample& next) { walk.Scatter(vertex, next); };
        chunk.rays += TraceLightPath(scene, emitted, sampler, options.maxDepth, visit, scatter).segments;
      },
      [&](const Chunk& chunk, int64_t) {
        for (size_t i = 0; i < chunk.arrivals.size(); ++i) sums[i] += chunk.arrivals[i];
        pilot->rays += chunk.rays;
      });
  return sums;
}

}  // namespace

double RareLight::Gain() const {
  const double byPhotons = noise + photonNoise;
  const double all = noise + rareNoise;
  return all > 0 ? std::min(kMostGain, all / byPhotons) : 1;
}

RareLight FindRareLight(const Scene& scene, const IntegratorOptions& options, uint64_t seed) {
  constexpr uint64_t kLooking = 4;
  std::vector<Place> places = LookFromCamera(scene, options, Hash(seed, kLooking));
  const PlaceMap map = MapOf(&places);
  // A tenth of the picture's mean is as dark as matters.
  constexpr double kDark = 0.1;
  const double count = static_cast<double>(places.size());
  double mean = 0;
  RareLight result;
  for (const Place& place : places) {
    mean += place.radiance / count;
    result.pilot.rays += place.rays;
  }
  const std::vector<Arrivals> arrivals = ShootLight(scene, options, seed, places, map, kDark * mean, &result.pilot);

  std::vector<double> light(places.size());
  double rareMean = 0, lostMean = 0;
  for (size_t i = 0; i < places.size(); ++i) {
    if (!places[i].bsdf) continue;
    const double perRadiance = kRareLightPaths * kPiD * Sqr(static_cast<double>(places[i].reach));
    light[i] = arrivals[i].light / perRadiance;
    rareMean += light[i] / count;
    lostMean += arrivals[i].lost / perRadiance / count;
  }
  if (!(mean + rareMean > 0)) return result;
  result.share = rareMean / (mean + rareMean);
  result.lostShare = lostMean / (mean + rareMean);
  for (size_t i = 0; i < places.size(); ++i) {
    const double scale = 1 / (Sqr(places[i].radiance + light[i]) + Sqr(kDark * (mean + rareMean)));
    result.noise += places[i].variance * scale / count;
    if (light[i] == 0) continue;
    const double photons = kRareLightPaths, area = kPiD * Sqr(static_cast<double>(places[i].reach));
    // However rare, in a render of so many passes it misses no more than all of it. Of pairs of photons, so that few
    // of them are no more than they are.
    constexpr double kPasses = 256;
    const Arrivals& at = arrivals[i];
    const double missed = kPasses * std::max(0.0, Sqr(at.light) - at.lightSquared) / Sqr(photons * area);
    const double byPaths = std::min(at.byPaths / (photons * area), missed);
    result.rareNoise += byPaths * scale / count;
    result.photonNoise += std::min(byPaths, at.byBoth / (photons * area)) * scale / count;
  }
  return result;
}

}  // namespace dapple
