#include "reference/assembly_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/math.hpp"

namespace riffler::reference {

AssemblyDistance::AssemblyDistance(const Tool& tool) {
  Solid cutter;
  Vec2 from{0, 0};
  for (const tool::ProfileSegment& s : tool.profile().segments()) {
    Edge e{from, s.to, s.centre};
    // Heights rise along an arc of a profile, so the arc is entirely on one side of its centre.
    if (s.centre)
      e.radius = glm::length(from - *s.centre), e.side = 0.5 * (from.x + s.to.x) >= s.centre->x ? 1.0 : -1.0;
    cutter.edges.push_back(e);
    from = s.to;
  }
  cutter.edges.push_back({from, {0, from.y}, {}});
  cutter.convex = convex(cutter.edges);
  solids_.push_back(std::move(cutter));
  for (const std::vector<tool::Frustum>* frusta : {&tool.shank(), &tool.holder()})
    for (const tool::Frustum& f : *frusta) {
      const Vec2 low{f.r0, f.z0}, high{f.r1, f.z1};
      solids_.push_back({{{{0, f.z0}, low, {}}, {low, high, {}}, {high, {0, f.z1}, {}}}});
    }
  double size = 0;
  for (Solid& s : solids_) {
    s.low = s.edges.front().from.y, s.high = s.edges.back().to.y;  // heights do not fall
    for (const Edge& e : s.edges) {
      size = std::max({size, glm::length(e.from), glm::length(e.to)});
      s.radius = std::max({s.radius, e.from.x, e.to.x, e.centre ? e.centre->x + e.side * e.radius : 0.0});
    }
  }
  step_ = 1e-9 * size;
  for (const Solid& s : solids_)
    for (const Edge& e : s.edges) add_if_on_surface(e.from), add_if_on_surface(e.to);
  for (std::size_t a = 0; a < solids_.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (const Edge& e : solids_[a].edges)
        for (const Edge& f : solids_[b].edges) add_crossings(e, f);
}

/// Heights never fall along a solid's outline, so a point is inside if it is nearer to the axis than the outline.
bool AssemblyDistance::inside(const Solid& solid, double rho, double z) {
  for (const Edge& e : solid.edges) {
    if (!(e.from.y < e.to.y) || z < e.from.y || z > e.to.y) continue;
    if (!e.centre) {
      if (rho <= e.from.x + (e.to.x - e.from.x) * ((z - e.from.y) / (e.to.y - e.from.y))) return true;
      continue;
    }
    const double up = z - e.centre->y, half = std::sqrt(std::max(0.0, (e.radius - up) * (e.radius + up)));
    if (rho <= e.centre->x + e.side * half) return true;
  }
  return false;
}

bool AssemblyDistance::inside(double rho, double z) const {
  return std::any_of(solids_.begin(), solids_.end(), [&](const Solid& s) { return inside(s, rho, z); });
}

/// Whether any of sixteen small steps leads out of all solids.
bool AssemblyDistance::on_surface(const Vec2& q) const {
  for (int k = 0; k < 16; ++k) {
    const double angle = (k + 0.37) * kPi / 8;
    const Vec2 near = q + step_ * Vec2(std::cos(angle), std::sin(angle));
    if (!inside(std::abs(near.x), near.y)) return true;
  }
  return false;
}

void AssemblyDistance::add_if_on_surface(const Vec2& q) {
  if (on_surface(q)) corners_.push_back(q);
}

/// Adds the crossings of two edges: of two lines by Cramer's rule, of a line and an arc from the quadratic equation of
/// the circle. Only the cutter has arcs, so two arcs never meet here.
void AssemblyDistance::add_crossings(const Edge& a, const Edge& b) {
  const Edge &line = a.centre ? b : a, &other = a.centre ? a : b;
  const Vec2 way = line.to - line.from;
  const auto add = [&](double t) {
    if (t >= 0 && t <= 1) add_if_on_surface(line.from + t * way);
  };
  if (other.centre) {
    const Vec2 off = line.from - *other.centre;
    const double square = glm::dot(way, way), half = glm::dot(way, off),
                 disc = half * half - square * (glm::dot(off, off) - other.radius * other.radius);
    if (square > 0 && disc >= 0)
      for (const double sign : {-1.0, 1.0}) add((-half + sign * std::sqrt(disc)) / square);
    return;
  }
  const Vec2 along = other.to - other.from, off = other.from - line.from;
  const double area = way.x * along.y - way.y * along.x;
  if (area == 0) return;
  const double s = (off.x * way.y - off.y * way.x) / area;
  if (s >= 0 && s <= 1) add((off.x * along.y - off.y * along.x) / area);
}

/// The nearest point of the edge, if it is not one of its ends.
std::optional<Vec2> AssemblyDistance::foot(const Edge& e, const Vec2& p) {
  if (!e.centre) {
    const Vec2 way = e.to - e.from;
    const double t = glm::dot(p - e.from, way), square = glm::dot(way, way);
    if (!(t > 0 && t < square)) return {};
    return e.from + (t / square) * way;
  }
  const Vec2 d = p - *e.centre;
  const double length = glm::length(d);
  if (length == 0) return e.from;  // p is the centre: the whole arc is equally near
  const Vec2 at = *e.centre + d * (e.radius / length);
  // Compare angles: near a ball's tip, points of the circle that are apart have the same height up to rounding.
  const auto turn = [&](const Vec2& from, const Vec2& to) {
    return e.side * std::atan2(from.x * to.y - from.y * to.x, glm::dot(from, to));
  };
  if (e.side * d.x < 0 || turn(e.from - *e.centre, d) < 0 || turn(d, e.to - *e.centre) < 0) return {};
  return at;
}

AssemblyDistance::Nearest AssemblyDistance::nearest(double rho, double z) const {
  const Vec2 p{rho, z};
  const bool within = inside(rho, z);
  Nearest out{std::numeric_limits<double>::infinity(), p};
  for (const Vec2& c : corners_)
    if (const double d = glm::length(p - c); d < out.distance) out = {d, c};
  for (const Solid& s : solids_)
    for (const Edge& e : s.edges)
      if (const std::optional<Vec2> at = foot(e, p)) {
        const double d = glm::length(p - *at);
        if (d < out.distance && (!within || on_surface(*at))) out = {d, *at, &s, &e};
      }
  if (within) out.distance = -out.distance;
  return out;
}

double AssemblyDistance::distance(double rho, double z) const {
  return nearest(rho, z).distance;
}

double AssemblyDistance::operator()(const Vec3& p, const Pose& pose) const {
  const Vec3 d = p - pose.tip;
  const double z = glm::dot(d, pose.axis);
  return distance(glm::length(d - z * pose.axis), z);
}

/// Whether every corner turns left, as convex arcs do.
bool AssemblyDistance::convex(const std::vector<Edge>& edges) {
  const auto way = [](const Edge& e, const Vec2& at) {
    return e.centre ? Vec2(e.centre->y - at.y, at.x - e.centre->x) : e.to - e.from;
  };
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Edge& e = edges[k];
    if (e.centre && e.side < 0) return false;
    if (k + 1 == edges.size()) break;
    const Vec2 a = way(e, e.to), b = way(edges[k + 1], e.to);
    if (a.x * b.y - a.y * b.x < -1e-12 * glm::length(a) * glm::length(b)) return false;
  }
  return true;
}

/// Distance to one solid, 0 in it.
double AssemblyDistance::outside(const Solid& solid, const Vec2& p) {
  if (inside(solid, p.x, p.y)) return 0;
  double best = std::numeric_limits<double>::infinity();
  for (const Edge& e : solid.edges) {
    best = std::min({best, glm::length(p - e.from), glm::length(p - e.to)});
    if (const std::optional<Vec2> at = foot(e, p)) best = std::min(best, glm::length(p - *at));
  }
  return best;
}

bool AssemblyDistance::beyond(const Vec3& p, double radius, const Pose& pose) const {
  const Vec3 d = p - pose.tip;
  const double z = glm::dot(d, pose.axis), square = glm::dot(d, d) - z * z;
  return std::all_of(solids_.begin(), solids_.end(), [&](const Solid& s) {
    const double reach = s.radius + radius;
    return z < s.low - radius || z > s.high + radius || square > reach * reach;
  });
}

/// The bound exists if the edge nearest to p belongs to a convex solid, is on the union's surface around the foot of p
/// as far as the feet of all points within `radius` can be, and no other solid is that near. Then all points of the
/// triangle that are in the tool are in that solid, and no deeper than below the extended edge. The signed distance
/// from the extended edge (a cone, a ball or the outside of a ring) is convex, so it is nowhere below its tangent plane
/// at p, whose minimum over the triangle is at a corner.
std::optional<double> AssemblyDistance::tangent_bound(const Corners& triangle, const Vec3& p, double radius,
                                                      const Pose& pose) const {
  const Vec3 d = p - pose.tip;
  const double z = glm::dot(d, pose.axis);
  const Vec3 out = d - z * pose.axis;
  const Vec2 at{glm::length(out), z};
  const Nearest near = nearest(at.x, at.y);
  if (!near.edge || !near.solid->convex) return {};
  double shift = radius, height;  // height: above the edge
  Vec2 normal;
  if (const Edge& e = *near.edge; e.centre) {
    const Vec2 from = at - *e.centre;
    const double length = glm::length(from);
    if (length <= radius || (e.centre->x > 0 && at.x - radius < e.centre->x)) return {};
    shift *= std::max(1.0, e.radius / (length - radius)), height = length - e.radius, normal = from / length;
  } else {
    const Vec2 way = glm::normalize(e.to - e.from);
    normal = {way.y, -way.x}, height = glm::dot(at - e.from, normal);
  }
  if (std::any_of(corners_.begin(), corners_.end(), [&](const Vec2& c) { return glm::length(c - near.at) <= shift; }))
    return {};
  for (const Solid& s : solids_)
    if (&s != near.solid && outside(s, at) <= radius) return {};
  const Vec3 up = normal.y * pose.axis + (at.x > 0 ? normal.x / at.x * out : Vec3(0));
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& corner : triangle) least = std::min(least, height + glm::dot(up, corner - p));
  return std::max(0.0, -least);
}

}  // namespace riffler::reference
