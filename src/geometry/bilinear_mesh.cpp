#include "src/geometry/bilinear_mesh.h"

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/base/frame.h"
#include "src/geometry/surface_math.h"
#include "src/sampling/warps.h"

namespace dapple {
namespace {

template <typename T>
T Bilerp(const Vec2d& st, const T& v00, const T& v10, const T& v01, const T& v11) {
  return (v00 * (1 - st.x) + v10 * st.x) * (1 - st.y) + (v01 * (1 - st.x) + v11 * st.x) * st.y;
}

/// `v`, turned by the rotation that takes the unit vector `from` to the unit vector `to` of its hemisphere (Rodrigues).
Vec3d Rotate(const Vec3d& v, const Vec3d& from, const Vec3d& to) {
  const double cosine = Dot(from, to);
  const Vec3d axis = Cross(from, to);
  return v * cosine + Cross(axis, v) + axis * (Dot(axis, v) / (1 + cosine));
}

/// The largest distance of two points of the patch along each axis.
Vec3d Extent(const std::array<Vec3d, 4>& corners) {
  Bounds3d box;
  for (const Vec3d& corner : corners) box.extendBy(corner);
  return box.size();
}

float PointError(const std::array<Vec3d, 4>& corners, const Vec3d& p, const Vec3d& n) {
  constexpr double kInDouble = 0x1p-48;
  const double size = MaxAbsComponent(corners[0]) + Length(corners[3] - corners[0]) + MaxAbsComponent(p);
  return RoundUp(RoundingAlong(n, p, Extent(corners)) + kInDouble * size);
}

/// The bilinear density that follows the areas around the four corners.
struct CornerWeights {
  explicit CornerWeights(const std::array<double, 4>& areas) : w(areas), sum(w[0] + w[1] + w[2] + w[3]) {}
  Vec2d Sample(const Vec2d& u) const {
    const double v = SampleLinear(u.y, w[0] + w[1], w[2] + w[3]);
    return {SampleLinear(u.x, Lerp(v, w[0], w[2]), Lerp(v, w[1], w[3])), v};
  }
  double Pdf(const Vec2d& st) const { return 4 * Bilerp(st, w[0], w[1], w[2], w[3]) / sum; }
  Vec2d Invert(const Vec2d& st) const {
    const double a = Lerp(st.y, w[0], w[2]), b = Lerp(st.y, w[1], w[3]);
    return {a + b > 0 ? InvertLinear(st.x, a, b) : 0, InvertLinear(st.y, w[0] + w[1], w[2] + w[3])};
  }

  std::array<double, 4> w;
  double sum;
};

}  // namespace

BilinearMesh::BilinearMesh(std::vector<Vec3> positions, std::vector<Vec3> normals, std::vector<Vec2> uvs,
                           std::vector<int> indices, bool reverseOrientation, bool swapsHandedness)
    : positions_(std::move(positions)),
      normals_(std::move(normals)),
      uvs_(std::move(uvs)),
      indices_(std::move(indices)),
      flipsNormal_(reverseOrientation != swapsHandedness) {
  const size_t count = positions_.size();
  if ((!normals_.empty() && normals_.size() != count) || (!uvs_.empty() && uvs_.size() != count))
    throw Error(fmt::format("bilinear mesh: {} normals and {} uvs given for {} positions: expected as many, or none",
                            normals_.size(), uvs_.size(), count));
  if (indices_.size() % 4 != 0)
    throw Error(fmt::format("bilinear mesh: {} indices given: expected a multiple of four", indices_.size()));
  for (const int index : indices_)
    if (index < 0 || static_cast<size_t>(index) >= count)
      throw Error(fmt::format("bilinear mesh: vertex index {} out of range: expected 0 to {}", index,
                              static_cast<int64_t>(count) - 1));
  if (reverseOrientation)
    for (Vec3& n : normals_) n = -n;
}

Vec3d BilinearMesh::Patch::At(double u, double v) const {
  // From a corner along edges: exact at far away patches that are small.
  return corner[0] + (corner[1] - corner[0]) * (u * (1 - v)) + (corner[2] - corner[0]) * ((1 - u) * v) +
         (corner[3] - corner[0]) * (u * v);
}

Vec2d BilinearMesh::Patch::Coordinates(const Vec3d& p) const {
  Vec2d st(0.5);
  double best = LengthSquared(At(st.x, st.y) - p);
  constexpr int kGrid = 4;
  for (int i = 0; i <= kGrid && !IsParallelogram(); ++i) {
    for (int j = 0; j <= kGrid; ++j) {
      const Vec2d candidate(static_cast<double>(i) / kGrid, static_cast<double>(j) / kGrid);
      const double distance = LengthSquared(At(candidate.x, candidate.y) - p);
      if (distance < best) best = distance, st = candidate;
    }
  }
  // Gauss-Newton: on a parallelogram the first step is exact; elsewhere it converges quadratically, as p is on the
  // patch.
  constexpr int kIterations = 12;
  constexpr double kConverged = 1e-15;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Vec3d du = Du(st.y), dv = Dv(st.x), error = p - At(st.x, st.y);
    const double uu = Dot(du, du), uv = Dot(du, dv), vv = Dot(dv, dv);
    const double determinant = DifferenceOfProducts(uu, vv, uv, uv);
    if (!(determinant > 0)) break;
    const double eu = Dot(du, error), ev = Dot(dv, error);
    const Vec2d before = st, step((eu * vv - ev * uv) / determinant, (ev * uu - eu * uv) / determinant);
    st = {std::clamp(st.x + step.x, 0.0, 1.0), std::clamp(st.y + step.y, 0.0, 1.0)};
    if (std::abs(st.x - before.x) + std::abs(st.y - before.y) < kConverged || IsParallelogram()) break;
  }
  return st;
}

