#include "integrators/hybrid.h"

#include "integrators/emission_ratio.h"
#include "integrators/pixel_loop.h"
#include "src/base/error.h"
#include "src/photons/coverage.h"
#include "src/photons/kernel.h"
#include "src/photons/radius_schedule.h"
#include "src/photons/same_surface.h"

namespace dapple {

namespace {

/// A weight as photons carry it: huge, but finite.
float ToFloatRange(double weight) { return static_cast<float>(std::min(weight, 1e30)); }

/// How narrow a scattering is that goes a way of this density: 0 for the widest, 1 for specular ones.
double Sharpness(double pdf) {
  constexpr double kHalfSharp = 10;  // per solid angle: a lobe of about 0.1 sr
  return pdf / (pdf + kHalfSharp);
}

/// The probability with which a camera path goes on, along a way of this density, from where it gathered so many
/// photons.
double ContinueProbability(double pdf, double photons) {
  const double sharpness = Sharpness(pdf);
  return sharpness + (1 - sharpness) / (1 + photons);
}

}  // namespace

HybridIntegrator::HybridIntegrator(const IntegratorOptions& options) : options_(options) {
  if (options.direct.technique != DirectTechnique::Mis)
    throw Error("integrator hybrid joins all techniques of direct light; expected mis, or integrator path or sppm");
}

void HybridIntegrator::Prepare(const Scene& scene, uint64_t seed) {
  scene_ = &scene;
  seed_ = seed;
  plan_.emplace(scene, options_, 0, seed);
}

HybridIntegrator::MergeSite HybridIntegrator::SiteAt(const Vec3& p, const Merging& merging) const {
  const GatherForecast forecast = plan_->radius.At(p);
  const double factorSquared = Sqr(static_cast<double>(merging.radiusFactor));
  return {forecast.radius * merging.radiusFactor,
          static_cast<double>(plan_->paths) *
              Kernel::EffectiveArea(options_.kernel, static_cast<double>(forecast.radius)) * factorSquared,
          static_cast<double>(forecast.photons) * factorSquared};
}

PassStats HybridIntegrator::RenderPass(int pass, Film& film) const {
  Merging merging{RadiusFactor(pass), {}};
  PassStats stats = ShootPhotons(pass, &merging);
  const auto radiance = [&](const CameraRay& camera, Sampler& sampler, PassStats& tileStats) {
    return Radiance(camera.ray, merging, sampler, tileStats);
  };
  stats += RenderPixels(*scene_, seed_, pass, plan_->cameraSamples, radiance, film);
  film.FinishPass(pass);
  return stats;
}

/// The weights of a light path, vertex by vertex.
class HybridIntegrator::LightWalk {
 public:
  LightWalk(const HybridIntegrator& hybrid, const Merging& merging, const EmissionSample& emitted)
      : hybrid_(hybrid), merging_(merging), emitted_(emitted), light_(LightOf(hybrid, emitted.light)) {}

  /// At a surface; the sums for `Photon`.
  const MergingWeights::Sums& Arrive(const LightVertex& vertex) {
    if (vertex.scattered > 0) weights_.Arrive(AbsCosIn(vertex));
    return weights_.Before();
  }

  void Scatter(const LightVertex& vertex, const BsdfSample& next) {
    const double cosOut = static_cast<double>(AbsDot(vertex.hit.ng, next.wi));
    if (vertex.scattered == 0) {
      weights_.Begin(PathsAtFirst(vertex, next), cosOut);
    } else if (next.IsSpecular()) {
      weights_.ScatterSpecular(cosOut);
    } else {
      const MergeSite site = hybrid_.SiteAt(vertex.hit.p, merging_);
      const double pdf = CameraPdf(vertex, next);
      weights_.Scatter(site.eta, static_cast<double>(next.pdf), pdf * ContinueProbability(pdf, site.photons),
                       Sharpness(pdf), cosOut);
    }
  }

 private:
  static const Light& LightOf(const HybridIntegrator& hybrid, int light) {
    return *hybrid.scene_->Lights()[static_cast<size_t>(light)];
  }
  static double AbsCosIn(const LightVertex& vertex) {
    return static_cast<double>(AbsDot(vertex.hit.ng, vertex.hit.wo));
  }

  /// The density with which the camera's walk, coming the way that `next` goes, would go on to where the light came
  /// from.
  static double CameraPdf(const LightVertex& vertex, const BsdfSample& next) {
    return static_cast<double>(vertex.bsdf.Pdf(next.wi, vertex.hit.wo, TransportMode::Radiance));
  }

