#include "lights/distant_light.h"

#include "lights/light_math.h"

namespace dapple {

void DistantLight::Prepare(const SceneExtent& extent) {
  extent_ = {extent.center, extent.radius};
  disk_ = EmissionDisks::Smallest(extent, -direction_);
}

Color DistantLight::Power() const { return FiniteColor(irradiance_, disk_.Area()); }

double DistantLight::ImportanceAt(const LightContext& at) const {
  return static_cast<double>(irradiance_.MaxComponent()) * ReceiverCosine(at, -direction_);
}

std::optional<LiSample> DistantLight::Sample_Li(const LightContext& at, const LiRandom&) const {
  if (irradiance_.IsBlack()) return std::nullopt;
  LiSample sample;
  sample.L = irradiance_;
  sample.wi = -direction_;
  sample.pdf = 1;
  sample.p = PointOutside(extent_, at.p, sample.wi);
  sample.isDelta = true;
  sample.isDistant = true;
  return sample;
}

std::optional<LeSample> DistantLight::Sample_Le(const LeRandom& u) const {
  if (irradiance_.IsBlack()) return std::nullopt;
  LeSample sample;
  sample.ray = Ray{disk_.Sample(u.position), direction_};
  sample.Le = irradiance_;
  sample.pdfPos = 1 / disk_.Area();
  sample.pdfDir = 1;
  sample.deltaDir = true;
  return sample;
}

LePdf DistantLight::Pdf_Le(const Ray& ray, const LightPoint&) const { return {disk_.Pdf(ray.o), 1}; }

LeRandom DistantLight::Invert_Le(const Ray& ray, const LightPoint&) const {
  LeRandom u;
  u.position = disk_.Invert(ray.o);
  return u;
}

}  // namespace dapple