double BilinearMesh::Patch::PdfArea(const Vec2d& st) const {
  const double pdf = CornerWeights(CornerAreas()).Pdf(st) / Length(Normal(st.x, st.y));
  return std::isfinite(pdf) ? pdf : 0;
}

BilinearMesh::Patch BilinearMesh::PatchOf(int primitive) const {
  Patch patch;
  for (int i = 0; i < 4; ++i) patch.corner[i] = ToDouble(positions_[indices_[4 * primitive + i]]);
  return patch;
}

Bounds3 BilinearMesh::PrimitiveBounds(int primitive) const {
  Bounds3 bounds;
  for (int i = 0; i < 4; ++i) ExtendBy(&bounds, positions_[indices_[4 * primitive + i]]);
  return bounds;
}

void BilinearMesh::AppendHull(std::vector<HullBall>* hull) const {
  const auto position = [this](int vertex) { return positions_[static_cast<size_t>(vertex)]; };
  AppendVertices(indices_, static_cast<int>(positions_.size()), position, hull);
}

PrimitiveHits BilinearMesh::IntersectAll(const Ray& ray, int primitive) const {
  const Patch patch = PatchOf(primitive);
  const auto& [p00, p10, p01, p11] = patch.corner;
  const Vec3d o = ToDouble(ray.o), d = ToDouble(ray.d);
  // The u at which the ray meets the line between (u, 0) and (u, 1): a u^2 + b u + c = 0.
  const double a = Dot(Cross(p10 - p00, p01 - p11), d);
  const double c = Dot(Cross(p00 - o, d), p01 - p00);
  const double b = Dot(Cross(p10 - o, d), p11 - p10) - (a + c);
  const double discriminant = DifferenceOfProducts(b, b, 4 * a, c);
  if (!(discriminant >= 0)) return {};
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  const double roots[2] = {c / q, q / a};

  PrimitiveHits hits;
  for (const double u : roots) {
    if (!(u >= 0 && u <= 1) || (hits.count > 0 && roots[0] == roots[1])) continue;
    const Vec3d start = p00 + (p10 - p00) * u, along = patch.Dv(u), toStart = start - o;
    const Vec3d perpendicular = Cross(d, along);
    const double lengthSquared = LengthSquared(perpendicular);
    const double v = Dot(Cross(toStart, d), perpendicular) / lengthSquared;
    const double t = Dot(Cross(toStart, along), perpendicular) / lengthSquared;
    if (!(v >= 0 && v <= 1 && t > 0 && t < ray.tMax)) continue;
    hits.hits[hits.count++] = {static_cast<float>(t), static_cast<float>(u), static_cast<float>(v), primitive};
  }
  if (hits.count == 2 && hits.hits[1].t < hits.hits[0].t) std::swap(hits.hits[0], hits.hits[1]);
  return hits;
}

