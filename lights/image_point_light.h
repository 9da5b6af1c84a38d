// What the lights have in common that shine from one point by an image of directions (goniometric, projection).
#pragma once

#include "lights/light.h"
#include "lights/light_frame.h"
#include "lights/light_math.h"

namespace dapple {

/// `Map` is an image over directions with its exact sampler, as `EnvironmentMap`: `Radiance` (here the intensity, W /
/// sr), `Evaluate` (with the density of the direction), `Sample`, `Invert`, `Integral`, `IsBlack`. Rays are emitted by
/// the density of the map, so that each carries nearly the same flux.
template <typename Map>
class ImagePointLight : public Light {
 public:
  bool IsDelta() const override { return true; }
  TableUse Tables() const override { return map_.Tables(); }
  /// The integral of the intensity over all directions.
  Color Power() const override { return map_.Integral(); }
  double ImportanceAt(const LightContext& at) const override {
    const std::optional<LiSample> sample = ImagePointLight::Sample_Li(at, {});
    return sample ? Importance(sample->L) * ReceiverCosine(at, sample->wi) : 0;
  }

  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom&) const override {
    const Vec3d away = ToDouble(at.p) - ToDouble(position_);
    if (LengthSquared(away) == 0) return std::nullopt;
    return SamplePointLi(at, position_, Intensity(ToFloat(Normalize(away))));
  }
  double Pdf_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return 0; }
  LiRandom Invert_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return {}; }

  std::optional<LeSample> Sample_Le(const LeRandom& u) const override {
    if (map_.IsBlack()) return std::nullopt;
    LeSample sample;
    sample.ray = Ray{position_, frame_.ToRender(map_.Sample(u.direction))};
    const auto value = map_.Evaluate(frame_.ToLight(sample.ray.d));
    if (value.pdf == 0 || value.L.IsBlack()) return std::nullopt;
    sample.Le = value.L;
    sample.pdfPos = 1;
    sample.pdfDir = value.pdf;
    sample.deltaPos = true;
    return sample;
  }
  LePdf Pdf_Le(const Ray& ray, const LightPoint&) const override {
    return {1, map_.Evaluate(frame_.ToLight(ray.d)).pdf};
  }
  LeRandom Invert_Le(const Ray& ray, const LightPoint&) const override {
    LeRandom u;
    if (!map_.IsBlack()) u.direction = map_.Invert(frame_.ToLight(ray.d));
    return u;
  }

  /// Intensity in the unit direction `w` away from the light, W / sr.
  Color Intensity(const Vec3& w) const { return map_.Radiance(frame_.ToLight(w)); }

 protected:
  /// `mapToRender` as for `LightFrame`; only its directions count.
  ImagePointLight(const Vec3& position, const Transform& mapToRender, Map map)
      : position_(position), frame_(mapToRender), map_(std::move(map)) {}

 private:
  Vec3 position_;
  LightFrame frame_;
  Map map_;
};

}  // namespace dapple
