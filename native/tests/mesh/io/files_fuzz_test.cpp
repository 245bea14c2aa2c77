// Damaged files: a FormatError or a mesh that is valid, never anything else.
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "mesh/io/obj.hpp"
#include "mesh/io/ply.hpp"
#include "mesh/io/stl.hpp"
#include "mesh/shapes.hpp"
#include "riffler/base/error.hpp"
#include "riffler/mesh/audit.hpp"

namespace riffler::mesh::files_fuzz_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using From = Mesh (*)(std::span<const std::uint8_t>, const std::string&);

std::string ascii_stl(const Mesh& mesh) {
  std::string text = "solid part\n";
  for (const Vec3i& t : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (int k = 0; k < 3; ++k) {
      const Vec3& v = mesh.vertices[t[k]];
      text += "vertex " + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid part\n";
}

std::string ascii_ply(const Mesh& mesh) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                     "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                     std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : mesh.vertices)
    text += std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
  for (const Vec3i& t : mesh.triangles)
    text += "3 " + std::to_string(t.x) + " " + std::to_string(t.y) + " " + std::to_string(t.z) + "\n";
  return text;
}

/// Damages a file in one of several forms.
void damage(Bytes& bytes, std::mt19937& random) {
  static const std::string kWords[] = {"nan", "-1", "1e999", "4294967295", " ",      "\n",
                                       "\\",  "0",  "/",     "solid",      "element"};
  const auto any = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  const std::size_t at = any(bytes.size());
  switch (random() % 7) {
    case 0:
      bytes.resize(at);
      break;
    case 1:
      if (!bytes.empty()) bytes[at] = static_cast<std::uint8_t>(random());
      break;
    case 2:
      if (!bytes.empty()) bytes[at] ^= static_cast<std::uint8_t>(1U << (random() % 8));
      break;
    case 3: {
      const std::string& word = kWords[any(std::size(kWords))];
      bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), word.begin(), word.end());
      break;
    }
    case 4: {
      const std::size_t end = std::min(bytes.size(), at + any(64));
      bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.begin() + static_cast<std::ptrdiff_t>(end));
      break;
    }
    case 5: {
      const std::size_t end = std::min(bytes.size(), at + any(64));
      const Bytes piece(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                        bytes.begin() + static_cast<std::ptrdiff_t>(end));
      const auto to = static_cast<std::ptrdiff_t>(any(bytes.size()));
      bytes.insert(bytes.begin() + to, piece.begin(), piece.end());
      break;
    }
    default:
      // Four bytes, as a count or a coordinate would be hit.
      for (std::size_t k = at; k < std::min(bytes.size(), at + 4); ++k)
        bytes[k] = random() % 3 == 0 ? 0xff : static_cast<std::uint8_t>(random());
  }
}

void fuzz(From from, const Bytes& good, unsigned seed) {
  std::mt19937 random(seed);
  int errors = 0, meshes = 0;
  for (int round = 0; round < 4000; ++round) {
    Bytes bytes = good;
    for (auto n = 1 + random() % 3; n > 0; --n) damage(bytes, random);
    try {
      const Mesh mesh = from(bytes, "part");
      ASSERT_NO_THROW(validate(mesh));
      ASSERT_FALSE(mesh.empty());
      if (round % 16 == 0) audit(mesh);
      ++meshes;
    } catch (const FormatError& e) {
      const std::string what = e.what();
      ASSERT_TRUE(what.starts_with("part, line ") || what.starts_with("part, byte ")) << what;
      ++errors;
    }
  }
  EXPECT_GT(errors, 400);
  EXPECT_GT(meshes, 40);
}

Bytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

TEST(DamagedFiles, BinaryStl) {
  fuzz(from_stl, to_stl(sphere_mesh(3, 1)), 1);
}
TEST(DamagedFiles, AsciiStl) {
  fuzz(from_stl, bytes_of(ascii_stl(sphere_mesh(3, 0))), 2);
}
TEST(DamagedFiles, Obj) {
  fuzz(from_obj, to_obj(sphere_mesh(3, 1)), 3);
}
TEST(DamagedFiles, BinaryPly) {
  fuzz(from_ply, to_ply(sphere_mesh(3, 1)), 4);
}
TEST(DamagedFiles, AsciiPly) {
  fuzz(from_ply, bytes_of(ascii_ply(sphere_mesh(3, 1))), 5);
}

}  // namespace
}  // namespace riffler::mesh::files_fuzz_test
