// Reads ASCII and binary PLY (Stanford polygon) files and writes binary ones.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Reads a mesh from a PLY file's bytes (ascii, binary_little_endian, binary_big_endian); `name` appears in messages.
/// Requires an element "vertex" with x, y, z and, after it, an element "face" with a list vertex_indices or
/// vertex_index. Splits polygons into fans, skips everything else, merges equal vertices and keeps vertices without a
/// face. Throws FormatError naming the line or byte for a header that is not PLY, wrong counts, extra bytes, an index
/// out of range, a face with fewer than three vertices, a vertex that is not finite or beyond 1e30, or zero faces.
Mesh from_ply(std::span<const std::uint8_t> bytes, const std::string& name);
/// Calls `progress` every few thousand rows, with the fraction of the current element.
Mesh from_ply(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress);

/// Writes binary little-endian PLY. Coordinates are float if that represents all of them exactly, otherwise double.
/// Throws std::invalid_argument if `validate` does.
std::vector<std::uint8_t> to_ply(const Mesh& mesh);

}  // namespace riffler::mesh
