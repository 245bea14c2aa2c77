// Gives meshes that bound solids a consistent, outward orientation.
#pragma once

#include <cstddef>
#include <optional>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// What `oriented` found and changed.
struct Orientation {
  std::size_t turned = 0;         ///< triangles turned to agree with their neighbours
  std::size_t turned_shells = 0;  ///< closed pieces that faced inwards as a whole and were turned
  std::size_t left_out = 0;       ///< repeated triangles removed because they tear the surface open
  std::size_t one_sided = 0;      ///< pieces with one side only, such as a Möbius strip; unchanged
  double turned_volume = 0;       ///< mm³ enclosed by the turned shells

  bool changed() const { return turned + turned_shells + left_out > 0; }
};

/// What to do if all closed pieces face inwards. Such a mesh is a room in endless material; planning searches its
/// valleys.
enum class Hollow { Turned, Kept };

/// Turns triangles so that the mesh bounds a solid. Returns nothing if no triangle has to be turned. Vertices are those
/// of `mesh`; vertices with equal coordinates count as one, and at open edges so do vertices a few ulps apart.
///
/// A piece is connected across edges that exactly two triangles share (equal triangles count as one); orientation
/// spreads over these edges. In a closed piece with contradicting orientations, the larger area wins, and only one copy
/// of a repeated triangle stays. Closed pieces then face outwards, except cavities: pieces inside another one with the
/// opposite orientation. With `Hollow::Kept`, no closed piece is turned if all of them would be. Open and one-sided
/// pieces are unchanged. Triangles keep their indices: a removed triangle names one vertex three times. Takes linear
/// time for closed, outward meshes.
std::optional<Mesh> oriented(const Mesh& mesh, Orientation& found, Hollow hollow = Hollow::Turned);

/// For callers that need a solid: returns `mesh` itself, or the result of `oriented`, which `storage` then owns.
const Mesh& as_solid(const Mesh& mesh, std::optional<Mesh>& storage, Hollow hollow = Hollow::Turned);

}  // namespace riffler::mesh
