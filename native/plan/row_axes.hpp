// Tool axes along lines of ball centres, by a rule.
#pragma once

#include <vector>

#include "mesh/closest.hpp"
#include "riffler/base/progress.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/plan/axis_rule.hpp"
#include "riffler/plan/cut_along.hpp"

namespace riffler::plan {

/// Gives lines of ball centres their axes. At each place the axis follows the rule, is moved into the cone of
/// `max_tilt` about the set-up's axis, averaged over one radius of the ball along the line, and then limited to
/// `max_turn` by going along the line in both directions. A ball's cut does not depend on its axis: the centres stay
/// where they are.
class RowAxes {
 public:
  /// `part` in the frame of the lines; `up`: the set-up's axis; `distance`: see CutAlongOptions. Keeps references to
  /// `rule`, `tool` and `collider`. Throws std::invalid_argument for a tool without a ball at its tip.
  RowAxes(const AxisRule& rule, const Mesh& part, const Vec3& up, const collide::Assembly& tool,
          const collide::Collider& collider, double distance, double tolerance);

  /// Poses along the line through `centres`, with points between them where the axis turns, so that the ball's centre
  /// leaves the line by at most a quarter of the tolerance. `kinds`: of the move to each centre.
  CutLine operator()(const std::vector<Vec3>& centres, const std::vector<MoveKind>& kinds,
                     const Progress& progress = {}) const;

 private:
  struct Line;
  Line divided(const std::vector<Vec3>& centres, const std::vector<MoveKind>& kinds) const;
  void by_rule(Line& line, const Progress& progress) const;
  void of_least_tilt(Line& line, const Progress& progress) const;
  void tilt_run(Line& line, double from, double to) const;
  Vec3 target_near(const Vec3& p) const;
  Vec3 in_cone(const Vec3& axis) const;
  void average(Line& line) const;
  void limit(Line& line) const;
  CutLine poses(const Line& line) const;

  const AxisRule& rule_;
  mesh::Closest part_;
  Vec3 up_;
  const collide::Assembly& tool_;
  collide::Assembly roomy_;  // with wider shank and holder
  const collide::Collider& collider_;
  double distance_, tolerance_, radius_, step_;
};

/// Radius (mm) of the ball at a tool's tip. Throws std::invalid_argument if there is none.
double ball_for_rows(const Tool& tool);

}  // namespace riffler::plan
