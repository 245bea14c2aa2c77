// Pencil paths: the curves along which a ball touches a part at two places at once without entering it.
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

/// Options of pencil.
struct PencilOptions {
  double tolerance = 0.01;  ///< mm; of the curves; a valley with a smaller gap under the ball counts as faceting
  /// Smallest angle (rad) between the directions to the two contacts; default: the angle of a gap of `tolerance`.
  std::optional<double> bitangency_angle = {};
  double minimum_length = 0;  ///< mm; shorter paths are dropped
  /// mm. Also machine what a ball larger in radius by this amount leaves: where the ball has no valley of its own, the
  /// valleys of the larger ball are followed with the ball laid into them. Blends of the ball's radius and larger then
  /// count.
  double overthickness = 0;
  /// Curves per valley: 1 is the valley alone, each further pass adds one curve on either side.
  int passes = 1;
  std::optional<double> stepover = {};  ///< mm between passes; default: scallops of height `tolerance`
};

/// Counts of what the search did and how it ended.
struct PencilStats {
  std::size_t balls = 0;     ///< tangent balls tested against the part
  std::size_t entered = 0;   ///< of these: the ball enters the part, so the place is out of reach
  std::size_t starts = 0;    ///< of these: moved into a valley as a start
  std::size_t stuck = 0;     ///< starts without a valid place for the ball
  std::size_t faceting = 0;  ///< starts with a gap within the tolerance or too small an angle
  std::size_t edges = 0;     ///< starts where the ball rests on sharp or open edges
  std::size_t traces = 0;    ///< valleys traced, including duplicates
  std::size_t steps = 0;     ///< ball positions computed while tracing
  std::size_t cut = 0;       ///< path ends cut off at the step limit
};

/// The paths found, and the area that the ball cannot reach.
struct PencilResult {
  std::vector<PencilPath> paths;
  /// How each path begins and ends: "loop", "corner", "part", "faded" or "cut"; "joined" where another path continues;
  /// "pass" for the passes at the sides of a valley.
  std::vector<std::array<const char*, 2>> ends;
  double rest_area = 0;            ///< area that the ball cannot reach, mm²
  std::vector<double> rest_areas;  ///< mm² per triangle
  /// The same for the ball enlarged by the overthickness: the area to be machined. Without overthickness equal to the
  /// two above.
  double reference_area = 0;
  std::vector<double> reference_areas;
  PencilStats stats;
  std::string reason;  ///< why there are no paths; empty if there are some
};

/// The angle (rad) between the directions to the two contacts at which a ball of `radius` (mm) leaves `gap` (mm) to the
/// bottom of a valley between two planes: 2 acos(R / (R + gap)), the inverse of R (1 / cos(angle / 2) − 1).
double bitangency_angle_of_gap(double radius, double gap);

/// Radius (mm) of the ball at the tool's tip: the ball that rolls. Throws std::invalid_argument naming the argument
/// `name` and the cutters that qualify, for a flat end, a bull nose or any other tip: such a cutter touches the sides
/// of a valley at other places than a ball of its diameter.
double tip_ball_radius(const Tool& tool, std::string_view name);

/// All valleys of `part` for a ball of `radius` (mm). Paths end at the part's border or at three-contact points, each
/// valley once; an open path begins at its end with the smaller x, then y, then z, and a loop runs counter-clockwise,
/// seen along the axis from which it is widest: the mesh's order of triangles does not decide. With an overthickness,
/// balls of radii between the two are tried as well where the larger ball leaves blends, so that paths in a blend
/// extend towards its corners. Throws std::invalid_argument for an empty or invalid mesh and for sizes that are not
/// positive and finite.
PencilResult pencil(const Mesh& part, double radius, const PencilOptions& options = {}, const Progress& progress = {});

}  // namespace riffler::plan
