#include "src/io/ply.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "src/io/ply_header.h"
#include "src/io/text_file.h"

namespace dapple {

namespace {

/// Which number of a vertex a property is.
enum VertexSlot { kX, kY, kZ, kNx, kNy, kNz, kU, kV, kVertexSlotCount };
constexpr int kNoSlot = -1;

constexpr std::array<std::array<std::string_view, 5>, kVertexSlotCount> kSlotNames = {
    {{"x"},
     {"y"},
     {"z"},
     {"nx"},
     {"ny"},
     {"nz"},
     {"u", "s", "texture_u", "texture_s"},
     {"v", "t", "texture_v", "texture_t"}}};

int SlotOf(const std::string& name) {
  for (std::size_t slot = 0; slot < kSlotNames.size(); ++slot)
    if (std::find(kSlotNames[slot].begin(), kSlotNames[slot].end(), name) != kSlotNames[slot].end())
      return static_cast<int>(slot);
  return kNoSlot;
}

template <typename T>
double LoadAs(const char* bytes, bool swap) {
  std::array<char, sizeof(T)> raw = {};
  std::memcpy(raw.data(), bytes, sizeof(T));
  if (swap) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<T>(raw));
}

double Load(PlyScalar type, const char* bytes, bool swap) {
  switch (type) {
    case PlyScalar::Int8:
      return LoadAs<std::int8_t>(bytes, swap);
    case PlyScalar::Uint8:
      return LoadAs<std::uint8_t>(bytes, swap);
    case PlyScalar::Int16:
      return LoadAs<std::int16_t>(bytes, swap);
    case PlyScalar::Uint16:
      return LoadAs<std::uint16_t>(bytes, swap);
    case PlyScalar::Int32:
      return LoadAs<std::int32_t>(bytes, swap);
    case PlyScalar::Uint32:
      return LoadAs<std::uint32_t>(bytes, swap);
    case PlyScalar::Float32:
      return LoadAs<float>(bytes, swap);
    case PlyScalar::Float64:
      return LoadAs<double>(bytes, swap);
  }
  return 0;
}

/// Hands out the numbers behind the header one by one; `Fail` tells where.
class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, bool isBigEndian, const std::string& fileName)
      : cursor_(bytes.data()),
        end_(bytes.data() + bytes.size()),
        swap_(isBigEndian != (std::endian::native == std::endian::big)),
        fileName_(fileName) {}

  double Read(PlyScalar type) {
    const std::size_t size = SizeOf(type);
    if (Left() < size) Fail("the file ends early");
    const double value = Load(type, cursor_, swap_);
    cursor_ += size;
    return value;
  }

  void Skip(PlyScalar type, std::size_t count) {
    if (Left() / SizeOf(type) < count) Fail("the file ends early");
    cursor_ += SizeOf(type) * count;
  }

  /// The least bytes that a number takes.
  static std::size_t LeastSize(PlyScalar type) { return SizeOf(type); }
  std::size_t Left() const { return static_cast<std::size_t>(end_ - cursor_); }
  [[noreturn]] void Fail(const std::string& message) const { throw Error(FileLocation(fileName_), message); }

 private:
  const char* cursor_;
  const char* end_;
  bool swap_;
  const std::string& fileName_;
};

class AsciiBody {
 public:
  AsciiBody(std::string_view bytes, int firstLine, const std::string& fileName)
      : cursor_(bytes.data()),
        end_(bytes.data() + bytes.size()),
        token_(cursor_),
        lineStart_(cursor_),
        line_(firstLine),
        fileName_(fileName) {}

  double Read(PlyScalar type) {
    SkipBlanks();
    token_ = cursor_;
    if (cursor_ == end_) Fail("the file ends early");
    double value = 0;
    const char* behind = cursor_;
    const NumberStatus status = ParseNumber(cursor_, end_, &value, &behind);
    const char* const wordEnd = std::find_if(cursor_, end_, IsBlank);
    if (status != NumberStatus::Ok || behind != wordEnd)
      Fail(fmt::format("expected a finite number, found {}",
                       Quoted({cursor_, static_cast<std::size_t>(wordEnd - cursor_)})));
    if (!IsFloat(type) && value != std::floor(value)) Fail(fmt::format("expected an integer, found {}", value));
    cursor_ = behind;
    return value;
  }

