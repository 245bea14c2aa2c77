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
  };
  /// Operation counts.
  struct Stats {
    std::size_t boxes = 0, triangles = 0;  ///< tested
  };

  /// `axis`: unit vector from tip to spindle. Throws std::invalid_argument for an empty or invalid mesh.
  DropCutter(const Mesh& mesh, const Tool& tool, const Vec3& axis = {0, 0, 1});

  /// Lowers the tool along the line through `p` (mm) parallel to the axis.
  Landing operator()(const Vec3& p, Stats* stats = nullptr) const;
  /// As above for many points, in parallel.
  std::vector<Landing> operator()(const std::vector<Vec3>& points, const Progress& progress = {}) const;

  /// The axis passed to the constructor.
  const Vec3& axis() const;

 private:
  struct Core;
  std::shared_ptr<const Core> core_;
};

}  // namespace riffler::plan
