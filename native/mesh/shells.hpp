// Decides on which side of closed surfaces the solid lies if some may be cavities in others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

struct ShellSide {
  bool turn = false;  ///< the shell faces the wrong side
  double volume = 0;  ///< mm³ that the shell encloses, positive
};

/// The sides of shells 0, 1, …. `shell[t]` is the closed shell that triangle t belongs to, or −1. `runs[t]` is 1 if the
/// triangle keeps its orientation and −1 if it has to be reversed for its shell to be oriented consistently.
/// `open_to_either[s]`: shell s has no orientation of its own.
///
/// A shell lies in another if all samples of its surface, taken slightly behind it, do. Orientation is compared with
/// the smallest shell around it. Outermost shells face outwards. A shell that faces inwards is a cavity if the shells
/// around it leave material to remove; otherwise it is turned. So a part turned inside out keeps its cavities. Shells
/// without volume are not turned.
std::vector<ShellSide> shell_sides(const Mesh& mesh, std::span<const int> shell, std::span<const int> runs,
                                   std::span<const std::uint8_t> open_to_either);

}  // namespace riffler::mesh
