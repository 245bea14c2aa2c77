// What must hold after every move.
#pragma once

#include <string>

#include "riffler/sweep/carve.hpp"
#include "stress/scenario.hpp"

namespace riffler::stress {

/// Every check returns what is wrong, or nothing.
using Problem = std::string;

/// Spans finite, longer than nothing, in order, apart, inside the box; the tile's reach covers them; normals are unit
/// vectors; rays beyond the grid are empty. With `before`: every span lies in one that was there before. Tiles that
/// both share are not looked at.
Problem check_spans(const Volume& volume, const Volume* before = nullptr);

/// What the move says it removed is what the volume lost, and the volume did not grow.
Problem check_removed(const Volume& before, const Volume& after, const sweep::Cut& cut);

/// The same spans, normals and offsets, tile by tile.
Problem check_same_bytes(const Volume& a, const Volume& b);

/// Whether the tool stays away from the stock for certain, by a ball about it.
bool out_of_reach(const Stage& stage, const Move& move);

/// How far an end of a span may be from the exact surface.
struct Allowed {
  double error;     ///< mm: the tolerance for moves that turn, what is left of hollow arcs, and rounding
  bool along_rays;  ///< whether it is meant along the ray, where that does not graze
};
Allowed allowed_error(const Stage& stage, const Move& move);

/// How the ends that a move made compare with the reference.
struct Comparison {
  long ends = 0, points = 0;
  double worst = 0;  ///< of error / allowed error, over all ends
  Problem problem;
};

/// Checks up to `rays` rays that the move changed, and some others: new ends are within the tolerance, along the ray
/// or, where the ray grazes, in space; and the middles of all spans and gaps, and random points, are on the right side.
Comparison compare_with_reference(Random& random, const Stage& stage, const Move& move, const Volume& before,
                                  const Volume& after, int rays);

}  // namespace riffler::stress
