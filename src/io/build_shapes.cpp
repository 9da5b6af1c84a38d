#include "src/io/build_shapes.h"

#include <array>

#include <fmt/format.h>

#include "src/base/numerics.h"
#include "src/geometry/bilinear_mesh.h"
#include "src/geometry/cylinder.h"
#include "src/geometry/disk.h"
#include "src/geometry/loop_subdivision.h"
#include "src/geometry/sphere.h"
#include "src/geometry/triangle_mesh.h"
#include "src/io/ply.h"

namespace dapple {

namespace {

using Shapes = std::vector<std::unique_ptr<Shape>>;

const std::vector<std::string> kShapeTypes = {"trianglemesh", "plymesh", "bilinearmesh", "loopsubdiv",
                                              "sphere",       "disk",    "cylinder"};
const std::vector<std::string> kUnsupportedShapes = {"curve",       "cone",         "paraboloid", "hyperboloid",
                                                     "heightfield", "heightfield2", "nurbs"};
constexpr int kMaxSubdivisionLevels = 10;
constexpr float kMaxCoordinate = 1e18f;  // squares of distances stay within float

/// A shape statement with the whole transform to where it goes.
struct ShapeInput {
  const BuildContext& context;
  const ShapeDescription& shape;
  Transform transform;

  const ParameterList& Params() const { return shape.params; }
  FileLocation Place(std::string_view parameter) const { return Params().LocationOf(parameter, shape.location); }
};

Shapes ListOf(std::unique_ptr<Shape> shape) {
  Shapes shapes;
  shapes.push_back(std::move(shape));
  return shapes;
}

// ---- Meshes

[[noreturn]] void FailTooFar(const ShapeInput& in, const std::string& what) {
  throw Error(in.shape.location, fmt::format("{} lies beyond {:g} after its transform, expected smaller coordinates",
                                             what, kMaxCoordinate));
}

std::vector<Vec3> TransformPoints(const ShapeInput& in, const std::vector<Vec3d>& points) {
  std::vector<Vec3> result(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    result[i] = ToFloat(in.transform.Point(points[i]));
    if (!(MaxAbsComponent(result[i]) < kMaxCoordinate)) FailTooFar(in, fmt::format("vertex {}", i));
  }
  return result;
}

std::vector<Vec3> TransformNormals(const ShapeInput& in, const std::vector<Vec3>& normals) {
  std::vector<Vec3> result(normals.size());
  for (size_t i = 0; i < normals.size(); ++i)
    result[i] = ToFloat(Normalize(in.transform.Normal(Normalize(ToDouble(normals[i])))));
  return result;
}

std::vector<Vec3> TransformVectors(const ShapeInput& in, const std::vector<Vec3>& vectors) {
  std::vector<Vec3> result(vectors.size());
  for (size_t i = 0; i < vectors.size(); ++i)
    result[i] = ToFloat(Normalize(in.transform.Vector(Normalize(ToDouble(vectors[i])))));
  return result;
}

std::vector<Vec3d> GetPositions(const ShapeInput& in) {
  std::vector<Vec3d> positions = in.Params().GetPoint3Array("P");
  if (positions.empty())
    throw Error(in.shape.location,
                fmt::format("\"{}\" has no vertices, expected a parameter \"point3 P\"", in.shape.type));
  return positions;
}

void CheckIndices(const ShapeInput& in, std::string_view name, const std::vector<int>& indices, size_t vertexCount) {
  for (size_t i = 0; i < indices.size(); ++i)
    if (indices[i] < 0 || static_cast<size_t>(indices[i]) >= vertexCount)
      throw Error(in.Place(name), fmt::format("index {} (number {} of \"{}\") is out of range, expected 0 to {}",
                                              indices[i], i, name, vertexCount - 1));
}

/// Indices in groups of `corners`; where a mesh of one face leaves them out (pbrt-v4), 0, 1, 2, ...
std::vector<int> GetIndices(const ShapeInput& in, size_t vertexCount, size_t corners) {
  std::vector<int> indices = in.Params().GetIntArray("indices");
  if (indices.empty() && vertexCount == corners)
    for (size_t i = 0; i < corners; ++i) indices.push_back(static_cast<int>(i));
  if (indices.empty())
    throw Error(in.shape.location,
                fmt::format("\"{}\" has no faces, expected a parameter \"integer indices\"", in.shape.type));
  if (indices.size() % corners != 0)
    throw Error(in.Place("indices"),
                fmt::format("parameter \"indices\" has {} values, expected a multiple of {}", indices.size(), corners));
  CheckIndices(in, "indices", indices, vertexCount);
  return indices;
}

template <typename T>
void CheckVertexCount(const ShapeInput& in, std::string_view name, const std::vector<T>& values, size_t vertexCount) {
  if (values.empty() || values.size() == vertexCount) return;
  throw Error(in.Place(name), fmt::format("parameter \"{}\" has {} values, expected one for each of the {} vertices",
                                          name, values.size(), vertexCount));
}

std::vector<Vec2> GetUvs(const ShapeInput& in, size_t vertexCount) {
  const char* name = in.Params().Has("uv") ? "uv" : "st";
  std::vector<Vec2> uvs = in.Params().GetPoint2Array(name);
  CheckVertexCount(in, name, uvs, vertexCount);
  return uvs;
}

std::vector<Vec3> GetNormals(const ShapeInput& in, size_t vertexCount) {
  const std::vector<Vec3> normals = in.Params().GetNormalArray("N");
  CheckVertexCount(in, "N", normals, vertexCount);
  return TransformNormals(in, normals);
}

Shapes BuildTriangleMesh(const ShapeInput& in) {
  const std::vector<Vec3d> positions = GetPositions(in);
  const size_t count = positions.size();
  std::vector<int> indices = GetIndices(in, count, 3);
  const std::vector<Vec3> tangents = in.Params().GetVector3Array("S");
  CheckVertexCount(in, "S", tangents, count);
  return ListOf(std::make_unique<TriangleMesh>(TransformPoints(in, positions), GetNormals(in, count), GetUvs(in, count),
                                               std::move(indices), TransformVectors(in, tangents),
                                               in.shape.reverseOrientation, in.transform.SwapsHandedness()));
}

Shapes BuildBilinearMesh(const ShapeInput& in) {
  const std::vector<Vec3d> positions = GetPositions(in);
  const size_t count = positions.size();
  std::vector<int> indices = GetIndices(in, count, 4);
  WarnUnsupported(in.context, in.Params(), "emissionfilename");
  return ListOf(std::make_unique<BilinearMesh>(TransformPoints(in, positions), GetNormals(in, count), GetUvs(in, count),
                                               std::move(indices), in.shape.reverseOrientation,
                                               in.transform.SwapsHandedness()));
}

Shapes BuildLoopSubdivision(const ShapeInput& in) {
  const std::vector<Vec3d> positions = GetPositions(in);
  const std::vector<int> indices = GetIndices(in, positions.size(), 3);
  const char* levelsName = in.Params().Has("levels") ? "levels" : "nlevels";
  const int levels = in.Params().GetInt(levelsName, 3);
  if (levels < 0 || levels > kMaxSubdivisionLevels)
    throw Error(in.Place(levelsName),
                fmt::format("parameter \"{}\" is {}, expected 0 to {}", levelsName, levels, kMaxSubdivisionLevels));
  in.Params().GetString("scheme", "loop");
  SubdividedMesh mesh = LoopSubdivide(levels, TransformPoints(in, positions), indices);
  // Its normals hang on the winding, which a mirroring transform turns around; pbrt subdivides before it transforms.
  const bool swaps = in.transform.SwapsHandedness();
  if (swaps)
    for (Vec3& n : mesh.normals) n = -n;
  return ListOf(std::make_unique<TriangleMesh>(std::move(mesh.positions), std::move(mesh.normals), std::vector<Vec2>(),
                                               std::move(mesh.indices), std::vector<Vec3>(),
                                               in.shape.reverseOrientation, swaps));
}

// ---- PLY files

/// The vertices that faces name, renumbered; the others are left out.
struct VertexSubset {
  std::vector<Vec3> positions, normals;
  std::vector<Vec2> uvs;
  std::vector<int> indices;
};

VertexSubset AllVertices(const ShapeInput& in, const PlyMesh& ply) {
  return {TransformPoints(in, ply.positions), TransformNormals(in, ply.normals), ply.uvs, {}};
}

/// Drops the vertices that no index names, so that triangles and patches of one file do not carry each other's.
VertexSubset UsedVertices(const VertexSubset& all, std::vector<int> indices) {
  VertexSubset used;
  std::vector<int> newIndex(all.positions.size(), -1);
  for (int& index : indices) {
    const auto old = static_cast<size_t>(index);
    if (newIndex[old] < 0) {
      newIndex[old] = static_cast<int>(used.positions.size());
      used.positions.push_back(all.positions[old]);
      if (!all.normals.empty()) used.normals.push_back(all.normals[old]);
      if (!all.uvs.empty()) used.uvs.push_back(all.uvs[old]);
    }
    index = newIndex[old];
  }
  used.indices = std::move(indices);
  return used;
}

void CheckPly(const ShapeInput& in, const Parameter& fileName, const PlyMesh& ply) {
  const std::string& name = fileName.strings[0];
  if (ply.polygonCount > 0 && !in.context.IsV3())
    in.context.diagnostics.Warn(fileName.location,
                                fmt::format("{} faces of \"{}\" have more than four vertices; they are "
                                            "split into triangles",
                                            ply.polygonCount, name));
  if (ply.skippedFaceCount > 0)
    in.context.diagnostics.Warn(fileName.location,
                                fmt::format("{} faces of \"{}\" have fewer than three vertices and are "
                                            "left out",
                                            ply.skippedFaceCount, name));
  if (ply.triangles.empty() && ply.quads.empty())
    in.context.diagnostics.Warn(fileName.location, fmt::format("\"{}\" has no faces", name));
}

Shapes BuildPlyMesh(const ShapeInput& in) {
  in.Params().GetString("filename", "");  // checks its type
  const Parameter* fileName = in.Params().Find("filename");
  if (!fileName) throw Error(in.shape.location, "\"plymesh\" names no file, expected a parameter \"string filename\"");
  WarnUnsupported(in.context, in.Params(), "displacement");
  in.Params().Find("displacement.edgelength");
  PlyMesh ply =
      ReadPly(in.context.description.ResolvePath(fileName->strings[0], fileName->location), fileName->location);
  CheckPly(in, *fileName, ply);
  // pbrt-v4 makes patches of faces with four vertices, pbrt-v3 triangles.
  if (in.context.IsV3()) ply.SplitQuads();
  const bool reverse = in.shape.reverseOrientation, swaps = in.transform.SwapsHandedness();
  const VertexSubset all = AllVertices(in, ply);
  std::vector<int> triangles, patches;
  for (const auto& face : ply.triangles) triangles.insert(triangles.end(), face.begin(), face.end());
  for (const auto& face : ply.quads) patches.insert(patches.end(), {face[0], face[1], face[3], face[2]});
  Shapes shapes;
  if (!triangles.empty()) {
    VertexSubset mesh = UsedVertices(all, std::move(triangles));
    shapes.push_back(std::make_unique<TriangleMesh>(std::move(mesh.positions), std::move(mesh.normals),
                                                    std::move(mesh.uvs), std::move(mesh.indices), std::vector<Vec3>(),
                                                    reverse, swaps));
  }
  if (!patches.empty()) {
    VertexSubset mesh = UsedVertices(all, std::move(patches));
    shapes.push_back(std::make_unique<BilinearMesh>(std::move(mesh.positions), std::move(mesh.normals),
                                                    std::move(mesh.uvs), std::move(mesh.indices), reverse, swaps));
  }
  return shapes;
}

// ---- Quadrics

Shapes QuadricList(const ShapeInput& in, std::unique_ptr<Shape> shape) {
  const Bounds3 bounds = shape->PrimitiveBounds(0);
  const bool isNear = MaxAbsComponent(bounds.min) < kMaxCoordinate && MaxAbsComponent(bounds.max) < kMaxCoordinate;
  if (!isNear) FailTooFar(in, "the shape");
  return ListOf(std::move(shape));
}

double GetRadius(const ShapeInput& in) {
  const double radius = in.Params().GetFloat("radius", 1);
  if (!(radius > 0))
    throw Error(in.Place("radius"), fmt::format("parameter \"radius\" is {}, expected more than 0", radius));
  return radius;
}

Shapes BuildSphere(const ShapeInput& in) {
  const double radius = GetRadius(in);
  const double zMin = in.Params().GetFloat("zmin", -radius), zMax = in.Params().GetFloat("zmax", radius);
  const double phiMax = in.Params().GetFloat("phimax", 360);
  return QuadricList(in,
                     std::make_unique<Sphere>(in.transform, in.shape.reverseOrientation, radius, zMin, zMax, phiMax));
}

Shapes BuildCylinder(const ShapeInput& in) {
  const double radius = GetRadius(in);
  const double zMin = in.Params().GetFloat("zmin", -1), zMax = in.Params().GetFloat("zmax", 1);
  const double phiMax = in.Params().GetFloat("phimax", 360);
  return QuadricList(in,
                     std::make_unique<Cylinder>(in.transform, in.shape.reverseOrientation, radius, zMin, zMax, phiMax));
}

Shapes BuildDisk(const ShapeInput& in) {
  const double radius = GetRadius(in), height = in.Params().GetFloat("height", 0);
  const double inner = in.Params().GetFloat("innerradius", 0), phiMax = in.Params().GetFloat("phimax", 360);
  if (!(inner >= 0 && inner < radius))
    throw Error(
        in.Place("innerradius"),
        fmt::format("parameter \"innerradius\" is {}, expected at least 0 and less than the radius {}", inner, radius));
  return QuadricList(in,
                     std::make_unique<Disk>(in.transform, in.shape.reverseOrientation, height, radius, inner, phiMax));
}

Shapes BuildKnown(const ShapeInput& in) {
  const std::string& type = in.shape.type;
  if (type == "trianglemesh") return BuildTriangleMesh(in);
  if (type == "plymesh") return BuildPlyMesh(in);
  if (type == "bilinearmesh") return BuildBilinearMesh(in);
  if (type == "loopsubdiv") return BuildLoopSubdivision(in);
  if (type == "sphere") return BuildSphere(in);
  if (type == "disk") return BuildDisk(in);
  if (type == "cylinder") return BuildCylinder(in);
  FailUnknownName(in.shape.location, "shape", type, kShapeTypes);
}

}  // namespace

std::vector<std::unique_ptr<Shape>> BuildShapes(const BuildContext& context, const ShapeDescription& shape,
                                                const Transform& targetFromWorld) {
  if (std::find(kUnsupportedShapes.begin(), kUnsupportedShapes.end(), shape.type) != kUnsupportedShapes.end()) {
    context.diagnostics.Warn(shape.location, fmt::format("shape \"{}\" is not supported and left out", shape.type));
    shape.params.IgnoreAll();
    return {};
  }
  const ShapeInput in{context, shape, targetFromWorld * shape.worldFromShape};
  if (in.transform.IsSingular()) {
    context.diagnostics.Warn(shape.location, "the shape is left out: its transform has no inverse");
    shape.params.IgnoreAll();
    return {};
  }
  Shapes shapes = AtLocation(shape.location, [&] { return BuildKnown(in); });
  // "alpha" is the caller's; the rest is pbrt's own housekeeping.
  shape.params.ReportUnused(context.diagnostics,
                            {"alpha", "shadowalpha", "faceIndices", "discarddegenerateUVs", "normal", "edgelength"});
  return shapes;
}

}  // namespace dapple
