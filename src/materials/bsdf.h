// The BSDF at one surface point: a small value that evaluates and samples scattering, made by a `Material`.
//
// Everything here is in render space and includes the cosine, so that integrators multiply and never ask which normal:
//   radiance:    Eval = f(wo, wi) |ns.wi|
//   importance:  Eval = f(wi, wo) |ns.wo| |ng.wi| / |ng.wo|      (Veach 1997, section 5.3.2; light walks along wo ->
//   wi)
// In both modes wo is where the walk came from and wi where it goes. Radiance that refracts is scaled by 1/eta^2 (Veach
// 1997, section 5.2).
//
// Whether light is reflected or transmitted is decided by `ng`, so that shading normals leak nothing. A direction that
// ng and ns place on different sides is seen by the lobes mirrored across the shading plane: so silhouettes do not turn
// black, Lambert's f is the same on all of ng's hemisphere (as in pbrt-v3), and its albedo stays what it is. `Sample`
// reaches the mirrored directions too, with the exact density.
#pragma once

#include <cassert>
#include <cstdint>
#include <optional>
#include <variant>

#include "src/base/color.h"
#include "src/base/frame.h"
#include "src/base/vec.h"
#include "src/geometry/interaction.h"
#include "src/materials/lobes.h"

namespace dapple {

/// A sampled direction.
struct BsdfSample {
  Vec3 wi;
  Color weight;   ///< what the walk's throughput is multiplied by: Eval / pdf over all lobes that could have given wi;
                  ///< for specular lobes the lobe's share of the light over pdf
  float pdf = 0;  ///< per solid angle, over all non-specular lobes; for specular ones the discrete probability
  float eta = 1;  ///< relative index of refraction along a refracted path (n_to / n_from); 1 for reflection
  LobeFlags flags;  ///< of the branch of the lobe that was drawn

  bool IsSpecular() const { return flags.IsSpecular(); }
};

/// What comes by the two ways of a smooth interface, each with its whole share as weight (not over pdf).
struct SpecularPair {
  BsdfSample reflected, transmitted;
};

/// The shares of arriving flux that leave on the side where it came from, and on the other.
struct ScatteredShares {
  Color reflected, transmitted;

  Color Sum() const { return reflected + transmitted; }
  ScatteredShares& operator+=(const ScatteredShares& other) {
    reflected += other.reflected;
    transmitted += other.transmitted;
    return *this;
  }
  friend ScatteredShares operator*(const ScatteredShares& a, const Color& scale) {
    return {a.reflected * scale, a.transmitted * scale};
  }
};

/// Of a surface; its normal points outside.
enum class SurfaceSide { Outside, Inside };

class Bsdf {
 public:
  /// Two materials of five lobes (v3's "uber") may be mixed.
  static constexpr int kMaxLobes = 10;

  /// A black BSDF in the shading frame of `hit`.
  explicit Bsdf(const SurfaceInteraction& hit);
  /// As above in another shading frame, as bump and normal maps make it; its normal in the hemisphere of `hit.ng`.
  Bsdf(const SurfaceInteraction& hit, const Frame& shading);

  /// Adds a lobe whose value is multiplied by `scale`; at most kMaxLobes. A lobe of no albedo is left out.
  void Add(const Lobe& lobe, const Color& scale = Color(1));
  /// Adds the lobes of another BSDF, in the frame of this one.
  void Add(const Bsdf& other, const Color& scale);

  /// The union over lobes.
  LobeFlags Flags() const { return flags_; }
  bool IsBlack() const { return count_ == 0; }
  /// True where nothing but specular lobes are present: no point in connecting or in gathering photons.
  bool IsPurelySpecular() const { return !flags_.HasNonSpecular(); }
  /// The smallest roughness (GGX alpha) of the non-specular lobes; 1 for diffuse ones and where there are none.
  float MinRoughness() const;

  /// Scattering value times cosine, see above; zero for specular lobes. Unit vectors.
  Color Eval(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
    return isLambertian_ ? EvalLambertian(wo, wi, mode) : EvalLobes(wo, wi, mode);
  }
  /// Density per solid angle with which `Sample` gives the direction `wi`, specular lobes' share left out. It is the
  /// same in both modes.
  float Pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const;
  /// `uc` chooses the lobe, `u` the direction. Nothing where no light goes on: then the density integrates to less than
  /// one. Lobes are chosen in proportion to their albedo for `wo`.
  std::optional<BsdfSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const;

