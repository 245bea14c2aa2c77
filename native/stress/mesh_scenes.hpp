// Small random volumes from the degenerate limits, for the meshing stress run.
#pragma once

#include "riffler/dexel/volume.hpp"
#include "stress/random.hpp"
#include "stress/solids.hpp"

namespace riffler::stress {

/// Kind of degeneracy of a volume.
enum class MeshScene {
  Contradictory,  ///< independent grids; random ends, often on lattice planes
  Signs,          ///< lattice points inside or outside at random, the same in all grids
  Checkerboard,   ///< inside and outside alternately, with some points inverted
  OneUlp,         ///< gaps and spans of one step of a double, and ends one step off lattice planes
  Islands,        ///< only a few rays have spans, in one grid or in all
  Solids,         ///< unions of spheres, half-spaces, and boxes turned or not
  Coincident,     ///< boxes that share faces, edges and corners, on lattice planes and halfway between
  Thin,           ///< walls, gaps and steps thinner than the pitch
  Booleans,       ///< unions, differences and intersections of volumes
  Carved,         ///< moves of every cutter, from the degenerate limits
  kCount
};
const char* name(MeshScene scene);

/// A random volume of this kind: up to a few tens of cells a side, usually few, sometimes long enough for more than one
/// of the mesher's bricks, and up to 2e6 pitches away from the origin.
Volume draw_volume(Random& random, MeshScene scene);

/// Random spans of a ray, with probability `share`; none otherwise. Ends are often on lattice planes or faces of the
/// box.
SolidSpans spans_at_random(Random& random, const dexel::Grid& grid, double share, bool normals);
/// Fills a `share` of the rays with independent random spans; normals are along the rays or, with `normals`, random.
void fill_at_random(Volume& volume, Random& random, double share, bool normals);

}  // namespace riffler::stress
