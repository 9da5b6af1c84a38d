// Light from all around: an image of the environment, or one radiance from everywhere.
//
// pbrt: `LightSource "infinite"`. One table gives the directions both of `Sample_Li` (unless another strategy is
// chosen, environment_strategy.h) and of `Sample_Le`; emitted rays start on a disk across the scene (emission_disk.h)
// of area A(w), so that the power is the integral of L(w) A(w). For comparison, emission may draw its directions evenly
// instead.
#pragma once

#include "lights/emission_disk.h"
#include "lights/environment_map.h"
#include "lights/environment_strategy.h"
#include "lights/light.h"
#include "lights/light_frame.h"

namespace dapple {

/// How an environment draws the directions of the rays that it emits.
enum class EnvironmentEmission {
  Importance,  ///< by radiance, from the table of the map
  Uniform,     ///< evenly over the sphere
};

/// How an environment is sampled.
struct EnvironmentOptions {
  EnvironmentEmission emission = EnvironmentEmission::Importance;
  EnvironmentSampling sampling = EnvironmentSampling::Importance;  ///< of `Sample_Li`
  int samples = 1;                                                 ///< `Light::SampleCount`
};

class EnvironmentLight final : public Light {
 public:
  using Mapping = EnvironmentMapping;

  /// `image` as `EnvironmentMap` takes it; `EnvironmentMap::Repair` makes it so. `lightToRender` as for `LightFrame`.
  EnvironmentLight(const Image& image, const Transform& lightToRender, const Color& scale, Mapping mapping,
                   const EnvironmentOptions& options = {});
  EnvironmentLight(const EnvironmentLight&) = delete;
  EnvironmentLight& operator=(const EnvironmentLight&) = delete;

  std::string_view Name() const override { return "infinite"; }
  bool IsInfinite() const override { return true; }
  void Prepare(const SceneExtent& extent) override;
  void PrepareChoice(double probability) override {
    if (strategy_) strategy_->PrepareChoice(probability);
  }
  /// The integral of radiance times the area of the disk, over all directions; relative error below 5e-5.
  Color Power() const override { return power_; }
  double ImportanceAt(const LightContext& at) const override;

  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const override;
  double Pdf_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const override;
  LiRandom Invert_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const override;

  std::optional<LeSample> Sample_Le(const LeRandom& u) const override;
  LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const override;
  LeRandom Invert_Le(const Ray& ray, const LightPoint& from) const override;

  Color Le(const Ray& ray) const override;
  RadianceWithPdf LeWithPdf(const LightContext& at, const Ray& ray) const override { return Toward(at, ray.d); }

  TableUse Tables() const override {
    return map_.Tables() + disks_.Table() + (strategy_ ? strategy_->Tables() : TableUse());
  }
  bool WantsReceiver() const override { return strategy_ && strategy_->WantsReceiver(); }
  std::shared_ptr<const ReceiverTable> PrepareReceiver(const Bsdf& bsdf, const Vec3& wo) const override {
    return strategy_ ? strategy_->PrepareReceiver(bsdf, wo) : nullptr;
  }

  /// The map in its own space.
  const EnvironmentMap& Map() const { return map_; }

 private:
  Vec3 ToRender(const Vec3d& w) const { return frame_.ToRender(w); }
  Vec3d ToMap(const Vec3& w) const { return frame_.ToLight(w); }
  /// What comes from `wi`, with the density of `Sample_Li`.
  RadianceWithPdf Toward(const LightContext& at, const Vec3& wi) const;
  /// The density of emitted directions where the map has `value`.
  double EmissionPdf(const RadianceWithPdf& value) const;

  EnvironmentMap map_;
  EnvironmentOptions options_;
  LightFrame frame_;
  std::unique_ptr<EnvironmentStrategy> strategy_;  // of `Sample_Li`; null: the map's own density
  SceneExtent extent_;
  EmissionDisks disks_;
  Color power_;
};

/// The same radiance from everywhere. Toward a surface that light does not cross, directions are drawn by the cosine.
class UniformEnvironmentLight final : public Light {
 public:
  /// `L`: radiance, W / (m^2 sr).
  explicit UniformEnvironmentLight(const Color& L) : L_(L) {}

  std::string_view Name() const override { return "infinite"; }
  bool IsInfinite() const override { return true; }
  void Prepare(const SceneExtent& extent) override;
  /// L times the integral of the area of the disk over all directions.
  Color Power() const override { return power_; }
  double ImportanceAt(const LightContext& at) const override;

  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const override;
  double Pdf_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const override;
  LiRandom Invert_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const override;

  std::optional<LeSample> Sample_Le(const LeRandom& u) const override;
  LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const override;
  LeRandom Invert_Le(const Ray& ray, const LightPoint& from) const override;

  Color Le(const Ray&) const override { return L_; }
  TableUse Tables() const override { return disks_.Table(); }

 private:
  Color L_;
  SceneExtent extent_;
  EmissionDisks disks_;
  Color power_;
};

}  // namespace dapple
