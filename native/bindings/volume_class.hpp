// riffler.Volume, which several files bind.
#pragma once

#include <memory>

#include "bindings/bindings.hpp"
#include "bindings/shared_volume.hpp"

namespace riffler::bindings {

using VolumeClass = py::class_<SharedVolume, std::shared_ptr<SharedVolume>>;

inline std::shared_ptr<SharedVolume> share(Volume&& v) {
  return std::make_shared<SharedVolume>(std::move(v));
}

/// Boxes, balls, cylinders.
void bind_volume_solids(VolumeClass& volume);
/// The volume of a mesh, and the mesh of a volume.
void bind_volume_meshes(VolumeClass& volume);
/// Carving, operators of sets, snapshots.
void bind_volume_carving(py::module_& m, VolumeClass& volume);
/// Files and bytes.
void bind_volume_files(VolumeClass& volume);
/// Methods that make other volumes of one, clip it, or ask what it holds.
void bind_volume_edits(VolumeClass& volume);

}  // namespace riffler::bindings
