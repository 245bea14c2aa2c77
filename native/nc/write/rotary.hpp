// From tool poses to positions of a machine's axes: chooses rotary branches and turns, and the places where limits
// force a retract to unwind an axis.
#pragma once

#include <optional>
#include <vector>

#include "nc/machine/machine.hpp"
#include "riffler/nc/program.hpp"

namespace riffler::nc {

/// Joints at the end of a row, or at a point before it.
struct Waypoint {
  std::size_t row;
  double share;  ///< fraction of the row's move; 1 at its end
  Joints joints;
  /// Whether the move does not reach these joints: the previous waypoint has the same pose with other joints, and the
  /// tool leaves the material in between.
  bool rewound = false;
};

/// Marks the rows that may turn the rotary axes arbitrarily: rapids with both ends at or above `safe_height` (mm;
/// default: above the tip of every feed move), and rows with a new tool, whose start is unknown. In all other rows the
/// axes follow the great circle between two rows. Throws std::invalid_argument naming a feed move that is not below
/// `safe_height`.
std::vector<bool> free_moves(const Program& program, std::optional<double> safe_height = {});

/// One waypoint per row of the program, and more where the tool must retract. Among all choices of branches and turns
/// within the machine's limits, takes those with the fewest retracts, and among these the shortest rotary path over the
/// whole program (dynamic programming over the reachable places; Viterbi, IEEE Trans. Inf. Theory 13, 1967). The tool
/// retracts at the last row that it can reach; within a move only if no row will do. The branch may change in free
/// rapids and where a move passes the pole within axis_tolerance / 4; elsewhere the rotary axes can follow the great
/// circle on one branch only. Before the first row away from the pole, the free axis takes its value from that row.
/// `free`: result of free_moves. Throws std::invalid_argument naming a row that the machine cannot hold, or a move
/// between opposite axes that is not free.
std::vector<Waypoint> choose_joints(const Program& program, const Machine& machine, double axis_tolerance,
                                    const std::vector<bool>& free);

}  // namespace riffler::nc
