#include "collide/outline_runs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geom/hypot.hpp"
#include "geom/math.hpp"

namespace riffler::collide {

namespace {

double area(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Direction along an edge at one of its points.
Vec2 tangent(const tool::OutlineEdge& e, const Vec2& p) {
  if (!e.centre) return glm::normalize(e.to - e.from);
  const Vec2 out = (p - *e.centre) / e.bulge;
  return {-out.y, out.x};
}

bool hollow(const tool::OutlineEdge& e) {
  return e.centre && e.bulge < 0;
}

/// Whether the outline continues straight or turns towards the solid from one edge to the next.
bool goes_on(const tool::OutlineEdge& a, const tool::OutlineEdge& b) {
  return a.to == b.from && !hollow(a) && !hollow(b) && area(tangent(a, a.to), tangent(b, b.from)) >= -1e-12;
}

/// Edges that meet smoothly share a plane; a second plane must differ from the first.
bool differ(const OutlineRuns::Slope& a, const OutlineRuns::Slope& b) {
  return glm::dot(a.normal, b.normal) < 1 - 1e-6;
}

}  // namespace

/// The nearest point of an edge, with the edge's normal there, out of the solid.
struct OutlineRuns::Foot {
  Vec2 point{0}, normal{0};
  double distance = kInfinity;
  bool at_end = false, between = false;  // between: at an end where the run continues
  double margin = -1;  // mm to the normals at the edge's ends off the axis; −1 if the foot is at an end
  const tool::OutlineEdge* edge = nullptr;

