// STL: binary and ASCII in, binary out.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// The mesh in an STL file's bytes; `name` stands in messages. Binary where the size fits the count at byte 80,
/// whatever the header says; ASCII where it starts with "solid" otherwise. Coordinates are float32; equal ones (-0 is
/// 0) become one vertex, numbered in the order of the file; no triangle is dropped. Normals and attributes are ignored.
/// FormatError naming the byte or line for a wrong count, a truncated file, zero triangles, a vertex that is not finite
/// or beyond 1e30.
Mesh from_stl(std::span<const std::uint8_t> bytes, const std::string& name);

/// Binary STL. Coordinates are rounded to float32; normals are those of the rounded triangles, 0 where they have no
/// area. An empty mesh gives the 84 bytes of an STL with no triangles. std::invalid_argument where `validate` throws.
std::vector<std::uint8_t> to_stl(const Mesh& mesh);

/// Takes a piece of a file, and the share of it that there is then.
using PutBytes = std::function<void(std::span<const std::uint8_t> bytes, double share)>;

/// The same bytes, piece after piece: a large file is written from a few MB that stay in the cache.
void put_stl(const Mesh& mesh, const PutBytes& put);

}  // namespace riffler::mesh
