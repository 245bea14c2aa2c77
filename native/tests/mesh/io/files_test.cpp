// STL, OBJ and PLY: round trips and what each format allows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>

#include "base/io.hpp"
#include "geom/float32.hpp"
#include "mesh/io/obj.hpp"
#include "mesh/io/ply.hpp"
#include "mesh/io/stl.hpp"
#include "mesh/shapes.hpp"
#include "riffler/base/error.hpp"
#include "riffler/mesh/audit.hpp"
#include "riffler/mesh/io/io.hpp"

namespace riffler::mesh::files_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

using From = Mesh (*)(std::span<const std::uint8_t>, const std::string&);

/// The message of the FormatError, or what came instead.
std::string error_of(From read, const Bytes& bytes) {
  try {
    read(bytes, "part");
  } catch (const FormatError& e) {
    return e.what();
  }
  return "no error";
}

/// Binary STL by the book: 80 bytes, count, and 50 a triangle.
Bytes raw_stl(const std::vector<float>& coordinates, const std::string& title = "title", float normal = 0) {
  Bytes bytes(84, 0);
  std::memcpy(bytes.data(), title.data(), title.size());
  const auto count = static_cast<std::uint32_t>(coordinates.size() / 9);
  std::memcpy(&bytes[80], &count, 4);
  const auto put = [&](float x) {
    const auto* p = reinterpret_cast<const std::uint8_t*>(&x);
    bytes.insert(bytes.end(), p, p + 4);
  };
  for (std::size_t t = 0; t < count; ++t) {
    for (int k = 0; k < 3; ++k) put(normal);
    for (std::size_t k = 0; k < 9; ++k) put(coordinates[9 * t + k]);
    bytes.insert(bytes.end(), 2, 0xff);  // attributes of no meaning
  }
  return bytes;
}

const std::vector<float> kTwo = {0, 0, 0, 1, 0, 0, 0, 1, 0, /**/ 1, 0, 0, 1, 1, 0, -0.0F, 1, 0};

std::string ascii_stl() {
  return "solid a part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n  "
         "endloop\n"
         " endfacet\n FACET NORMAL nan -nan(ind) 1.#QNAN\n  OUTER LOOP\n   VERTEX 1 0 0\n   VERTEX +1 1e0 -0\n"
         "   VERTEX 0 1.0 0\n  ENDLOOP\n ENDFACET\nendsolid a part\n";
}

void expect_two(const Mesh& mesh) {
  EXPECT_EQ(mesh.vertices, (Vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {1, 3, 2}}));
}

TEST(Stl, BinaryIsReadAndWelded) {
  expect_two(from_stl(raw_stl(kTwo), "part"));
}

TEST(Stl, BinaryWhoseTitleSaysSolidIsReadAsBinary) {
  expect_two(from_stl(raw_stl(kTwo, "solid part"), "part"));
}

TEST(Stl, NormalsThatAreNotNumbersAreIgnored) {
  expect_two(from_stl(raw_stl(kTwo, "title", std::numeric_limits<float>::quiet_NaN()), "part"));
  expect_two(from_stl(raw_stl(kTwo, "title", std::numeric_limits<float>::infinity()), "part"));
}

TEST(Stl, AsciiIsReadInAnyCaseAndWithAnyLineEnds) {
  expect_two(from_stl(bytes_of(ascii_stl()), "part"));
  std::string text = ascii_stl();
  for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += 2) text.replace(at, 1, "\r\n");
  expect_two(from_stl(bytes_of(text), "part"));
  expect_two(from_stl(bytes_of("\n  " + ascii_stl() + "\n\n"), "part"));
}

TEST(Stl, NormalsWithDecimalCommasAreIgnored) {
  std::string text = ascii_stl();
  text.replace(text.find("normal 0 0 1"), 12, "normal -0,5 1,0e-3 0,25");
  expect_two(from_stl(bytes_of(text), "part"));
  text.replace(text.find("0,25"), 4, "0,2,5");
  EXPECT_EQ(error_of(from_stl, bytes_of(text)), "part, line 2: expected a normal's component, found '0,2,5'");
  text = ascii_stl();
  text.replace(text.find("vertex 1 0 0"), 12, "vertex 1,0 0 0");
  EXPECT_EQ(error_of(from_stl, bytes_of(text)), "part, line 5: expected a finite coordinate, found '1,0'");
}

