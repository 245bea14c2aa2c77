#include "verify/shapes.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "sweep/body_groups.hpp"

namespace riffler::verify {

namespace {

Rod rod_round(const tool::Piece& piece) {
  return {bottom(piece), top(piece), max_radius(piece)};
}

Probe probe_of(Member member, const std::vector<tool::Frustum>& pieces, double tolerance) {
  return {member, sweep::body_groups(pieces, 0), sweep::body_groups(pieces, tolerance)};
}

}  // namespace

void Rod::add(const Rod& other) {
  if (empty()) {
    *this = other;
    return;
  }
  low = std::min(low, other.low), high = std::max(high, other.high), radius = std::max(radius, other.radius);
}

Box3 Rod::swept(const Pose& from, const Pose& to, double top) const {
  Box3 box;
  double end = high;
  // The z of the axis is a concave function of time while positive, so it never falls below the smaller of its ends;
  // nor does that of the tip.
  if (const double rise = std::min(from.axis.z, to.axis.z); rise > 0) {
    const double least = std::min(from.tip.z, to.tip.z);
    end = std::min(high, (top - least + radius) / rise);
    if (end < low) return box;
  }
  for (const Pose* pose : {&from, &to}) {
    const Vec3& o = pose->axis;
    const Vec3 disc(std::sqrt(std::max(0.0, 1 - o.x * o.x)), std::sqrt(std::max(0.0, 1 - o.y * o.y)),
                    std::sqrt(std::max(0.0, 1 - o.z * o.z)));
    for (const double z : {low, end}) {
      const Vec3 centre = pose->tip + z * o;
      box.add({centre - radius * disc, centre + radius * disc});
    }
  }
  // Every point of the tool stays within lever φ² / 8 of the straight line between its two places, because its
  // acceleration relative to the tip is at most lever φ².
  const double chord = glm::length(to.axis - from.axis);
  const double angle = 2 * base::asin(std::min(1.0, chord / 2)),
               lever = geom::hypot(std::max(std::abs(low), std::abs(end)), radius);
  return box.grown(lever * angle * angle / 8 + 1e-9 * (1 + lever));
}

ToolShapes::ToolShapes(const Tool& tool, double tolerance, double reach, double pitch)
    : cutter(sweep::convex_groups(tool.cutter())) {
  for (const tool::Piece& piece : tool.cutter()) cutter_rod.add(rod_round(piece));
  if (!tool.shank().empty()) probes.push_back(probe_of(Member::Shank, tool.shank(), tolerance));
  if (!tool.holder().empty()) probes.push_back(probe_of(Member::Holder, tool.holder(), tolerance));
  whole_rod = cutter_rod;
  for (const std::vector<tool::Frustum>* pieces : {&tool.shank(), &tool.holder()})
    for (const tool::Frustum& f : *pieces) probe_rods.push_back(rod_round(f)), whole_rod.add(rod_round(f));
  // Wider by a pitch: there is also a wall next to what the cutter has just cut, and it is unknown what would pass it.
  const tool::Frustum beyond{whole_rod.high, whole_rod.radius + pitch, whole_rod.high + reach,
                             whole_rod.radius + pitch};
  probes.push_back(probe_of(Member::Beyond, {beyond}, tolerance));
  probe_rods.push_back(rod_round(beyond)), whole_rod.add(rod_round(beyond));
  for (const Probe& probe : probes) small.insert(small.end(), probe.small.begin(), probe.small.end());
}

}  // namespace riffler::verify
