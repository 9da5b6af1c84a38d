#include "src/geometry/loop_subdivision.h"

#include <array>
#include <cstdint>
#include <unordered_map>

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/base/numerics.h"

namespace dapple {
namespace {

constexpr int kNone = -1;
using Triangle = std::array<int, 3>;

/// One edge from a vertex to the next within a triangle, by its number: 3 triangle + corner at which it starts.
int NextInTriangle(int edge) { return edge % 3 == 2 ? edge - 2 : edge + 1; }
int PreviousInTriangle(int edge) { return edge % 3 == 0 ? edge + 2 : edge - 1; }

/// A closed or open manifold: triangles, and for each of their edges the same edge in the neighbour.
class Mesh {
 public:
  Mesh(int vertexCount, std::vector<Triangle> triangles);

  int VertexCount() const { return static_cast<int>(firstEdge_.size()); }
  int EdgeCount() const { return static_cast<int>(3 * triangles_.size()); }
  const std::vector<Triangle>& Triangles() const { return triangles_; }
  int Start(int edge) const { return triangles_[edge / 3][edge % 3]; }
  int End(int edge) const { return Start(NextInTriangle(edge)); }
  /// The same edge in the neighbouring triangle, where it runs the other way; kNone on a boundary.
  int Twin(int edge) const { return twin_[edge]; }
  /// An edge that starts at the vertex: on a boundary the one with no neighbour; kNone where no triangle uses it.
  int FirstEdge(int vertex) const { return firstEdge_[vertex]; }
  bool IsUsed(int vertex) const { return firstEdge_[vertex] != kNone; }
  bool IsBoundary(int vertex) const { return isBoundary_[vertex]; }
  /// The vertices around, counter-clockwise; on a boundary from one boundary neighbour to the other.
  void Ring(int vertex, std::vector<int>* ring) const;

 private:
  void LinkTwins();
  void CheckFans() const;

