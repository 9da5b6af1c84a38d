// Lights, and what lights are drawn with, with a fault planted in them, for the mutation suite: in the sampler, in the
// density, or in both.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/lights/light_checks.h"

namespace dapple {

/// Where the fault is.
enum class Place { Nowhere, Sampler, Density, Both };

inline bool InSampler(Place place) { return place == Place::Sampler || place == Place::Both; }
inline bool InDensity(Place place) { return place == Place::Density || place == Place::Both; }

/// A light that does and says what another one does.
class LightDecorator : public Light {
 public:
  LightDecorator(std::unique_ptr<Light> light, Place place) : light_(std::move(light)), place_(place) {}

  std::string_view Name() const override { return light_->Name(); }
  bool IsDelta() const override { return light_->IsDelta(); }
  bool IsInfinite() const override { return light_->IsInfinite(); }
  void Prepare(const SceneExtent& extent) override { light_->Prepare(extent); }
  Color Power() const override { return light_->Power(); }
  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const override {
    return light_->Sample_Li(at, u);
  }
  double Pdf_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const override {
    return light_->Pdf_Li(at, wi, hit);
  }
  LiRandom Invert_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const override {
    return light_->Invert_Li(at, wi, hit);
  }
  std::optional<LeSample> Sample_Le(const LeRandom& u) const override { return light_->Sample_Le(u); }
  LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const override { return light_->Pdf_Le(ray, from); }
  LeRandom Invert_Le(const Ray& ray, const LightPoint& from) const override { return light_->Invert_Le(ray, from); }
  Color Le(const Ray& ray) const override { return light_->Le(ray); }
  Color L(const SurfaceInteraction& hit, const Vec3& w) const override { return light_->L(hit, w); }

 protected:
  bool SamplerIsFaulty() const { return InSampler(place_); }
  bool DensityIsFaulty() const { return InDensity(place_); }

  std::unique_ptr<Light> light_;
  Place place_;
};

/// The names of the checks that reject something.
using Rejections = std::vector<std::string>;

/// A fault, what it is rejected by where it is planted, and the checks that must be among those, one for each place.
struct Fault {
  std::string name;
  std::function<Rejections(Place)> rejections;
  const char* rejectedBy[3];  ///< in the sampler, in the density, in both
};

std::vector<Fault> FaultsOfLights();
/// Of the choice of a light, of tables and of a BSDF.
std::vector<Fault> FaultsOfParts();

inline std::vector<Fault> AllFaults() {
  std::vector<Fault> faults = FaultsOfLights();
  for (Fault& fault : FaultsOfParts()) faults.push_back(std::move(fault));
  return faults;
}

}  // namespace dapple
