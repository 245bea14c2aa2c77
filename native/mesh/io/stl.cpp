#include "mesh/io/stl.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "geom/float32.hpp"
#include "mesh/io/scan.hpp"
#include "mesh/weld.hpp"
#include "riffler/base/error.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

constexpr std::size_t kHeader = 80, kStart = 84, kRecord = 50;
constexpr std::size_t kPiece = 1 << 15;  // triangles written at once: 1.6 MB
// Must not start with "solid", which many readers take for ASCII.
constexpr std::string_view kTitle = "Binary STL by Riffler; lengths in mm";

Mesh to_mesh(const Welder<Vec3f>& welder, Triangles&& triangles) {
  Mesh mesh;
  mesh.vertices.assign(welder.points().begin(), welder.points().end());
  mesh.triangles = std::move(triangles);
  return mesh;
}

/// Reports the first vertex that is not finite or too large, with the byte of its coordinate.
void check_coordinates(std::span<const std::uint8_t> bytes, std::size_t count, const std::string& name) {
  constexpr std::size_t kGrain = 1 << 15;
  std::vector<std::size_t> bad((count + kGrain - 1) / kGrain, 0);
  base::parallel_for(count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      for (std::size_t k = 0; k < 9; ++k) {
        const std::size_t at = kStart + t * kRecord + 12 + 4 * k;
        float x;
        std::memcpy(&x, &bytes[at], 4);
        if (!(std::abs(static_cast<double>(x)) <= 1e30)) {
          bad[begin / kGrain] = at;
          return;
        }
      }
  });
  for (const std::size_t at : bad)
    if (at > 0) {
      float x;
      std::memcpy(&x, &bytes[at], 4);
      throw FormatError(name, "byte " + std::to_string(at),
                        std::isfinite(x) ? "a vertex's coordinate is beyond 1e30" : "a vertex is not finite");
    }
}

Mesh from_binary(std::span<const std::uint8_t> bytes, std::size_t count, const std::string& name) {
  if (count == 0) throw FormatError(name, "byte 80", "zero triangles");
  if (count > 0x7fffffff / 3) throw FormatError(name, "byte 80", "more triangles than can be indexed");
  check_coordinates(bytes, count, name);
  Welder<Vec3f> welder(count / 2 + 2);  // Euler: a closed mesh has half as many vertices as triangles
  Triangles triangles(count);
  constexpr std::size_t kBlock = 16;
  std::array<Vec3f, 3 * kBlock> corners;
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t n = std::min(kBlock, count - begin);
    for (std::size_t i = 0; i < n; ++i) std::memcpy(&corners[3 * i], &bytes[kStart + (begin + i) * kRecord + 12], 36);
    welder.add(std::span(corners).first(3 * n), &triangles[begin].x);
  }
  return to_mesh(welder, std::move(triangles));
}

Mesh from_ascii(std::span<const std::uint8_t> bytes, const std::string& name) {
  Scanner scan(bytes, name);
  Welder<Vec3f> welder;
  Triangles triangles;
  scan.expect("solid");
  scan.next_line();
  for (;;) {
    const std::string_view word = scan.token();
    if (equal_ignoring_case(word, "facet")) {
      scan.expect("normal");
      for (int k = 0; k < 3; ++k) scan.skip_number("a normal's component");
      scan.expect("outer");
      scan.expect("loop");
      std::array<Vec3f, 3> corners;
      for (Vec3f& corner : corners) {
        scan.expect("vertex");
        corner = Vec3f(scan.vertex());
      }
      scan.expect("endloop");
      scan.expect("endfacet");
      welder.add(corners, &triangles.emplace_back().x);
    } else if (equal_ignoring_case(word, "endsolid")) {
      scan.next_line();
      // A file may hold several solids; they become one mesh.
      const std::string_view next = scan.token();
      if (next.empty()) break;
      if (!equal_ignoring_case(next, "solid")) scan.fail_expected("'solid' or the end of the file", next);
      scan.next_line();
    } else {
      scan.fail_expected("'facet' or 'endsolid'", word);
    }
  }
  if (triangles.empty()) scan.fail("zero triangles");
  return to_mesh(welder, std::move(triangles));
}

bool looks_like_ascii(std::span<const std::uint8_t> bytes) {
  const std::span<const std::uint8_t> head = bytes.first(std::min<std::size_t>(bytes.size(), 512));
  if (std::memchr(head.data(), 0, head.size())) return false;  // a binary file whose title is "solid …"
  return equal_ignoring_case(Scanner(head, "").token(), "solid");
}

std::array<float, 12> record(const Mesh& mesh, const Vec3i& t) {
  std::array<Vec3, 4> rows;  // normal, corners
  for (int k = 0; k < 3; ++k) rows[k + 1] = geom::to_float32(mesh.vertices[t[k]]);
  const Vec3 normal = glm::cross(rows[2] - rows[1], rows[3] - rows[1]);
  const double length = glm::length(normal);
  rows[0] = length > 0 && std::isfinite(length) ? normal / length : Vec3(0);
  std::array<float, 12> values;
  for (int k = 0; k < 12; ++k) values[k] = static_cast<float>(rows[k / 3][k % 3] + 0);  // -0 becomes 0
  return values;
}

}  // namespace

Mesh from_stl(std::span<const std::uint8_t> bytes, const std::string& name) {
  if (bytes.empty()) throw FormatError(name, "byte 0", "the file is empty");
  std::uint32_t count = 0;
  if (bytes.size() >= kStart) {
    std::memcpy(&count, &bytes[kHeader], 4);
    if (bytes.size() == kStart + kRecord * count) return from_binary(bytes, count, name);
  }
  if (looks_like_ascii(bytes)) return from_ascii(bytes, name);
  if (bytes.size() < kStart)
    throw FormatError(name, "byte " + std::to_string(bytes.size()),
                      "the file ends within the 84 bytes before the first triangle");
  throw FormatError(name, "byte 80",
                    "the count says " + std::to_string(count) + " triangles, that is " +
                        std::to_string(kStart + kRecord * count) + " bytes, but the file has " +
                        std::to_string(bytes.size()));
}

void put_stl(const Mesh& mesh, const PutBytes& put) {
  validate(mesh);
  const std::size_t count = mesh.triangles.size();
  if (count > 0xffffffff) throw std::invalid_argument("triangles: more than a binary STL can count");
  std::array<std::uint8_t, kStart> head{};
  std::memcpy(head.data(), kTitle.data(), kTitle.size());
  const auto count32 = static_cast<std::uint32_t>(count);
  std::memcpy(&head[kHeader], &count32, 4);
  put(head, count == 0 ? 1 : 0);
  std::vector<std::uint8_t> bytes(kRecord * std::min(count, kPiece), 0);  // attributes stay 0
  for (std::size_t at = 0; at < count; at += kPiece) {
    const std::size_t some = std::min(kPiece, count - at);
    base::parallel_for(some, 1 << 13, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const std::array<float, 12> values = record(mesh, mesh.triangles[at + t]);
        std::memcpy(&bytes[t * kRecord], values.data(), 48);
      }
    });
    put(std::span(bytes).first(some * kRecord), static_cast<double>(at + some) / static_cast<double>(count));
  }
}

std::vector<std::uint8_t> to_stl(const Mesh& mesh) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(kStart + kRecord * mesh.triangles.size());
  put_stl(mesh,
          [&](std::span<const std::uint8_t> piece, double) { bytes.insert(bytes.end(), piece.begin(), piece.end()); });
  return bytes;
}

}  // namespace riffler::mesh
