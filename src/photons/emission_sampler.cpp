#include "src/photons/emission_sampler.h"

namespace dapple {

std::optional<EmissionSample> EmissionSampler::Sample(const LeRandom& u) const {
  EmissionSample sample;
  EmissionGuide::Bent bent{u.position, u.direction};
  if (guide_.IsEmpty()) {
    const PickedLight picked = scene_->Picker().PickByPower(u.part);
    if (picked.index < 0) return std::nullopt;
    sample.light = picked.index;
    sample.pdfLight = picked.probability;
    sample.own.part = picked.u;
  } else {
    const DiscreteSample picked = guide_.PickLight(u.part);
    sample.light = picked.index;
    sample.pdfLight = picked.probability;
    sample.own.part = picked.u;
    bent = guide_.Bend(sample.light, u.position, u.direction);
  }
  sample.own.position = bent.position;
  sample.own.direction = bent.direction;
  sample.bend = bent.pdfPosition * bent.pdfDirection;
  const std::optional<LeSample> le = scene_->Lights()[static_cast<size_t>(sample.light)]->Sample_Le(sample.own);
  if (!le) return std::nullopt;
  sample.le = *le;
  sample.le.pdfPos *= bent.pdfPosition;
  sample.le.pdfDir *= bent.pdfDirection;
  return sample;
}

EmissionPdf EmissionSampler::Pdf(int light, const Ray& ray, const Vec3& n) const {
  const Light& source = *scene_->Lights()[static_cast<size_t>(light)];
  const LePdf pdf = source.Pdf_Le(ray, n);
  if (guide_.IsEmpty()) return {scene_->Picker().ProbabilityByPower(light), pdf.position, pdf.direction};
  const LeRandom own = source.Invert_Le(ray, n);
  const EmissionGuide::Bent bent = guide_.Unbend(light, own.position, own.direction);
  return {guide_.LightProbability(light), pdf.position * bent.pdfPosition, pdf.direction * bent.pdfDirection};
}

LeRandom EmissionSampler::Inverse(int light, const Ray& ray, const Vec3& n) const {
  LeRandom u = scene_->Lights()[static_cast<size_t>(light)]->Invert_Le(ray, n);
  if (guide_.IsEmpty()) {
    u.part = scene_->Picker().InvertByPower(light, u.part);
    return u;
  }
  const EmissionGuide::Bent bent = guide_.Unbend(light, u.position, u.direction);
  return {guide_.InvertLight(light, u.part), bent.position, bent.direction};
}

}  // namespace dapple
