// Consistent, outward orientation for meshes that are to be solids.
#pragma once

#include <cstddef>
#include <optional>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// What `oriented` found and changed.
struct Orientation {
  std::size_t turned = 0;         ///< triangles turned to agree with their neighbours
  std::size_t turned_shells = 0;  ///< closed pieces that faced inwards as a whole, turned
  std::size_t left_out = 0;       ///< repeated triangles left out, which tear the surface open
  std::size_t one_sided = 0;      ///< pieces that have no two sides, as a Möbius strip; they stay as they are
  double turned_volume = 0;       ///< mm³ that the turned shells enclose

  bool changed() const { return turned + turned_shells + left_out > 0; }
};

/// The mesh with its triangles turned so that it bounds a solid; nothing where none has to be turned. Vertices are
/// those of `mesh`; those with equal coordinates, or within a few ulps where the surface ends, count as one.
///
/// A piece is connected across edges that just two triangles share, equal triangles counted as one: over such edges the
/// orientation is carried. In a closed piece that disagrees with itself the larger area wins, and a repeated triangle
/// stands once. Closed pieces then face outwards, but for cavities: pieces that lie in another one and are oriented the
/// other way round. Open pieces, and pieces with one side only, stay as they are. Triangles keep their places: one that
/// is left out names a vertex three times. Linear time for closed outward meshes. `Hollow::Kept`: where all closed
/// pieces would be turned as they are, they are not: that is room in endless material, of which planning finds the
/// valleys.
enum class Hollow { Turned, Kept };
std::optional<Mesh> oriented(const Mesh& mesh, Orientation& found, Hollow hollow = Hollow::Turned);

/// For takers of a solid: `mesh` itself, or what `oriented` made of it, kept in `storage`.
const Mesh& as_solid(const Mesh& mesh, std::optional<Mesh>& storage, Hollow hollow = Hollow::Turned);

}  // namespace riffler::mesh
