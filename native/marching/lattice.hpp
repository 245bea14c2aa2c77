// The lattice spanned by a volume's rays, and the float32 coordinates that its mesh may use.
#pragma once

#include <array>
#include <cstdint>

#include "riffler/dexel/volume.hpp"

namespace riffler::marching {

/// Lattice points (I, J, K) with one layer outside the volume on every side: 0 ≤ I ≤ count(0) + 1, and so on; I − 1 is
/// the index of a ray. Cell (I, J, K) is the cube between the points (I, J, K) and (I + 1, J + 1, K + 1). The axes are
/// those of the world for a tri-dexel volume, and the cyclic frame of the rays otherwise.
class Lattice {
 public:
  /// Throws std::invalid_argument if the box reaches 2²¹ pitches or more from the origin.
  explicit Lattice(const Volume& volume);

  /// The direction whose cyclic frame the lattice uses.
  Axis axis() const { return axis_; }
  /// Number of rays along each axis, without the outer layers.
  int rays(int axis) const { return rays_[axis]; }
  int points(int axis) const { return rays_[axis] + 2; }
  int cells(int axis) const { return rays_[axis] + 1; }
  double pitch() const { return pitch_; }
  /// Contains the whole surface: the volume's box, enlarged by half a pitch across the rays of one direction.
  const Box3& box() const { return box_; }
  /// Coordinate of lattice plane `index`, mm. For planes with rays it is bit-identical to Grid::u and Grid::v.
  double at(int axis, int index) const { return origin_[axis] + (index - 0.5) * pitch_; }
  /// The spacing u of float32 values at the lattice's largest coordinate, a power of two: every multiple of u that a
  /// vertex may take is a float32. At most a quarter of the pitch (plus up to 1e-6 of it).
  double step() const { return step_; }

 private:
  Axis axis_;
  std::array<int, 3> rays_;
  std::array<double, 3> origin_;
  Box3 box_;
  double pitch_, step_;
};

}  // namespace riffler::marching
