#include "collide/swept_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "collide/outline_lanes.hpp"
#include "geom/math.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::collide {

namespace {

constexpr std::size_t kLooksAReport = 64;
constexpr double kShortest = 1e-12;    // of the motion's duration: shorter intervals are not halved
constexpr double kLooseInSpace = 0.5;  // of a margin: a triangle whose bound leaves out more is divided
constexpr double kSmallest = 1e-9;     // of a triangle's distance from the origin: smaller ones are not divided

bool is_divisible(const Corners& t) {
  const double longest = std::max({glm::length(t.b - t.a), glm::length(t.c - t.b), glm::length(t.a - t.c)});
  return longest > kSmallest * (1 + glm::length(t.a));
}

/// Spheres about places of triangles that contain the triangles.
SphereGroup spheres_about(const LanePlaces& places, const Vec3& tip, const Corners* triangles) {
  SphereGroup out;
  for (int k = 0; k < base::kLanes; ++k) {
    const Vec3 at = tip + Vec3(places.x[k], places.y[k], places.z[k]);
    const double radius = farthest(triangles[k], at);
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

/// Dismisses triangles of a group by their spheres and the planes there, before their lowest places are searched.
void SweptSearch::open_leaf(const Surface& surface, const Entry& e) {
  const SphereTree& tree = surface.tree();
  const SphereGroup& spheres = tree.group(e.index);
  const MoveInterval& s = stretches_[e.stretch];
  const Corners* corners = &surface.corners(tree.first_item(e.index));
  Entry all = e;
  all.kind = Entry::Leaf;
  for (int k = 0; k < base::kLanes && e.kind == Entry::Group; ++k)
    if (spheres.radius[k] >= 0) all.open |= static_cast<std::uint8_t>(1U << k);
  double distance[base::kLanes], low[base::kLanes];
  centre_distances(assembly_.lane_edges(), s.frame, spheres, distance);
  triangle_bounds(assembly_.runs(), assembly_.lane_edges(), s.frame, spheres, corners, &s.drift, distance, low);
  dismiss(all, low);
  if (all.open != 0) open_triangles(surface, all, corners, low);
}

/// Raises bounds to the entry's own, and closes those of its triangles that are far enough away.
void SweptSearch::dismiss(Entry& e, double* low) {
  for (int k = 0; k < base::kLanes; ++k)
    if ((e.open >> k & 1U) && (low[k] = std::max(low[k], e.low)) >= wanted_)
      out_.bound = std::min(out_.bound, low[k]), e.open &= static_cast<std::uint8_t>(~(1U << k));
}

/// Looks at the lowest places of some triangles or pieces. What stays open is left to shorter intervals where its bound
/// at the middle of the interval is near its distance, and otherwise divided.
void SweptSearch::open_triangles(const Surface& surface, Entry e, const Corners* corners, double* low) {
  const MoveInterval& s = stretches_[e.stretch];
  double drifts[base::kLanes], by_planes[base::kLanes], most = 0;
  for (int k = 0; k < base::kLanes; ++k)
    if (e.open >> k & 1U) most = std::max(most, drifts[k] = s.drift.nearer(farthest(corners[k], s.frame.tip)));
  LanePlaces places;
  look_closely(s, corners, wanted_ + most, places, by_planes);
  visit(e, places, e.open);
  for (int k = 0; k < base::kLanes; ++k)
    if (e.open >> k & 1U) low[k] = std::max({low[k], by_planes[k], places.low[k] - drifts[k]});
  dismiss(e, low);
  if (e.open == 0) return;
  if (out_.clearance < wanted_) return push(e);
  Entry later = e;
  later.open = 0, later.low = kInfinity;
  for (int k = 0; k < base::kLanes; ++k) {
    if (!(e.open >> k & 1U)) continue;
    if (places.distance[k] - places.low[k] > kLooseInSpace * (places.distance[k] - wanted_) && is_divisible(corners[k]))
      push(in_pieces(e, corners[k], low[k]));
    else
      later.open |= static_cast<std::uint8_t>(1U << k), later.low = std::min(later.low, low[k]);
  }
  if (later.open != 0 && !halve(surface, later)) out_.bound = std::min(out_.bound, later.low);  // only rounding is left
}

void SweptSearch::open_pieces(const Surface& surface, const Entry& e) {
  const std::array<Corners, base::kLanes> corners = pieces_[e.index];  // a copy, since the pieces grow
  double low[base::kLanes];
  std::fill_n(low, base::kLanes, e.low);
  open_triangles(surface, e, corners.data(), low);
}

/// The pieces of a triangle of an entry.
SweptSearch::Entry SweptSearch::in_pieces(const Entry& e, const Corners& triangle, double low) {
  divide(triangle, pieces_.emplace_back().data());
  Entry out = e;
  out.kind = Entry::Pieces, out.index = static_cast<std::uint32_t>(pieces_.size() - 1);
  out.open = (1U << base::kLanes) - 1, out.low = low;
  return out;
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
    e.kind == Entry::Pieces ? open_pieces(surface, e) : open(surface, e);
  }
  if (!heap_.empty()) out_.bound = std::min(out_.bound, heap_.front().low);
  out_.bound = std::min(out_.bound, out_.clearance);
  out_.answer = out_.clearance < wanted_ ? Swept::Answer::Gouges
                : heap_.empty()          ? Swept::Answer::Clear
                                         : Swept::Answer::Unknown;
  return out_;
}

}  // namespace riffler::collide
