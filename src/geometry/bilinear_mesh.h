// A mesh of bilinear patches, as pbrt's `bilinearmesh`: rectangles above all, but any four corners make a patch.
//
// The patch is p(u, v) = (1-u)(1-v) p00 + u(1-v) p10 + (1-u)v p01 + uv p11; orientation as for triangle meshes.
#pragma once

#include <array>
#include <vector>

#include "src/geometry/shape.h"

namespace dapple {

class BilinearMesh final : public Shape {
 public:
  /// `normals` and `uvs` are empty or as many as `positions`; each four `indices` make a patch: p00, p10, p01, p11.
  /// `reverseOrientation` also turns `normals` around. Throws `Error` where counts do not fit or an index is out of
  /// range.
  BilinearMesh(std::vector<Vec3> positions, std::vector<Vec3> normals, std::vector<Vec2> uvs, std::vector<int> indices,
               bool reverseOrientation = false, bool swapsHandedness = false);

  const std::vector<Vec3>& Positions() const { return positions_; }
  const std::vector<int>& Indices() const { return indices_; }

  int PrimitiveCount() const override { return static_cast<int>(indices_.size() / 4); }
  int64_t MemoryBytes() const override {
    return static_cast<int64_t>((positions_.size() + normals_.size()) * sizeof(Vec3) + uvs_.size() * sizeof(Vec2) +
                                indices_.size() * sizeof(int));
  }
  Bounds3 PrimitiveBounds(int primitive) const override;
  void AppendHull(std::vector<HullBall>* hull) const override;
  /// Reshetov 2019, "Cool patches"; in double.
  PrimitiveHits IntersectAll(const Ray& ray, int primitive) const override;
  SurfaceInteraction Interact(const Ray& ray, const PrimitiveHit& hit) const override;
  Vec2 Uv(const PrimitiveHit& hit) const override;

  double PrimitiveArea(int primitive) const override;
  /// Patch coordinates from a bilinear density that follows the area of the corners (pbrt-v4, 6.6.2).
  ShapeSample SampleArea(int primitive, const Vec2d& u) const override;
  double PdfArea(int primitive, const Vec3& p) const override;
  Vec2d InvertArea(int primitive, const Vec3& p) const override;
  /// By area.
  std::optional<ShapeSample> SampleSolidAngle(int primitive, const Vec3& reference, const Vec2d& u) const override;
  double PdfSolidAngle(int primitive, const Vec3& reference, const Vec3& p, const Vec3& n) const override;
  Vec2d InvertSolidAngle(int primitive, const Vec3& reference, const Vec3& p) const override;

 private:
  /// A patch in double: corners p00, p10, p01, p11.
  struct Patch {
    std::array<Vec3d, 4> corner;
    Vec3d At(double u, double v) const;
    Vec3d Du(double v) const { return (corner[1] - corner[0]) * (1 - v) + (corner[3] - corner[2]) * v; }
    Vec3d Dv(double u) const { return (corner[2] - corner[0]) * (1 - u) + (corner[3] - corner[1]) * u; }
    Vec3d Normal(double u, double v) const { return Cross(Du(v), Dv(u)); }
    /// The mixed derivative; zero for parallelograms.
    Vec3d Twist() const { return corner[3] - corner[2] - corner[1] + corner[0]; }
    bool IsParallelogram() const { return Twist() == Vec3d(0); }
    /// |dp/du x dp/dv| at the corners.
    std::array<double, 4> CornerAreas() const {
      return {Length(Normal(0, 0)), Length(Normal(1, 0)), Length(Normal(0, 1)), Length(Normal(1, 1))};
    }
    /// Patch coordinates of the point nearest to `p`.
    Vec2d Coordinates(const Vec3d& p) const;
    /// The density of `SampleArea` at patch coordinates, per area.
    double PdfArea(const Vec2d& st) const;
  };

  Patch PatchOf(int primitive) const;
  Vec2d UvAt(int primitive, const Vec2d& st) const;
  /// Interpolated vertex normal at patch coordinates; zero without vertex normals.
  Vec3d VertexNormal(int primitive, const Vec2d& st) const;
  Vec3d GeometricNormal(int primitive, const Patch& patch, const Vec2d& st) const;
  void FillDerivatives(int primitive, const Patch& patch, const Vec2d& st, SurfaceInteraction* interaction) const;

  std::vector<Vec3> positions_, normals_;
  std::vector<Vec2> uvs_;
  std::vector<int> indices_;
  bool flipsNormal_;
};

}  // namespace dapple
