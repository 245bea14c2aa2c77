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

/// Spheres about places of triangles that contain the triangles.
SphereGroup spheres_about(const LanePlaces& places, const Vec3& tip, const Corners* triangles) {
  SphereGroup out;
  for (int k = 0; k < base::kLanes; ++k) {
    const Vec3 at = tip + Vec3(places.x[k], places.y[k], places.z[k]);
    const Corners& c = triangles[k];
    const double radius = std::max({glm::length(c.a - at), glm::length(c.b - at), glm::length(c.c - at)});
    out.put(k, {at, radius * (1 + 1e-14) + 1e-15 * (std::abs(at.x) + std::abs(at.y) + std::abs(at.z))});
  }
  return out;
}

/// Halves a triangle across its longest sides into as many pieces as there are lanes.
void divide(const Corners& triangle, Corners* pieces) {
  pieces[0] = triangle;
  for (int n = 1; n < base::kLanes; n *= 2)
    for (int k = 0; k < n; ++k) {
      const Corners t = pieces[k];
      const double ab = glm::length(t.b - t.a), bc = glm::length(t.c - t.b), ca = glm::length(t.a - t.c);
      const bool first = ab >= bc && ab >= ca;
      const auto& [p, q, r] = first ? t : bc >= ca ? Corners{t.b, t.c, t.a} : Corners{t.c, t.a, t.b};
      const Vec3 middle = 0.5 * (p + q);
      pieces[k] = {p, middle, r}, pieces[n + k] = {middle, q, r};
    }
}

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
  double low[base::kLanes], high[base::kLanes];
  box_bounds(assembly_.runs(), assembly_.lane_edges(), s.frame, surface.boxes(above), &s.drift, low, high);
  ++out_.evaluations;
  e.drifts = s.drift.nearer(glm::length(siblings.sphere(k).centre - s.frame.tip) + e.radius);
  e.high = high[k], e.low = std::max(e.low, low[k]);
}

/// Whether to split time rather than space: the one that leaves more open. A group that is too near anyway contains a
/// triangle that is, and in short intervals tangent planes give better bounds than spheres.
bool SweptSearch::is_better_halved(const Entry& e) const {
  constexpr double kShort = 0.05;  // times the cutter's diameter
  return e.kind == Entry::Group && e.drifts > std::max(e.radius, kShort * assembly_.tool().diameter()) &&
         e.high >= wanted_;
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
  if (tree.holds_items(e.index)) return open_leaf(surface, e);
  const SphereGroup& spheres = tree.group(e.index);
  const MoveInterval& s = stretches_[e.stretch];
  double low[base::kLanes], high[base::kLanes];
  box_bounds(assembly_.runs(), assembly_.lane_edges(), s.frame, surface.boxes(e.index), &s.drift, low, high);
  for (int k = 0; k < base::kLanes; ++k) {
    const double radius = spheres.radius[k];
    if (radius < 0) continue;
    const double drifts = s.drift.nearer(glm::length(spheres.sphere(k).centre - s.frame.tip) + radius);
    push({std::max(low[k], e.low), radius, drifts, high[k],
          static_cast<std::uint32_t>(tree.first_child(e.index) + static_cast<std::size_t>(k)), e.stretch, e.surface, 0,
          Entry::Group});
  }
}

/// The lowest places of triangles at the middle of the interval, and bounds over the interval from the planes there.
/// `enough` (mm): lower bounds above it need not be the best.
void SweptSearch::look_closely(const MoveInterval& s, const Corners* triangles, double enough, LanePlaces& places,
                               double* low) {
  const std::vector<LaneEdge>& outline = assembly_.lane_edges();
  std::fill_n(places.low, base::kLanes, -kInfinity);
  lowest_places(assembly_.runs(), outline, s.frame, triangles, enough, TriangleSearch::slack(0), places);
  const SphereGroup about = spheres_about(places, s.frame.tip, triangles);
  double distance[base::kLanes];
  centre_distances(outline, s.frame, about, distance);
  triangle_bounds(assembly_.runs(), outline, s.frame, about, triangles, &s.drift, distance, low);
}

/// Takes note of the lowest of some places.
void SweptSearch::visit(const Entry& e, const LanePlaces& places, unsigned some) {
  int lowest = -1;
  for (int k = 0; k < base::kLanes; ++k)
    if ((some >> k & 1U) && (lowest < 0 || places.distance[k] < places.distance[lowest])) lowest = k;
  if (!(places.distance[lowest] < out_.clearance)) return;
  search_.forget();
  search_.visit(stretches_[e.stretch].frame.seen(Vec3(places.x[lowest], places.y[lowest], places.z[lowest])));
  attained(e);
}