  std::vector<Triangle> triangles_;
  std::vector<int> twin_, firstEdge_;
  std::vector<char> isBoundary_;
};

Mesh::Mesh(int vertexCount, std::vector<Triangle> triangles)
    : triangles_(std::move(triangles)),
      twin_(3 * triangles_.size(), kNone),
      firstEdge_(vertexCount, kNone),
      isBoundary_(vertexCount, 0) {
  LinkTwins();
  for (int edge = 0; edge < EdgeCount(); ++edge) {
    const bool isOpen = twin_[edge] == kNone;
    if (firstEdge_[Start(edge)] == kNone || isOpen) firstEdge_[Start(edge)] = edge;
    if (isOpen) isBoundary_[Start(edge)] = isBoundary_[End(edge)] = 1;
  }
  CheckFans();
}

void Mesh::LinkTwins() {
  std::unordered_map<uint64_t, int> byEnds;
  byEnds.reserve(twin_.size());
  const auto key = [](int from, int to) { return static_cast<uint64_t>(from) << 32 | static_cast<uint32_t>(to); };
  for (int edge = 0; edge < EdgeCount(); ++edge) {
    if (!byEnds.emplace(key(Start(edge), End(edge)), edge).second)
      throw Error(
          fmt::format("loop subdivision: the edge from vertex {} to {} belongs to two triangles on the same side: "
                      "expected a manifold mesh of one winding",
                      Start(edge), End(edge)));
  }
  for (int edge = 0; edge < EdgeCount(); ++edge) {
    const auto found = byEnds.find(key(End(edge), Start(edge)));
    if (found != byEnds.end()) twin_[edge] = found->second;
  }
}

void Mesh::CheckFans() const {
  std::vector<int> edgesAt(VertexCount(), 0);
  for (int edge = 0; edge < EdgeCount(); ++edge) ++edgesAt[Start(edge)];
  std::vector<int> ring;
  for (int vertex = 0; vertex < VertexCount(); ++vertex) {
    if (!IsUsed(vertex)) continue;
    Ring(vertex, &ring);
    const int fan = static_cast<int>(ring.size()) - (IsBoundary(vertex) ? 1 : 0);
    if (fan != edgesAt[vertex])
      throw Error(fmt::format(
          "loop subdivision: the triangles around vertex {} are not one fan: expected a manifold mesh", vertex));
  }
}

void Mesh::Ring(int vertex, std::vector<int>* ring) const {
  ring->clear();
  const int first = firstEdge_[vertex];
  for (int edge = first;;) {
    ring->push_back(End(edge));
    const int incoming = PreviousInTriangle(edge);  // from the next neighbour to the vertex
    edge = twin_[incoming];
    if (edge == first) return;
    if (edge == kNone) {
      ring->push_back(Start(incoming));
      return;
    }
  }
}

/// Weight of each neighbour in a new position of an inner vertex (Warren's choice).
double Beta(int valence) { return valence == 3 ? 3.0 / 16 : 3.0 / (8.0 * valence); }

Vec3d Sum(const std::vector<Vec3d>& positions, const std::vector<int>& ring) {
  Vec3d sum(0);
  for (const int neighbour : ring) sum += positions[neighbour];
  return sum;
}

/// Moves a vertex that is already there: by its ring, or along the boundary.
Vec3d MoveVertex(const Mesh& mesh, const std::vector<Vec3d>& positions, int vertex, std::vector<int>* ring) {
  if (!mesh.IsUsed(vertex)) return positions[vertex];
  mesh.Ring(vertex, ring);
  if (mesh.IsBoundary(vertex))
    return positions[vertex] * 0.75 + (positions[ring->front()] + positions[ring->back()]) * 0.125;
  const int valence = static_cast<int>(ring->size());
  const double beta = Beta(valence);
  return positions[vertex] * (1 - valence * beta) + Sum(positions, *ring) * beta;
}

Vec3d EdgePoint(const Mesh& mesh, const std::vector<Vec3d>& positions, int edge) {
  const Vec3d ends = positions[mesh.Start(edge)] + positions[mesh.End(edge)];
  const int twin = mesh.Twin(edge);
  if (twin == kNone) return ends * 0.5;
  const Vec3d across =
      positions[mesh.Start(PreviousInTriangle(edge))] + positions[mesh.Start(PreviousInTriangle(twin))];
  return ends * (3.0 / 8) + across * (1.0 / 8);
}

/// One level: each triangle becomes four. Returns the finer mesh and replaces the positions by its own.
Mesh Refine(const Mesh& mesh, std::vector<Vec3d>* positions) {
  std::vector<Vec3d> finer(positions->size());
  std::vector<int> ring;
  for (int vertex = 0; vertex < mesh.VertexCount(); ++vertex)
    finer[vertex] = MoveVertex(mesh, *positions, vertex, &ring);
  std::vector<int> edgePoint(mesh.EdgeCount(), kNone);
  for (int edge = 0; edge < mesh.EdgeCount(); ++edge) {
    if (edgePoint[edge] != kNone) continue;
    edgePoint[edge] = static_cast<int>(finer.size());
    if (mesh.Twin(edge) != kNone) edgePoint[mesh.Twin(edge)] = edgePoint[edge];
    finer.push_back(EdgePoint(mesh, *positions, edge));
  }
  std::vector<Triangle> triangles;
  triangles.reserve(4 * mesh.Triangles().size());
  for (int i = 0; i < static_cast<int>(mesh.Triangles().size()); ++i) {
    const Triangle& corner = mesh.Triangles()[i];
    const Triangle middle = {edgePoint[3 * i], edgePoint[3 * i + 1], edgePoint[3 * i + 2]};
    triangles.push_back({corner[0], middle[0], middle[2]});
    triangles.push_back({middle[0], corner[1], middle[1]});
    triangles.push_back({middle[2], middle[1], corner[2]});
    triangles.push_back(middle);
  }
  const int vertexCount = static_cast<int>(finer.size());
  *positions = std::move(finer);
  return {vertexCount, std::move(triangles)};
}

/// Where the vertex goes after infinitely many levels.
Vec3d LimitPosition(const Mesh& mesh, const std::vector<Vec3d>& positions, int vertex, std::vector<int>* ring) {
  if (!mesh.IsUsed(vertex)) return positions[vertex];
  mesh.Ring(vertex, ring);
  if (mesh.IsBoundary(vertex))
    return positions[vertex] * 0.6 + (positions[ring->front()] + positions[ring->back()]) * 0.2;
  const int valence = static_cast<int>(ring->size());
  const double gamma = 1 / (valence + 3 / (8 * Beta(valence)));
  return positions[vertex] * (1 - valence * gamma) + Sum(positions, *ring) * gamma;
}

/// The limit surface's normal, from its two tangents at the vertex; `positions` are limit positions, as in pbrt, and so
/// is its side, from which the triangles run clockwise.
Vec3d LimitNormal(const Mesh& mesh, const std::vector<Vec3d>& positions, int vertex, std::vector<int>* ring) {
  if (!mesh.IsUsed(vertex)) return Vec3d(0);
  mesh.Ring(vertex, ring);
  const auto at = [&](int i) { return positions[(*ring)[i]]; };
  const Vec3d& p = positions[vertex];
  const int count = static_cast<int>(ring->size());
  Vec3d s(0), t(0);
  if (!mesh.IsBoundary(vertex)) {
    for (int i = 0; i < count; ++i) {
      s += at(i) * std::cos(2 * kPiD * i / count);
      t += at(i) * std::sin(2 * kPiD * i / count);
    }
    return Cross(t, s);
  }
  s = at(count - 1) - at(0);
  if (count == 2) {
    t = at(0) + at(1) - p * 2;
  } else if (count == 3) {
    t = at(1) - p;
  } else if (count == 4) {
    t = at(0) * -1 + at(1) * 2 + at(2) * 2 + at(3) * -1 + p * -2;
  } else {
    const double theta = kPiD / (count - 1);
    t = (at(0) + at(count - 1)) * std::sin(theta);
    for (int i = 1; i < count - 1; ++i) t += at(i) * ((2 * std::cos(theta) - 2) * std::sin(i * theta));
    t = -t;
  }
  return Cross(s, t);
}

Mesh MakeMesh(size_t vertexCount, const std::vector<int>& indices) {
  if (indices.size() % 3 != 0)
    throw Error(fmt::format("loop subdivision: {} indices given: expected a multiple of three", indices.size()));
  std::vector<Triangle> triangles;
  for (size_t i = 0; i < indices.size(); i += 3) {
    const Triangle triangle = {indices[i], indices[i + 1], indices[i + 2]};
    for (const int index : triangle)
      if (index < 0 || static_cast<size_t>(index) >= vertexCount)
        throw Error(fmt::format("loop subdivision: vertex index {} out of range: expected 0 to {}", index,
                                static_cast<int64_t>(vertexCount) - 1));
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
      throw Error(
          fmt::format("loop subdivision: triangle {} uses a vertex twice: expected three different ones", i / 3));
    triangles.push_back(triangle);
  }
  return {static_cast<int>(vertexCount), std::move(triangles)};
}

}  // namespace

SubdividedMesh LoopSubdivide(int levels, const std::vector<Vec3>& positions, const std::vector<int>& indices) {
  if (levels < 0) throw Error(fmt::format("loop subdivision: {} levels: expected none or more", levels));
  std::vector<Vec3d> points;
  points.reserve(positions.size());
  for (const Vec3& p : positions) points.push_back(ToDouble(p));
  Mesh mesh = MakeMesh(positions.size(), indices);
  for (int level = 0; level < levels; ++level) {
    constexpr size_t kMostTriangles = size_t{1} << 28;
    if (mesh.Triangles().size() > kMostTriangles / 4)
      throw Error(fmt::format("loop subdivision: {} levels make more than {} triangles: expected fewer levels", levels,
                              kMostTriangles));
    mesh = Refine(mesh, &points);
  }

  std::vector<Vec3d> limit(points.size());
  std::vector<int> ring;
  for (int vertex = 0; vertex < mesh.VertexCount(); ++vertex)
    limit[vertex] = LimitPosition(mesh, points, vertex, &ring);
  SubdividedMesh result;
  result.positions.reserve(points.size());
  result.normals.reserve(points.size());
  for (int vertex = 0; vertex < mesh.VertexCount(); ++vertex) {
    result.positions.push_back(ToFloat(limit[vertex]));
    result.normals.push_back(ToFloat(LimitNormal(mesh, limit, vertex, &ring)));
  }
  for (const Triangle& triangle : mesh.Triangles())
    result.indices.insert(result.indices.end(), triangle.begin(), triangle.end());
  return result;
}

}  // namespace dapple
