// Reads PLY meshes: ASCII, binary of either byte order, gzipped or not, every scalar type, properties in any order.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/error.h"
#include "src/base/vec.h"

namespace dapple {

/// Every index is within `positions`; every number is finite.
struct PlyMesh {
  std::vector<Vec3d> positions;
  std::vector<Vec3> normals;  ///< Empty or one a position: properties nx, ny, nz.
  std::vector<Vec2> uvs;      ///< Empty or one a position: u v, s t, texture_u texture_v or texture_s texture_t.
  std::vector<std::array<int, 3>> triangles;
  /// Faces with four vertices, in the file's order around the face; pbrt-v4 makes bilinear patches of them.
  std::vector<std::array<int, 4>> quads;
  /// Faces with more than four vertices; they are in `triangles`, as fans around their first vertex.
  int polygonCount = 0;
  int skippedFaceCount = 0;  ///< Faces with fewer than three vertices.

  /// Replaces the quads by two triangles each (0 1 2 and 0 2 3), behind the other triangles.
  void SplitQuads();
};

/// Throws Error that names the file (and the line, in an ASCII body or header; else the vertex or face) where it is
/// missing, malformed, shorter than its header says, or a face names a vertex that is not there. `namedAt`: the place
/// that names the file. Memory stays proportional to the (decompressed) file's size, whatever the header claims.
PlyMesh ReadPly(const std::filesystem::path& path, const FileLocation& namedAt = {});

/// As `ReadPly`, from the bytes of a file.
PlyMesh ParsePly(std::string_view bytes, const std::string& fileName);

}  // namespace dapple
