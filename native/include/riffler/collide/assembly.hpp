// Assembly: a tool with the data that contact queries need.
#pragma once

#include <memory>
#include <vector>

#include "riffler/tool/outline.hpp"

namespace riffler::collide {

struct LaneEdge;
class OutlineRuns;

/// A tool prepared for collision queries. Build it once and query it at many poses, from any number of threads.
class Assembly {
 public:
  explicit Assembly(const Tool& tool);

  const Tool& tool() const { return tool_; }
  const tool::Outline& outline() const { return outline_; }
  /// Largest distance from the tip to any point of the tool, mm.
  double reach() const { return reach_; }

  /// Largest radius of the tool, mm: no point can lie deeper inside it than this.
  double max_radius() const { return max_radius_; }
  /// Cutter, shank and holder as height bands: each band names the part with the largest radius there.
  struct HeightBand {
    double low, high;
    tool::Part part;
    double radius, bottom, top;  // mm: largest radius in the band, and the radii at its two ends
  };
  /// Height bands from the tip upward, heights in mm along the axis.
  const std::vector<HeightBand>& stretches() const { return stretches_; }
  /// The part with the largest radius at height `z` (mm along the axis from the tip).
  tool::Part part_at(double z) const;
  /// Local maxima of the depth inside the tool, as (radius, height) in mm: at least one point of every connected set of
  /// maxima. Computed on the first call.
  const std::vector<Vec2>& deepest() const;

  /// The outline in the forms that the searches use.
  const OutlineRuns& runs() const;
  /// The outline's edges with precomputed data for vector lanes.
  const std::vector<LaneEdge>& lane_edges() const;

 private:
  Tool tool_;
  tool::Outline outline_;
  struct Forms;
  std::shared_ptr<const Forms> forms_;
  std::vector<HeightBand> stretches_;
  double reach_, max_radius_;
  struct Deepest;
  std::shared_ptr<Deepest> deepest_;
};

}  // namespace riffler::collide