TEST(MeshFiles, MayBeginWithAByteOrderMark) {
  const std::string mark = "\xef\xbb\xbf";
  expect_two(from_stl(bytes_of(mark + ascii_stl()), "part"));
  EXPECT_EQ(from_obj(bytes_of(mark + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), "part").triangles.size(), 1U);
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  EXPECT_EQ(from_ply(bytes_of(mark + header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "part").triangles.size(), 1U);
  EXPECT_EQ(error_of(from_obj, bytes_of(mark + mark + "v 0 0 0\n")).substr(0, 37),
            "part, line 1: expected a statement, f");
}

TEST(Stl, SolidsOfOneAsciiFileBecomeOneMesh) {
  const Mesh mesh = from_stl(bytes_of(ascii_stl() + ascii_stl()), "part");
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.triangles.size(), 4U);
}

TEST(Stl, AsciiCoordinatesBecomeFloats) {
  std::string text = ascii_stl();
  text.replace(text.find("vertex 1 0 0"), 12, "vertex 0.1 0 0");
  EXPECT_EQ(from_stl(bytes_of(text), "part").vertices[1].x, static_cast<double>(0.1F));
}

TEST(Stl, BadBinaryNamesTheByte) {
  const auto error = [](const Bytes& bytes) { return error_of(from_stl, bytes); };
  EXPECT_EQ(error({}), "part, byte 0: the file is empty");
  EXPECT_EQ(error(Bytes(50, 7)), "part, byte 50: the file ends within the 84 bytes before the first triangle");
  EXPECT_EQ(error(raw_stl({})), "part, byte 80: zero triangles");
  Bytes bytes = raw_stl(kTwo);
  bytes.pop_back();
  EXPECT_EQ(error(bytes), "part, byte 80: the count says 2 triangles, that is 184 bytes, but the file has 183");
  bytes = raw_stl(kTwo);
  bytes.push_back(0);
  EXPECT_EQ(error(bytes), "part, byte 80: the count says 2 triangles, that is 184 bytes, but the file has 185");
  bytes = raw_stl(kTwo, "solid part");
  bytes[83] = 0xff;
  EXPECT_NE(error(bytes).find("byte 80: the count says 4278190082 triangles"), std::string::npos) << error(bytes);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    std::vector<float> coordinates = kTwo;
    coordinates[9 + 4] = bad;
    EXPECT_EQ(error(raw_stl(coordinates)), "part, byte 162: a vertex is not finite");
  }
  std::vector<float> coordinates = kTwo;
  coordinates[0] = -2e30F;
  EXPECT_EQ(error(raw_stl(coordinates)), "part, byte 96: a vertex's coordinate is beyond 1e30");
}

