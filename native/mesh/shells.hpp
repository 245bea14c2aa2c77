// Which side of closed surfaces their solid is on, where some may be cavities in others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

struct ShellSide {
  bool turn = false;  ///< it faces the wrong way
  double volume = 0;  ///< mm³ that it encloses, positive
};

/// The sides of shells 0, 1, … `shell[t]` is the closed shell that triangle t belongs to, or −1; read forwards where
/// `runs[t]` is 1 and backwards where it is −1, the triangles of a shell are oriented alike. `open_to_either[s]`: shell
/// s has no orientation of its own.
///
/// A shell lies in another if samples of its surface, a little behind it, all do. Orientation is taken relative to the
/// smallest shell around it, outermost shells face outwards, and a shell that faces inwards is a cavity where the
/// shells around it leave material to take away; elsewhere it is turned. So a part turned inside out keeps its
/// cavities. Shells without volume are not turned.
std::vector<ShellSide> shell_sides(const Mesh& mesh, std::span<const int> shell, std::span<const int> runs,
                                   std::span<const std::uint8_t> open_to_either);

}  // namespace riffler::mesh
