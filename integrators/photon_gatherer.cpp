#include "integrators/photon_gatherer.h"

#include "integrators/density_sum.h"
#include "integrators/guided_bsdf.h"
#include "src/photons/radius_schedule.h"
#include "src/sampling/mis.h"

namespace dapple {

namespace {

/// Surfaces that look in few enough directions for camera paths to go on through them, as through mirrors.
bool IsGlossy(const Bsdf& bsdf) {
  constexpr float kMaxRoughness = 0.25f;  // GGX alpha
  return !bsdf.Flags().HasDiffuse() && bsdf.MinRoughness() < kMaxRoughness;
}

}  // namespace

void PhotonGatherer::Prepare(const Scene& scene, uint64_t seed) {
  scene_ = &scene;
  seed_ = seed;
  plan_.emplace(scene, options_, PhotonUse{.finalGathers = rules_.finalGathers}, seed);
  if (rules_.hasCausticMap && plan_->isNeeded && scene.Facts().MayHaveCaustics())
    causticRadius_ = CausticRadius(*plan_, scene, options_, seed);
  // One scattering before the photon lands, one where it is found, and the one whose directions are guided.
  if (rules_.finalGathers > 0 && plan_->isNeeded && options_.maxDepth >= 3)
    gatherGuide_ = GatherGuide(scene, plan_->emission, options_.maxDepth, seed);
}

PreparationUse PhotonGatherer::Preparation() const {
  PreparationUse use = plan_->Use();
  if (causticRadius_) {
    use.tables += TableUse::Of(causticRadius_->MemoryBytes());
    use.pilots += causticRadius_->Pilot();
  }
  use.tables += TableUse::Of(gatherGuide_.MemoryBytes());
  use.pilots += gatherGuide_.Pilot();
  return use;
}

PassStats PhotonGatherer::RenderPass(int pass, Film& film) const {
  PassStats stats;
  const PhotonPass photons = TracePhotons(pass, film.TracksBlur(), &stats);
  const auto radiance = [&](const CameraRay& camera, Sampler& sampler, PassStats& tileStats) {
    return Radiance({camera.ray, rules_.finalGathers}, photons, sampler, tileStats);
  };
  stats += RenderPixels(*scene_, seed_, pass, SampleAllocation(plan_->cameraSamples), radiance, film);
  film.FinishPass(pass);
  return stats;
}

PhotonGatherer::PhotonPass PhotonGatherer::TracePhotons(int pass, bool tracksBlur, PassStats* stats) const {
  const auto trace = [&](const EmissionSample& emitted, const Sampler& sampler, auto& chunk) {
    const auto store = [&](const LightVertex& v) {
      // Light straight from its source is sampled where it is needed.
      if (v.scattered == 0 || v.bsdf.IsPurelySpecular()) return;
      chunk.Store(v.hit.p,
                  {ShadedFlux(v), OctahedralVector(v.hit.wo), OctahedralVector(v.hit.ng), v.scattered, v.isCaustic});
    };
    AddLightPath(TraceLightPath(*scene_, emitted, sampler, options_.maxDepth, store), emitted, &chunk.stats);
  };
  ShotPhotons<Photon> shot = ShootPhotons<Photon>(*plan_, seed_, pass, trace);
  PhotonPass photons{{}, {}, 1 / static_cast<float>(plan_->paths), RadiusFactor(pass), tracksBlur};
  if (causticRadius_)
    photons.caustics = BuildPhotonMap(shot.Extract([](const Photon& photon) { return photon.isCaustic; }), stats);
  photons.all = BuildPhotonMap(std::move(shot), stats);
  return photons;
}

PathEstimate PhotonGatherer::Radiance(Walk walk, const PhotonPass& photons, Sampler& sampler, PassStats& stats) const {
  PathEstimate estimate;
  for (;;) {
    ++stats.cameraRays;
    const std::optional<SurfaceInteraction> hit = scene_->Intersect(walk.ray);
    // Sources that a gathering surface sees by specular ones reach it as caustic photons.
    if (walk.isAllSpecular || !walk.last.isSpecular)
      estimate +=
          walk.throughput * EmittedAlong(*scene_, walk.ray, hit ? &*hit : nullptr, walk.last, stats, options_.direct);
    if (!hit) return estimate;
    const Material* material = scene_->MaterialAt(*hit);
    if (!material) {
      walk.ray = SpawnRay(*hit, walk.ray.d);
      continue;
    }
    if (walk.scattered >= options_.maxDepth || walk.isDone) return estimate;
    const Bsdf bsdf = material->GetBsdf(*hit);
    if (bsdf.IsBlack()) return estimate;

    ++walk.scattered;
    sampler.StartBlock(walk.scattered);
    const auto follow = [&](Walk way, Sampler& fork) { return Radiance(std::move(way), photons, fork, stats); };
    if (const auto reflected = FollowReflected(&walk, *hit, bsdf, sampler, follow)) {
      estimate += *reflected;
      continue;
    }
    const Vec2d uDirection = sampler.Get2D();
    const double uLobe = sampler.Get1D();
    const double uRoulette = sampler.Get1D();
    const bool isGlossy = IsGlossy(bsdf), goesOn = isGlossy || walk.gathersLeft > 0;
    LightContext at = ContextOf(*scene_, *hit, bsdf, options_.direct);
    const GuidedBsdf guided(*hit, bsdf, goesOn && !isGlossy ? GuideAt(*hit, bsdf) : nullptr);
    if (!bsdf.IsPurelySpecular()) {
      const auto weigh = [&](int, const LiSample& li, double pdf) -> double {
        if (li.isDelta || options_.direct.technique != DirectTechnique::Mis) return 1;
        return PowerHeuristic(pdf, static_cast<double>(guided.Pdf(li.wi)));
      };
      estimate += walk.throughput * SampleDirectLight(*scene_, *hit, bsdf, at, sampler, stats, options_.direct, weigh);
      const GatherPoint point{*hit, bsdf, options_.maxDepth - walk.scattered, goesOn, sampler.BlockSeed()};
      estimate += walk.throughput * Gather(photons, point, stats);
    }

    const std::optional<BsdfSample> next = guided.Sample(*scene_, uLobe, uDirection, stats);
    if (!next) return estimate;
    walk.Scatter(*hit, *next, std::move(at));
    if (!next->IsSpecular()) {
      walk.isDone = !goesOn;
      if (!isGlossy) --walk.gathersLeft;
    }
    if (!SurvivesRoulette(uRoulette, &walk)) return estimate;
  }
}

const DirectionTable* PhotonGatherer::GuideAt(const SurfaceInteraction& hit, const Bsdf& bsdf) const {
  // A table has the directions on one side alone.
  if (bsdf.IsPurelySpecular() || bsdf.Flags().HasTransmission()) return nullptr;
  return gatherGuide_.At(hit.p, FaceForward(hit.ng, hit.wo));
}

PathEstimate PhotonGatherer::Gather(const PhotonPass& photons, const GatherPoint& point, PassStats& stats) const {
  Color sum, blur;
  const auto add = [&](const Map& map, const GatherRadius& radius) {
    const PathEstimate gathered =
        Gather(map, radius.At(point.hit.p).radius * photons.radiusFactor, photons.tracksBlur, point, stats);
    sum += gathered.radiance;
    blur += gathered.blur;
  };
  if (causticRadius_) add(photons.caustics, *causticRadius_);
  if (!point.causticsOnly || (!causticRadius_ && scene_->Facts().MayHaveCaustics())) add(photons.all, plan_->radius);
  return {sum * photons.weight, blur * photons.weight};
}

PathEstimate PhotonGatherer::Gather(const Map& map, float radius, bool tracksBlur, const GatherPoint& point,
                                    PassStats& stats) const {
  ++stats.gathers;
  const SurfaceInteraction& hit = point.hit;
  DensitySum sum(options_.kernel, hit, point.bsdf.Flags().HasTransmission(), radius, tracksBlur);
  map.ForEachWithin(hit.p, radius, [&](const Vec3& position, const Photon& photon, float distanceSquared) {
    ++stats.photonsGathered;
    if (photon.scattered > point.maxScattered || (point.causticsOnly && !photon.isCaustic)) return;
    const Vec3 wi = photon.wi.Decode();
    const PhotonPlace place{position, distanceSquared, photon.normal.Decode(), wi};
    if (!sum.Takes(place)) return;
    sum.Add(place, point.bsdf.Eval(hit.wo, wi, TransportMode::Radiance) * photon.flux);
  });
  const PathEstimate estimate = sum.Estimate(*scene_, point.seed, &stats.probeRays);
  return {Finite(estimate.radiance, &stats.nonFinite,
                 [&] { return SourceOfGather(*scene_, map, radius, hit, point.bsdf); }),
          estimate.blur};
}

}  // namespace dapple