  /// Of a path that leaves its first surface: the densities of light sampling there and of scattering into the light,
  /// over that of the light path, of which `next` is the newest part.
  double PathsAtFirst(const LightVertex& vertex, const BsdfSample& next) const {
    const LeSample& le = emitted_.le;
    const double distanceSquared = LengthSquared(ToDouble(vertex.hit.p) - ToDouble(le.ray.o));
    const double ratio = EmissionRatio(emitted_.Pdf(), static_cast<double>(le.cosTheta), le.deltaPos, distanceSquared) *
                         AbsCosIn(vertex);
    if (next.IsSpecular()) return light_.IsDelta() ? 0 : 1 / ratio;
    // As the camera's walk comes there.
    SurfaceInteraction seen = vertex.hit;
    seen.wo = next.wi;
    const LightContext at = ContextOf(*hybrid_.scene_, seen, vertex.bsdf, hybrid_.options_.direct);
    const SurfaceInteraction origin = OriginOf(le);
    double paths = hybrid_.LightPdf(at, emitted_.light, vertex.hit.wo, light_.IsInfinite() ? nullptr : &origin);
    if (!light_.IsDelta()) {
      const double pdf = CameraPdf(vertex, next);
      paths += pdf * ContinueProbability(pdf, hybrid_.SiteAt(vertex.hit.p, merging_).photons);
    }
    return paths / (ratio * static_cast<double>(next.pdf));
  }

  const HybridIntegrator& hybrid_;
  const Merging& merging_;
  const EmissionSample& emitted_;
  const Light& light_;
  MergingWeights weights_;
};

PassStats HybridIntegrator::ShootPhotons(int pass, Merging* merging) const {
  ShotPhotons<Photon> shot = dapple::ShootPhotons<Photon>(
      *plan_, seed_, pass, [&](const EmissionSample& emitted, const Sampler& sampler, auto& chunk) {
        LightWalk walk(*this, *merging, emitted);
        const auto store = [&](const LightVertex& v) {
          const MergingWeights::Sums& others = walk.Arrive(v);
          // Light straight from its source is sampled where it is needed.
          if (v.scattered == 0 || v.bsdf.IsPurelySpecular()) return;
          chunk.Store(v.hit.p, {v.flux, OctahedralVector(v.hit.wo), OctahedralVector(v.hit.ng),
                                ToFloatRange(others.merging), ToFloatRange(others.paths), v.scattered});
        };
        const auto scatter = [&](const LightVertex& v, const BsdfSample& next) { walk.Scatter(v, next); };
        chunk.stats.photonRays += TraceLightPath(*scene_, emitted, sampler, options_.maxDepth, store, scatter);
      });
  PassStats stats;
  merging->map = BuildPhotonMap(std::move(shot), &stats);
  return stats;
}

Color HybridIntegrator::Radiance(const Ray& ray, const Merging& merging, Sampler& sampler, PassStats& stats) const {
  CameraWalk walk;
  walk.ray = ray;
  Color radiance;
  float etaScale = 1;
  for (;;) {
    ++stats.cameraRays;
    const std::optional<SurfaceInteraction> hit = scene_->Intersect(walk.ray);
    radiance += walk.throughput * EmittedAlong(walk, hit ? &*hit : nullptr);
    if (!hit) return radiance;
    const Material* material = scene_->MaterialAt(*hit);
    if (!material) {
      walk.ray = SpawnRay(*hit, walk.ray.d);
      continue;
    }
    if (walk.scattered >= options_.maxDepth) return radiance;
    const Bsdf bsdf = material->GetBsdf(*hit);
    if (bsdf.IsBlack()) return radiance;

    walk.weights.Arrive(static_cast<double>(AbsDot(hit->ng, hit->wo)));
    ++walk.scattered;
    sampler.StartBlock(walk.scattered);
    const Vec2d uDirection = sampler.Get2D();
    const double uLobe = sampler.Get1D();
    double uContinue = sampler.Get1D();
    walk.last.at = ContextOf(*scene_, *hit, bsdf, options_.direct);
    const MergeSite site = bsdf.IsPurelySpecular() ? MergeSite{} : SiteAt(hit->p, merging);
    if (!bsdf.IsPurelySpecular()) {
      if (sampler.Get1D() < walk.mergeProbability)
        radiance += walk.throughput * Merge(walk, merging, site, *hit, bsdf, sampler.BlockSeed(), stats);
      radiance += walk.throughput * SampleDirectLight(walk, site, *hit, bsdf, sampler, stats);
    }

    const std::optional<BsdfSample> next = bsdf.Sample(hit->wo, uLobe, uDirection, TransportMode::Radiance);
    if (!next) return radiance;
    walk.throughput *= next->weight;
    etaScale *= next->eta * next->eta;
    const double cosOut = static_cast<double>(AbsDot(hit->ng, next->wi));
    walk.last.isSpecular = next->IsSpecular();
    walk.last.pdf = next->pdf;
    if (next->IsSpecular()) {
      walk.weights.ScatterSpecular(cosOut);
    } else {
      const double pdf = static_cast<double>(next->pdf);
      const double keep = ContinueProbability(pdf, site.photons);
      if (uContinue >= keep) return radiance;
      uContinue /= keep;
      walk.throughput /= static_cast<float>(keep);
      walk.last.pdf = static_cast<float>(pdf * keep);
      const double reversePdf = static_cast<double>(bsdf.Pdf(next->wi, hit->wo, TransportMode::Importance));
      walk.weights.Scatter(site.eta * walk.mergeProbability, pdf * keep, reversePdf, 1, cosOut);
      walk.mergeProbability *= Sharpness(pdf);
    }
    walk.ray = SpawnRay(*hit, next->wi);
    if (!SurvivesRoulette(walk.scattered, uContinue, etaScale, &walk.throughput)) return radiance;
  }
}

Color HybridIntegrator::EmittedAlong(const CameraWalk& walk, const SurfaceInteraction* hit) const {
  const Ray& ray = walk.ray;
  return dapple::EmittedAlong(*scene_, ray, hit, [&](int index) -> double {
    if (walk.scattered == 0) return 1;
    double others = 0;
    if (!walk.last.isSpecular) {
      others = LightPdf(walk.last.at, index, ray.d, hit) / static_cast<double>(walk.last.pdf);
    }
    if (walk.weights.Unmerged().merging > 0) {
      const Vec3 n = hit ? hit->ng : Vec3(0);
      const double pdf = plan_->emission.Pdf(index, Ray{hit ? hit->p : ray.o, -ray.d}, n).Product();
      const double cosAtLight = hit ? static_cast<double>(AbsDot(n, ray.d)) : 1;
      others += EmissionRatio(pdf, cosAtLight, false, 0) * walk.weights.Unmerged().merging;
    }
    return 1 / (1 + others);
  });
}

double HybridIntegrator::LightPdf(const LightContext& at, int index, const Vec3& wi,
                                  const SurfaceInteraction* hit) const {
  return dapple::LightPdf(*scene_, at, index, wi, hit, options_.direct);
}

Color HybridIntegrator::SampleDirectLight(const CameraWalk& walk, const MergeSite& site, const SurfaceInteraction& hit,
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
      const double emitted = plan_->emission.Pdf(index, Ray{li.p, -li.wi}, li.n).Product();
      others += EmissionRatio(emitted, cosAtLight, isPoint, distanceSquared) *
                static_cast<double>(AbsDot(hit.ng, li.wi) * bsdf.Pdf(li.wi, hit.wo, TransportMode::Importance)) *
                walk.weights.Before().merging;
    }
    return pdf / (pdf + others);
  };
  return dapple::SampleDirectLight(*scene_, hit, bsdf, walk.last.at, sampler, stats, options_.direct, weigh);
}

