// Mesh files by their name.
#pragma once

#include <filesystem>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Reads .stl, .obj or .ply (any case). FormatError for a bad file, std::invalid_argument for another extension.
Mesh read_mesh(const std::filesystem::path& path, const Progress& progress = {});

/// Writes .stl (binary, float32), .obj (text) or .ply (binary little-endian), whole or not at all.
/// std::invalid_argument for another extension or where `validate` throws, std::runtime_error where the system refuses.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const Progress& progress = {});

}  // namespace riffler::mesh
