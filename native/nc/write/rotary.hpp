// From tool poses to the positions of a machine's axes: which of the two rotary branches, how many turns, and where
// limits force the tool out of the material, so that an axis can be turned back.
#pragma once

#include <optional>
#include <vector>

#include "nc/machine/machine.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::nc {

/// Where the axes stand at the end of a row, or on its way.
struct Waypoint {
  std::size_t row;
  double share;  ///< of the row's move; 1 at its end
  Joints joints;
  /// Not reached by the move: the waypoint before has the same pose with other joints, and the tool leaves the material
  /// in between.
  bool rewound = false;
};

/// Which rows may turn the rotary axes in whatever way: rapids whose both ends lie at `safe_height` or above it, if
/// that is given, else above the tip of every feed move, and rows with another tool than the row before: nobody knows
/// from where that one comes. Everywhere else the axes follow the great circle between two rows. Throws
/// std::invalid_argument naming the feed move that is not below `safe_height`.
std::vector<bool> free_moves(const Program& program, std::optional<double> safe_height = {});

/// One waypoint per row of the program, and more where the tool must leave. Of all choices of branches and turns within
/// the machine's limits those that leave the material least often, and of these the one with the shortest rotary path
/// over the whole program (dynamic programming over the places that the axes can have reached; Viterbi, IEEE Trans.
/// Inf. Theory 13, 1967). The tool leaves at the last row that it can reach; within a move only where no row would do.
/// The branch may change in free rapids and where a move passes the pole within axis_tolerance / 4, nowhere else: in
/// between the rotary axes can follow the great circle on one branch only. Before the first row that is away from the
/// pole, the free axis stands where that row has it. `free`: free_moves. Throws std::invalid_argument naming the row
/// that the machine cannot hold, and a move between opposite axes that is not free.
std::vector<Waypoint> choose_joints(const Program& program, const Machine& machine, double axis_tolerance,
                                    const std::vector<bool>& free);

}  // namespace riffler::nc