  /// The depth at a point inside, as a slope.
  Slope depth(const Vec2& p) const {
    Slope s{-distance, at_end && distance > 0 ? (point - p) / distance : normal};
    if (!at_end && edge->bulge > 0) s.curvature = 1 / std::max(edge->bulge - distance, 1e-9);
    if (hollow(*edge)) s.reach = -edge->bulge;
    return s;
  }
};

OutlineRuns::OutlineRuns(std::vector<tool::OutlineEdge> edges) : edges_(std::move(edges)) {
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const tool::OutlineEdge& e = edges_[i];
    outermost_.push_back(all_behind(e));
    const Vec2 start = tangent(e, e.from), end = tangent(e, e.to);
    const auto end_at = [&](const Vec2& point, const Vec2& way, const Vec2& normal) {
      const bool open = point.x > 0;
      return End{point, way, normal, open, open && (hollow(e) || way.x < 0)};
    };
    if (i == 0 || !goes_on(edges_[i - 1], e))
      runs_.push_back({i, i, hollow(e) ? -e.bulge : kInfinity, end_at(e.from, -start, {start.y, -start.x}), {}});
    runs_.back().last = i + 1;
    runs_.back().upper = end_at(e.to, end, {end.y, -end.x});
  }
}

bool OutlineRuns::all_behind(const tool::OutlineEdge& e) const {
  if (e.centre) return false;
  const Vec2 way = tangent(e, e.from), normal(way.y, -way.x);
  return std::all_of(edges_.begin(), edges_.end(), [&](const tool::OutlineEdge& o) {
    const double most = std::max(glm::dot(o.from - e.from, normal), glm::dot(o.to - e.from, normal));
    const double bulge = o.centre && o.bulge > 0 ? glm::dot(*o.centre - e.from, normal) + o.bulge : most;
    return std::max(most, bulge) <= 0;
  });
}

OutlineRuns::Foot OutlineRuns::foot_on(const tool::OutlineEdge& e, const Vec2& p) const {
  Foot f;
  f.edge = &e;
  if (e.centre) {
    const Vec2 w = p - *e.centre;
    const double length = glm::length(w), r = std::abs(e.bulge), side = e.bulge > 0 ? 1 : -1;
    if (length > 0 && faces(e, p)) {
      f.point = *e.centre + r / length * w, f.normal = side / length * w, f.distance = std::abs(length - r);
      const auto from_normal = [&](const Vec2& end) {
        return end.x > 0 ? std::abs(area(end - *e.centre, w)) / r : kInfinity;
      };
      f.margin = std::min({length, from_normal(e.from), from_normal(e.to)});
      return f;
    }
    const Vec2 a = p - e.from, b = p - e.to;
    f.point = glm::dot(a, a) <= glm::dot(b, b) ? e.from : e.to;
    f.normal = (f.point - *e.centre) / e.bulge;
    f.at_end = true;
  } else {
    const Vec2 way = e.to - e.from, w = p - e.from;
    const double square = glm::dot(way, way), along = glm::dot(w, way);
    f.normal = Vec2(way.y, -way.x) / std::sqrt(square);
    f.at_end = !(along >= 0 && along <= square);
    f.point = along < 0 ? e.from : along > square ? e.to : e.from + along / square * way;
    if (!f.at_end) {
      const double length = std::sqrt(square), before = along / length;
      f.distance = std::abs(glm::dot(w, f.normal));
      f.margin = std::min(e.from.x > 0 ? before : kInfinity, e.to.x > 0 ? length - before : kInfinity);
      return f;
    }
  }
  f.distance = glm::length(p - f.point);
  return f;
}

bool OutlineRuns::holds(const Run& run, const Vec2& p) const {
  if (p.y < run.lower.point.y || p.y > run.upper.point.y) return false;
  for (std::size_t i = run.first; i < run.last; ++i) {
    const tool::OutlineEdge& e = edges_[i];
    if (e.from.y < e.to.y && e.from.y <= p.y && p.y <= e.to.y) return p.x <= radius_at(e, p.y);
  }
  return false;
}

/// For a hollow: at an end, the ball may be as large as the other end allows, but no smaller than the hollow's radius.
double OutlineRuns::reach_at(const Run& run, const Slope& closed, const Vec2& foot) const {
  double reach = kInfinity;
  for (const Vec2& end : {run.lower.point, run.upper.point}) {
    const Vec2 way = end - foot;
    const double ahead = glm::dot(way, closed.normal);
    if (ahead > 0) reach = std::min(reach, glm::dot(way, way) / (2 * ahead));
  }
  return std::max(reach, run.reach);
}

void OutlineRuns::add_facing(const Slope& slope, double margin, RunAt& out) {
  if (slope.distance > out.facing[0].distance) {
    if (differ(slope, out.facing[0])) out.facing[1] = out.facing[0], out.margin[1] = out.margin[0];
    out.facing[0] = slope, out.margin[0] = margin;
  } else if (slope.distance > out.facing[1].distance && differ(slope, out.facing[0])) {
    out.facing[1] = slope, out.margin[1] = margin;
  }
}

void OutlineRuns::look(const Run& run, const Vec2& p, RunAt& out, Foot& nearest, Foot& second) const {
  Foot own;
  out.inside = holds(run, p), out.hollow = run.reach < kInfinity;
  out.behind = {Slope{-kInfinity, {0, 0}}, Slope{-kInfinity, {0, 0}}};
  out.facing = out.behind, out.margin = {-1, -1};
  for (std::size_t i = run.first; i < run.last; ++i) {
    Foot f = foot_on(edges_[i], p);
    if (f.distance < own.distance) own = f;
    // Where two edges of a run meet, the solid is convex, and no point inside has its foot there.
    f.between = f.at_end && (f.point == edges_[i].from ? i > run.first : i + 1 < run.last);
    if (f.distance < nearest.distance) {
      if (!nearest.between) second = nearest;
      nearest = f;
    } else if (f.distance < second.distance && f.point != nearest.point && !f.between) {
      second = f;
    }
    // Signed distance to the half-space that touches the edge at its foot: at most that of K.
    Slope s{glm::dot(p - f.point, f.normal), f.normal, 0, run.reach};
    if (out.hollow) {  // also outside its sector, where rounding requires it
      const Vec2 to_centre = *edges_[i].centre - p;
      const double length = glm::length(to_centre);
      if (length > 0) s = {run.reach - length, to_centre / length, 0, run.reach};
    }
    if (edges_[i].bulge > 0 && !f.at_end) s.curvature = 1 / std::max(edges_[i].bulge + s.distance, 1e-9);
    if (!edges_[i].centre && f.margin >= 0) add_facing(s, f.margin, out);
    if (s.distance > out.behind[0].distance) {
      if (differ(s, out.behind[0])) out.behind[1] = out.behind[0];
      out.behind[0] = s;
    } else if (s.distance > out.behind[1].distance && differ(s, out.behind[0])) {
      out.behind[1] = s;
    }
  }
  if (out.behind[1].distance == -kInfinity) out.behind[1] = out.behind[0];
  out.from_run = own.distance;
  if (out.inside) return;
  if (own.at_end && own.distance > 0)
    out.closed = {own.distance, (p - own.point) / own.distance, 1 / own.distance};
  else
    out.closed = {own.distance, own.normal, own.edge->bulge > 0 ? 1 / (own.edge->bulge + own.distance) : 0};
  for (const End* e : {&run.lower, &run.upper}) {
    const double up = e == &run.lower ? run.lower.point.y - p.y : p.y - run.upper.point.y;
    if (p.x <= e->point.x && up >= 0 && up < out.closed.distance) out.closed = {up, {0, e == &run.lower ? -1 : 1}, 0};
  }
  if (run.reach < kInfinity) {
    out.closed.reach = reach_at(run, out.closed, p - out.closed.distance * out.closed.normal);
    return;
  }
  // From outside, K's foot may be a corner of the run: a steeper bound than any plane. At an end it is no foot on K.
  const auto at_end = [&](const End& e) { return e.open && own.point == e.point; };
  if (out.closed.distance > out.behind[0].distance && out.closed.distance == own.distance && !at_end(run.lower) &&
      !at_end(run.upper))
    out.behind = {out.closed, out.closed};
}

double OutlineRuns::beyond_ends(std::size_t run, double low_rho, double low_z, double high_z) const {
  double low = kInfinity;
  for (const End* e : {&runs_[run].lower, &runs_[run].upper}) {
    if (!e->narrow) continue;
    const bool lower = e == &runs_[run].lower;
    const double first = lower ? low_z - e->point.y : e->point.y - high_z,
                 last = lower ? high_z - e->point.y : e->point.y - low_z;  // mm from the end, into the run
    const double in = e->point.x - std::max(0.0, low_rho), out = -e->way.x, along = std::abs(e->way.y);
    if (last < 0 || in <= 0 || out * in < along * first) continue;
    low = std::min(low, -geom::hypot(in, along * last > out * in ? out / along * in : last));
  }
  return low;
}

OutlineRuns::At OutlineRuns::at(const Vec2& p, RunAt* runs) const {
  Foot nearest, second;
  bool inside = false;
  std::size_t run = 0;
  for (std::size_t j = 0; j < runs_.size(); ++j) {
    const double before = nearest.distance;
    look(runs_[j], p, runs[j], nearest, second);
    if (nearest.distance < before) run = j;
    inside = inside || runs[j].inside;
  }
  const bool outermost = outermost_[static_cast<std::size_t>(nearest.edge - edges_.data())];
  At out{runs[run].closed, nearest.point, nearest.edge->part, run, nearest.margin, outermost, {-kInfinity, {0, 0}}};
  if (inside) {
    static_cast<Slope&>(out) = nearest.depth(p);
    if (second.edge) out.second = second.depth(p);
  } else {
    out.distance = nearest.distance;
  }
  return out;
}

}  // namespace riffler::collide
