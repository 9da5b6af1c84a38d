// A point light: the same radiant intensity in all directions, from one point.
//
// pbrt: `LightSource "point"`.
#pragma once

#include "lights/light.h"

namespace dapple {

class PointLight final : public Light {
 public:
  /// `position` in render space, `intensity` in W / sr.
  PointLight(const Vec3& position, const Color& intensity) : position_(position), intensity_(intensity) {}

  std::string_view Name() const override { return "point"; }
  bool IsDelta() const override { return true; }
  /// 4 pi I.
  Color Power() const override;
  double ImportanceAt(const LightContext& at) const override;

  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const override;
  double Pdf_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return 0; }
  LiRandom Invert_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return {}; }

  std::optional<LeSample> Sample_Le(const LeRandom& u) const override;
  LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const override;
  LeRandom Invert_Le(const Ray& ray, const LightPoint& from) const override;

 private:
  Vec3 position_;
  Color intensity_;
};

}  // namespace dapple
