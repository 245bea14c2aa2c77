#include "collide/outline_runs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace riffler {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double area(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}

/// Direction of the way along an edge at one of its points.
Vec2 tangent(const OutlineEdge& e, const Vec2& p) {
  if (!e.centre) return glm::normalize(e.to - e.from);
  const Vec2 out = (p - *e.centre) / e.bulge;
  return {-out.y, out.x};
}

bool hollow(const OutlineEdge& e) {
  return e.centre && e.bulge < 0;
}

/// Whether the outline turns towards the solid, or not at all, from one edge to the next.
bool goes_on(const OutlineEdge& a, const OutlineEdge& b) {
  return a.to == b.from && !hollow(a) && !hollow(b) && area(tangent(a, a.to), tangent(b, b.from)) >= -1e-12;
}

}  // namespace

/// The nearest point of an edge; `normal` is that of the edge there, out of the solid.
struct OutlineRuns::Foot {
  Vec2 point{0}, normal{0};
  double distance = kInfinity;
  bool at_end = false;
  double margin = -1;  // of a foot on a line, from its ends off the axis
  const OutlineEdge* edge = nullptr;
};

OutlineRuns::OutlineRuns(std::vector<OutlineEdge> edges) : edges_(std::move(edges)) {
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const OutlineEdge& e = edges_[i];
    const Vec2 start = tangent(e, e.from), end = tangent(e, e.to);
    if (i == 0 || !goes_on(edges_[i - 1], e))
      runs_.push_back(
          {i, i, hollow(e) ? -e.bulge : kInfinity, {e.from, -start, {start.y, -start.x}, e.from.x > 0}, {}});
    runs_.back().last = i + 1;
    runs_.back().upper = {e.to, end, {end.y, -end.x}, e.to.x > 0};
  }
}

OutlineRuns::Foot OutlineRuns::foot_on(const OutlineEdge& e, const Vec2& p) const {
  Foot f;
  f.edge = &e;
  if (e.centre) {
    const Vec2 w = p - *e.centre;
    const double length = glm::length(w), r = std::abs(e.bulge), side = e.bulge > 0 ? 1 : -1;
    if (length > 0) {
      f.point = *e.centre + r / length * w;
      if (side * w.x >= 0 && f.point.y >= e.from.y && f.point.y <= e.to.y) {
        f.normal = side / length * w, f.distance = std::abs(length - r);
        return f;
      }
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
    const OutlineEdge& e = edges_[i];
    if (e.from.y < e.to.y && e.from.y <= p.y && p.y <= e.to.y) return p.x <= radius_at(e, p.y);
  }
  return false;
}

/// Of a hollow: at an end, the ball may be as large as the other end lets it, but for the hollow's own radius.
double OutlineRuns::reach_at(const Run& run, const Slope& closed, const Vec2& foot) const {
  double reach = kInfinity;
  for (const Vec2& end : {run.lower.point, run.upper.point}) {
    const Vec2 way = end - foot;
    const double ahead = glm::dot(way, closed.normal);
    if (ahead > 0) reach = std::min(reach, glm::dot(way, way) / (2 * ahead));
  }
  return std::max(reach, run.reach);
}

void OutlineRuns::look(const Run& run, const Vec2& p, RunAt& out, Foot& nearest) const {
  Foot own;
  out.inside = holds(run, p);
  out.behind = {Slope{-kInfinity, {0, 0}}, Slope{-kInfinity, {0, 0}}};
  out.facing = out.behind[0], out.margin = -1;
  out.reach = run.reach;
  for (std::size_t i = run.first; i < run.last; ++i) {
    const Foot f = foot_on(edges_[i], p);
    if (f.distance < own.distance) own = f;
    // Signed distance to the half-space that touches the edge in its foot: of K at the greatest.
    Slope s{glm::dot(p - f.point, f.normal), f.normal};
    if (edges_[i].bulge > 0 && !f.at_end) s.curvature = 1 / std::max(edges_[i].bulge + s.distance, 1e-9);
    if (f.margin >= 0 && s.distance > out.facing.distance) out.facing = s, out.margin = f.margin;
    // Steps that meet smoothly share a plane; the second is to say something else.
    const auto differs = [&](const Slope& o) { return glm::dot(o.normal, s.normal) < 1 - 1e-6; };
    if (s.distance > out.behind[0].distance) {
      if (differs(out.behind[0])) out.behind[1] = out.behind[0];
      out.behind[0] = s;
    } else if (s.distance > out.behind[1].distance && differs(out.behind[0])) {
      out.behind[1] = s;
    }
  }
  if (out.behind[1].distance == -kInfinity) out.behind[1] = out.behind[0];
  out.from_run = own.distance;
  if (own.distance < nearest.distance) nearest = own;
  if (out.inside) return;
  if (own.at_end && own.distance > 0)
    out.closed = {own.distance, (p - own.point) / own.distance, 1 / own.distance};
  else
    out.closed = {own.distance, own.normal, own.edge->bulge > 0 ? 1 / (own.edge->bulge + own.distance) : 0};
  for (const End* e : {&run.lower, &run.upper}) {
    const double up = e == &run.lower ? run.lower.point.y - p.y : p.y - run.upper.point.y;
    if (p.x <= e->point.x && up >= 0 && up < out.closed.distance) out.closed = {up, {0, e == &run.lower ? -1 : 1}, 0};
  }
  if (run.reach < kInfinity) out.reach = reach_at(run, out.closed, p - out.closed.distance * out.closed.normal);
  // From outside, K's foot may be a corner of the run: steeper than any of the planes.
  if (out.closed.distance > out.behind[0].distance && out.closed.distance == own.distance)
    out.behind = {out.closed, out.closed};
}

OutlineRuns::At OutlineRuns::at(const Vec2& p, RunAt* runs) const {
  Foot nearest;
  bool inside = false;
  std::size_t run = 0;
  for (std::size_t j = 0; j < runs_.size(); ++j) {
    const double before = nearest.distance;
    look(runs_[j], p, runs[j], nearest);
    if (nearest.distance < before) run = j;
    inside = inside || runs[j].inside;
  }
  At out{{}, nearest.point, nearest.edge->part, run};
  static_cast<Slope&>(out) = inside ? Slope{-nearest.distance, nearest.normal} : runs[run].closed;
  out.distance = inside ? -nearest.distance : nearest.distance;
  if (inside && nearest.at_end && nearest.distance > 0) out.normal = (nearest.point - p) / nearest.distance;
  if (inside && !nearest.at_end && nearest.edge->bulge > 0)
    out.curvature = 1 / std::max(nearest.edge->bulge - nearest.distance, 1e-9);
  return out;
}

}  // namespace riffler
