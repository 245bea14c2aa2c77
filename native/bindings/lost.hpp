// Thin material that gets lost from a mesh to a volume and back, for Python.
#pragma once

#include "bindings/bindings.hpp"
#include "riffler/dexel/from_mesh/mesh_report.hpp"
#include "riffler/marching/thin.hpp"

namespace riffler::bindings {

struct Lost {
  double volume = 0, of = 0;  ///< mm³: lost, and of how much
  double used = 0;            ///< mm: the pitch
  double pitch = 0;           ///< mm: what keeps it
  Box3 box;                   ///< where it is
  std::string note;           ///< a sentence where it is worth one, otherwise empty
};

/// For a volume that was made of a mesh: what its rays miss, or what its own mesh will lack.
Lost lost_in(const Volume& volume, const dexel::MissedMaterial& missed);
/// For a volume whose mesh has so many triangles.
Lost lost_by_meshing(const Volume& volume, std::size_t triangles);

/// The note, where there is one, as a Python warning.
void warn(const Lost& lost);
/// Puts `lost`, `lost_box`, `lost_pitch` and `lost_note` among the fields of a result.
void put(const Lost& lost, py::dict& fields);

}  // namespace riffler::bindings
