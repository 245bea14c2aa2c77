// Checks after every move of the stress run.
#pragma once

#include <string>

#include "riffler/sweep/carve.hpp"
#include "stress/scenario.hpp"

namespace riffler::stress {

/// Result of a check: a description of the fault, or empty.
using Problem = std::string;

/// Checks that spans are finite, not empty, in order, apart and inside the box, that the tile's reach covers them,
/// normals are unit vectors, and rays beyond the grid are empty. With `before`, every span must be within one of
/// `before`; tiles that both volumes share are skipped.
Problem check_spans(const Volume& volume, const Volume* before = nullptr);

/// Checks that the move removed as much as it reports, and that no grid grew.
Problem check_removed(const Volume& before, const Volume& after, const sweep::Cut& cut);

/// Checks that spans, normals and offsets are the same, tile by tile.
Problem check_same_bytes(const Volume& a, const Volume& b);

/// Whether the tool certainly stays away from the stock, from a ball around the tool.
bool out_of_reach(const Stage& stage, const Move& move);

/// Allowed distance of a span's end from the exact surface.
struct Allowed {
  double error;     ///< mm: the tolerance for moves that turn, the error of hollow arcs, and rounding
  bool along_rays;  ///< whether `error` is measured along the ray, unless the ray grazes
};
Allowed allowed_error(const Stage& stage, const Move& move);

/// Comparison of the ends that a move made with the reference.
struct Comparison {
  long ends = 0, points = 0, normals = 0;
  long off_normals = 0;                 ///< after straight moves, where the surface is smooth, by more than 1e-4 rad
  double worst = 0;                     ///< of error / allowed error, over all ends
  double worst_normal = 0, turned = 0;  ///< rad: largest error of a normal after a straight and a turning move
  Problem problem;
};

/// Checks up to `rays` rays that the move changed, and some others. New ends must be within the tolerance, measured
/// along the ray or, if the ray grazes, in space. The middles of all spans and gaps, and random points, must be on the
/// right side.
Comparison compare_with_reference(Random& random, const Stage& stage, const Move& move, const Volume& before,
                                  const Volume& after, int rays);

}  // namespace riffler::stress
