#include "src/geometry/triangle_mesh.h"

#include <utility>

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/base/frame.h"
#include "src/geometry/spherical_triangle.h"
#include "src/geometry/surface_math.h"
#include "src/sampling/warps.h"

namespace dapple {
namespace {

Vec3d Mix(const Vec3d& b, const Vec3d& v0, const Vec3d& v1, const Vec3d& v2) { return v0 * b.x + v1 * b.y + v2 * b.z; }

/// Uniform per area.
Vec3d SquareToTriangle(const Vec2d& u) {
  const Vec2d b = SampleTriangle(u);
  return {1 - b.x - b.y, b.x, b.y};
}

Vec2d TriangleToSquare(const Vec3d& b) { return InvertTriangle({b.y, b.z}); }

Vec2d Mix(const Vec3d& b, const std::array<Vec2d, 3>& v) { return v[0] * b.x + v[1] * b.y + v[2] * b.z; }

/// Derivatives by u and v of what has the values v0, v1, v2 at the corners; false where the uvs span no area.
struct UvGradient {
  explicit UvGradient(const std::array<Vec2d, 3>& uv) : d1(uv[1] - uv[0]), d2(uv[2] - uv[0]) {
    const double determinant = d1.x * d2.y - d1.y * d2.x;  // exact products: the uvs are floats
    // Relative to the edges, so that densely tessellated meshes with small uv steps keep theirs.
    constexpr double kDegenerate = 1e-9;
    isValid = Sqr(determinant) > Sqr(kDegenerate) * d1.length2() * d2.length2();
    inverse = isValid ? 1 / determinant : 0;
  }
  Vec3d ByU(const Vec3d& e1, const Vec3d& e2) const { return (e1 * d2.y - e2 * d1.y) * inverse; }
  Vec3d ByV(const Vec3d& e1, const Vec3d& e2) const { return (e2 * d1.x - e1 * d2.x) * inverse; }