/// Dismisses triangles of a group; what is open then and clear at the middle of the interval is left to shorter
/// intervals, and what is not shown to be clear even there to `test`.
void SweptSearch::open_leaf(const Surface& surface, const Entry& e) {
  const SphereTree& tree = surface.tree();
  const SphereGroup& spheres = tree.group(e.index);
  const MoveInterval& s = stretches_[e.stretch];
  const std::size_t first = tree.first_item(e.index);
  const Corners* corners = &surface.corners(first);
  LanePlaces places;
  double low[base::kLanes], by_planes[base::kLanes], drifts[base::kLanes];
  unsigned open = e.open;
  for (int k = 0; k < base::kLanes && e.kind == Entry::Group; ++k) open |= spheres.radius[k] >= 0 ? 1U << k : 0;
  const auto is_open = [&](int k) { return (open >> k & 1U) != 0; };
  const auto dismiss = [&] {
    for (int k = 0; k < base::kLanes; ++k)
      if (is_open(k) && (low[k] = std::max(low[k], e.low)) >= wanted_)
        out_.bound = std::min(out_.bound, low[k]), open &= ~(1U << k);
  };
  centre_distances(assembly_.lane_edges(), s.frame, spheres, places.distance);
  triangle_bounds(assembly_.runs(), assembly_.lane_edges(), s.frame, spheres, corners, &s.drift, places.distance, low);
  dismiss();
  if (open == 0) return;
  double most = 0;
  for (int k = 0; k < base::kLanes; ++k) {
    if (!is_open(k)) continue;
    drifts[k] = s.drift.nearer(glm::length(spheres.sphere(k).centre - s.frame.tip) + spheres.radius[k]);
    most = std::max(most, drifts[k]);
  }
  look_closely(s, corners, wanted_ + most, places, by_planes);
  visit(e, places, open);
  for (int k = 0; k < base::kLanes; ++k)
    if (is_open(k)) low[k] = std::max({low[k], by_planes[k], places.low[k] - drifts[k]});
  dismiss();
  Entry rest{kInfinity, e.radius, most, 0, e.index, e.stretch, e.surface, 0, Entry::Leaf};
  for (int k = 0; k < base::kLanes; ++k) {
    if (!is_open(k)) continue;
    if (places.low[k] >= wanted_)
      rest.open |= static_cast<std::uint8_t>(1U << k), rest.low = std::min(rest.low, low[k]);
    else
      push({low[k], spheres.radius[k], drifts[k], 0, static_cast<std::uint32_t>(first + static_cast<std::size_t>(k)),
            e.stretch, e.surface, 0, Entry::Triangle});
  }
  if (rest.open == 0) return;
  if (out_.clearance < wanted_) return push(rest);
  if (!halve(surface, rest)) out_.bound = std::min(out_.bound, rest.low);  // only rounding is left
}

/// A plane says little about a large triangle where the tool changes its shape: pieces of it are looked at first.
void SweptSearch::test(const Surface& surface, const Entry& e) {
  const MoveInterval& s = stretches_[e.stretch];
  const Corners& c = surface.corners(e.index);
  Corners pieces[base::kLanes];
  divide(c, pieces);
  LanePlaces places;
  double low[base::kLanes];
  look_closely(s, pieces, wanted_ + e.drifts, places, low);
  visit(e, places, (1U << base::kLanes) - 1);
  double still = kInfinity, moving = kInfinity;
  for (int k = 0; k < base::kLanes; ++k)
    still = std::min(still, places.low[k]), moving = std::min(moving, std::max(low[k], places.low[k] - e.drifts));
  Entry next = e;
  next.low = std::max(e.low, moving);
  if (out_.clearance < wanted_ || next.low >= wanted_) return push(next);
  if (still < wanted_) {
    const Corners t{s.frame.to_tool(c.a), s.frame.to_tool(c.b), s.frame.to_tool(c.c)};
    search_.forget();
    next.low = std::max(next.low, search_.bound(t, s.drift.in(s.frame)));
    attained(e);
    if (out_.clearance < wanted_ || next.low >= wanted_) return push(next);
    // The clearance reached is the smallest one, or nearly: the drift of the whole tool may now be small enough.
    // Whether it is does not take the exact clearance.
    const double near = TriangleSearch::slack(glm::length(t.a) + e.radius), needed = wanted_ + e.drifts + 2 * near;
    if (search_.least().distance >= needed) {
      Deadline none;
      search_.below(needed), search_.enough(needed);
      search_.search(t, -kInfinity, none);
      if (search_.least().distance < needed) attained(e);
      next.low = std::max(next.low, search_.low() - near - e.drifts);
      if (out_.clearance < wanted_ || next.low >= wanted_) return push(next);
    }
  }
  if (!halve(surface, next)) out_.bound = std::min(out_.bound, next.low);  // only rounding is left
}

Swept SweptSearch::operator()(std::span<const Surface* const> surfaces) {
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    push({-kInfinity, kInfinity, 0, 0, 0, 0, static_cast<std::uint16_t>(i), 0, Entry::Group});
  while (!heap_.empty() && !(out_.clearance < wanted_) && out_.evaluations < most_) {
    std::pop_heap(heap_.begin(), heap_.end());
    const Entry e = heap_.back();
    heap_.pop_back();
    const Surface& surface = *surfaces[e.surface];
    if (is_better_halved(e) && halve(surface, e)) continue;
    if (++out_.evaluations % kLooksAReport == 0) base::still_wanted();
    e.kind == Entry::Triangle ? test(surface, e) : open(surface, e);
  }
  if (!heap_.empty()) out_.bound = std::min(out_.bound, heap_.front().low);
  out_.bound = std::min(out_.bound, out_.clearance);
  out_.answer = out_.clearance < wanted_ ? Swept::Answer::Gouges
                : heap_.empty()          ? Swept::Answer::Clear
                                         : Swept::Answer::Unknown;
  return out_;
}

}  // namespace riffler::collide
