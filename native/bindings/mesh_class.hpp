// riffler.Mesh, which two files bind.
#pragma once

#include <memory>

#include "bindings/bindings.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::bindings {

using MeshPtr = std::shared_ptr<Mesh>;
using MeshClass = py::class_<Mesh, MeshPtr>;

/// Methods that look at a mesh as a whole, or make another of it.
void bind_mesh_edits(MeshClass& mesh);

}  // namespace riffler::bindings
