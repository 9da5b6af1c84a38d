// A distant light: parallel rays that fill the scene, as from a sun of no extent.
//
// pbrt: `LightSource "distant"`. Rays are emitted from a disk across the scene.
#pragma once

#include "lights/emission_disk.h"

namespace dapple {

class DistantLight final : public Light {
 public:
  /// `directionOfTravel`: any length but zero. `irradiance` (pbrt's L) on a plane across it, in W / m^2.
  DistantLight(const Vec3& directionOfTravel, const Color& irradiance)
      : direction_(Normalize(directionOfTravel)), irradiance_(irradiance) {}

  std::string_view Name() const override { return "distant"; }
  bool IsDelta() const override { return true; }
  bool ComesFromOutside() const override { return true; }
  void Prepare(const SceneExtent& extent) override;
  /// Irradiance times the area of the disk.
  Color Power() const override;
  double ImportanceAt(const LightContext& at) const override;

  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const override;
  double Pdf_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return 0; }
  LiRandom Invert_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return {}; }

  std::optional<LeSample> Sample_Le(const LeRandom& u) const override;
  LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const override;
  LeRandom Invert_Le(const Ray& ray, const LightPoint& from) const override;

 private:
  Vec3 direction_;
  Color irradiance_;
  SceneExtent extent_;
  EmissionDisk disk_;
};

}  // namespace dapple
