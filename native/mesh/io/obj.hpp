// Wavefront OBJ: geometry in and out.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// The mesh in an OBJ file's bytes; `name` stands in messages. Reads v and f (v, v/vt, v//vn, v/vt/vn, negative
/// indices, polygons as fans, lines continued by '\'); other statements of the format are passed over. Equal vertices
/// become one; vertices without a face stay. FormatError naming the line for an unknown statement, a face with fewer
/// than three vertices or one that is not there (yet), a vertex that is not finite or beyond 1e30; also for zero faces.
Mesh from_obj(std::span<const std::uint8_t> bytes, const std::string& name);
/// `progress` hears of every few thousand lines; its share is of no more than the part at hand.
Mesh from_obj(std::span<const std::uint8_t> bytes, const std::string& name, const Progress& progress);

/// OBJ with coordinates that read back to the same doubles. std::invalid_argument where `validate` throws.
std::vector<std::uint8_t> to_obj(const Mesh& mesh);

}  // namespace riffler::mesh
