// The reader of PLY meshes.
#include <cmath>

#include "src/base/numerics.h"
#include "src/io/ply.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace dapple;
  return Fuzz(data, size, [](std::string_view bytes) {
    const PlyMesh mesh = ParsePly(bytes, kFuzzInput);
    const auto vertices = static_cast<int>(mesh.positions.size());
    const auto isVertex = [&](int index) { return index >= 0 && index < vertices; };
    for (const auto& triangle : mesh.triangles)
      for (const int index : triangle) Require(isVertex(index), "indices of triangles are of vertices");
    for (const auto& quad : mesh.quads)
      for (const int index : quad) Require(isVertex(index), "indices of quads are of vertices");
    for (const Vec3d& p : mesh.positions) Require(std::isfinite(p.x + p.y + p.z), "positions are finite");
    Require(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size(), "one normal a vertex, or none");
    Require(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size(), "one uv a vertex, or none");
  });
}
