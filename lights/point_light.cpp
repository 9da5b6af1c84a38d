#include "lights/point_light.h"

#include "lights/light_math.h"
#include "src/sampling/warps.h"

namespace dapple {

Color PointLight::Power() const { return FiniteColor(intensity_, 4 * kPiD); }

double PointLight::ImportanceAt(const LightContext& at) const {
  return PointImportance(at, position_, static_cast<double>(intensity_.MaxComponent()));
}

std::optional<LiSample> PointLight::Sample_Li(const LightContext& at, const LiRandom&) const {
  return SamplePointLi(at, position_, intensity_);
}

std::optional<LeSample> PointLight::Sample_Le(const LeRandom& u) const {
  if (intensity_.IsBlack()) return std::nullopt;
  LeSample sample;
  sample.ray = Ray{position_, ToFloat(SampleSphere(u.direction))};
  sample.Le = intensity_;
  sample.pdfPos = 1;
  sample.pdfDir = kSpherePdf;
  sample.deltaPos = true;
  return sample;
}

LePdf PointLight::Pdf_Le(const Ray&, const LightPoint&) const { return {1, kSpherePdf}; }

LeRandom PointLight::Invert_Le(const Ray& ray, const LightPoint&) const {
  LeRandom u;
  u.direction = InvertSphere(ToDouble(ray.d));
  return u;
}

}  // namespace dapple
