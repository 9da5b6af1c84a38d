#include "lights/environment_light.h"

#include "lights/light_math.h"
#include "src/base/frame.h"
#include "src/sampling/warps.h"

namespace dapple {

EnvironmentLight::EnvironmentLight(const Image& image, const Transform& lightToRender, const Color& scale,
                                   Mapping mapping, const EnvironmentOptions& options)
    : map_(image, mapping, scale), options_(options), frame_(lightToRender) {
  SetSampleCount(options.samples);
  if (!map_.IsBlack()) strategy_ = MakeStrategy(options.sampling, {this, map_, frame_});
}

void EnvironmentLight::Prepare(const SceneExtent& extent) {
  extent_ = {extent.center, extent.radius};
  if (map_.IsBlack()) return;
  disks_ = EmissionDisks(extent);
  power_ = map_.IntegralTimes([this](const Vec3d& w) { return disks_.Area(ToDouble(ToRender(w))); });
}

double EnvironmentLight::ImportanceAt(const LightContext&) const {
  // pi times the mean radiance.
  return static_cast<double>(map_.Integral().MaxComponent()) / 4;
}

std::optional<LiSample> EnvironmentLight::Sample_Li(const LightContext& at, const LiRandom& u) const {
  if (map_.IsBlack()) return std::nullopt;
  LiSample sample;
  sample.wi = strategy_ ? strategy_->Sample(at, u) : ToRender(map_.Sample(u.direction));
  const RadianceWithPdf value = Toward(at, sample.wi);
  if (value.pdf == 0) return std::nullopt;
  sample.L = value.L;
  sample.pdf = value.pdf;
  sample.p = PointOutside(extent_, at.p, sample.wi);
  sample.isDistant = true;
  return sample;
}

double EnvironmentLight::Pdf_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction*) const {
  return Toward(at, wi).pdf;
}

RadianceWithPdf EnvironmentLight::Toward(const LightContext& at, const Vec3& wi) const {
  const EnvironmentPlace place = map_.PlaceOf(ToMap(wi));
  return {map_.RadianceAt(place), strategy_ ? strategy_->Pdf(at, wi, place) : map_.DensityAt(map_.Density(), place)};
}

LiRandom EnvironmentLight::Invert_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction*) const {
  if (strategy_) return strategy_->Invert(at, wi);
  LiRandom u;
  if (!map_.IsBlack()) u.direction = map_.Invert(ToMap(wi));
  return u;
}

double EnvironmentLight::EmissionPdf(const RadianceWithPdf& value) const {
  return options_.emission == EnvironmentEmission::Uniform ? kSpherePdf : value.pdf;
}

std::optional<LeSample> EnvironmentLight::Sample_Le(const LeRandom& u) const {
  if (map_.IsBlack()) return std::nullopt;
  const bool isUniform = options_.emission == EnvironmentEmission::Uniform;
  const Vec3 wi = ToRender(isUniform ? SampleSphere(u.direction) : map_.Sample(u.direction));
  const RadianceWithPdf value = map_.Evaluate(ToMap(wi));
  const double pdf = EmissionPdf(value);
  if (pdf == 0 || value.L.IsBlack()) return std::nullopt;
  const EmissionDisk disk = disks_.Toward(wi);
  LeSample sample;
  sample.ray = Ray{disk.Sample(u.position), -wi};
  sample.Le = value.L;
  sample.pdfPos = 1 / disk.Area();
  sample.pdfDir = pdf;
  return sample;
}

LePdf EnvironmentLight::Pdf_Le(const Ray& ray, const LightPoint&) const {
  return {disks_.Toward(-ray.d).Pdf(ray.o), EmissionPdf(map_.Evaluate(ToMap(-ray.d)))};
}

LeRandom EnvironmentLight::Invert_Le(const Ray& ray, const LightPoint&) const {
  LeRandom u;
  if (!map_.IsBlack()) {
    const Vec3d w = ToMap(-ray.d);
    u.direction = options_.emission == EnvironmentEmission::Uniform ? InvertSphere(w) : map_.Invert(w);
  }
  u.position = disks_.Toward(-ray.d).Invert(ray.o);
  return u;
}

Color EnvironmentLight::Le(const Ray& ray) const { return map_.Radiance(ToMap(ray.d)); }

void UniformEnvironmentLight::Prepare(const SceneExtent& extent) {
  extent_ = {extent.center, extent.radius};
  if (L_.IsBlack()) return;
  disks_ = EmissionDisks(extent);
  power_ = FiniteColor(L_, disks_.AreaIntegral());
}

double UniformEnvironmentLight::ImportanceAt(const LightContext&) const {
  return kPiD * static_cast<double>(L_.MaxComponent());
}

std::optional<LiSample> UniformEnvironmentLight::Sample_Li(const LightContext& at, const LiRandom& u) const {
  if (L_.IsBlack()) return std::nullopt;
  LiSample sample;
  if (HasHorizon(at)) {
    sample.wi = Normalize(Frame::FromZ(at.n).ToWorld(ToFloat(SampleCosineHemisphere(u.direction))));
  } else {
    sample.wi = ToFloat(SampleSphere(u.direction));
  }
  sample.pdf = Pdf_Li(at, sample.wi, nullptr);
  if (sample.pdf == 0) return std::nullopt;
  sample.L = L_;
  sample.p = PointOutside(extent_, at.p, sample.wi);
  sample.isDistant = true;
  return sample;
}

double UniformEnvironmentLight::Pdf_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction*) const {
  return HasHorizon(at) ? CosineHemispherePdf(static_cast<double>(Dot(at.n, wi))) : kSpherePdf;
}

LiRandom UniformEnvironmentLight::Invert_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction*) const {
  LiRandom u;
  u.direction =
      HasHorizon(at) ? InvertCosineHemisphere(ToDouble(Frame::FromZ(at.n).ToLocal(wi))) : InvertSphere(ToDouble(wi));
  return u;
}

std::optional<LeSample> UniformEnvironmentLight::Sample_Le(const LeRandom& u) const {
  if (L_.IsBlack()) return std::nullopt;
  const Vec3 wi = ToFloat(SampleSphere(u.direction));
  const EmissionDisk disk = disks_.Toward(wi);
  LeSample sample;
  sample.ray = Ray{disk.Sample(u.position), -wi};
  sample.Le = L_;
  sample.pdfPos = 1 / disk.Area();
  sample.pdfDir = kSpherePdf;
  return sample;
}

LePdf UniformEnvironmentLight::Pdf_Le(const Ray& ray, const LightPoint&) const {
  return {disks_.Toward(-ray.d).Pdf(ray.o), kSpherePdf};
}

LeRandom UniformEnvironmentLight::Invert_Le(const Ray& ray, const LightPoint&) const {
  LeRandom u;
  u.position = disks_.Toward(-ray.d).Invert(ray.o);
  u.direction = InvertSphere(ToDouble(-ray.d));
  return u;
}

}  // namespace dapple
