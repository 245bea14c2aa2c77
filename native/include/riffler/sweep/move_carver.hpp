// One tool on one volume, move by move, as a pen makes them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::sweep {

/// Leaves of a volume, bit for bit, what `carve` would leave of each move by itself, and says the same of it. Where
/// moves stay as large, nothing is asked of the system after the first of them, as long as tiles that are replaced come
/// back (block_pool.hpp): a step of the pen has a deadline.
class MoveCarver {
 public:
  struct Options {
    double tolerance = 0.01;         ///< mm, as CarveOptions
    double removal_constant = 0.05;  ///< N·s/mm³
  };
  struct Taken {
    double removed = 0;        ///< mm³
    Vec3 force{0}, torque{0};  ///< N; N·mm about the tip at the end of the move: on the tool, against its motion
  };

  /// `volume` must outlive this and stay where it is. std::invalid_argument as `carve`.
  MoveCarver(Volume& volume, const Tool& tool, const Options& options);
  MoveCarver(const MoveCarver&) = delete;
  MoveCarver& operator=(const MoveCarver&) = delete;
  ~MoveCarver();

  /// Throws std::invalid_argument as `carve` does for poses or a `dt` (s) that make no move; then nothing was cut.
  Taken move(const Pose& from, const Pose& to, double dt);

  double pitch() const;

  /// A tile by the numbers of its grid and in it.
  struct Place {
    std::uint32_t grid, tile;
    friend bool operator==(const Place&, const Place&) = default;
  };
  /// What the last move replaced.
  std::span<const Place> replaced() const;

 private:
  struct Core;
  std::unique_ptr<Core> core_;
};

}  // namespace riffler::sweep