  void Skip(PlyScalar type, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) Read(type);
  }

  static std::size_t LeastSize(PlyScalar) { return 2; }  // a digit and a blank; the last blank may be missing
  std::size_t Left() const { return static_cast<std::size_t>(end_ - cursor_) + 1; }
  [[noreturn]] void Fail(const std::string& message) const {
    throw Error({std::make_shared<const std::string>(fileName_), line_, static_cast<int>(token_ - lineStart_) + 1},
                message);
  }

 private:
  static bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  void SkipBlanks() {
    for (; cursor_ != end_ && IsBlank(*cursor_); ++cursor_) {
      if (*cursor_ != '\n') continue;
      ++line_;
      lineStart_ = cursor_ + 1;
    }
  }

  const char* cursor_;
  const char* end_;
  const char* token_;  ///< The number read last: where errors are.
  const char* lineStart_;
  int line_;
  const std::string& fileName_;
};

template <typename Body>
class PlyReader {
 public:
  PlyReader(Body body, const PlyHeader& header) : body_(body), header_(header) {}

  PlyMesh Read() {
    for (const PlyElement& element : header_.elements) {
      CheckSize(element);
      if (element.name == "vertex")
        ReadVertices(element);
      else if (element.name == "face")
        ReadFaces(element);
      else
        SkipElement(element);
    }
    return std::move(mesh_);
  }

 private:
  /// Before anything is allocated: the rest of the file must have room for the least that the element needs.
  void CheckSize(const PlyElement& element) {
    std::size_t least = 0;
    for (const PlyProperty& property : element.properties)
      least += Body::LeastSize(property.isList ? property.countType : property.type);
    if (least == 0 && element.count > 0) body_.Fail(fmt::format("element \"{}\" has no properties", element.name));
    if (element.count > 0 && body_.Left() / least < element.count)
      body_.Fail(fmt::format("the file is too short for the {} of element \"{}\" that its header names", element.count,
                             element.name));
    if (element.count > static_cast<std::size_t>(std::numeric_limits<int>::max()))
      body_.Fail(fmt::format("element \"{}\" has more than 2^31 - 1 entries", element.name));
  }

  void SkipElement(const PlyElement& element) {
    for (std::size_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) SkipProperty(property);
  }

  void SkipProperty(const PlyProperty& property) {
    body_.Skip(property.type, property.isList ? ReadListCount(property) : 1);
  }

  std::size_t ReadListCount(const PlyProperty& property) {
    const double count = body_.Read(property.countType);
    if (!(count >= 0) || count > std::numeric_limits<int>::max())
      body_.Fail(fmt::format("a list of \"{}\" has {} entries", property.name, count));
    return static_cast<std::size_t>(count);
  }

  void ReadVertices(const PlyElement& element) {
    if (!mesh_.positions.empty()) body_.Fail("the file has two elements \"vertex\"");
    std::vector<int> slots;
    std::array<bool, kVertexSlotCount> has = {};
    for (const PlyProperty& property : element.properties) {
      slots.push_back(property.isList ? kNoSlot : SlotOf(property.name));
      if (slots.back() != kNoSlot) has[static_cast<std::size_t>(slots.back())] = true;
    }
    if (!has[kX] || !has[kY] || !has[kZ]) body_.Fail("element \"vertex\" has no properties x, y and z");
    const bool hasNormals = has[kNx] && has[kNy] && has[kNz], hasUvs = has[kU] && has[kV];
    mesh_.positions.reserve(element.count);
    if (hasNormals) mesh_.normals.reserve(element.count);
    if (hasUvs) mesh_.uvs.reserve(element.count);
    std::array<double, kVertexSlotCount> values = {};
    for (std::size_t i = 0; i < element.count; ++i) {
      for (std::size_t p = 0; p < slots.size(); ++p) {
        if (slots[p] == kNoSlot)
          SkipProperty(element.properties[p]);
        else
          values[static_cast<std::size_t>(slots[p])] = ReadFinite(element.properties[p], i);
      }
      mesh_.positions.emplace_back(values[kX], values[kY], values[kZ]);
      if (hasNormals) mesh_.normals.push_back(ToFloat(Vec3d(values[kNx], values[kNy], values[kNz])));
      if (hasUvs) mesh_.uvs.emplace_back(static_cast<float>(values[kU]), static_cast<float>(values[kV]));
    }
  }

