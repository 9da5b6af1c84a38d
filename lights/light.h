// The interface of lights, both sides of each: a direction toward the light from a point, and a ray that leaves the
// light.
//
// Each draw has its density and its inverse. Densities of directions are per solid angle, of origins per area (on the
// light's surface, or on the disk across the scene that environments and distant lights emit from), unless the flag
// says that the choice is discrete; then the density is 1 and stands for the whole of it. Flux identity: the mean of Le
// |cos| / (pdfPos pdfDir) over emitted rays is `Power()`, where cos = 1 without a surface.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "src/base/color.h"
#include "src/geometry/interaction.h"
#include "src/geometry/ray.h"
#include "src/sampling/table_use.h"

namespace dapple {

class Bsdf;
class Light;

/// What a light has worked out for one receiver, whose scattering it was shown: see `Light::PrepareReceiver`.
struct ReceiverTable {
  explicit ReceiverTable(const Light* of) : light(of) {}
  ReceiverTable(const ReceiverTable&) = delete;
  ReceiverTable& operator=(const ReceiverTable&) = delete;
  virtual ~ReceiverTable() = default;

  const Light* light;
};

/// Where light is asked for. Light from behind an opaque surface (not transmissive, `n` not zero) does not count: a
/// light may leave it out of its importance and of what it draws.
struct LightContext {
  Vec3 p;
  Vec3 n{0, 0, 0};  ///< geometric normal, turned to the side that is looked from; zero where there is no surface
  bool transmissive = false;  ///< light from behind counts too
  /// The BSDF draws directions too, and both kinds are weighted against each other (multiple importance sampling): the
  /// light may leave to it what it finds well. Else the density of what the light draws is positive wherever its light
  /// comes from.
  bool bsdfDrawsToo = false;
  std::vector<std::shared_ptr<const ReceiverTable>> tables;  ///< of the lights that want one

  explicit LightContext(const Vec3& point) : p(point) {}
  LightContext(const Vec3& point, const Vec3& normal, bool isTransmissive)
      : p(point), n(normal), transmissive(isTransmissive) {}

  /// The table that `light` has made for this receiver, or null.
  const ReceiverTable* TableOf(const Light* light) const {
    for (const auto& table : tables)
      if (table->light == light) return table.get();
    return nullptr;
  }
};

/// Light that may arrive at a point.
struct LiSample {
  Color L;             ///< radiance; for a delta light, irradiance on a plane across wi
  Vec3 wi;             ///< unit direction toward the light
  double pdf = 0;      ///< per solid angle; 1 for a delta light
  Vec3 p;              ///< the point on the light; outside the scene for infinite lights
  float pError = 0;    ///< as in SurfaceInteraction
  Vec3 n{0, 0, 0};     ///< its normal; zero where there is no surface
  int primitive = -1;  ///< of the light's shape, where it has one
  bool isDelta = false;
  bool isDistant = false;  ///< comes from infinitely far away: a direction and no place
};

/// Where a ray leaves its light, beside its origin.
struct LightPoint {
  Vec3 n{0, 0, 0};     ///< unit normal; zero where there is no surface
  int primitive = -1;  ///< of the light's shape; -1: whichever is nearest to the origin, which takes long in big meshes
};

/// A ray that leaves a light.
struct LeSample {
  Ray ray;             ///< starts on the light, already moved off its surface
  Vec3 n{0, 0, 0};     ///< normal at the origin; zero where there is no surface
  float cosTheta = 1;  ///< |n . d|; 1 where there is no surface
  Color Le;            ///< radiance; intensity for a point-like origin; irradiance for a distant direction
  double pdfPos = 0;   ///< per area; 1 for a discrete origin
  double pdfDir = 0;   ///< per solid angle; 1 for a discrete direction
  bool deltaPos = false;
  bool deltaDir = false;
  int primitive = 0;  ///< of the light's shape, where it has one

  /// Where it leaves the light, for `Light::Pdf_Le` and `Invert_Le`.
  LightPoint From() const { return {n, primitive}; }
  /// The flux that this ray stands for.
  Color Flux() const { return Le * static_cast<float>(cosTheta / (pdfPos * pdfDir)); }
};

/// Radiance from an infinite light, and the density per solid angle with which its direction is drawn.
struct RadianceWithPdf {
  Color L;
  double pdf = 0;
};

/// The densities of an emitted ray.
struct LePdf {
  double position = 0;   ///< as LeSample::pdfPos
  double direction = 0;  ///< as LeSample::pdfDir
};

/// The random numbers of an emitted ray, each in [0, 1): which part of the light, where on it, which way.
struct LeRandom {
  double part = 0;
  Vec2d position{0, 0};
  Vec2d direction{0, 0};
};

/// The random numbers of a direction toward the light, each in [0, 1): which part of it, and where.
struct LiRandom {
  double part = 0;
  Vec2d direction{0, 0};
};

class Outline;

/// What the scene tells its lights before the first sample: a sphere around all that can be hit.
struct SceneExtent {
  Vec3 center{0, 0, 0};
  float radius = 1;
  /// What is seen of it from any side, while lights are prepared and where one of them `ComesFromOutside`; else null.
  const Outline* outline = nullptr;
};

/// Immutable after `Prepare` and shared by all threads.
class Light {
 public:
  virtual ~Light() = default;

