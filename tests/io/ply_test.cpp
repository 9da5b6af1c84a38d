#include "src/io/ply.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "tests/io/reader_test_support.h"

namespace dapple {
namespace {

constexpr bool kNativeIsBig = std::endian::native == std::endian::big;

/// Builds a binary body in either byte order.
class Body {
 public:
  explicit Body(bool isBigEndian) : swap_(isBigEndian != kNativeIsBig) {}
  template <typename T>
  Body& Put(T value) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    bytes_.append(raw.data(), raw.size());
    return *this;
  }
  const std::string& Bytes() const { return bytes_; }

 private:
  bool swap_;
  std::string bytes_;
};

std::string Header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\ncomment by hand\n" + elements + "end_header\n";
}

const std::string kSimpleElements =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 2\nproperty list uchar int vertex_indices\n";
const std::string kSimpleBody = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

PlyMesh Parse(const std::string& bytes) { return ParsePly(bytes, "a.ply"); }

std::string ErrorOf(const std::string& bytes) {
  return MessageOf([&] { Parse(bytes); });
}

std::string AsciiFaces(const std::string& count, const std::string& faces) {
  return Header("ascii", "element vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                             count + "\nproperty list uchar int vertex_index\n") +
         "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n" + faces;
}

TEST(Ply, ReadsAscii) {
  const PlyMesh mesh = Parse(Header("ascii", kSimpleElements) + kSimpleBody);
  EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.uvs.empty());
  EXPECT_TRUE(mesh.quads.empty());
}

TEST(Ply, AsciiWithCarriageReturnsAndWithoutALastLineEnd) {
  std::string bytes = Header("ascii", kSimpleElements) + kSimpleBody;
  bytes.pop_back();
  std::string dos;
  for (const char c : bytes) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
  for (const std::string& text : {bytes, dos}) {
    EXPECT_EQ(Parse(text).triangles.size(), 2u);
    EXPECT_EQ(Parse(text).positions[2], Vec3d(1, 1, 0));
  }
}

TEST(Ply, EveryScalarTypeInEitherByteOrder) {
  const std::string elements =
      "element vertex 2\n"
      "property char a\nproperty uint8 u\nproperty int16 v\nproperty ushort b\nproperty int32 x\nproperty uint y\n"
      "property double z\nproperty float nx\nproperty float32 ny\nproperty float64 nz\n"
      "element face 0\nproperty list uchar uint vertex_indices\n";
  for (const bool isBig : {false, true}) {
    Body body(isBig);
    for (int i = 0; i < 2; ++i) {
      body.Put<std::int8_t>(-1).Put<std::uint8_t>(200).Put<std::int16_t>(-300).Put<std::uint16_t>(60000);
      body.Put<std::int32_t>(-70000).Put<std::uint32_t>(4000000000u).Put<double>(10000000.0625);
      body.Put<float>(0.5f).Put<float>(-0.25f).Put<double>(1);
    }
    const PlyMesh mesh = Parse(Header(isBig ? "binary_big_endian" : "binary_little_endian", elements) + body.Bytes());
    ASSERT_EQ(mesh.positions.size(), 2u);
    EXPECT_EQ(mesh.positions[1], Vec3d(-70000, 4000000000.0, 10000000.0625));
    EXPECT_EQ(mesh.normals[1], Vec3(0.5f, -0.25f, 1));
    EXPECT_EQ(mesh.uvs[1], Vec2(200, -300));
  }
}