  double ReadFinite(const PlyProperty& property, std::size_t vertex) {
    const double value = body_.Read(property.type);
    if (!(std::abs(value) <= std::numeric_limits<float>::max()))
      body_.Fail(
          fmt::format("property \"{}\" of vertex {} is {}, expected a finite number", property.name, vertex, value));
    return value;
  }

  void ReadFaces(const PlyElement& element) {
    const auto isIndices = [](const PlyProperty& p) {
      return p.isList && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::none_of(element.properties.begin(), element.properties.end(), isIndices)) {
      if (element.count > 0) body_.Fail("element \"face\" has no list \"vertex_indices\"");
      return;
    }
    for (std::size_t i = 0; i < element.count; ++i)
      for (const PlyProperty& property : element.properties) {
        if (isIndices(property))
          ReadFace(property, i);
        else
          SkipProperty(property);
      }
  }

  void ReadFace(const PlyProperty& property, std::size_t face) {
    const std::size_t count = ReadListCount(property);
    if (count < 3) {
      body_.Skip(property.type, count);
      ++mesh_.skippedFaceCount;
      return;
    }
    const int a = ReadIndex(property, face), b = ReadIndex(property, face);
    int previous = ReadIndex(property, face);
    if (count == 4) {
      mesh_.quads.push_back({a, b, previous, ReadIndex(property, face)});
      return;
    }
    mesh_.triangles.push_back({a, b, previous});
    if (count > 4) ++mesh_.polygonCount;
    for (std::size_t i = 3; i < count; ++i) {
      const int next = ReadIndex(property, face);
      mesh_.triangles.push_back({a, previous, next});
      previous = next;
    }
  }

  int ReadIndex(const PlyProperty& property, std::size_t face) {
    const double index = body_.Read(property.type);
    if (!(index >= 0 && index < static_cast<double>(header_.VertexCount()) && index == std::floor(index)))
      body_.Fail(
          fmt::format("face {} names vertex {}, but the mesh has {} vertices", face, index, header_.VertexCount()));
    return static_cast<int>(index);
  }

  Body body_;
  const PlyHeader& header_;
  PlyMesh mesh_;
};

}  // namespace

void PlyMesh::SplitQuads() {
  triangles.reserve(triangles.size() + 2 * quads.size());
  for (const auto& q : quads) {
    triangles.push_back({q[0], q[1], q[2]});
    triangles.push_back({q[0], q[2], q[3]});
  }
  quads.clear();
}

PlyMesh ReadPly(const std::filesystem::path& path, const FileLocation& namedAt) {
  return ParsePly(ReadTextFile(path, namedAt), path.string());
}

PlyMesh ParsePly(std::string_view bytes, const std::string& fileName) {
  const PlyHeader header = ParsePlyHeader(bytes, fileName);
  const std::string_view body = bytes.substr(header.byteCount);
  if (header.format == PlyFormat::Ascii)
    return PlyReader<AsciiBody>(AsciiBody(body, header.lineCount + 1, fileName), header).Read();
  const bool isBigEndian = header.format == PlyFormat::BinaryBigEndian;
  return PlyReader<BinaryBody>(BinaryBody(body, isBigEndian, fileName), header).Read();
}

}  // namespace dapple
