#include "integrators/hybrid.h"

#include "integrators/density_sum.h"
#include "src/base/error.h"
#include "src/photons/radius_schedule.h"

namespace dapple {

namespace {

/// A weight as photons carry it: huge, but finite.
float ToFloatRange(double weight) { return static_cast<float>(std::min(weight, 1e30)); }

}  // namespace

HybridIntegrator::HybridIntegrator(const IntegratorOptions& options) : options_(options) {
  if (options.direct.technique != DirectTechnique::Mis)
    throw Error("integrator hybrid joins all techniques of direct light; expected mis, or integrator path or sppm");
}

void HybridIntegrator::Prepare(const Scene& scene, uint64_t seed) {
  scene_ = &scene;
  seed_ = seed;
  plan_.emplace(scene, options_, PhotonUse{.forecastsPhotons = true}, seed);
}

MergeSite HybridIntegrator::SiteAt(const Vec3& p, const Merging& merging) const {
  const GatherForecast forecast = plan_->radius.At(p);
  const double factorSquared = Sqr(static_cast<double>(merging.radiusFactor));
  return {forecast.radius * merging.radiusFactor,
          static_cast<double>(plan_->paths) *
              Kernel::EffectiveArea(options_.kernel, static_cast<double>(forecast.radius)) * factorSquared,
          static_cast<double>(forecast.photons) * factorSquared};
}

PassStats HybridIntegrator::RenderPass(int pass, Film& film) const {
  Merging merging{RadiusFactor(pass), film.TracksBlur(), {}};
  PassStats stats = ShootPhotons(pass, &merging);
  const auto radiance = [&](const CameraRay& camera, Sampler& sampler, PassStats& tileStats) {
    return Radiance(Walk(camera.ray), merging, sampler, tileStats);
  };
  stats += RenderPixels(*scene_, seed_, pass, SampleAllocation(plan_->cameraSamples), radiance, film);
  film.FinishPass(pass);
  return stats;
}

PassStats HybridIntegrator::ShootPhotons(int pass, Merging* merging) const {
  const auto siteAt = [&](const Vec3& p) { return SiteAt(p, *merging); };
  ShotPhotons<Photon> shot = dapple::ShootPhotons<Photon>(
      *plan_, seed_, pass, [&](const EmissionSample& emitted, const Sampler& sampler, auto& chunk) {
        LightWalk walk(*scene_, options_.direct, emitted, siteAt);
        const auto store = [&](const LightVertex& v) {
          const MergingWeights::Sums& others = walk.Arrive(v);
          // Light straight from its source is sampled where it is needed.
          if (v.scattered == 0 || v.bsdf.IsPurelySpecular()) return;
          chunk.Store(v.hit.p, {ShadedFlux(v), OctahedralVector(v.hit.wo), OctahedralVector(v.hit.ng),
                                ToFloatRange(others.merging), ToFloatRange(others.paths), v.scattered});
        };
        const auto scatter = [&](const LightVertex& v, const BsdfSample& next) { walk.Scatter(v, next); };
        AddLightPath(TraceLightPath(*scene_, emitted, sampler, options_.maxDepth, store, scatter), emitted,
                     &chunk.stats);
      });
  PassStats stats;
  merging->map = BuildPhotonMap(std::move(shot), &stats);
  return stats;
}

PathEstimate HybridIntegrator::Radiance(Walk walk, const Merging& merging, Sampler& sampler, PassStats& stats) const {
  PathEstimate estimate;
  for (;;) {
    ++stats.cameraRays;
    const std::optional<SurfaceInteraction> hit = scene_->Intersect(walk.ray);
    estimate += walk.throughput * EmittedAlong(walk, hit ? &*hit : nullptr, stats);
    if (!hit) return estimate;
    const Material* material = scene_->MaterialAt(*hit);
    if (!material) {
      walk.ray = SpawnRay(*hit, walk.ray.d);
      continue;
    }
    if (walk.scattered >= options_.maxDepth) return estimate;
    const Bsdf bsdf = material->GetBsdf(*hit);
    if (bsdf.IsBlack()) return estimate;

    walk.weights.Arrive(static_cast<double>(AbsDot(hit->ng, hit->wo)));
    ++walk.scattered;
    sampler.StartBlock(walk.scattered);
    const auto follow = [&](Walk way, Sampler& fork) { return Radiance(std::move(way), merging, fork, stats); };
    if (const auto reflected = FollowReflected(&walk, *hit, bsdf, sampler, follow)) {
      estimate += *reflected;
      continue;
    }
    const Vec2d uDirection = sampler.Get2D();
    const double uLobe = sampler.Get1D();
    double uContinue = sampler.Get1D();
    walk.last.at = ContextOf(*scene_, *hit, bsdf, options_.direct);
    const MergeSite site = bsdf.IsPurelySpecular() ? MergeSite{} : SiteAt(hit->p, merging);
    if (!bsdf.IsPurelySpecular()) {
      if (sampler.Get1D() < walk.mergeProbability)
        estimate += walk.throughput * Merge(walk, merging, site, *hit, bsdf, sampler.BlockSeed(), stats);
      estimate += walk.throughput * SampleDirectLight(walk, site, *hit, bsdf, sampler, stats);
    }

    const std::optional<BsdfSample> next = SampleWayOn(*scene_, *hit, bsdf, uLobe, uDirection, stats);
    if (!next) return estimate;
    if (next->IsSpecular()) {
      walk.ScatterSpecular(*hit, *next);
    } else {
      const double pdf = static_cast<double>(next->pdf), keep = ContinueProbability(pdf, site.photons);
      if (uContinue >= keep) return estimate;
      uContinue /= keep;
      walk.Scatter(*hit, *next, std::move(walk.last.at));
      walk.throughput /= static_cast<float>(keep);
      walk.last.pdf = static_cast<float>(pdf * keep);
      const double reversePdf = static_cast<double>(bsdf.Pdf(next->wi, hit->wo, TransportMode::Importance));
      walk.weights.Scatter(site.eta * walk.mergeProbability, pdf * keep, reversePdf, 1,
                           static_cast<double>(AbsDot(hit->ng, next->wi)));
      walk.mergeProbability *= Sharpness(pdf);
    }
    if (!SurvivesRoulette(uContinue, &walk)) return estimate;
  }
}

Color HybridIntegrator::EmittedAlong(const Walk& walk, const SurfaceInteraction* hit, PassStats& stats) const {
  const Ray& ray = walk.ray;
  return dapple::EmittedAlong(*scene_, ray, hit, stats, [&](int index) -> double {
    if (walk.scattered == 0) return 1;
    double others = 0;
    if (!walk.last.isSpecular) {
      others = LightPdf(*scene_, walk.last.at, index, ray.d, hit, options_.direct) / static_cast<double>(walk.last.pdf);
    }
    if (walk.weights.Unmerged().merging > 0) {
      const LightPoint from = hit ? LightPoint{hit->ng, hit->primitive} : LightPoint{};
      const double pdf = plan_->emission.Pdf(index, Ray{hit ? hit->p : ray.o, -ray.d}, from).Product();
      const double cosAtLight = hit ? static_cast<double>(AbsDot(hit->ng, ray.d)) : 1;
      others += EmissionRatio(pdf, cosAtLight, false, 0) * walk.weights.Unmerged().merging;
    }
    return 1 / (1 + others);
  });
}

Color HybridIntegrator::SampleDirectLight(const Walk& walk, const MergeSite& site, const SurfaceInteraction& hit,
                                          const Bsdf& bsdf, Sampler& sampler, PassStats& stats) const {
  const auto weigh = [&](int index, const LiSample& li, double pdf) {
    double others = 0;
    if (!li.isDelta) {
      others = static_cast<double>(bsdf.Pdf(hit.wo, li.wi, TransportMode::Radiance));
      others *= ContinueProbability(others, site.photons);
    }
    if (walk.weights.Before().merging > 0) {
      const bool isPoint = li.isDelta && !li.isDistant;
      const double distanceSquared = LengthSquared(ToDouble(li.p) - ToDouble(hit.p));
      const double cosAtLight = LengthSquared(li.n) > 0 ? static_cast<double>(AbsDot(li.n, li.wi)) : 1;
      const double emitted = plan_->emission.Pdf(index, Ray{li.p, -li.wi}, {li.n, li.primitive}).Product();
      others += EmissionRatio(emitted, cosAtLight, isPoint, distanceSquared) *
                static_cast<double>(AbsDot(hit.ng, li.wi) * bsdf.Pdf(li.wi, hit.wo, TransportMode::Importance)) *
                walk.weights.Before().merging;
    }
    return pdf / (pdf + others);
  };
  return dapple::SampleDirectLight(*scene_, hit, bsdf, walk.last.at, sampler, stats, options_.direct, weigh);
}

PathEstimate HybridIntegrator::Merge(const Walk& walk, const Merging& merging, const MergeSite& at,
                                     const SurfaceInteraction& hit, const Bsdf& bsdf, uint64_t seed,
                                     PassStats& stats) const {
  ++stats.gathers;
  const double eta = at.eta * walk.mergeProbability, before = walk.weights.Before().merging;
  DensitySum sum(options_.kernel, hit, bsdf.Flags().HasTransmission(), at.radius, merging.tracksBlur);
  merging.map.ForEachWithin(hit.p, at.radius, [&](const Vec3& position, const Photon& photon, float distanceSquared) {
    ++stats.photonsGathered;
    if (photon.scattered + walk.scattered > options_.maxDepth) return;
    const Vec3 wi = photon.wi.Decode();
    const PhotonPlace place{position, distanceSquared, photon.normal.Decode(), wi};
    if (!sum.Takes(place)) return;
    const Color value = bsdf.Eval(hit.wo, wi, TransportMode::Radiance) * photon.flux;
    if (value.IsBlack()) return;
    const double pdf = static_cast<double>(bsdf.Pdf(hit.wo, wi, TransportMode::Radiance));
    double others = pdf * ContinueProbability(pdf, at.photons) *
                    (static_cast<double>(photon.paths) +
                     walk.mergeProbability * Sharpness(pdf) * static_cast<double>(photon.merging));
    if (before > 0) others += static_cast<double>(bsdf.Pdf(wi, hit.wo, TransportMode::Importance)) * before;
    sum.Add(place, value, static_cast<float>(at.eta / (eta + others)));
  });
  const PathEstimate estimate = sum.Estimate(*scene_, seed, &stats.probeRays);
  const auto paths = static_cast<float>(plan_->paths);
  return {Finite(estimate.radiance / paths, &stats.nonFinite,
                 [&] { return SourceOfGather(*scene_, merging.map, at.radius, hit, bsdf); }),
          estimate.blur / paths};
}

}  // namespace dapple
