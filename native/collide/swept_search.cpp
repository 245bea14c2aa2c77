#include "collide/swept_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collide/outline_lanes.hpp"
#include "geom/math.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::collide {

namespace {

constexpr std::size_t kLooksAReport = 64;
constexpr double kShortest = 1e-12;  // of the motion's duration: shorter intervals are not halved

}  // namespace

SweptSearch::SweptSearch(const Assembly& assembly, const Motion& motion, double wanted, std::size_t most)
    : assembly_(assembly), motion_(motion), wanted_(wanted), most_(most), search_(assembly.runs()) {
  out_.clearance = out_.bound = kInfinity;
  add_stretch(0, 1);
}

std::uint32_t SweptSearch::add_stretch(double from, double to) {
  const Drift drift(motion_, to - from, assembly_.reach());
  stretches_.push_back({from, to, ToolFrame(motion_.at(0.5 * (from + to))), drift, 0});
  return static_cast<std::uint32_t>(stretches_.size() - 1);
}

/// Entries that are far enough away are finished and only lower the bound.
void SweptSearch::push(const Entry& e) {
  if (e.low >= wanted_) {
    out_.bound = std::min(out_.bound, e.low);
    return;
  }
  heap_.push_back(e);
  std::push_heap(heap_.begin(), heap_.end());
}

/// Splits the interval of a group and evaluates the group again in each half; false if the interval is too short.
bool SweptSearch::halve(const Surface& surface, Entry e) {
  const MoveInterval& whole = stretches_[e.stretch];
  const double from = whole.from, to = whole.to, middle = 0.5 * (from + to);
  if (to - from < kShortest) return false;
  if (whole.half == 0) {
    const std::uint32_t first = add_stretch(from, middle);
    add_stretch(middle, to);
    stretches_[e.stretch].half = first;
  }
  const std::uint32_t first = stretches_[e.stretch].half;
  for (const std::uint32_t half : {first, first + 1}) {
    Entry next = e;
    next.stretch = half, next.drifts = 0.5 * e.drifts;
    if (e.kind == Entry::Group) look_again(surface, next);
    push(next);
  }
  return true;
}

void SweptSearch::look_again(const Surface& surface, Entry& e) {
  const auto [above, k] = surface.tree().parent(e.index);
  const SphereGroup& siblings = surface.tree().group(above);
  const MoveInterval& s = stretches_[e.stretch];
  double distance[base::kLanes];
  centre_distances(assembly_.lane_edges(), s.frame, siblings, distance);
  ++out_.evaluations;
  e.distance = distance[k];
  e.drifts = s.drift.nearer(glm::length(siblings.sphere(k).centre - s.frame.tip) + e.radius);
  e.low = std::max(e.low, e.distance - e.radius - e.drifts);
}

/// Whether to split time rather than space: the one that leaves more open. A group that is too near anyway contains a
/// triangle that is, and in short intervals tangent planes give better bounds than spheres.
bool SweptSearch::is_better_halved(const Entry& e) const {
  constexpr double kShort = 0.05;  // times the cutter's diameter
  return e.kind == Entry::Group && e.drifts > std::max(e.radius, kShort * assembly_.tool().diameter()) &&
         e.distance + e.radius >= wanted_;
}

void SweptSearch::attained(const Entry& e) {
  const TriangleSearch::Least& least = search_.least();
  if (!(least.distance < out_.clearance)) return;
  const MoveInterval& s = stretches_[e.stretch];
  out_.clearance = least.distance, out_.at = 0.5 * (s.from + s.to);
  out_.touch = e.surface > 0 ? Touch::Fixture : static_cast<Touch>(least.part);
}

void SweptSearch::open(const Surface& surface, const Entry& e) {
  const SphereTree& tree = surface.tree();
  const SphereGroup& spheres = tree.group(e.index);
  const MoveInterval& s = stretches_[e.stretch];
  double distance[base::kLanes], low[base::kLanes];
  centre_distances(assembly_.lane_edges(), s.frame, spheres, distance);
  const bool items = tree.holds_items(e.index);
  const std::size_t first = items ? tree.first_item(e.index) : tree.first_child(e.index);
  if (items)
    triangle_bounds(assembly_.runs(), assembly_.lane_edges(), s.frame, spheres, &surface.corners(first), &s.drift,
                    distance, low);
  for (int k = 0; k < base::kLanes; ++k) {
    const double radius = spheres.radius[k];
    if (radius < 0) continue;
    const double drifts = s.drift.nearer(glm::length(spheres.sphere(k).centre - s.frame.tip) + radius);
    if (!items) low[k] = distance[k] - radius - drifts;
    push({std::max(low[k], e.low), radius, drifts, distance[k],
          static_cast<std::uint32_t>(first + static_cast<std::size_t>(k)), e.stretch, e.surface,
          items ? Entry::Triangle : Entry::Group});
  }
}

void SweptSearch::test(const Surface& surface, const Entry& e) {
  const MoveInterval& s = stretches_[e.stretch];
  const Corners& c = surface.corners(e.index);
  const Corners t{s.frame.to_tool(c.a), s.frame.to_tool(c.b), s.frame.to_tool(c.c)};
  search_.forget();
  Entry next = e;
  next.low = std::max(e.low, search_.bound(t, s.drift.in(s.frame)));
  attained(e);
  if (out_.clearance < wanted_ || next.low >= wanted_) return push(next);
  // The clearance reached is the smallest one, or nearly: the drift of the whole tool may now be small enough.
  if (search_.least().distance - e.drifts >= wanted_) {
    Deadline none;
    search_.search(t, -kInfinity, none);
    attained(e);
    next.low = std::max(next.low, search_.low() - e.drifts);
    if (out_.clearance < wanted_ || next.low >= wanted_) return push(next);
  }
  if (!halve(surface, next)) out_.bound = std::min(out_.bound, next.low);  // only rounding is left
}

Swept SweptSearch::operator()(std::span<const Surface* const> surfaces) {
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    push({-kInfinity, kInfinity, 0, 0, 0, 0, static_cast<std::uint16_t>(i), Entry::Group});
  while (!heap_.empty() && !(out_.clearance < wanted_) && out_.evaluations < most_) {
    std::pop_heap(heap_.begin(), heap_.end());
    const Entry e = heap_.back();
    heap_.pop_back();
    const Surface& surface = *surfaces[e.surface];
    if (is_better_halved(e) && halve(surface, e)) continue;
    if (++out_.evaluations % kLooksAReport == 0) base::still_wanted();
    e.kind == Entry::Group ? open(surface, e) : test(surface, e);
  }
  if (!heap_.empty()) out_.bound = std::min(out_.bound, heap_.front().low);
  out_.bound = std::min(out_.bound, out_.clearance);
  out_.answer = out_.clearance < wanted_ ? Swept::Answer::Gouges
                : heap_.empty()          ? Swept::Answer::Clear
                                         : Swept::Answer::Unknown;
  return out_;
}

}  // namespace riffler::collide
