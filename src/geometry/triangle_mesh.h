// A triangle mesh: what a scene's `trianglemesh`, `plymesh` and `loopsubdiv` become.
//
// Vertices are in render space, or in the space of the group that an instance places. Normals, uvs and tangents are
// optional. The orientation is pbrt's: with vertex normals, the outside is the side of the interpolated normal;
// without, the side from which the vertices run counter-clockwise, turned around by `reverseOrientation` !=
// `swapsHandedness`.
#pragma once

#include <array>
#include <vector>

#include "src/geometry/shape.h"

namespace dapple {

class TriangleMesh final : public Shape {
 public:
  /// `normals`, `uvs` and `tangents` are empty or as many as `positions`; normals and tangents need not be of unit
  /// length. Without uvs a triangle's corners are at (0,0), (1,0), (1,1). Each three `indices` make a triangle.
  /// `reverseOrientation` also turns `normals` around (so give them as they stand in the file, transformed);
  /// `swapsHandedness` says that the transform that made the positions mirrors. Throws `Error` where counts do not fit
  /// or an index is out of range. Triangles without area or with vertices that are not finite are never sampled.
  TriangleMesh(std::vector<Vec3> positions, std::vector<Vec3> normals, std::vector<Vec2> uvs, std::vector<int> indices,
               std::vector<Vec3> tangents = {}, bool reverseOrientation = false, bool swapsHandedness = false);

  int VertexCount() const { return vertexCount_; }
  Vec3 Position(int vertex) const { return Read3(vertex, 0); }
  const std::vector<int>& Indices() const { return indices_; }
  /// The vertices one after another, each `VertexStride()` floats of which the first three are its position; behind the
  /// last there is a float more, as Embree reads 16 bytes at each.
  const float* VertexData() const { return vertices_.data(); }
  int VertexStride() const { return stride_; }

  int PrimitiveCount() const override { return static_cast<int>(indices_.size() / 3); }
  int64_t MemoryBytes() const override {
    return static_cast<int64_t>(vertices_.size() * sizeof(float) + indices_.size() * sizeof(int));
  }
  Bounds3 PrimitiveBounds(int primitive) const override;
  void AppendHull(std::vector<HullBall>* hull) const override;
  PrimitiveHits IntersectAll(const Ray& ray, int primitive) const override;
  SurfaceInteraction Interact(const Ray& ray, const PrimitiveHit& hit) const override;
  Vec2 Uv(const PrimitiveHit& hit) const override;

  double PrimitiveArea(int primitive) const override;
  ShapeSample SampleArea(int primitive, const Vec2d& u) const override;
  double PdfArea(int primitive, const Vec3& p) const override;
  Vec2d InvertArea(int primitive, const Vec3& p) const override;
  /// Uniform over the spherical triangle (Arvo 1995); per area where that is too small or too large (pbrt-v4, 6.5.4).
  std::optional<ShapeSample> SampleSolidAngle(int primitive, const Vec3& reference, const Vec2d& u) const override;
  double PdfSolidAngle(int primitive, const Vec3& reference, const Vec3& p, const Vec3& n) const override;
  Vec2d InvertSolidAngle(int primitive, const Vec3& reference, const Vec3& p) const override;

 private:
  /// One triangle in double: a corner, two edges, and what follows from them.
  struct Corners {
    std::array<int, 3> index{};
    Vec3d p0, e1, e2;
    Vec3d cross;
    double crossLength = 0;  ///< twice the area; 0 where that is not finite
  };

  Corners CornersOf(int primitive) const;
  std::array<Vec2d, 3> CornerUvs(const std::array<int, 3>& index) const;
  /// The vertex normal at the barycentric coordinates `b`, of any length; zero without vertex normals.
  Vec3d VertexNormal(const std::array<int, 3>& index, const Vec3d& b) const;
  /// The unit geometric normal on the outside; any unit vector without area.
  Vec3d GeometricNormal(const Corners& corners, const Vec3d& vertexNormal) const;
  /// The weights of the corners at the point of the triangle nearest in its plane to `p`, in [0, 1].
  static Vec3d Barycentric(const Corners& corners, const Vec3& p);
  /// How far Embree's own arithmetic may see the surface from where it is, for rays that start at `p`.
  static float PointError(const Corners& corners, const Vec3d& n, const Vec3d& p);
  ShapeSample SampleAt(const Corners& corners, const Vec3d& b, double pdf) const;
  void FillShading(const Corners& corners, const Vec3d& b, const Vec3d& ng, const Vec3d& vertexNormal,
                   SurfaceInteraction* interaction) const;

  Vec3 Read3(int vertex, int offset) const {
    const float* data = &vertices_[static_cast<size_t>(vertex) * stride_ + offset];
    return {data[0], data[1], data[2]};
  }
  Vec3d Normal(int vertex) const { return ToDouble(Read3(vertex, normalOffset_)); }
  Vec3d Tangent(int vertex) const { return ToDouble(Read3(vertex, tangentOffset_)); }
  Vec2d VertexUv(int vertex) const {
    const float* data = &vertices_[static_cast<size_t>(vertex) * stride_ + uvOffset_];
    return {data[0], data[1]};
  }
  bool HasNormals() const { return normalOffset_ > 0; }
  bool HasUvs() const { return uvOffset_ > 0; }
  bool HasTangents() const { return tangentOffset_ > 0; }

  // All of a vertex together: a hit of a random ray waits for few cache lines instead of many.
  std::vector<float> vertices_;
  int vertexCount_;
  int stride_ = 3, normalOffset_ = 0, uvOffset_ = 0, tangentOffset_ = 0;  ///< in floats; offset 0: there are none
  std::vector<int> indices_;
  bool flipsNormal_;
};

}  // namespace dapple
