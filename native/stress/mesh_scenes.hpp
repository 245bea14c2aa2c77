// What the meshing stress run meshes: small volumes, random and from the degenerate limits.
#pragma once

#include "riffler/dexel/volume.hpp"
#include "stress/random.hpp"
#include "stress/solids.hpp"

namespace riffler::stress {

/// What is degenerate about a volume.
enum class MeshScene {
  Contradictory,  ///< the grids know nothing of each other; ends anywhere, often on lattice planes
  Signs,          ///< lattice points in and out at random, alike in all grids
  Checkerboard,   ///< in and out by turns, with some points turned round
  OneUlp,         ///< gaps and spans of one step of a double, and ends one step off lattice planes
  Islands,        ///< a few rays that hit anything, of one grid or of all
  Solids,         ///< spheres, half-spaces, boxes turned or not, put together
  Coincident,     ///< boxes that share faces, edges and corners, on lattice planes and halfway between
  Thin,           ///< walls, gaps and steps thinner than the pitch
  Booleans,       ///< volumes added, taken away and met
  Carved,         ///< moves of every cutter, from the degenerate limits
  kCount
};
const char* name(MeshScene scene);

/// A volume of this kind: up to some tens of cells a side, mostly few, now and then long enough for more than one of
/// the mesher's bricks; its box up to 2e6 pitches away from the origin.
Volume draw_volume(Random& random, MeshScene scene);

/// One ray's spans, with a chance of `share`: ends anywhere, often on lattice planes or faces of the box.
SolidSpans spans_at_random(Random& random, const dexel::Grid& grid, double share, bool normals);
/// Spans that know nothing of each other, on a `share` of the rays; normals along them or, where `normals`, anywhere.
void fill_at_random(Volume& volume, Random& random, double share, bool normals);

}  // namespace riffler::stress
