// Reads and writes mesh files; the file name's extension selects the format.
#pragma once

#include <filesystem>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Reads .stl, .obj or .ply (in any case). Throws FormatError for a bad file, std::invalid_argument for another
/// extension.
Mesh read_mesh(const std::filesystem::path& path, const Progress& progress = {});

/// Writes .stl (binary, float32), .obj (text) or .ply (binary little-endian), completely or not at all. Throws
/// std::invalid_argument for another extension or if `validate` does, std::runtime_error with the system's reason if
/// the file cannot be written.
void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const Progress& progress = {});

}  // namespace riffler::mesh
