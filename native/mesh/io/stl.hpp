// Reads binary and ASCII STL and writes binary STL.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Reads a mesh from an STL file's bytes; `name` appears in messages. The file is binary if its size matches the count
/// at byte 80, even if its header starts with "solid"; otherwise such a header means ASCII. Coordinates are float32.
/// Equal vertices (-0 equals 0) become one, numbered in the order of the file; no triangle is dropped. Normals and
/// attributes are ignored. Throws FormatError naming the byte or line for a wrong count, a truncated file, zero
/// triangles, or a vertex that is not finite or beyond 1e30.
Mesh from_stl(std::span<const std::uint8_t> bytes, const std::string& name);

/// Writes binary STL. Coordinates are rounded to float32; normals are those of the rounded triangles, or 0 for
/// triangles without area. An empty mesh gives the 84 bytes of an STL with no triangles. Throws std::invalid_argument
/// if `validate` does.
std::vector<std::uint8_t> to_stl(const Mesh& mesh);

/// Receives a piece of a file, and the fraction of the file written with it.
using PutBytes = std::function<void(std::span<const std::uint8_t> bytes, double share)>;

/// Writes the same bytes piece by piece: even a large file needs only a few MB, which stay in the cache.
void put_stl(const Mesh& mesh, const PutBytes& put);

}  // namespace riffler::mesh