  /// "point", "area", ...: the name in files and reports.
  virtual std::string_view Name() const = 0;
  /// A point or a direction of no extent: `Pdf_Li` is zero everywhere, and no ray finds it.
  virtual bool IsDelta() const { return false; }
  /// Rays that leave the scene find it; `Le` answers.
  virtual bool IsInfinite() const { return false; }
  /// Its rays set out from disks across the scene: an environment, a distant light.
  virtual bool ComesFromOutside() const { return IsInfinite(); }

  /// Called once, before all else.
  virtual void Prepare(const SceneExtent&) {}
  /// Called once more, where there are other lights: with what probability next-event estimation picks this one, at a
  /// point in the middle of the scene. A light may adapt to it how it draws directions, and nothing else.
  virtual void PrepareChoice(double /*probability*/) {}

  /// Total emitted flux, as `Sample_Le` emits it, in W (scene units).
  virtual Color Power() const = 0;
  /// About the irradiance that the light brings to a point, W / m^2 where the light reckons it; by default its power,
  /// W, which a light that is chosen against others had better override. For the choice among lights: finite, not
  /// negative, and zero only where surely none of its light arrives and counts (see `LightContext`), whatever stands
  /// between.
  virtual double ImportanceAt(const LightContext&) const { return static_cast<double>(Power().MaxComponent()); }

  /// True where `Sample_Li` would rather know how the receiver scatters: then `PrepareReceiver` is to be called before.
  virtual bool WantsReceiver() const { return false; }
  /// The table that belongs into `LightContext::tables` where light is scattered toward the unit vector `wo` by `bsdf`;
  /// or null. `Sample_Li`, `Pdf_Li` and `Invert_Li` speak of the same density only with the same tables.
  virtual std::shared_ptr<const ReceiverTable> PrepareReceiver(const Bsdf& /*bsdf*/, const Vec3& /*wo*/) const {
    return nullptr;
  }
  /// The tables that it has built to be sampled.
  virtual TableUse Tables() const { return {}; }

  /// How many directions next-event estimation draws where it has picked this light; at least 1.
  int SampleCount() const { return sampleCount_; }
  void SetSampleCount(int count) { sampleCount_ = count; }

  /// A direction toward the light; nothing where none of its light arrives (whatever stands between).
  virtual std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const = 0;
  /// The density with which `Sample_Li` gives the direction `wi`, per solid angle. `hit` is the point of the light that
  /// `wi` meets; null for infinite lights. Traces nothing. 0 for delta lights.
  virtual double Pdf_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const = 0;
  /// The random numbers with which `Sample_Li` gives the direction `wi`.
  virtual LiRandom Invert_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const = 0;

  /// A ray that leaves the light, distributed by emitted radiance times cosine as exactly as the light knows how;
  /// nothing where the light is black.
  virtual std::optional<LeSample> Sample_Le(const LeRandom& u) const = 0;
  /// The densities with which `Sample_Le` gives the ray. For infinite lights the origin may be any point along the ray:
  /// its line counts.
  virtual LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const = 0;
  /// The random numbers with which `Sample_Le` gives the ray.
  virtual LeRandom Invert_Le(const Ray& ray, const LightPoint& from) const = 0;

  /// Radiance that an infinite light sends back along a ray which left the scene; black for others.
  virtual Color Le(const Ray&) const { return Color(); }
  /// `Le(ray)` and `Pdf_Li(at, ray.d, nullptr)`, in one look-up where they share it.
  virtual RadianceWithPdf LeWithPdf(const LightContext& at, const Ray& ray) const {
    return {Le(ray), Pdf_Li(at, ray.d, nullptr)};
  }
  /// Radiance that an area light sends from the point `hit` along the unit vector `w`; black for others.
  virtual Color L(const SurfaceInteraction&, const Vec3& /*w*/) const { return Color(); }

 private:
  int sampleCount_ = 1;
};

}  // namespace dapple
