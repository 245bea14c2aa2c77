// PLY, the Stanford polygon file: ASCII and binary in, binary out.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// The mesh in a PLY file's bytes (ascii, binary_little_endian, binary_big_endian); `name` stands in messages. Needs an
/// element "vertex" with x, y, z and after it an element "face" with a list vertex_indices or vertex_index; polygons
/// become fans; everything else is passed over. Equal vertices become one; vertices without a face stay. FormatError
/// naming the line or byte for a header that is not PLY, wrong counts, bytes left over, an index out of range, a face
/// with fewer than three vertices, a vertex that is not finite or beyond 1e30, zero faces.
Mesh from_ply(std::span<const std::uint8_t> bytes, const std::string& name);
/// `progress` hears of every few thousand lines; its share is of no more than the part at hand.
Mesh from_ply(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress);

/// Binary little-endian PLY; coordinates are float where that keeps every one of them exact, else double.
/// std::invalid_argument where `validate` throws.
std::vector<std::uint8_t> to_ply(const Mesh& mesh);

}  // namespace riffler::mesh
