#include "lights/distant_light.h"

#include "lights/emission_disk.h"
#include "lights/light_math.h"

namespace dapple {

Color DistantLight::Power() const { return FiniteColor(irradiance_, EmissionDisk(extent_, -direction_).area); }

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
  return sample;
}

std::optional<LeSample> DistantLight::Sample_Le(const LeRandom& u) const {
  if (irradiance_.IsBlack()) return std::nullopt;
  const EmissionDisk disk(extent_, -direction_);
  LeSample sample;
  sample.ray = Ray{disk.Sample(u.position), direction_};
  sample.Le = irradiance_;
  sample.pdfPos = 1 / disk.area;
  sample.pdfDir = 1;
  sample.deltaDir = true;
  return sample;
}

LePdf DistantLight::Pdf_Le(const Ray& ray, const Vec3&) const {
  return {EmissionDisk(extent_, -direction_).Pdf(ray.o), 1};
}

LeRandom DistantLight::Invert_Le(const Ray& ray, const Vec3&) const {
  LeRandom u;
  u.position = EmissionDisk(extent_, -direction_).Invert(ray.o);
  return u;
}

}  // namespace dapple
