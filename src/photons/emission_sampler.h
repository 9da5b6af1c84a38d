// The one question that photons ask: which light, where on it, which way. One unit cube of five random numbers for all
// lights of the scene, with the exact density and the inverse.
#pragma once

#include <optional>

#include "lights/light.h"
#include "lights/light_picker.h"
#include "src/photons/emission_guide.h"
#include "src/scene/scene.h"

namespace dapple {

/// A photon as it leaves its light.
struct EmissionSample {
  int light = -1;       ///< index in the scene
  double pdfLight = 0;  ///< discrete probability of this light
  LeSample le;          ///< with the light's own densities
  LeRandom own;         ///< the light's own random numbers, after a guide bent them
  double bend = 1;      ///< density of `own` in the unit cube: 1 without a guide
  /// The flux that one emitted photon stands for: the mean over photons is the scene's emitted power.
  Color Flux() const { return le.Flux() * static_cast<float>(1 / (pdfLight * bend)); }
  /// Of light, position and direction together.
  double Pdf() const { return pdfLight * le.pdfPos * le.pdfDir * bend; }
};

struct EmissionPdf {
  double light = 0;      ///< discrete
  double position = 0;   ///< as LeSample::pdfPos
  double direction = 0;  ///< as LeSample::pdfDir
  double bend = 1;       ///< of position and direction together: their density is position * direction * bend

  double Product() const { return light * position * direction * bend; }
};

class EmissionSampler {
 public:
  /// The scene must outlive the sampler. Lights are chosen by power, and rays by the lights themselves.
  explicit EmissionSampler(const Scene& scene) : scene_(&scene) {}
  /// The same, bent by what `guide` learned.
  EmissionSampler(const Scene& scene, EmissionGuide guide) : scene_(&scene), guide_(std::move(guide)) {}

  /// `u.part` chooses the light, and what is left of it the part of the light. Nothing where no light emits.
  std::optional<EmissionSample> Sample(const LeRandom& u) const;
  /// The densities with which `Sample` gives this ray of this light; `from` as for Light::Pdf_Le.
  EmissionPdf Pdf(int light, const Ray& ray, const LightPoint& from) const;
  /// The random numbers with which `Sample` gives this ray of this light.
  LeRandom Inverse(int light, const Ray& ray, const LightPoint& from) const;

  const EmissionGuide& Guide() const { return guide_; }

 private:
  const Scene* scene_;
  EmissionGuide guide_;
};

}  // namespace dapple
