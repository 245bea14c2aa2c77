// The drop cutter: a tool comes down along its axis until it first touches a part.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Over a mesh's triangles, seen along one axis. Exact to rounding for lines and arcs that bulge; a hollow arc is taken
/// as cones that fill at most Profile::kConcaveTolerance of it less than the whole (tool/profile.hpp).
/// Queries may run on several threads.
class DropCutter {
 public:
  struct Landing {
    bool touches = false;  ///< nothing lies below or above the tool otherwise
    double height = 0;     ///< of the tip along the axis, mm
    Vec3 point{0};         ///< of the part
    tool::Part part = tool::Part::Cutter;
  };
  struct Stats {
    std::size_t boxes = 0, triangles = 0;  ///< looked at
  };

  /// `axis`: unit, from tip to spindle. std::invalid_argument for an empty or invalid mesh.
  DropCutter(const Mesh& mesh, const Tool& tool, const Vec3& axis = {0, 0, 1});

  /// The tool whose tip is somewhere on the line through `p` along the axis.
  Landing operator()(const Vec3& p, Stats* stats = nullptr) const;
  /// All of them, in parallel.
  std::vector<Landing> operator()(const std::vector<Vec3>& points, const Progress& progress = {}) const;

  const Vec3& axis() const;

 private:
  struct Core;
  std::shared_ptr<const Core> core_;
};

}  // namespace riffler::plan