TEST(Stl, BadAsciiNamesTheLine) {
  const auto error = [](const std::string& from, const std::string& to) {
    std::string text = ascii_stl();
    text.replace(text.find(from), from.size(), to);
    return error_of(from_stl, bytes_of(text));
  };
  EXPECT_EQ(error("vertex 1 0 0", "vertex 1 nan 0"), "part, line 5: expected a finite coordinate, found 'nan'");
  EXPECT_EQ(error("vertex 1 0 0", "vertex 1 inf 0"), "part, line 5: expected a finite coordinate, found 'inf'");
  EXPECT_EQ(error("vertex 1 0 0", "vertex 1 1e999 0"), "part, line 5: expected a finite coordinate, found '1e999'");
  EXPECT_EQ(error("vertex 1 0 0", "vertex 1 2e30 0"), "part, line 5: a vertex's coordinate is beyond 1e30");
  EXPECT_EQ(error("vertex 1 0 0", "vertex 1 0"), "part, line 6: expected a finite coordinate, found 'vertex'");
  EXPECT_EQ(error("vertex 1 0 0", "vertex 1 0x2 0"), "part, line 5: expected a finite coordinate, found '0x2'");
  EXPECT_EQ(error("  endloop", "  vertex 0 0 0"), "part, line 7: expected 'endloop', found 'vertex'");
  EXPECT_EQ(error("normal 0 0 1", "normal 0 0"), "part, line 3: expected a normal's component, found 'outer'");
  EXPECT_EQ(error("endsolid a part", ""), "part, line 17: the file ends where 'facet' or 'endsolid' was expected");
  EXPECT_EQ(error("endsolid a part\n", "endsolid\nrubbish"),
            "part, line 17: expected 'solid' or the end of the file, found 'rubbish'");
  EXPECT_EQ(error_of(from_stl, bytes_of("solid nothing\nendsolid nothing\n")), "part, line 3: zero triangles");
  EXPECT_EQ(error_of(from_stl, bytes_of("solid")),
            "part, line 1: the file ends where 'facet' or 'endsolid' was expected");
}

TEST(Stl, WritesTheBytesOfTheFormat) {
  const Bytes bytes = to_stl(box_mesh({0, 0, 0}, {1, 2, 3}));
  ASSERT_EQ(bytes.size(), 84U + 12 * 50);
  EXPECT_NE(std::memcmp(bytes.data(), "solid", 5), 0);
  EXPECT_EQ(bytes[80], 12);
  float record[12];
  std::memcpy(record, &bytes[84], 48);
  EXPECT_EQ((Vec3f(record[0], record[1], record[2])), Vec3f(0, 0, -1));  // triangle 0 2 3 of the bottom
  EXPECT_EQ((Vec3f(record[6], record[7], record[8])), Vec3f(0, 2, 0));
}

TEST(Stl, AnEmptyMeshWritesAValidEmptyFile) {
  const Bytes bytes = to_stl({});
  EXPECT_EQ(bytes.size(), 84U);
  EXPECT_EQ(error_of(from_stl, bytes), "part, byte 80: zero triangles");
}

TEST(Stl, RoundTripKeepsFloatsAndRoundsDoubles) {
  const Mesh sphere = sphere_mesh(10, 4);
  const Mesh back = from_stl(to_stl(sphere), "part");
  ASSERT_EQ(back.triangles.size(), sphere.triangles.size());
  for (std::size_t t = 0; t < back.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(back.vertices[back.triangles[t][k]], geom::to_float32(sphere.vertices[sphere.triangles[t][k]]));
  EXPECT_TRUE(audit(back).watertight());
  EXPECT_EQ(to_stl(back), to_stl(sphere));
}

TEST(Stl, WritingRefusesWhatCannotBeRead) {
  Mesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  mesh.vertices[3].z = std::nan("");
  EXPECT_THROW(to_stl(mesh), std::invalid_argument);
  EXPECT_THROW(to_obj(mesh), std::invalid_argument);
  EXPECT_THROW(to_ply(mesh), std::invalid_argument);
}

TEST(Obj, ReadsPolygonsNegativeIndicesAndTheirOtherForms) {
  const Mesh mesh = from_obj(bytes_of("# a comment with a \\ in it\nmtllib a.mtl\no part\nv 0 0 0\nv 1 0 0 1.0\n"
                                      "v 1 1 0 0.5 0.5 0.5\nv 0 1 0\nv -0 0 0\nvt 0 0\nvn nan 0 1\n"
                                      "f 1/1/1 2//1 3/1 4\ns off\nf -1 -3 \\\n  -2\n"),
                             "part");
  EXPECT_EQ(mesh.vertices, (Vertices{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 2, 3}}));
}

