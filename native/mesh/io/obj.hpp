// Reads and writes Wavefront OBJ geometry.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Reads a mesh from an OBJ file's bytes; `name` appears in messages. Understands v and f (v, v/vt, v//vn, v/vt/vn,
/// negative indices, polygons as fans, lines continued by '\'); skips the format's other statements. Merges equal
/// vertices; keeps vertices without a face. Throws FormatError naming the line for an unknown statement, a face with
/// fewer than three vertices or with a vertex that is not defined (yet), a vertex that is not finite or beyond 1e30, or
/// zero faces.
Mesh from_obj(std::span<const std::uint8_t> bytes, const std::string& name);
/// Calls `progress` every few thousand statements, with the fraction of the bytes read.
Mesh from_obj(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress);

/// Writes OBJ with coordinates that read back to the same doubles. Throws std::invalid_argument if `validate` does.
std::vector<std::uint8_t> to_obj(const Mesh& mesh);

}  // namespace riffler::mesh
