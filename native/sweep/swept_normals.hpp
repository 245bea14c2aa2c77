// Normals of the swept volume of a convex part of a tool, many ends of rays at a time.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "riffler/base/block_pool.hpp"
#include "riffler/dexel/span.hpp"
#include "sweep/steps.hpp"

namespace riffler::sweep {

/// A step as plain numbers for the kernel, in the cyclic frame of a grid.
struct SweptSurface {
  SweptSurface(const Step& step, Axis grid);

  std::size_t count;
  std::array<PieceShape, ConvexGroup::kMax> pieces;
  double tip[3], way[3], spin[3];  ///< the tip at t = 0, its displacement until t = 1, and the rotation vector
  double axis[3], side[3];         ///< axis(t) = cos θ axis + sin θ side, θ = angle (t − middle)
  double angle, middle;
  bool wide;  ///< θ is too large for the kernel's series: it gets the axes
  int world;  ///< component i of a world vector is component (i + world) mod 3 of a vector of the frame
};

/// Ends of rays that arise in one step, at heights s and times t. All arrays have a multiple of kLanes elements.
struct SweptEnds {
  base::BlockVector<double> u, v, s, t;
  base::BlockVector<double> axis[3];  ///< of a wide step; otherwise empty
  base::BlockVector<double> map[2];   ///< result: octahedral map of the normals, −1 … 1 (span.hpp)

  std::size_t count = 0;
  void reserve(std::size_t ends);
  void clear();
  void add(double u_at, double v_at, double s_at, double t_at);
  /// Fills the last group of lanes, and the axes if the step of `motion` is wide. At least one end must be there.
  void complete(const SweptSurface& surface, const Motion& motion);
};

}  // namespace riffler::sweep
