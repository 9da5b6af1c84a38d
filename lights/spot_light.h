// A spot light: a point light whose intensity falls from full to nothing between two cones around its axis.
//
// pbrt: `LightSource "spot"`. Directions are emitted in exact proportion to the intensity, so every emitted ray carries
// the same flux. The two versions of pbrt differ in the falloff between the cones.
#pragma once

#include "lights/light.h"

namespace dapple {

/// The intensity's share t in [0, 1], where t = (cos theta - cos total) / (cos start - cos total): t^4 in pbrt-v3,
/// t^2 (3 - 2 t) in pbrt-v4.
enum class SpotFalloff { PbrtV3, PbrtV4 };

/// The intensity of a spot light as a share of the full one, and directions drawn in proportion to it. Everything is in
/// terms of x = 1 - cos theta, which keeps its precision in narrow cones.
class SpotProfile {
 public:
  /// Angles from the axis in degrees. `totalWidth` is cut to [0, 180]; of `falloffStart` only the magnitude counts (as
  /// the cosine in pbrt has it), up to `totalWidth`. A cone narrower than 1e-4 degrees emits nothing: a float direction
  /// does not resolve it.
  SpotProfile(double totalWidth, double falloffStart, SpotFalloff falloff);

  /// Share in [0, 1] at x = 1 - cos theta.
  double Evaluate(double x) const;
  /// The integral of `Evaluate` over x in [0, 2]; times 2 pi it is that over solid angle.
  double Integral() const { return xStart_ + rimIntegral_; }
  /// x of density Evaluate(x) / Integral() for u in [0, 1).
  double Sample(double u) const;
  /// u with which `Sample` gives x.
  double Invert(double x) const;

 private:
  /// The share of the rim's flux that lies between t = 0 and `t`, and its inverse.
  double RimCdf(double t) const;
  double InvertRimCdf(double share) const;

  SpotFalloff falloff_;
  double xStart_ = 0, xTotal_ = 0;
  double rimIntegral_ = 0;
};

class SpotLight final : public Light {
 public:
  /// `axis`: the direction in which the light points, any length but zero. `intensity` in W / sr on the axis. Angles as
  /// for `SpotProfile`.
  SpotLight(const Vec3& position, const Vec3& axis, const Color& intensity, double totalWidthDegrees,
            double falloffStartDegrees, SpotFalloff falloff);

  std::string_view Name() const override { return "spot"; }
  bool IsDelta() const override { return true; }
  /// v3: 2 pi I ((1 - cos start) + (cos start - cos total) / 5); v4: with 1/2 in place of 1/5.
  Color Power() const override;
  double ImportanceAt(const LightContext& at) const override;

  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const override;
  double Pdf_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return 0; }
  LiRandom Invert_Li(const LightContext&, const Vec3&, const SurfaceInteraction*) const override { return {}; }

  std::optional<LeSample> Sample_Le(const LeRandom& u) const override;
  LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const override;
  LeRandom Invert_Le(const Ray& ray, const LightPoint& from) const override;

  /// Intensity in the unit direction `w` away from the light.
  Color Intensity(const Vec3& w) const;

 private:
  /// 1 - cos of the angle between `w` and the axis.
  double OneMinusCos(const Vec3& w) const;

  Vec3 position_;
  Vec3d s_, t_, axis_;
  Color intensity_;
  SpotProfile profile_;
};

}  // namespace dapple
