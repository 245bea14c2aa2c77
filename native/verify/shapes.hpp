// A tool as the simulation sees it: what cuts, what must not touch, and how far all of it reaches.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"
#include "riffler/verify/report.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::verify {

/// A cylinder round some of a tool's pieces: heights on the axis and radius, mm.
struct Rod {
  double low = 0, high = 0, radius = 0;
  bool empty() const { return !(low < high); }
  void add(const Rod& other);
  /// Box of what it sweeps between two poses; never too small. What stays above z = `top` may be left out.
  Box3 swept(const Pose& from, const Pose& to, double top) const;
};

/// What must not touch material.
struct Probe {
  Member member;
  std::vector<sweep::ConvexGroup> real;   ///< each piece by itself: their union is the probe
  std::vector<sweep::ConvexGroup> small;  ///< the same, smaller by the tolerance on all sides: a touch is none yet
};

struct ToolShapes {
  /// `reach` (mm): beyond its description the tool is taken to go on so far, a pitch wider than the widest of it.
  ToolShapes(const Tool& tool, double tolerance, double reach, double pitch);

  std::vector<sweep::ConvexGroup> cutter;
  std::vector<Probe> probes;              ///< shank, holder, beyond: those that there are
  std::vector<sweep::ConvexGroup> small;  ///< of all probes
  Rod cutter_rod, whole_rod;
  std::vector<Rod> probe_rods;  ///< of every piece of the probes
};

}  // namespace riffler::verify
