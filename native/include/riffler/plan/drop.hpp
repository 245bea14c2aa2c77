// Drop cutter: lowers a tool along its axis until it first touches a part.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Drop cutter over a mesh's triangles along one axis. Exact to rounding for line segments and convex arcs; a concave
/// arc is replaced by cones that lie at most Profile::kConcaveTolerance inside it (tool/profile.hpp). Queries may run
/// on several threads.
class DropCutter {
 public:
  /// Where the tool comes to rest.
  struct Landing {
    bool touches = false;  ///< false: no part of the mesh lies in line with the tool
    double height = 0;     ///< height of the tip along the axis, mm
    Vec3 point{0};         ///< contact point on the part, mm
    tool::Part part = tool::Part::Cutter;
    int triangle = -1;                    ///< index of the mesh's triangle on which the tool rests
    std::size_t piece = 0, position = 0;  ///< for `height_on`: the tool's piece and the triangle's position in the tree
  };
  /// How far the drop surface rises above a straight move.
  struct Rise {
    double above;   ///< mm; the value asked for if it rises by no more
    double at = 0;  ///< the share of the move at which it does
  };
  /// Operation counts.
  struct Stats {
    std::size_t boxes = 0, triangles = 0;  ///< tested
  };

  /// `axis`: unit vector from tip to spindle. `margin`: mm by which all of the tool keeps away from the mesh; heights
  /// are those of the tool's own tip. Throws std::invalid_argument for an empty or invalid mesh or a negative margin.
  DropCutter(const Mesh& mesh, const Tool& tool, const Vec3& axis = {0, 0, 1}, double margin = 0);

  /// Lowers the tool along the line through `p` (mm) parallel to the axis.
  Landing operator()(const Vec3& p, Stats* stats = nullptr) const;
  /// Whether the tool comes to rest above `height` (mm) there. Quicker, because it examines only triangles that reach
  /// that high.
  bool stops_above(const Vec3& p, double height) const;
  /// Lowers the tool at many points, in parallel.
  std::vector<Landing> operator()(const std::vector<Vec3>& points, const Progress& progress = {}) const;

  /// The height at which the landing's piece of the tool stops at the landing's triangle alone when it comes down
  /// along the line through `p`; −∞ out of its reach. A concave function of `p`, and nowhere above the drop surface.
  double height_on(const Landing& landing, const Vec3& p) const;
  /// Largest height of the drop surface above the straight move of the tip from `from` to `to`, if it is more than
  /// `enough` (mm). A bound, not sampled: above one triangle the drop surface of one convex piece is concave, so
  /// secants bound it, and boxes of the tree bound groups of triangles.
  Rise rise(const Vec3& from, const Vec3& to, double enough) const;

  /// The axis passed to the constructor.
  const Vec3& axis() const;

 private:
  friend struct RiseSearch;
  struct Core;
  std::shared_ptr<const Core> core_;
};

}  // namespace riffler::plan
