#include "src/geometry/loop_subdivision.h"

#include <gtest/gtest.h>

#include "src/base/error.h"
#include "tests/geometry/shape_checks.h"

namespace dapple {
namespace {

/// A regular grid of the plane z = 0, counter-clockwise from +z: (size + 1)^2 vertices.
void Grid(int size, std::vector<Vec3>* positions, std::vector<int>* indices) {
  for (int y = 0; y <= size; ++y)
    for (int x = 0; x <= size; ++x) positions->push_back({static_cast<float>(x), static_cast<float>(y), 0});
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const int a = y * (size + 1) + x, b = a + 1, c = a + size + 1, d = c + 1;
      indices->insert(indices->end(), {a, b, d, a, d, c});
    }
  }
}

void Octahedron(std::vector<Vec3>* positions, std::vector<int>* indices) {
  *positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  *indices = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
}

double Volume(const SubdividedMesh& mesh) {
  double volume = 0;
  for (size_t i = 0; i < mesh.indices.size(); i += 3)
    volume += Dot(ToDouble(mesh.positions[mesh.indices[i]]),
                  Cross(ToDouble(mesh.positions[mesh.indices[i + 1]]), ToDouble(mesh.positions[mesh.indices[i + 2]])));
  return volume / 6;
}

TEST(LoopSubdivision, CountsAreThoseOfEuler) {
  std::vector<Vec3> positions;
  std::vector<int> indices;
  Octahedron(&positions, &indices);
  for (int levels = 0; levels <= 4; ++levels) {
    const SubdividedMesh mesh = LoopSubdivide(levels, positions, indices);
    const size_t triangles = size_t{8} << (2 * levels);
    EXPECT_EQ(mesh.indices.size(), 3 * triangles);
    EXPECT_EQ(mesh.positions.size(), triangles / 2 + 2);
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());
  }
}

TEST(LoopSubdivision, AFlatGridStaysFlatAndItsInsideStaysInPlace) {
  std::vector<Vec3> positions;
  std::vector<int> indices;
  Grid(6, &positions, &indices);
  const SubdividedMesh mesh = LoopSubdivide(2, positions, indices);
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    EXPECT_EQ(mesh.positions[i].z, 0);
    EXPECT_FLOAT_EQ(Normalize(mesh.normals[i]).z, -1);  // pbrt's side: from there the triangles run clockwise
  }
  // Linear functions are reproduced: old vertices two rings from the boundary keep their places.
  for (int y = 2; y <= 4; ++y)
    for (int x = 2; x <= 4; ++x) ExpectNear(mesh.positions[y * 7 + x], positions[y * 7 + x], 1e-6, "inner vertex");
}

TEST(LoopSubdivision, ABoundaryIsACubicSpline) {
  // Along the straight side the limit of the control points is the uniform cubic B-spline: straight, ends drawn in by
  // none of the inner vertices. Raising an inner vertex must not move the boundary.
  std::vector<Vec3> positions;
  std::vector<int> indices;
  Grid(4, &positions, &indices);
  positions[2] = {2, 0, 1.2f};
  std::vector<Vec3> raised = positions;
  raised[2 * 5 + 2].z = 3;
  const SubdividedMesh flat = LoopSubdivide(5, positions, indices), bumped = LoopSubdivide(5, raised, indices);
  EXPECT_NEAR(flat.positions[2].z, 1.2f * 2 / 3, 1e-4);  // the spline's value at its control point: 2/3
  EXPECT_NEAR(flat.positions[1].z, 1.2f / 6, 1e-4);
  for (const int i : {0, 1, 2, 3, 4}) EXPECT_EQ(flat.positions[i], bumped.positions[i]);
}

TEST(LoopSubdivision, LimitPointsDoNotDependOnTheLevel) {
  std::vector<Vec3> positions;
  std::vector<int> indices;
  Octahedron(&positions, &indices);
  positions[4].z = 2;
  const SubdividedMesh coarse = LoopSubdivide(1, positions, indices), fine = LoopSubdivide(4, positions, indices);
  for (size_t i = 0; i < coarse.positions.size(); ++i)
    ExpectNear(coarse.positions[i], fine.positions[i], 1e-6, "limit position");
}

TEST(LoopSubdivision, VolumeOfAClosedMeshConvergesAndNormalsAreThoseOfTheSurface) {
  std::vector<Vec3> positions;
  std::vector<int> indices;
  Octahedron(&positions, &indices);
  const double v4 = Volume(LoopSubdivide(4, positions, indices)), v5 = Volume(LoopSubdivide(5, positions, indices));
  const double v6 = Volume(LoopSubdivide(6, positions, indices));
  EXPECT_GT(v4, 0);
  EXPECT_NEAR((v5 - v4) / (v6 - v5), 4, 0.1);  // a smooth surface: error falls by four with each level

  const SubdividedMesh mesh = LoopSubdivide(5, positions, indices);
  std::vector<Vec3d> sums(mesh.positions.size(), Vec3d(0));
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const int* k = &mesh.indices[i];
    const Vec3d p = ToDouble(mesh.positions[k[0]]);
    const Vec3d cross = Cross(ToDouble(mesh.positions[k[1]]) - p, ToDouble(mesh.positions[k[2]]) - p);
    for (int j = 0; j < 3; ++j) sums[k[j]] += cross;
  }
  for (size_t i = 0; i < sums.size(); ++i)
    EXPECT_LT(Dot(Normalize(sums[i]), Normalize(ToDouble(mesh.normals[i]))), -0.99) << mesh.positions[i];
}

TEST(LoopSubdivision, RefusesWhatIsNoManifold) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  EXPECT_THROW(LoopSubdivide(1, p, {0, 1}), Error);
  EXPECT_THROW(LoopSubdivide(1, p, {0, 1, 9}), Error);
  EXPECT_THROW(LoopSubdivide(1, p, {0, 1, 1}), Error);
  EXPECT_THROW(LoopSubdivide(-1, p, {0, 1, 2}), Error);
  EXPECT_THROW(LoopSubdivide(1, p, {0, 1, 2, 0, 1, 3}), Error);           // wound against each other
  EXPECT_THROW(LoopSubdivide(1, p, {0, 1, 2, 1, 0, 3, 0, 1, 4}), Error);  // three triangles on an edge
  EXPECT_THROW(LoopSubdivide(1, p, {0, 1, 2, 0, 3, 4}), Error);           // two fans that touch at a vertex
  EXPECT_NO_THROW(LoopSubdivide(2, p, {0, 1, 2}));
  EXPECT_TRUE(LoopSubdivide(2, {}, {}).positions.empty());
}

}  // namespace
}  // namespace dapple
