#include "reference/cutter_distance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geom/hypot.hpp"

namespace riffler::reference {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double cross(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace

/// The nearest foot on the edges examined so far.
class CutterDistance::Search {
 public:
  Search(const Vec2& p, bool inside, double scale) : p_(p), inside_(inside), scale_(scale) {}

  void add(const Edge& e) {
    const bool faced = e.arc ? add_arc(e) : add_line(e);
    if (!faced) add_corner(e.from, e.at_from), add_corner(e.to, e.at_to);
  }
  Nearest found() const { return {inside_ ? -distance_ : distance_, normal_, support_}; }
  bool on_corner() const { return on_corner_; }

 private:
  bool add_line(const Edge& e) {
    const Vec2 w = p_ - e.from;
    const double along = glm::dot(w, e.way);
    if (along < 0 || along > e.length || e.length == 0) return false;
    add_face(std::abs(glm::dot(w, e.normal)), e.normal);
    return true;
  }

  /// Heights rise along the arc and it stays on one side of its centre, so its nearest point is at the same angle, if
  /// that is in the arc's range.
  bool add_arc(const Edge& e) {
    const Arc& arc = *e.arc;
    const Vec2 d = p_ - arc.centre;
    const double length = glm::length(d);
    const Vec2 out = length > 0 ? d / length : (e.from - arc.centre) / arc.radius;
    const Vec2 foot = arc.centre + out * arc.radius;
    if (arc.side * (foot.x - arc.centre.x) < 0 || foot.y < e.from.y || foot.y > e.to.y) return false;
    add_face(std::abs(length - arc.radius), out * arc.side);
    return true;
  }

  void add_face(double distance, const Vec2& normal) {
    if (distance < distance_) distance_ = distance, normal_ = normal, support_ = normal, on_corner_ = false;
  }

  /// A corner's normal is the direction to the point, which rounding hides close by.
  void add_corner(const Vec2& corner, const Cone& cone) {
    const Vec2 to_point = p_ - corner;
    const double d = glm::length(to_point);
    if (d >= distance_) return;
    distance_ = d, on_corner_ = true;
    normal_.reset();
    if (d > 1e-7 * scale_) normal_ = to_point / (inside_ ? -d : d);
    support_ = inside_ || cross(cone.first, to_point) <= 0 ? cone.first
               : cross(to_point, cone.last) <= 0           ? cone.last
                                                           : to_point / d;
  }

  Vec2 p_;
  bool inside_;
  double scale_;
  double distance_ = kInfinity;
  std::optional<Vec2> normal_;
  Vec2 support_{0, 0};
  bool on_corner_ = false;
};

CutterDistance::Edge CutterDistance::edge(const Vec2& from, const Vec2& to, const std::optional<Vec2>& centre) {
  const double length = glm::length(to - from);
  const Vec2 way = length > 0 ? (to - from) / length : Vec2(1, 0);
  Edge e{from, to, {}, length, way, {way.y, -way.x}};
  if (centre) e.arc = Arc{*centre, glm::length(from - *centre), from.x + to.x >= 2 * centre->x ? 1.0 : -1.0};
  return e;
}

CutterDistance::CutterDistance(const tool::Profile& profile)
    : reach_(geom::hypot(profile.max_radius(), profile.length())) {
  Vec2 from{0, 0};
  for (const tool::ProfileSegment& s : profile.segments()) {
    edges_.push_back(edge(from, s.to, s.centre));
    from = s.to;
  }
  edges_.push_back(edge(from, {0, from.y}, {}));
  add_cones(edges_);
  convex_ = convex(edges_);
  if (convex_) return;
  for (const Edge& e : edges_)
    if (e.to.y > e.from.y) add_slices(e);
}

/// Sets the cones of an outline from the axis to the axis. Edges without a length have no normals of their own.
void CutterDistance::add_cones(std::span<Edge> outline) {
  const auto normal_at = [](const Edge& e, const Vec2& at) {
    return e.arc ? (at - e.arc->centre) * (e.arc->side / e.arc->radius) : e.normal;
  };
  const auto mirrored = [](const Vec2& n) { return Vec2(-n.x, n.y); };  // beyond the axis
  std::vector<std::pair<Vec2, Vec2>> normals;                           // at the ends of each edge with a length
  std::vector<std::size_t> first;                                       // of those from this edge on
  for (const Edge& e : outline) {
    first.push_back(normals.size());
    if (e.length > 0) normals.emplace_back(normal_at(e, e.from), normal_at(e, e.to));
  }
  const auto cone = [&](std::size_t k) {  // between edges k − 1 and k with a length
    const Vec2 below = k > 0 ? normals[k - 1].second : mirrored(normals[0].first);
    return Cone{below, k < normals.size() ? normals[k].first : mirrored(below)};
  };
  for (std::size_t k = 0; k < outline.size(); ++k)
    outline[k].at_from = cone(first[k]), outline[k].at_to = cone(first[k] + (outline[k].length > 0));
}

/// Adds one slice, or several under a hollow arc: the shorter the arc, the closer the slice is to its hull.
void CutterDistance::add_slices(const Edge& e) {
  const bool hollow = e.arc && e.arc->side < 0;
  const int parts = hollow ? 8 : 1;
  slices_convex_ = slices_convex_ && !hollow;
  Vec2 from = e.from;
  for (int k = 1; k <= parts; ++k) {
    Vec2 to = e.to;
    if (k < parts) {
      const Vec2 onwards = glm::normalize(glm::mix(e.from, e.to, static_cast<double>(k) / parts) - e.arc->centre);
      to = e.arc->centre + onwards * e.arc->radius;
    }
    slices_.push_back({edge({0, from.y}, from, {}), edge(from, to, e.arc ? std::optional(e.arc->centre) : std::nullopt),
                       edge(to, {0, to.y}, {})});
    add_cones(slices_.back());
    from = to;
  }
}

/// Whether the outline turns only one way between its two ends on the axis.
bool CutterDistance::convex(const std::vector<Edge>& edges) {
  double heading = 0;
  const auto turns_on = [&](const Vec2& way) {
    const double before = heading;
    heading = std::atan2(way.y, way.x);
    return heading > before - 1e-12;
  };
  for (const Edge& e : edges) {
    if (!(e.length > 0)) continue;
    if (!e.arc) {
      if (!turns_on(e.way)) return false;
      continue;
    }
    const Vec2 a = e.from - e.arc->centre, b = e.to - e.arc->centre;
    if (e.arc->side < 0 || !turns_on({-a.y, a.x}) || !turns_on({-b.y, b.x})) return false;
  }
  return true;
}

/// Whether the point is between the axis and the edge.
bool CutterDistance::inside(const Edge& e, double rho, double z) {
  if (z < e.from.y || z >= e.to.y) return false;
  if (!e.arc) return rho < e.from.x + (e.to.x - e.from.x) * (z - e.from.y) / (e.to.y - e.from.y);
  const double up = z - e.arc->centre.y, r = e.arc->radius;
  return rho < e.arc->centre.x + e.arc->side * std::sqrt(std::max(0.0, (r - up) * (r + up)));
}

bool CutterDistance::inside(double rho, double z) const {
  return std::any_of(edges_.begin(), edges_.end(), [&](const Edge& e) { return inside(e, rho, z); });
}

Nearest CutterDistance::nearest(double rho, double z) const {
  Search search({rho, z}, inside(rho, z), reach_);
  for (const Edge& e : edges_) search.add(e);
  return search.found();
}

/// Whether the whole cutter is behind the line through `foot`. A hollow arc is within the hull of its ends.
bool CutterDistance::behind(const Vec2& foot, const Vec2& normal) const {
  const auto reaches = [&](const Vec2& at) { return std::abs(normal.x) * at.x + normal.y * at.y; };  // on both sides
  const double most = glm::dot(foot, normal) + 1e-14 * reach_;
  return std::all_of(edges_.begin(), edges_.end(), [&](const Edge& e) {
    const bool bulges = e.arc && e.arc->side > 0;
    const double round = bulges ? reaches(e.arc->centre) + e.arc->radius : -kInfinity;
    return std::max({reaches(e.from), reaches(e.to), round}) <= most;
  });
}

Nearest CutterDistance::with_free_radius(double rho, double z, Nearest at) const {
  if (!at.normal) return at;
  const Vec2 foot = Vec2(rho, z) - at.distance * *at.normal;
  at.free_radius = convex_ || behind(foot, *at.normal) ? kInfinity : 0;
  // The ball about the point itself, up to the foot, is free; a hardly larger one would not help.
  const double least = std::max({1.05 * at.distance, -0.25 * at.distance, 1e-3 * reach_});
  for (double radius = 8 * reach_; at.free_radius == 0 && radius > least; radius *= 0.6) {
    const Vec2 centre = foot + radius * *at.normal;
    if (distance(std::abs(centre.x), centre.y) >= radius - 1e-12 * reach_) at.free_radius = radius;
  }
  return at;
}

Nearest CutterDistance::nearest_in_slice(std::size_t k, double rho, double z) const {
  const Edge& outside = slices_[k][1];
  const bool within = inside(outside, rho, z);
  Search search({rho, z}, within, reach_);
  for (const Edge& e : slices_[k]) search.add(e);
  Nearest at = search.found();
  if (!at.normal || within) return at;
  const bool hollow = outside.arc && outside.arc->side < 0;
  if (!hollow)
    at.free_radius = kInfinity;
  else if (!search.on_corner() && at.normal->x > 0)
    at.free_radius = outside.arc->radius;
  else
    at.free_radius = beside_hollow(outside, Vec2(rho, z) - at.distance * *at.normal, *at.normal);
  return at;
}

/// Free radius at the foot of `normal` on a flat end, or a corner, of a slice under the hollow arc of `e`.
double CutterDistance::beside_hollow(const Edge& e, const Vec2& foot, const Vec2& normal) const {
  // The slice lies within the hull of its corners.
  double behind = kInfinity;
  for (const Vec2& corner : {e.from, e.to})
    for (const double side : {1.0, -1.0})
      behind = std::min(behind, glm::dot(foot - Vec2(side * corner.x, corner.y), normal));
  if (behind > -1e-12 * reach_) return kInfinity;
  // The slice is outside the arc's circle, behind its flat end and, if the corner is its widest point, within the
  // cylinder there. If normal = share · (normal of the arc) + rest · (normal of flat end or cylinder), every touching
  // ball with `share` times the circle's curvature is free.
  const bool upper = glm::length(foot - e.to) < glm::length(foot - e.from);
  const Vec2 corner = upper ? e.to : e.from, to_centre = (e.arc->centre - corner) / e.arc->radius;
  const auto radius_with = [&](const Vec2& other) {
    const double area = to_centre.x * other.y - to_centre.y * other.x;
    if (std::abs(area) < 1e-9) return 0.0;
    const double share = (normal.x * other.y - normal.y * other.x) / area,
                 rest = (to_centre.x * normal.y - to_centre.y * normal.x) / area;
    return share > 0 && rest >= 0 ? e.arc->radius / share : 0.0;
  };
  if (normal.x < 0) return 0;
  const bool widest = corner.x >= std::max(e.from.x, e.to.x);
  return std::max(radius_with({0, upper ? 1 : -1}), widest ? radius_with({1, 0}) : 0.0);
}

}  // namespace riffler::reference
