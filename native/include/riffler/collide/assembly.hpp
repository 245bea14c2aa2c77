// A tool made ready for contact.
#pragma once

#include <memory>
#include <vector>

#include "riffler/tool/outline.hpp"

namespace riffler::collide {

struct LaneEdge;
class OutlineRuns;

/// Prepare it once, use it for many poses, from any number of threads.
class Assembly {
 public:
  explicit Assembly(const Tool& tool);

  const Tool& tool() const { return tool_; }
  const tool::Outline& outline() const { return outline_; }
  /// Largest distance of any of its points from the tip, mm.
  double reach() const { return reach_; }

  /// Of all of it, mm: no point is deeper than this.
  double max_radius() const { return max_radius_; }
  /// Cutter, shank and holder by their heights: which is the widest there.
  struct HeightBand {
    double low, high;
    tool::Part part;
    double radius, bottom, top;  // where it is widest, and at both ends
  };
  const std::vector<HeightBand>& stretches() const { return stretches_; }
  tool::Part part_at(double z) const;
  /// Places on the axis and off it (radius, height) that are deeper than what is round them: at least one of every
  /// connected set of such. Found when first asked for.
  const std::vector<Vec2>& deepest() const;

  /// The outline in the forms that searches use.
  const OutlineRuns& runs() const;
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
