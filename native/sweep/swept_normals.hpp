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
  double tip[3], way[3], spin[3];  ///< at time t the tip is at tip + t way; a point p moves with way + spin × (p − tip)
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
  void clear();
  void add(double u_at, double v_at, double s_at, double t_at);
};

/// Computes the normals out of the material, which face the tool. Ends may be inaccurate by a tolerance. `ends` is
/// padded for the kernel.
void swept_normals(const SweptSurface& surface, const Motion& motion, SweptEnds& ends);

}  // namespace riffler::sweep