  Vec2d d1, d2;
  double inverse;
  bool isValid;
};

}  // namespace

TriangleMesh::TriangleMesh(std::vector<Vec3> positions, std::vector<Vec3> normals, std::vector<Vec2> uvs,
                           std::vector<int> indices, std::vector<Vec3> tangents, bool reverseOrientation,
                           bool swapsHandedness)
    : vertexCount_(static_cast<int>(positions.size())),
      indices_(std::move(indices)),
      flipsNormal_(reverseOrientation != swapsHandedness) {
  const auto requireCount = [&](size_t given, const char* what) {
    if (given != 0 && given != positions.size())
      throw Error(fmt::format("triangle mesh: {} {} given for {} positions: expected as many, or none", given, what,
                              positions.size()));
  };
  requireCount(normals.size(), "normals");
  requireCount(uvs.size(), "uvs");
  requireCount(tangents.size(), "tangents");
  if (indices_.size() % 3 != 0)
    throw Error(fmt::format("triangle mesh: {} indices given: expected a multiple of three", indices_.size()));
  for (const int index : indices_)
    if (index < 0 || index >= vertexCount_)
      throw Error(
          fmt::format("triangle mesh: vertex index {} out of range: expected 0 to {}", index, vertexCount_ - 1));

  const auto reserve = [&](bool isThere, int floats) { return isThere ? std::exchange(stride_, stride_ + floats) : 0; };
  normalOffset_ = reserve(!normals.empty(), 3);
  uvOffset_ = reserve(!uvs.empty(), 2);
  tangentOffset_ = reserve(!tangents.empty(), 3);
  vertices_.resize(positions.size() * stride_ + 1);
  for (size_t i = 0; i < positions.size(); ++i) {
    float* vertex = &vertices_[i * stride_];
    const auto write = [&](const Vec3& v, int offset) { std::copy_n(&v.x, 3, vertex + offset); };
    write(positions[i], 0);
    if (HasNormals()) write(reverseOrientation ? -normals[i] : normals[i], normalOffset_);
    if (HasUvs()) std::copy_n(&uvs[i].x, 2, vertex + uvOffset_);
    if (HasTangents()) write(tangents[i], tangentOffset_);
  }
}

TriangleMesh::Corners TriangleMesh::CornersOf(int primitive) const {
  Corners corners;
  corners.index = {indices_[3 * primitive], indices_[3 * primitive + 1], indices_[3 * primitive + 2]};
  corners.p0 = ToDouble(Position(corners.index[0]));
  corners.e1 = ToDouble(Position(corners.index[1])) - corners.p0;
  corners.e2 = ToDouble(Position(corners.index[2])) - corners.p0;
  corners.cross = Cross(corners.e1, corners.e2);
  const double length = Length(corners.cross);
  corners.crossLength = std::isfinite(length) ? length : 0;
  return corners;
}

std::array<Vec2d, 3> TriangleMesh::CornerUvs(const std::array<int, 3>& index) const {
  if (!HasUvs()) return {Vec2d(0, 0), Vec2d(1, 0), Vec2d(1, 1)};
  return {VertexUv(index[0]), VertexUv(index[1]), VertexUv(index[2])};
}

Bounds3 TriangleMesh::PrimitiveBounds(int primitive) const {
  Bounds3 bounds;
  for (int corner = 0; corner < 3; ++corner) ExtendBy(&bounds, Position(indices_[3 * primitive + corner]));
  return bounds;
}

void TriangleMesh::AppendHull(std::vector<HullBall>* hull) const {
  AppendVertices(
      indices_, vertexCount_, [this](int vertex) { return Position(vertex); }, hull);
}

PrimitiveHits TriangleMesh::IntersectAll(const Ray& ray, int primitive) const {
  const Corners corners = CornersOf(primitive);
  const Vec3d d = ToDouble(ray.d), a = corners.p0 - ToDouble(ray.o), b = a + corners.e1, c = a + corners.e2;
  const double w0 = Dot(d, Cross(b, c)), w1 = Dot(d, Cross(c, a)), w2 = Dot(d, Cross(a, b));
  if (!((w0 >= 0 && w1 >= 0 && w2 >= 0) || (w0 <= 0 && w1 <= 0 && w2 <= 0))) return {};
  const double sum = w0 + w1 + w2;
  const double t = Dot(a, corners.cross) / Dot(d, corners.cross);
  if (sum == 0 || !(t > 0 && t < ray.tMax)) return {};
  return {1, {{static_cast<float>(t), static_cast<float>(w1 / sum), static_cast<float>(w2 / sum), primitive}, {}}};
}

Vec2 TriangleMesh::Uv(const PrimitiveHit& hit) const {
  const int* i = &indices_[3 * hit.primitive];
  return ToFloat(Mix({1.0 - hit.b1 - hit.b2, hit.b1, hit.b2}, CornerUvs({i[0], i[1], i[2]})));
}

Vec3d TriangleMesh::VertexNormal(const std::array<int, 3>& index, const Vec3d& b) const {
  return HasNormals() ? Mix(b, Normal(index[0]), Normal(index[1]), Normal(index[2])) : Vec3d(0);
}

Vec3d TriangleMesh::GeometricNormal(const Corners& corners, const Vec3d& vertexNormal) const {
  const Vec3d n = corners.crossLength > 0 ? corners.cross / corners.crossLength : Vec3d(0, 0, 1);
  const Vec3d oriented = flipsNormal_ ? -n : n;
  return Dot(oriented, vertexNormal) < 0 ? -oriented : oriented;
}

// Embree rounds vertices and edges relative to the ray's origin, and so the normal, whose error grows for slivers as
// the products of edges that make it cancel. Axis by axis, as a plane across an axis has next to no error.
float TriangleMesh::PointError(const Corners& corners, const Vec3d& n, const Vec3d& p) {
  const Vec3d &e1 = corners.e1, &e2 = corners.e2, e3 = e2 - e1;
  Vec3d extent, products;
  for (int axis = 0; axis < 3; ++axis) {
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    extent[axis] = std::max({std::abs(e1[axis]), std::abs(e2[axis]), std::abs(e3[axis])});
    products[axis] =
        std::min({std::abs(e1[j] * e2[k]) + std::abs(e1[k] * e2[j]), std::abs(e1[j] * e3[k]) + std::abs(e1[k] * e3[j]),
                  std::abs(e2[j] * e3[k]) + std::abs(e2[k] * e3[j])});
  }
  const double tilt = corners.crossLength > 0 ? Dot(products, extent) / corners.crossLength : 0;
  // A sliver's plane is all but lost in rounding; moving rays off by more than this would harm more than it heals.
  const double longest = std::max({extent.x, extent.y, extent.z});
  constexpr double kMostSliver = 0x1p-12;
  return RoundUp(RoundingAlong(n, p, extent) + std::min(2 * kFloatRounding * tilt, kMostSliver * longest));
}

SurfaceInteraction TriangleMesh::Interact(const Ray& ray, const PrimitiveHit& hit) const {
  const Corners corners = CornersOf(hit.primitive);
  const Vec3d b(1.0 - hit.b1 - hit.b2, hit.b1, hit.b2);
  const Vec3d p = corners.p0 + corners.e1 * b.y + corners.e2 * b.z;
  const Vec3d vertexNormal = VertexNormal(corners.index, b);
  const Vec3d ng = GeometricNormal(corners, vertexNormal);

  SurfaceInteraction interaction;
  interaction.p = ToFloat(p);
  interaction.pError = PointError(corners, ng, p);
  interaction.ng = ToFloat(ng);
  interaction.wo = -Normalize(ray.d);
  interaction.t = hit.t;
  interaction.primitive = hit.primitive;
  FillShading(corners, b, ng, vertexNormal, &interaction);
  return interaction;
}

void TriangleMesh::FillShading(const Corners& corners, const Vec3d& b, const Vec3d& ng, const Vec3d& vertexNormal,
                               SurfaceInteraction* interaction) const {
  const auto& [i0, i1, i2] = corners.index;
  const std::array<Vec2d, 3> uvs = CornerUvs(corners.index);
  interaction->uv = ToFloat(Mix(b, uvs));
  const UvGradient gradient(uvs);
  const bool hasUv = gradient.isValid && corners.crossLength > 0;
  Vec3d dpdu = gradient.ByU(corners.e1, corners.e2), dpdv = gradient.ByV(corners.e1, corners.e2);
  if (!hasUv) CoordinateSystem(ng, &dpdu, &dpdv);
  interaction->dpdu = interaction->dpdus = ToFloat(dpdu);
  interaction->dpdv = interaction->dpdvs = ToFloat(dpdv);
  interaction->ns = interaction->ng;
  if (!HasNormals() && !HasTangents()) return;

  Vec3d ns = ng;
  const double normalSquared = LengthSquared(vertexNormal);
  if (normalSquared > 0) {
    const double inverseLength = 1 / std::sqrt(normalSquared);
    ns = vertexNormal * inverseLength;
    const Vec3d n0 = Normal(i0), d1 = Normal(i1) - n0, d2 = Normal(i2) - n0;
    // Without uvs, along the tangents that stand in for them: their weights of the edges follow from the plane.
    const double inverse = corners.crossLength > 0 ? 1 / Sqr(corners.crossLength) : 0;
    const auto along = [&](const Vec3d& tangent) {
      return d1 * (Dot(Cross(tangent, corners.e2), corners.cross) * inverse) +
             d2 * (Dot(Cross(corners.e1, tangent), corners.cross) * inverse);
    };
    const Vec3d byU = hasUv ? gradient.ByU(d1, d2) : along(dpdu), byV = hasUv ? gradient.ByV(d1, d2) : along(dpdv);
    interaction->ns = ToFloat(ns);
    interaction->dndu = ToFloat((byU - ns * Dot(ns, byU)) * inverseLength);  // of the vector at unit length
    interaction->dndv = ToFloat((byV - ns * Dot(ns, byV)) * inverseLength);
  }
  Vec3d tangent = HasTangents() ? Mix(b, Tangent(i0), Tangent(i1), Tangent(i2)) : dpdu;
  if (!(LengthSquared(tangent) > 0)) tangent = dpdu;
  Vec3d s, t = Cross(ns, tangent);
  const double tSquared = LengthSquared(t);
  if (tSquared > 0) {
    t *= 1 / std::sqrt(tSquared);
    s = Cross(t, ns);
  } else {
    CoordinateSystem(ns, &s, &t);
  }
  interaction->dpdus = ToFloat(s);
  interaction->dpdvs = ToFloat(t);
}

double TriangleMesh::PrimitiveArea(int primitive) const { return CornersOf(primitive).crossLength / 2; }

ShapeSample TriangleMesh::SampleAt(const Corners& corners, const Vec3d& b, double pdf) const {
  const Vec3d p = corners.p0 + corners.e1 * b.y + corners.e2 * b.z;
  const Vec3d n = GeometricNormal(corners, VertexNormal(corners.index, b));
  return {ToFloat(p), PointError(corners, n, p), ToFloat(n), ToFloat(Mix(b, CornerUvs(corners.index))), pdf};
}

ShapeSample TriangleMesh::SampleArea(int primitive, const Vec2d& u) const {
  const Corners corners = CornersOf(primitive);
  return SampleAt(corners, SquareToTriangle(u), corners.crossLength > 0 ? 2 / corners.crossLength : 0);
}

double TriangleMesh::PdfArea(int primitive, const Vec3&) const {
  const double twiceArea = CornersOf(primitive).crossLength;
  return twiceArea > 0 ? 2 / twiceArea : 0;
}

Vec3d TriangleMesh::Barycentric(const Corners& corners, const Vec3& p) {
  if (!(corners.crossLength > 0)) return {1, 0, 0};
  const Vec3d q = ToDouble(p) - corners.p0, n = corners.cross / Sqr(corners.crossLength);
  const double b1 = std::clamp(Dot(Cross(q, corners.e2), n), 0.0, 1.0);
  const double b2 = std::clamp(Dot(Cross(corners.e1, q), n), 0.0, 1.0);
  const double sum = std::max(1.0, b1 + b2);
  return {std::max(0.0, 1 - b1 - b2), b1 / sum, b2 / sum};
}

Vec2d TriangleMesh::InvertArea(int primitive, const Vec3& p) const {
  return TriangleToSquare(Barycentric(CornersOf(primitive), p));
}

std::optional<ShapeSample> TriangleMesh::SampleSolidAngle(int primitive, const Vec3& reference, const Vec2d& u) const {
  const Corners corners = CornersOf(primitive);
  const SphericalTriangle seen(corners.p0, corners.e1, corners.e2, ToDouble(reference));
  if (!(seen.SolidAngle() > 0)) return std::nullopt;
  if (seen.IsWellConditioned()) return SampleAt(corners, seen.Sample(u), 1 / seen.SolidAngle());

  ShapeSample sample = SampleArea(primitive, u);
  sample.pdf = PdfSolidAngle(primitive, reference, sample.p, sample.n);
  return sample.pdf > 0 ? std::optional(sample) : std::nullopt;
}

double TriangleMesh::PdfSolidAngle(int primitive, const Vec3& reference, const Vec3& p, const Vec3&) const {
  const Corners corners = CornersOf(primitive);
  const SphericalTriangle seen(corners.p0, corners.e1, corners.e2, ToDouble(reference));
  if (!(seen.SolidAngle() > 0)) return 0;
  if (seen.IsWellConditioned()) return 1 / seen.SolidAngle();
  // The triangle's own normal: the caller's, rounded to float, would not do for a triangle seen edge-on.
  return AreaToSolidAngle(2 / corners.crossLength, ToDouble(p) - ToDouble(reference), corners.cross);
}

Vec2d TriangleMesh::InvertSolidAngle(int primitive, const Vec3& reference, const Vec3& p) const {
  const Corners corners = CornersOf(primitive);
  const SphericalTriangle seen(corners.p0, corners.e1, corners.e2, ToDouble(reference));
  const Vec3d b = Barycentric(corners, p);
  return seen.IsWellConditioned() ? seen.Invert(b) : TriangleToSquare(b);
}

}  // namespace dapple