  /// The two ways that radiance comes from at a smooth interface, for walks that follow both. Nothing where there is
  /// one way, or more than two, or any that is not specular.
  std::optional<SpecularPair> BothWays(const Vec3& wo) const;

  /// An estimate of the hemispherical-directional reflectance and transmittance for `wo`, for demodulation and guides.
  Color Albedo(const Vec3& wo) const;

  /// Hemispherical-directional reflectance and transmittance: of the flux that arrives along `wo`, the shares that all
  /// lobes, specular ones too, scatter to either side. In the shading frame, as if ng were ns: the integral of `Eval`
  /// in importance mode, and what is specular; by reciprocity `reflected` is also the radiance toward `wo` under
  /// radiance 1 from all of its side. Exact for specular, Lambertian and Oren-Nayar lobes; any other by `samples` > 0
  /// stratified samples, the same in every call, a power of two best.
  ScatteredShares Rho(const Vec3& wo, int samples = 1024) const;
  /// Hemispherical-hemispherical ones: of diffuse light that arrives on one side, the mean of `Rho(wo)` by the cosine
  /// of wo, from `samples` stratified directions.
  ScatteredShares Rho(SurfaceSide from = SurfaceSide::Outside, int samples = 4096) const;

  const Frame& ShadingFrame() const { return shading_; }
  const Vec3& GeometricNormal() const { return ng_; }

 private:
  struct WeightedLobe {
    Lobe lobe;
    Color scale;
  };

  /// A direction as the lobes see it: local, z on the side on which ng has it.
  struct Sided {
    Vec3 local;
    float cosGeometric;
    bool isMirrored;

    bool IsValid() const { return cosGeometric != 0 && local.z != 0; }
  };

  /// The world directions that the lobes see as one local direction: up to two, itself and its mirror image.
  struct Preimages {
    bool direct, mirrored;

    int Count() const { return static_cast<int>(direct) + static_cast<int>(mirrored); }
  };

  Sided ToSided(const Vec3& w) const;
  Preimages PreimagesOf(const Vec3& local) const;
  float CosineFactor(const Sided& wo, const Sided& wi, TransportMode mode) const;
  Color ValueOfLobes(const Vec3& wo, const Vec3& wi, TransportMode mode) const;
  float PdfOfLobes(const Vec3& wo, const Vec3& wi) const;
  Color EvalLobes(const Vec3& wo, const Vec3& wi, TransportMode mode) const;
  /// The share of each lobe in the choice for the local direction `wo`; false where all are black.
  bool LobeProbabilities(const Vec3& wo, float* probabilities) const;
  /// One of the `count` preimages of `local`, drawn by `u`; nothing where there is none.
  std::optional<Sided> DrawPreimage(const Vec3& local, bool allowMirrored, double u, int* count) const;
  std::optional<BsdfSample> FinishSpecular(const Sided& wo, const Vec3& woWorld, const LobeSample& drawn,
                                           const Color& scale, double uMirror, TransportMode mode) const;
  std::optional<BsdfSample> FinishNonSpecular(const Sided& wo, const LobeSample& drawn, double uMirror,
                                              TransportMode mode) const;

  Color EvalLambertian(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
    const float cosO = Dot(wo, ng_), cosI = Dot(wi, ng_);
    const float cosine =
        mode == TransportMode::Radiance || isFlat_ ? AbsDot(wi, shading_.n) : AbsDot(wo, shading_.n) * (cosI / cosO);
    return lambertian_ * (cosO * cosI > 0 ? cosine : 0);  // no branch: photons come from either side
  }

  Frame shading_;
  Vec3 ng_;
  Vec3 ngLocal_;
  Color lambertian_;  ///< albedo / pi where there is one Lambertian reflection and nothing else
  LobeFlags flags_;
  bool isLambertian_ = false;
  bool isFlat_;  ///< ns == ng
  int count_ = 0;
  // Only the first count_ are alive: a union, so that the rest is never initialised.
  union {
    WeightedLobe lobes_[kMaxLobes];
  };
};

}  // namespace dapple
