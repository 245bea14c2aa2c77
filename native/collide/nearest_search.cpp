#include "collide/nearest_search.hpp"

#include <algorithm>

#include "collide/lowest_places.hpp"
#include "collide/outline_lanes.hpp"

namespace riffler::collide {

NearestSearch::NearestSearch(const Assembly& assembly, const ToolFrame& frame)
    : assembly_(assembly), frame_(frame), triangles_(assembly.runs()), slack_(0) {
  heap_.reserve(512);
}

void NearestSearch::push(const Entry& e) {
  if (e.low > limit_ + slack_) return;
  heap_.push_back(e);
  std::push_heap(heap_.begin(), heap_.end());
}

void NearestSearch::open(const Surface& surface, const Entry& e, Counts& counts) {
  const SphereTree& tree = surface.tree();
  const SphereGroup& spheres = tree.group(e.index);
  LanePlaces places;
  counts.nodes += base::kLanes;
  const bool items = tree.holds_items(e.index);
  const std::size_t first = items ? tree.first_item(e.index) : tree.first_child(e.index);
  if (items) {
    look_closely(surface, spheres, first, places, e.surface);
  } else {
    double high[base::kLanes];
    box_bounds(assembly_.runs(), assembly_.lane_edges(), frame_, surface.boxes(e.index), nullptr, places.low, high);
    for (int k = 0; k < base::kLanes; ++k)  // every box contains a point of the surface
      if (spheres.radius[k] >= 0) limit_ = std::min(limit_, high[k]);
  }
  for (int k = 0; k < base::kLanes; ++k)
    if (spheres.radius[k] >= 0)
      push({places.low[k], static_cast<std::uint32_t>(first + k), e.surface, items ? Entry::Triangle : Entry::Group});
}

/// Bounds the triangles of a group, and where that leaves some open, finds their lowest places.
void NearestSearch::look_closely(const Surface& surface, const SphereGroup& spheres, std::size_t first,
                                 LanePlaces& places, std::size_t which) {
  const Corners* corners = &surface.corners(first);
  centre_distances(assembly_.lane_edges(), frame_, spheres, places.distance);
  for (int k = 0; k < base::kLanes; ++k)  // every sphere contains a point of the surface
    if (spheres.radius[k] >= 0) limit_ = std::min(limit_, places.distance[k] + spheres.radius[k]);
  triangle_bounds(assembly_.runs(), assembly_.lane_edges(), frame_, spheres, corners, nullptr, places.distance,
                  places.low);
  const double enough = triangles_.least().distance - slack_;
  double chord = 0;  // of a triangle that is open
  bool open = false;
  for (int k = 0; k < base::kLanes; ++k) {
    const double by = surface.exact() ? surface.chord(first + static_cast<std::size_t>(k)) : 0;
    if (spheres.radius[k] >= 0 && places.low[k] - by < enough) open = true, chord = std::max(chord, by);
  }
  if (open) find_lowest(surface, spheres, first, enough + chord, places, which);
  if (surface.exact())
    for (int k = 0; k < base::kLanes; ++k) places.low[k] -= surface.chord(first + static_cast<std::size_t>(k));
}

/// `enough`: distance of the flat triangles from which on none of them matters.
void NearestSearch::find_lowest(const Surface& surface, const SphereGroup& spheres, std::size_t first, double enough,
                                LanePlaces& places, std::size_t which) {
  lowest_places(assembly_.runs(), assembly_.lane_edges(), frame_, &surface.corners(first), enough, 0.5 * slack_,
                places);
  int lowest = -1;
  for (int k = 0; k < base::kLanes; ++k)
    if (spheres.radius[k] >= 0 && (lowest < 0 || places.distance[k] < places.distance[lowest])) lowest = k;
  const double before = triangles_.least().distance;
  const std::size_t place = first + static_cast<std::size_t>(lowest);
  const double chord = surface.exact() ? surface.chord(place) : 0;
  if (!(places.distance[lowest] - chord < before)) return;
  const Vec3 at = frame_.seen(Vec3(places.x[lowest], places.y[lowest], places.z[lowest]));
  if (surface.exact())
    triangles_.visit(in_tool(surface, place), at);
  else
    triangles_.visit(at);
  if (triangles_.least().distance < before) best_surface_ = which;
  limit_ = std::min(limit_, triangles_.least().distance);
}

ExactPiece NearestSearch::in_tool(const Surface& surface, std::size_t place) const {
  const Corners& c = surface.corners(place);
  const nurbs::ExactTriangle& e = surface.exact(place);
  return {*surface.exact(), frame_, e, {frame_.to_tool(c.a), frame_.to_tool(c.b), frame_.to_tool(c.c)}};
}

void NearestSearch::test(const Surface& surface, const Entry& e, Deadline& deadline, Counts& counts) {
  const Corners& c = surface.corners(e.index);
  const Corners t{frame_.to_tool(c.a), frame_.to_tool(c.b), frame_.to_tool(c.c)};
  const double before = triangles_.least().distance;
  if (surface.exact()) {
    ++counts.triangles;
    triangles_.search(in_tool(surface, e.index), e.low, deadline);
  } else if (e.kind == Entry::Triangle) {
    ++counts.triangles;
    const double low = triangles_.bound(t);
    if (low < triangles_.least().distance - slack_) {
      // This bound is tighter than the sphere's, so another entry may now come first.
      if (!heap_.empty() && low > heap_.front().low)
        push({std::max(low, e.low), e.index, e.surface, Entry::Looked});
      else
        triangles_.search(t, std::max(low, e.low), deadline);
    }
  } else {
    triangles_.search(t, e.low, deadline);
  }
  if (triangles_.least().distance < before) best_surface_ = e.surface;
}

NearestSearch::Found NearestSearch::operator()(std::span<const Surface* const> surfaces, Deadline deadline,
                                               Counts& counts) {
  double size = glm::length(frame_.tip);
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const SphereGroup& root = surfaces[s]->tree().group(0);
    for (int k = 0; k < base::kLanes; ++k)
      if (root.radius[k] >= 0) size = std::max(size, glm::length(root.sphere(k).centre) + root.radius[k]);
    if (surfaces[s]->exact()) loose_ = std::max(loose_, TriangleSearch::kExact), triangles_.loose(loose_);
    heap_.push_back({-std::numeric_limits<double>::infinity(), 0, static_cast<std::uint16_t>(s), Entry::Group});
  }
  slack_ = std::max(TriangleSearch::slack(size), loose_);
  const std::size_t before = counts.triangles;
  while (!heap_.empty() && heap_.front().low < triangles_.least().distance - slack_ && !deadline.passed() &&
         triangles_.least().distance >= enough_) {
    std::pop_heap(heap_.begin(), heap_.end());
    const Entry e = heap_.back();
    heap_.pop_back();
    if (e.kind == Entry::Group)
      open(*surfaces[e.surface], e, counts);
    else
      test(*surfaces[e.surface], e, deadline, counts);
  }
  counts.cells += triangles_.cells();
  Found found{triangles_.least(), best_surface_, triangles_.low(), slack_, 1};
  if (heap_.empty() || heap_.front().low >= found.low - slack_) return found;
  // The search was cut short: count what is left in the heap and could still matter.
  const double tested = static_cast<double>(counts.triangles - before);
  double left = 0;
  for (const Entry& e : heap_)
    if (e.low < found.low - slack_)
      left += e.kind == Entry::Group ? static_cast<double>(surfaces[e.surface]->tree().under(e.index)) : 1;
  found.checked = tested / (tested + left);
  found.low = std::min(found.low, heap_.front().low);
  return found;
}

}  // namespace riffler::collide