TEST(Ply, BinaryFacesWithEveryIndexType) {
  const auto faces = [](const std::string& type, const auto& put) {
    for (const bool isBig : {false, true}) {
      Body body(isBig);
      for (int i = 0; i < 9; ++i) body.Put<float>(static_cast<float>(i));
      body.Put<std::uint16_t>(3);
      for (const int index : {2, 0, 1}) put(body, index);
      const std::string header = Header(isBig ? "binary_big_endian" : "binary_little_endian",
                                        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                                        "element face 1\nproperty list ushort " +
                                            type + " vertex_indices\n");
      EXPECT_EQ(Parse(header + body.Bytes()).triangles, (std::vector<std::array<int, 3>>{{2, 0, 1}})) << type;
    }
  };
  faces("char", [](Body& body, int i) { body.Put(static_cast<std::int8_t>(i)); });
  faces("uchar", [](Body& body, int i) { body.Put(static_cast<std::uint8_t>(i)); });
  faces("short", [](Body& body, int i) { body.Put(static_cast<std::int16_t>(i)); });
  faces("uint16", [](Body& body, int i) { body.Put(static_cast<std::uint16_t>(i)); });
  faces("int", [](Body& body, int i) { body.Put(static_cast<std::int32_t>(i)); });
  faces("uint", [](Body& body, int i) { body.Put(static_cast<std::uint32_t>(i)); });
}

TEST(Ply, SkipsWhatIsNotOfTheMesh) {
  const std::string bytes =
      Header("ascii",
             "obj_info x\nelement camera 1\nproperty float view\nproperty list int float rest\n"
             "element vertex 3\nproperty uchar red\nproperty float z\nproperty list uchar int tags\n"
             "property float y\nproperty float x\n"
             "element face 1\nproperty int faceIndices\nproperty list uchar int vertex_indices\n"
             "property list uchar float texcoord\n"
             "element edge 1\nproperty int vertex1\n") +
      "7 2 .5 .5\n255 3 2 8 9 2 1\n0 6 0 5 4\n0 9 1 1 8 7\n4 3 0 1 2 6 0 0 1 0 1 1\n5\n";
  const PlyMesh mesh = Parse(bytes);
  EXPECT_EQ(mesh.positions, (std::vector<Vec3d>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}}));
}

TEST(Ply, TextureCoordinatesByAllTheirNames) {
  const std::vector<std::pair<std::string, std::string>> names = {
      {"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}, {"texture_s", "texture_t"}};
  for (const auto& [u, v] : names) {
    const PlyMesh mesh = Parse(
        Header("ascii", "element vertex 1\nproperty float " + v +
                            "\nproperty float x\nproperty float y\nproperty float z\nproperty float " + u + "\n") +
        "0.25 1 2 3 0.75\n");
    EXPECT_EQ(mesh.uvs, (std::vector<Vec2>{{0.75f, 0.25f}})) << u;
  }
}

TEST(Ply, QuadsAreKeptUntilSplit) {
  PlyMesh mesh = Parse(AsciiFaces("2", "4 0 1 2 3\n3 0 1 4\n"));
  EXPECT_EQ(mesh.quads, (std::vector<std::array<int, 4>>{{0, 1, 2, 3}}));
  EXPECT_EQ(mesh.triangles.size(), 1u);
  mesh.SplitQuads();
  EXPECT_TRUE(mesh.quads.empty());
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 4}, {0, 1, 2}, {0, 2, 3}}));
}

TEST(Ply, PolygonsBecomeFansAndThinFacesAreCounted) {
  const PlyMesh mesh = Parse(AsciiFaces("4", "5 0 1 2 3 4\n2 0 1\n0\n3 2 3 4\n"));
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {2, 3, 4}}));
  EXPECT_EQ(mesh.polygonCount, 1);
  EXPECT_EQ(mesh.skippedFaceCount, 2);
}

TEST(Ply, FacesMayComeBeforeVertices) {
  const std::string elements =
      "element face 1\nproperty list uchar int vertex_indices\n"
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  EXPECT_EQ(Parse(Header("ascii", elements) + "3 0 1 2\n0 0 0 1 0 0 0 1 0").triangles.size(), 1u);
  EXPECT_EQ(ErrorOf(Header("ascii", elements) + "3 0 1 3\n0 0 0 1 0 0 0 1 0"),
            "a.ply:11:7: error: face 0 names vertex 3, but the mesh has 3 vertices");
}

