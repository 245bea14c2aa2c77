// Pencil cuts: the curves along which a ball touches a part at two places at once and enters it nowhere.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/plan/path.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

struct PencilOptions {
  double tolerance = 0.01;  ///< mm; of the curves, and the gap at a valley's bottom below which it is faceting
  /// Least angle (rad) between the directions to both contacts; without it that of the gap.
  std::optional<double> bitangency_angle = {};
  double minimum_length = 0;  ///< mm; shorter paths are dropped
  /// mm. Adds what a ball whose radius is larger by that much leaves behind: the valleys of that ball, with the ball
  /// itself laid into them, where the ball has no valley of its own. So blends of its own radius and larger count.
  double overthickness = 0;
  /// Curves at each valley and side: 1 is the valley alone, each more adds one pass on either side of it.
  int passes = 1;
  std::optional<double> stepover = {};  ///< mm between passes; without it what leaves ridges of the tolerance
};

/// What was done, and what became of it.
struct PencilStats {
  std::size_t balls = 0;     ///< tried against the part, tangent to it
  std::size_t entered = 0;   ///< of these: there the ball cannot reach
  std::size_t starts = 0;    ///< of these: pressed into a valley
  std::size_t stuck = 0;     ///< starts from which no room was found for the ball
  std::size_t faceting = 0;  ///< starts where the gap is within the tolerance, or the angle too small
  std::size_t edges = 0;     ///< starts where the ball rests on sharp or open edges
  std::size_t traces = 0;    ///< valleys followed, those found twice among them
  std::size_t steps = 0;     ///< balls set while following
  std::size_t cut = 0;       ///< ends of paths that were cut off because they would not end
};

struct PencilResult {
  std::vector<PencilPath> paths;
  /// How each path begins and ends: "loop", "corner", "part", "faded" or "cut"; "joined" where another path continues;
  /// "pass" for passes beside a valley, which follow it.
  std::vector<std::array<const char*, 2>> ends;
  double rest_area = 0;            ///< mm² that the ball cannot reach
  std::vector<double> rest_areas;  ///< of each triangle
  /// The same for the ball that is larger by the overthickness: what is there to be machined. Without one they are
  /// those above.
  double reference_area = 0;
  std::vector<double> reference_areas;
  PencilStats stats;
  std::string reason;  ///< why there are no paths; empty where there are some
};

/// The angle (rad) between the directions to both contacts at which the ball's gap to the bottom of a valley of two
/// planes is `gap`: R (1 / cos(angle / 2) - 1).
double bitangency_angle_of_gap(double radius, double gap);

/// Radius (mm) of the ball at the tool's tip, which is what rolls. std::invalid_argument naming the argument `name` and
/// the cutters that have one, for a flat end, a bull nose and whatever else has none: such a cutter touches a valley's
/// two sides elsewhere than a ball of its diameter does.
double tip_ball_radius(const Tool& tool, std::string_view name);

/// All valleys of `part` for a ball of `radius` (mm). Paths run to the part's end or to three-contact points, each
/// valley once. With an overthickness, balls between the two radii are tried as well where the larger one leaves
/// blends, so that paths in a blend run on towards its corners. std::invalid_argument for an empty or invalid mesh and
/// for sizes that are not positive and finite.
PencilResult pencil(const Mesh& part, double radius, const PencilOptions& options = {}, const Progress& progress = {});

}  // namespace riffler::plan
