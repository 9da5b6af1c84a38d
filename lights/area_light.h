// An area light: a shape that glows with the same radiance in all directions of its outside, or of both sides.
//
// pbrt: `AreaLightSource "diffuse"`. Rays leave from points uniform in the area, with directions by the cosine; of a
// ball the direction is drawn first, uniform over the sphere, and then the point by its cosine: near random numbers
// send light the same way. Its `pdfPos` and `pdfDir` are told as if the point came first; they are right as a product,
// which is the same in either order. Toward a point, a primitive of the shape is chosen by area, then a direction in
// the solid angle that it covers.
//
// Where alpha lets rays through, the share of them that meets the surface sees its whole radiance (`L`); what is
// sampled from the light carries that share of it.
#pragma once

#include "lights/light.h"
#include "src/geometry/shape.h"
#include "src/materials/alpha.h"
#include "src/sampling/distribution.h"

namespace dapple {

class AreaLight final : public Light {
 public:
  /// The light of `shape`, which must live as long; radiance on the outside (the side of `ng`), or on both sides.
  AreaLight(const Shape* shape, const Color& radiance, bool twoSided);
  /// Radiance by surface coordinates. `alpha`: the surface is there, and shines, with the probability `Coverage`
  /// (src/materials/alpha.h), as the scene's rays find it; null: everywhere.
  AreaLight(const Shape* shape, ColorTexturePtr radiance, bool twoSided, FloatTexturePtr alpha = nullptr);

  std::string_view Name() const override { return "area"; }
  /// pi L times the area, of both sides if two-sided; with a texture, its mean is taken over a fixed set of points.
  Color Power() const override;
  double ImportanceAt(const LightContext& at) const override;

  std::optional<LiSample> Sample_Li(const LightContext& at, const LiRandom& u) const override;
  double Pdf_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const override;
  /// `part` is the middle of what gives the primitive.
  LiRandom Invert_Li(const LightContext& at, const Vec3& wi, const SurfaceInteraction* hit) const override;

  std::optional<LeSample> Sample_Le(const LeRandom& u) const override;
  LePdf Pdf_Le(const Ray& ray, const LightPoint& from) const override;
  /// `part` is the middle of what gives the primitive.
  LeRandom Invert_Le(const Ray& ray, const LightPoint& from) const override;

  Color L(const SurfaceInteraction& hit, const Vec3& w) const override;

  /// By area, of a shape of several primitives.
  TableUse Tables() const override { return TableUse::Of(byArea_.MemoryBytes()); }

  /// Of one side, all primitives together.
  double Area() const { return area_; }

 private:
  struct Primitive {
    int index = 0;
    double probability = 1;
  };

  /// The light lies in a plane and shines to one side of it only.
  struct Plane {
    Vec3 normal;
    float offset = 0;  ///< Dot(normal, p) of none of its points is less
  };

  /// The radiance of a point that is there with its coverage.
  Color EmittedAt(const TextureContext& at) const;
  bool IsEvenlyBright() const { return radiance_->IsConstant() && (!alpha_ || alpha_->IsConstant()); }
  Color MeanRadiance() const;
  std::optional<Plane> FindPlane() const;
  Primitive ChoosePrimitive(double u) const;
  double PrimitiveProbability(int primitive) const { return byArea_.Size() > 0 ? byArea_.Probability(primitive) : 1; }
  double InvertPrimitive(int primitive) const {
    return byArea_.Size() > 0 ? byArea_.InvertDiscrete(primitive, 0.5) : 0.5;
  }
  /// Of a ray that leaves from `p`.
  int PrimitiveOf(const LightPoint& from, const Vec3& p) const;
  /// `Sample_Le` of a ball, direction first: 1 / (4 pi) times cos / (pi r^2) is the product 1 / area times cos / pi.
  std::optional<LeSample> SampleBall(const LeRandom& u) const;
  /// The density per solid angle of an emitted ray whose angle with the outside normal has this cosine.
  double DirectionPdf(float cosTheta) const;

  const Shape* shape_;
  ColorTexturePtr radiance_;
  FloatTexturePtr alpha_;
  bool twoSided_;
  Distribution1D byArea_;  // empty for one primitive
  double area_ = 0;
  bool isUniform_ = true;  // all primitives are sampled with a density of 1 / area
  Color meanRadiance_;
  Bounds3 bounds_;
  std::optional<Plane> plane_;
  std::optional<Ball> ball_;  // of one side only, evenly bright
};

}  // namespace dapple
