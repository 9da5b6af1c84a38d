#include "src/photons/emission_sampler.h"

namespace dapple {

std::optional<EmissionSample> EmissionSampler::Sample(const LeRandom& u) const {
  EmissionSample sample;
  sample.own = u;
  if (guide_.IsEmpty()) {
    const PickedLight picked = scene_->Picker().PickByPower(u.part);
    if (picked.index < 0) return std::nullopt;
    sample.light = picked.index;
    sample.pdfLight = picked.probability;
    sample.own.part = picked.u;
  } else {
    const DiscreteSample picked = guide_.PickLight(u.part);
    const EmissionGuide::Bent bent = guide_.Bend(picked.index, {picked.u, u.position, u.direction});
    sample.light = picked.index;
    sample.pdfLight = picked.probability;
    sample.own = bent.own;
    sample.bend = bent.pdf;
  }
  const std::optional<LeSample> le = scene_->Lights()[static_cast<size_t>(sample.light)]->Sample_Le(sample.own);
  if (!le) return std::nullopt;
  sample.le = *le;
  return sample;
}

EmissionPdf EmissionSampler::Pdf(int light, const Ray& ray, const LightPoint& from) const {
  const Light& source = *scene_->Lights()[static_cast<size_t>(light)];
  const LePdf pdf = source.Pdf_Le(ray, from);
  if (guide_.IsEmpty()) return {scene_->Picker().ProbabilityByPower(light), pdf.position, pdf.direction, 1};
  const double bend = guide_.Bends(light) ? guide_.Pdf(light, source.Invert_Le(ray, from)) : 1;
  return {guide_.LightProbability(light), pdf.position, pdf.direction, bend};
}

LeRandom EmissionSampler::Inverse(int light, const Ray& ray, const LightPoint& from) const {
  LeRandom u = scene_->Lights()[static_cast<size_t>(light)]->Invert_Le(ray, from);
  if (guide_.IsEmpty()) {
    u.part = scene_->Picker().InvertByPower(light, u.part);
    return u;
  }
  u = guide_.Unbend(light, u);
  u.part = guide_.InvertLight(light, u.part);
  return u;
}

}  // namespace dapple