TEST(Ply, IndicesOutOfRangeNameFaceAndIndex) {
  EXPECT_EQ(ErrorOf(AsciiFaces("2", "3 0 1 2\n3 0 5 1\n")),
            "a.ply:17:5: error: face 1 names vertex 5, but the mesh has 5 vertices");
  EXPECT_EQ(ErrorOf(AsciiFaces("1", "3 0 -1 1\n")),
            "a.ply:16:5: error: face 0 names vertex -1, but the mesh has 5 vertices");
  EXPECT_EQ(ErrorOf(AsciiFaces("1", "4 0 1 2 99\n")),
            "a.ply:16:9: error: face 0 names vertex 99, but the mesh has 5 vertices");
}

TEST(Ply, CountsBeyondTheFileAreErrorsBeforeAnythingIsAllocated) {
  const std::string elements = "element vertex 1000000000000\nproperty float x\nproperty float y\nproperty float z\n";
  EXPECT_EQ(ErrorOf(Header("binary_little_endian", elements) + std::string(100, '\0')),
            "a.ply: error: the file is too short for the 1000000000000 of element \"vertex\" that its header names");
  EXPECT_NE(ErrorOf(Header("ascii", elements) + "0 0 0\n").find("the file is too short for the 1000000000000"),
            std::string::npos);
  EXPECT_NE(
      ErrorOf(Header("ascii", "element vertex 99999999999999999999\n")).find("a.ply:4:1: error: expected \"element"),
      std::string::npos);
  EXPECT_NE(ErrorOf(AsciiFaces("1", "2000000000 0 1 2\n")).find("error: the file ends early"), std::string::npos);
  Body body(false);
  for (int i = 0; i < 9; ++i) body.Put<float>(0);
  body.Put<std::uint32_t>(2000000000u).Put<std::int32_t>(0).Put<std::int32_t>(0).Put<std::int32_t>(0);
  EXPECT_EQ(ErrorOf(Header("binary_little_endian",
                           "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                           "element face 1\nproperty list uint int vertex_indices\n") +
                    body.Bytes()),
            "a.ply: error: the file ends early");
}

TEST(Ply, MalformedHeaders) {
  EXPECT_EQ(ErrorOf("hello\n"), "a.ply:1:1: error: expected a PLY file, whose first line is \"ply\"");
  EXPECT_EQ(ErrorOf(""), "a.ply:1:1: error: the file ends within its header");
  EXPECT_EQ(ErrorOf("ply\nformat ascii 1.0\n"), "a.ply:3:1: error: the file ends within its header");
  EXPECT_EQ(ErrorOf("ply\nformat text 1.0\n"),
            "a.ply:2:1: error: unknown format \"text\", expected ascii, binary_little_endian or binary_big_endian");
  EXPECT_EQ(ErrorOf("ply\nformat ascii 2.0\n"), "a.ply:2:1: error: unknown version \"2.0\" of PLY, expected 1.0");
  EXPECT_EQ(ErrorOf("ply\nend_header\n"), "a.ply:2:1: error: the header has no format");
  EXPECT_EQ(ErrorOf("ply\nproperty float x\n"), "a.ply:2:1: error: property before the first element");
  EXPECT_EQ(ErrorOf("ply\nelement vertex -1\n"),
            "a.ply:2:1: error: expected \"element NAME COUNT\", found the count \"-1\"");
  EXPECT_EQ(ErrorOf("ply\nelement vertex 1\nproperty quad x\n"),
            "a.ply:3:1: error: unknown type \"quad\", expected char, uchar, short, ushort, int, uint, float or double");
  EXPECT_EQ(ErrorOf("ply\nelement face 1\nproperty list float int vertex_indices\n"),
            "a.ply:3:1: error: the count of a list has a floating point type, expected an integer type");
  EXPECT_EQ(ErrorOf("ply\nelement vertex 1\nproperty float\n"), "a.ply:3:1: error: the property has no name");
  EXPECT_EQ(ErrorOf("ply\nelephant 1\n"),
            "a.ply:2:1: error: expected format, element, property, comment or end_header, found \"elephant\"");
  EXPECT_NE(ErrorOf(Header("ascii", "element vertex 1\nproperty float x\n") + "1\n")
                .find("error: element \"vertex\" has no properties x, y and z"),
            std::string::npos);
  EXPECT_NE(ErrorOf(Header("ascii", "element face 1\nproperty int x\n") + "1\n")
                .find("error: element \"face\" has no list \"vertex_indices\""),
            std::string::npos);
}

TEST(Ply, MalformedBodies) {
  const std::string header = Header("ascii", kSimpleElements);
  EXPECT_EQ(ErrorOf(header + "0 0 0\n1 x 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n"),
            "a.ply:12:3: error: expected a finite number, found \"x\"");
  EXPECT_EQ(ErrorOf(header + "0 0 0\n1 nan 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n"),
            "a.ply:12:3: error: expected a finite number, found \"nan\"");
  EXPECT_EQ(ErrorOf(header + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2"), "a.ply:16:6: error: the file ends early");
  EXPECT_EQ(ErrorOf(header + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2.5 1\n"),
            "a.ply:16:5: error: expected an integer, found 2.5");
  EXPECT_NE(ErrorOf(header + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n-3 0 1 2\n3 0 2 1\n").find("has -3 entries"),
            std::string::npos);
}

TEST(Ply, NumbersThatAreNotFiniteAreErrors) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Body body(false);
    body.Put<float>(0).Put<float>(0).Put<float>(0).Put<float>(0).Put<float>(bad).Put<float>(0);
    const std::string message = ErrorOf(
        Header("binary_little_endian", "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n") +
        body.Bytes());
    EXPECT_NE(message.find("a.ply: error: property \"y\" of vertex 1 is "), std::string::npos) << message;
  }
}

TEST(Ply, EveryTruncationIsAnError) {
  const std::string elements =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\n";
  Body body(true);
  for (int i = 0; i < 9; ++i) body.Put<float>(static_cast<float>(i));
  body.Put<std::uint8_t>(3).Put<std::int32_t>(0).Put<std::int32_t>(1).Put<std::int32_t>(2);
  const std::string whole = Header("binary_big_endian", elements) + body.Bytes();
  EXPECT_EQ(Parse(whole).triangles.size(), 1u);
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_THROW(Parse(whole.substr(0, length)), Error) << length;
}

TEST(Ply, AnyFlippedByteEndsInAMeshOrAnError) {
  const std::string whole = Header("ascii", kSimpleElements) + kSimpleBody;
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const char c : {'\0', '9', '-', '\n', 'e', '\xff'}) {
      std::string bytes = whole;
      bytes[i] = c;
      try {
        const PlyMesh mesh = Parse(bytes);
        for (const auto& triangle : mesh.triangles)
          for (const int index : triangle) ASSERT_LT(static_cast<std::size_t>(index), mesh.positions.size());
      } catch (const Error&) {
      }
    }
}

TEST(Ply, ReadsFilesPlainAndGzipped) {
  const TestFolder folder;
  const std::string bytes = Header("ascii", kSimpleElements) + kSimpleBody;
  EXPECT_EQ(ReadPly(folder.Write("a.ply", bytes)).triangles.size(), 2u);
  EXPECT_EQ(ReadPly(folder.Write("a.ply.gz", Gzip(bytes))).triangles.size(), 2u);
  const FileLocation place(std::make_shared<const std::string>("s.pbrt"), 4, 1);
  EXPECT_EQ(MessageOf([&] { ReadPly("/nowhere.ply", place); }), "s.pbrt:4:1: error: no file \"/nowhere.ply\"");
}

}  // namespace
}  // namespace dapple