Vec2d BilinearMesh::UvAt(int primitive, const Vec2d& st) const {
  if (uvs_.empty()) return st;
  const int* i = &indices_[4 * primitive];
  return Bilerp(st, Vec2d(uvs_[i[0]]), Vec2d(uvs_[i[1]]), Vec2d(uvs_[i[2]]), Vec2d(uvs_[i[3]]));
}

Vec2 BilinearMesh::Uv(const PrimitiveHit& hit) const { return ToFloat(UvAt(hit.primitive, {hit.b1, hit.b2})); }

Vec3d BilinearMesh::VertexNormal(int primitive, const Vec2d& st) const {
  if (normals_.empty()) return Vec3d(0);
  const int* i = &indices_[4 * primitive];
  return Bilerp(st, ToDouble(normals_[i[0]]), ToDouble(normals_[i[1]]), ToDouble(normals_[i[2]]),
                ToDouble(normals_[i[3]]));
}

Vec3d BilinearMesh::GeometricNormal(int primitive, const Patch& patch, const Vec2d& st) const {
  Vec3d cross = patch.Normal(st.x, st.y);
  if (!(LengthSquared(cross) > 0)) cross = patch.Normal(0.5, 0.5);  // at a corner where two edges fold together
  const double length = Length(cross);
  const Vec3d n = length > 0 && std::isfinite(length) ? cross / length : Vec3d(0, 0, 1);
  const Vec3d oriented = flipsNormal_ ? -n : n;
  return Dot(oriented, VertexNormal(primitive, st)) < 0 ? -oriented : oriented;
}

SurfaceInteraction BilinearMesh::Interact(const Ray& ray, const PrimitiveHit& hit) const {
  const Patch patch = PatchOf(hit.primitive);
  const Vec2d st(hit.b1, hit.b2);
  const Vec3d p = patch.At(st.x, st.y), ng = GeometricNormal(hit.primitive, patch, st);

  SurfaceInteraction interaction;
  interaction.p = ToFloat(p);
  interaction.pError = PointError(patch.corner, p, ng);
  interaction.ng = ToFloat(ng);
  interaction.wo = -Normalize(ray.d);
  interaction.uv = Uv(hit);
  interaction.t = hit.t;
  interaction.primitive = hit.primitive;
  FillDerivatives(hit.primitive, patch, st, &interaction);
  return interaction;
}

void BilinearMesh::FillDerivatives(int primitive, const Patch& patch, const Vec2d& st,
                                   SurfaceInteraction* interaction) const {
  const int* i = &indices_[4 * primitive];
  // Derivatives of uv by the patch coordinates s, t; their inverse turns derivatives by s, t into those by u, v.
  Vec2d uvByS(1, 0), uvByT(0, 1);
  if (!uvs_.empty()) {
    const Vec2d uv[4] = {Vec2d(uvs_[i[0]]), Vec2d(uvs_[i[1]]), Vec2d(uvs_[i[2]]), Vec2d(uvs_[i[3]])};
    uvByS = (uv[1] - uv[0]) * (1 - st.y) + (uv[3] - uv[2]) * st.y;
    uvByT = (uv[2] - uv[0]) * (1 - st.x) + (uv[3] - uv[1]) * st.x;
  }
  double determinant = DifferenceOfProducts(uvByS.x, uvByT.y, uvByS.y, uvByT.x);
  if (determinant == 0) uvByS = {1, 0}, uvByT = {0, 1}, determinant = 1;
  const auto byU = [&](const Vec3d& byS, const Vec3d& byT) { return (byS * uvByT.y - byT * uvByS.y) / determinant; };
  const auto byV = [&](const Vec3d& byS, const Vec3d& byT) { return (byT * uvByS.x - byS * uvByT.x) / determinant; };

  const Vec3d ng = ToDouble(interaction->ng);
  const Vec3d ds = patch.Du(st.y), dt = patch.Dv(st.x);
  Vec3d dpdu = byU(ds, dt), dpdv = byV(ds, dt);
  if (!(LengthSquared(Cross(dpdu, dpdv)) > 0)) CoordinateSystem(ng, &dpdu, &dpdv);
  interaction->dpdu = interaction->dpdus = ToFloat(dpdu);
  interaction->dpdv = interaction->dpdvs = ToFloat(dpdv);

  // Without vertex normals the shading normal is the patch's own, cross(dp/ds, dp/dt) up to its sign.
  Vec3d normal = patch.Normal(st.x, st.y);
  const Vec3d twist = patch.Twist();
  Vec3d normalByS = Cross(ds, twist), normalByT = Cross(twist, dt);
  const Vec3d vertexNormal = VertexNormal(primitive, st);
  interaction->ns = interaction->ng;
  double sign = Dot(normal, ng) < 0 ? -1 : 1;
  if (LengthSquared(vertexNormal) > 0) {
    const Vec3d n[4] = {ToDouble(normals_[i[0]]), ToDouble(normals_[i[1]]), ToDouble(normals_[i[2]]),
                        ToDouble(normals_[i[3]])};
    normal = vertexNormal;
    normalByS = (n[1] - n[0]) * (1 - st.y) + (n[3] - n[2]) * st.y;
    normalByT = (n[2] - n[0]) * (1 - st.x) + (n[3] - n[1]) * st.x;
    sign = 1;
    const Vec3d ns = Normalize(vertexNormal);
    interaction->ns = ToFloat(ns);
    interaction->dpdus = ToFloat(Rotate(dpdu, ng, ns));
    interaction->dpdvs = ToFloat(Rotate(dpdv, ng, ns));
  }
  interaction->dndu = ToFloat(NormalizedDerivative(normal, byU(normalByS, normalByT)) * sign);
  interaction->dndv = ToFloat(NormalizedDerivative(normal, byV(normalByS, normalByT)) * sign);
}

