// The header of a PLY file: its format, and which numbers stand in the body in which order.
//
// Used by ply.cpp alone. Source: Greg Turk, "The PLY Polygon File Format" (1994).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace dapple {

enum class PlyScalar { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };
enum class PlyFormat { Ascii, BinaryLittleEndian, BinaryBigEndian };

/// Bytes in a binary body.
std::size_t SizeOf(PlyScalar type);
inline bool IsFloat(PlyScalar type) { return type == PlyScalar::Float32 || type == PlyScalar::Float64; }

struct PlyProperty {
  std::string name;
  PlyScalar type = PlyScalar::Float32;  ///< Of a list: of its entries.
  bool isList = false;
  PlyScalar countType = PlyScalar::Uint8;
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::Ascii;
  std::vector<PlyElement> elements;
  std::size_t byteCount = 0;  ///< The body begins here.
  int lineCount = 0;

  /// Of the element "vertex"; 0 where there is none.
  std::size_t VertexCount() const;
};

/// Throws Error with the line of what is malformed.
PlyHeader ParsePlyHeader(std::string_view bytes, const std::string& fileName);

}  // namespace dapple
