// A tool for simulation: what cuts, what must not touch, and the extent of both.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"
#include "riffler/verify/report.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::verify {

/// A cylinder around some of a tool's pieces: heights on the axis and radius, mm.
struct Rod {
  double low = 0, high = 0, radius = 0;
  bool empty() const { return !(low < high); }
  void add(const Rod& other);
  /// Bounding box of its sweep between two poses; conservative. May leave out what stays above z = `top`.
  Box3 swept(const Pose& from, const Pose& to, double top) const;
};

/// A part of the tool that must not touch material.
struct Probe {
  Member member;
  std::vector<sweep::ConvexGroup> real;   ///< one group per piece: their union is the probe
  std::vector<sweep::ConvexGroup> small;  ///< the same, smaller by the tolerance on all sides: ignores mere touching
};

struct ToolShapes {
  /// `reach` (mm): length of the unknown part beyond the tool's description, one `pitch` (mm) wider than its widest
  /// piece.
  ToolShapes(const Tool& tool, double tolerance, double reach, double pitch);

  std::vector<sweep::ConvexGroup> cutter;
  std::vector<Probe> probes;              ///< shank, holder, beyond, if present
  std::vector<sweep::ConvexGroup> small;  ///< of all probes
  Rod cutter_rod, whole_rod;
  std::vector<Rod> probe_rods;  ///< one per piece of the probes
};

}  // namespace riffler::verify