double BilinearMesh::PrimitiveArea(int primitive) const {
  const Patch patch = PatchOf(primitive);
  // The normal is affine in (u, v); a constant one means a parallelogram, and its length is the area.
  const double middle = Length(patch.Normal(0.5, 0.5));
  if (!std::isfinite(middle) || patch.IsParallelogram()) return std::isfinite(middle) ? middle : 0;
  constexpr int kPanels = 4;
  return Integrate(0, 1, kPanels, [&](double u) {
    return Integrate(0, 1, kPanels, [&](double v) { return Length(patch.Normal(u, v)); });
  });
}

ShapeSample BilinearMesh::SampleArea(int primitive, const Vec2d& u) const {
  const Patch patch = PatchOf(primitive);
  const CornerWeights weights(patch.CornerAreas());
  const Vec2d st = weights.sum > 0 && std::isfinite(weights.sum) ? weights.Sample(u) : u;
  const Vec3d p = patch.At(st.x, st.y), n = GeometricNormal(primitive, patch, st);
  return {ToFloat(p), PointError(patch.corner, p, n), ToFloat(n), ToFloat(UvAt(primitive, st)), patch.PdfArea(st)};
}

double BilinearMesh::PdfArea(int primitive, const Vec3& p) const {
  const Patch patch = PatchOf(primitive);
  return patch.PdfArea(patch.Coordinates(ToDouble(p)));
}

Vec2d BilinearMesh::InvertArea(int primitive, const Vec3& p) const {
  const Patch patch = PatchOf(primitive);
  const CornerWeights weights(patch.CornerAreas());
  return weights.sum > 0 ? weights.Invert(patch.Coordinates(ToDouble(p))) : Vec2d(0);
}

std::optional<ShapeSample> BilinearMesh::SampleSolidAngle(int primitive, const Vec3& reference, const Vec2d& u) const {
  ShapeSample sample = SampleArea(primitive, u);
  sample.pdf = PdfSolidAngle(primitive, reference, sample.p, sample.n);
  return sample.pdf > 0 ? std::optional(sample) : std::nullopt;
}

double BilinearMesh::PdfSolidAngle(int primitive, const Vec3& reference, const Vec3& p, const Vec3&) const {
  const Patch patch = PatchOf(primitive);
  const Vec2d st = patch.Coordinates(ToDouble(p));
  return AreaToSolidAngle(patch.PdfArea(st), ToDouble(p) - ToDouble(reference), patch.Normal(st.x, st.y));
}

Vec2d BilinearMesh::InvertSolidAngle(int primitive, const Vec3&, const Vec3& p) const {
  return InvertArea(primitive, p);
}

}  // namespace dapple
