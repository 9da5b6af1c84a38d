#include "src/photons/emission_sampler.h"

namespace dapple {

std::optional<EmissionSample> EmissionSampler::Sample(const LeRandom& u) const {
  const PickedLight picked = scene_->Picker().PickByPower(u.part);
  if (picked.index < 0) return std::nullopt;
  const Light& light = *scene_->Lights()[static_cast<size_t>(picked.index)];
  std::optional<LeSample> le = light.Sample_Le({picked.u, u.position, u.direction});
  if (!le) return std::nullopt;
  return EmissionSample{picked.index, picked.probability, *le};
}

EmissionPdf EmissionSampler::Pdf(int light, const Ray& ray, const Vec3& n) const {
  const LePdf pdf = scene_->Lights()[static_cast<size_t>(light)]->Pdf_Le(ray, n);
  return {scene_->Picker().ProbabilityByPower(light), pdf.position, pdf.direction};
}

LeRandom EmissionSampler::Inverse(int light, const Ray& ray, const Vec3& n) const {
  LeRandom u = scene_->Lights()[static_cast<size_t>(light)]->Invert_Le(ray, n);
  u.part = scene_->Picker().InvertByPower(light, u.part);
  return u;
}

}  // namespace dapple