TEST(Obj, BadFilesNameTheLine) {
  const auto error = [](const std::string& tail) {
    return error_of(from_obj, bytes_of("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + tail));
  };
  EXPECT_EQ(error(""), "part, line 4: zero faces");
  EXPECT_EQ(error("f 1 2 3"), "no error");
  EXPECT_EQ(error("f 1 2"), "part, line 4: a face with fewer than three vertices");
  EXPECT_EQ(error("\nf 1 2 4"), "part, line 5: no vertex 4: 3 are defined so far");
  EXPECT_EQ(error("f 1 2 0"), "part, line 4: no vertex 0: 3 are defined so far");
  EXPECT_EQ(error("f 1 2 -4"), "part, line 4: no vertex -4: 3 are defined so far");
  EXPECT_EQ(error("f 1 2 x"), "part, line 4: expected a vertex's index, found 'x'");
  EXPECT_EQ(error("f 1 2 3/x"), "part, line 4: expected v, v/vt, v//vn or v/vt/vn, found '3/x'");
  EXPECT_EQ(error("f 1 2 3.5"), "part, line 4: expected a vertex's index, found '3.5'");
  EXPECT_EQ(error("f 1 2 99999999999999999999"),
            "part, line 4: expected a vertex's index, found '99999999999999999999'");
  EXPECT_EQ(error("v 1 2\nf 1 2 3"), "part, line 4: expected a finite coordinate, found the end of the line");
  EXPECT_EQ(error("v 1 2 nan\nf 1 2 3"), "part, line 4: expected a finite coordinate, found 'nan'");
  EXPECT_EQ(error("v 1 2 -inf\nf 1 2 3"), "part, line 4: expected a finite coordinate, found '-inf'");
  EXPECT_EQ(error("v 1 2 1e31\nf 1 2 3"), "part, line 4: a vertex's coordinate is beyond 1e30");
  EXPECT_EQ(error("face 1 2 3"), "part, line 4: expected a statement, found 'face'");
}

TEST(Obj, RoundTripKeepsEveryBit) {
  const Mesh sphere = moved(sphere_mesh(10.0 / 3, 3), {1e5, 1e-7, 0});
  const Mesh back = from_obj(to_obj(sphere), "part");
  EXPECT_EQ(back.vertices, sphere.vertices);
  EXPECT_EQ(back.triangles, sphere.triangles);
}

const std::string kPlyHeader =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nproperty float nx\nelement face 1\nproperty uchar red\nproperty list uchar int vertex_indices\n"
    "element edge 1\nproperty int vertex1\nproperty list uchar float rest\nend_header\n";
const std::string kPlyBody = "0 0 0 nan\n1 0 0 0\n1 1 0 0\n0 1 0 0\n255 4 0 1 2 3\n7 2 0.5 0.25\n";

TEST(Ply, ReadsAscii) {
  const Mesh mesh = from_ply(bytes_of(kPlyHeader + kPlyBody), "part");
  EXPECT_EQ(mesh.vertices, (Vertices{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

/// A binary PLY by the book, in either byte order.
Bytes raw_ply(bool big, int last_index = 2) {
  Bytes bytes = bytes_of(std::string("ply\nformat binary_") + (big ? "big" : "little") +
                         "_endian 1.0\nelement vertex 3\nproperty double x\nproperty short y\nproperty float z\n"
                         "element face 1\nproperty list ushort uint vertex_index\nproperty char flag\nend_header\n");
  const auto put = [&](auto value) {
    Bytes raw(sizeof value);
    std::memcpy(raw.data(), &value, sizeof value);
    if (big) std::reverse(raw.begin(), raw.end());
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  };
  for (int i = 0; i < 3; ++i) put(0.1 * i), put(static_cast<std::int16_t>(-2 * i * i)), put(0.5F);
  put(std::uint16_t{3}), put(std::uint32_t{0}), put(std::uint32_t{1}), put(last_index), put('x');
  return bytes;
}

TEST(Ply, ReadsBinaryOfBothByteOrders) {
  for (const bool big : {false, true}) {
    const Mesh mesh = from_ply(raw_ply(big), "part");
    EXPECT_EQ(mesh.vertices, (Vertices{{0, 0, 0.5}, {0.1, -2, 0.5}, {0.2, -8, 0.5}}));
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  }
}

TEST(Ply, BadBinaryNamesTheByte) {
  const auto error = [](const Bytes& bytes) { return error_of(from_ply, bytes); };
  const std::size_t size = raw_ply(false).size();
  for (const bool big : {false, true}) {
    EXPECT_EQ(error(raw_ply(big, 3)),
              "part, byte " + std::to_string(size + (big ? -3 : 0) - 1) + ": no vertex 3: there are 3, counted from 0");
    Bytes bytes = raw_ply(big);
    bytes.push_back(0);
    EXPECT_EQ(error(bytes), "part, byte " + std::to_string(bytes.size() - 1) + ": 1 bytes left over");
    bytes.resize(bytes.size() - 2);
    EXPECT_NE(error(bytes).find(": the file ends within a row"), std::string::npos) << error(bytes);
    bytes.resize(bytes.size() - 30);
    EXPECT_NE(error(bytes).find("rows of element 'vertex' do not fit"), std::string::npos) << error(bytes);
  }
}

TEST(Ply, BadTextNamesTheLine) {
  const auto error = [](const std::string& from, const std::string& to) {
    std::string text = kPlyHeader + kPlyBody;
    text.replace(text.find(from), from.size(), to);
    return error_of(from_ply, bytes_of(text));
  };
  EXPECT_EQ(error("ply", "plx"), "part, line 1: expected 'ply' at the start of the file");
  EXPECT_EQ(error("format ascii 1.0", "format ascii 2.0"), "part, line 2: expected version '1.0', found '2.0'");
  EXPECT_EQ(error("format ascii 1.0\n", ""), "part, line 14: the header has no line 'format'");
  EXPECT_EQ(error("element vertex 4", "element vertex -4"), "part, line 4: expected a count, found '-4'");
  EXPECT_EQ(error("property float y", "property real y"), "part, line 6: expected a type, found 'real'");
  EXPECT_EQ(error("property float y", "property float why"), "part, line 16: element 'vertex' has no x, y, z");
  EXPECT_EQ(error("vertex_indices", "indices"), "part, line 19: element 'face' has no list of integers vertex_indices");
  EXPECT_EQ(error("element face 1", "element vertex 1"), "part, line 9: element 'vertex' twice");
  EXPECT_EQ(error("element vertex 4", "element vertex 5"), "part, line 21: no vertex 7: there are 5, counted from 0");
  EXPECT_EQ(error("1 1 0 0", "1 inf 0 0"), "part, line 18: expected a finite number, found 'inf'");
  EXPECT_EQ(error("1 1 0 0", "1 -1e31 0 0"), "part, line 18: a vertex's coordinate is beyond 1e30");
  EXPECT_EQ(error("4 0 1 2 3", "4 0 1 2 4"), "part, line 20: no vertex 4: there are 4, counted from 0");
  EXPECT_EQ(error("4 0 1 2 3", "2 0 1"), "part, line 20: a face with fewer than three vertices");
  EXPECT_EQ(error("4 0 1 2 3", "-1 0 1"), "part, line 20: a list with -1 values");
  EXPECT_EQ(error("element face 1", "element face 0"), "part, line 21: expected the end of the file, found '7'");
  EXPECT_EQ(error("0.25\n", "0.25\n9"), "part, line 22: expected the end of the file, found '9'");
  EXPECT_EQ(error("end_header\n" + kPlyBody, ""),
            "part, line 15: the file ends where a line of the header or 'end_header' was expected");
}

TEST(Ply, RoundTripKeepsEveryBit) {
  for (const double radius : {10.0 / 3, 1.0}) {
    Mesh sphere = sphere_mesh(radius, 3);
    if (radius == 1)
      for (Vec3& v : sphere.vertices) v = geom::to_float32(v);  // then floats suffice
    const Bytes bytes = to_ply(sphere);
    EXPECT_EQ(std::string(bytes.begin(), bytes.end()).find("property float x") != std::string::npos, radius == 1);
    const Mesh back = from_ply(bytes, "part");
    EXPECT_EQ(back.vertices, sphere.vertices);
    EXPECT_EQ(back.triangles, sphere.triangles);
  }
}

TEST(MeshFiles, AreDistinguishedByTheirNames) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("riffler_files_" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  const Mesh mesh = box_mesh({0, 0, 0}, {1, 2, 3});
  for (const char* name : {"a.stl", "b.STL", "c.obj", "d.Ply"}) {
    write_mesh(mesh, folder / name);
    EXPECT_DOUBLE_EQ(volume(read_mesh(folder / name)), 6) << name;
  }
  for (const char* name : {"a.3mf", "stl", "a.stl.gz"}) {
    EXPECT_THROW(write_mesh(mesh, folder / name), std::invalid_argument);
    EXPECT_THROW(read_mesh(folder / name), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(folder / name));
  }
  EXPECT_THROW(read_mesh(folder / "none.stl"), FormatError);
  std::filesystem::remove_all(folder);
}

TEST(MeshFiles, CancelledWritesLeaveTheOldFiles) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("riffler_cancelled_" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  const Mesh torus = torus_mesh(40, 15, 300, 300);  // 180 000 triangles: six pieces
  write_mesh(box_mesh({0, 0, 0}, {1, 2, 3}), folder / "part.stl");
  std::vector<double> shares;
  for (std::size_t until = 0;; ++until) {
    shares.clear();
    const auto listen = [&](double share) {
      shares.push_back(share);
      return shares.size() <= until;
    };
    try {
      write_mesh(torus, folder / "part.stl", listen);
      break;
    } catch (const Cancelled&) {
      EXPECT_DOUBLE_EQ(volume(read_mesh(folder / "part.stl")), 6) << until;
      EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1) << until;
    }
  }
  EXPECT_EQ(shares.size(), 8u);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_DOUBLE_EQ(shares.back(), 1);
  EXPECT_EQ(read_mesh(folder / "part.stl").triangles.size(), torus.triangles.size());
  std::filesystem::remove_all(folder);
}

TEST(Weld, NumbersManyPointsInTheOrderOfTheirFirstAppearance) {
  // More than the table first holds, each point six times on average; the reference is the torus's own numbering.
  const Mesh torus = torus_mesh(40, 15, 300, 100);
  std::vector<float> coordinates;
  for (const Vec3i& t : torus.triangles)
    for (int k = 0; k < 3; ++k)
      for (int d = 0; d < 3; ++d) coordinates.push_back(static_cast<float>(torus.vertices[t[k]][d]));
  const Mesh mesh = from_stl(raw_stl(coordinates), "part");
  EXPECT_EQ(mesh.vertices.size(), torus.vertices.size());
  int next = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.triangles[t][k];
      EXPECT_LE(v, next);
      next = std::max(next, v + 1);
      EXPECT_EQ(mesh.vertices[v], geom::to_float32(torus.vertices[torus.triangles[t][k]]));
    }
}

TEST(Ply, AHeaderOfManyElementsIsRefused) {
  std::string header = "ply\nformat ascii 1.0\n";
  for (int k = 0; k < 100'000; ++k) header += "element e" + std::to_string(k) + " 0\n";
  EXPECT_NE(error_of(from_ply, bytes_of(header + "end_header\n")).find("more than 1000 elements"), std::string::npos);
}

TEST(MeshFiles, ReadingReportsProgressAndCanBeStopped) {
  const Mesh sphere = subdivided(box_mesh({0, 0, 0}, {1, 1, 1}), 6);
  const Bytes obj = to_obj(sphere), ply = to_ply(sphere);
  for (int most = 1; most < 4; ++most) {
    int asked = 0;
    const auto stop = [&](double share) {
      EXPECT_TRUE(share >= 0 && share <= 1);
      return ++asked < most;
    };
    EXPECT_THROW(from_obj(obj, "o", stop), Cancelled);
    EXPECT_EQ(std::exchange(asked, 0), most);
    EXPECT_THROW(from_ply(ply, "p", stop), Cancelled);
  }
}

}  // namespace
}  // namespace riffler::mesh::files_test
