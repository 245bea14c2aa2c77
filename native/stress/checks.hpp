// Checks after every move of the stress run.
#pragma once

#include <cmath>
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

/// Allowed error of a span's end and of its normal.
struct Allowed {
  double error;     ///< mm from the exact surface: the tolerance for moves that turn, that of hollow arcs, and rounding
  bool along_rays;  ///< whether `error` is measured along the ray, unless the ray grazes
  double hollow;    ///< mm: the part of it for hollow arcs
  /// Whether normals have no bound: after moves that turn, because an end may be anywhere within the tolerance, and
  /// where hollow arcs are less than a hundred times larger than `hollow`.
  bool any_normal;
  /// rad, of a normal where the surface is smooth and has this radius of curvature. A hollow arc is cut as cones along
  /// tangents, `hollow` away from it where two of them meet: acos(r / (r + hollow)) off.
  double normal(double radius) const { return 1e-4 + std::acos(radius / (radius + hollow)); }
};
Allowed allowed_error(const Stage& stage, const Move& move);

/// Comparison of the ends that a move made with the reference.
struct Comparison {
  long ends = 0, points = 0, normals = 0;
  double worst = 0;                     ///< of error / allowed error, over all ends
  double worst_normal = 0, turned = 0;  ///< rad: largest error of normals with a bound, and of others
  Problem problem;
};

/// Checks up to `rays` rays that the move changed, and some others. New ends must be within the tolerance, measured
/// along the ray or, if the ray grazes, in space. The middles of all spans and gaps, and random points, must be on the
/// right side. Normals of new ends must be as exact as Allowed says; those of moves that turn are only measured.
Comparison compare_with_reference(Random& random, const Stage& stage, const Move& move, const Volume& before,
                                  const Volume& after, int rays);

}  // namespace riffler::stress