Color HybridIntegrator::Merge(const CameraWalk& walk, const Merging& merging, const MergeSite& at,
                              const SurfaceInteraction& hit, const Bsdf& bsdf, uint64_t seed, PassStats& stats) const {
  ++stats.gathers;
  const Kernel kernel(options_.kernel, at.radius);
  const GatherSite site(hit.p, hit.ng, hit.wo, at.radius, bsdf.Flags().HasTransmission());
  const double eta = at.eta * walk.mergeProbability, before = walk.weights.Before().merging;
  Color sum;
  merging.map.ForEachWithin(hit.p, at.radius, [&](const Vec3& position, const Photon& photon, float distanceSquared) {
    ++stats.photonsGathered;
    if (photon.scattered + walk.scattered > options_.maxDepth) return;
    const Vec3 wi = photon.wi.Decode();
    if (!IsOnSameSurface(site, position, distanceSquared, photon.normal.Decode(), wi)) return;
    // Photons are dense by |ng.wi|, and Eval has the shading normal's cosine.
    const float cosine = AbsDot(hit.ng, wi);
    if (!(cosine > 0)) return;
    const Color value = bsdf.Eval(hit.wo, wi, TransportMode::Radiance) * photon.flux;
    if (value.IsBlack()) return;
    const double pdf = static_cast<double>(bsdf.Pdf(hit.wo, wi, TransportMode::Radiance));
    double others = pdf * ContinueProbability(pdf, at.photons) *
                    (static_cast<double>(photon.paths) +
                     walk.mergeProbability * Sharpness(pdf) * static_cast<double>(photon.merging));
    if (before > 0) others += static_cast<double>(bsdf.Pdf(wi, hit.wo, TransportMode::Importance)) * before;
    sum += value * (kernel(distanceSquared) / cosine * static_cast<float>(at.eta / (eta + others)));
  });
  if (!sum.IsBlack()) sum *= InverseCoverage(*scene_, hit, site, options_.kernel, seed, &stats.probeRays);
  return sum / static_cast<float>(plan_->paths);
}

}  // namespace dapple
