#include "riffler/tool/outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/functions.hpp"
#include "base/sort_unique.hpp"

namespace riffler::tool {

namespace {

bool reaches(const OutlineEdge& e, double z) {
  return e.from.y <= z && z <= e.to.y;
}

std::vector<OutlineEdge> curves_of(const Tool& tool) {
  std::vector<OutlineEdge> out;
  Vec2 from{0, 0};
  for (const ProfileSegment& s : tool.profile().segments()) {
    // Heights rise along an arc of a profile, so the arc is entirely on one side of its centre.
    const double side = s.centre && from.x + s.to.x < 2 * s.centre->x ? -1 : 1;
    const double bulge = s.centre ? side * glm::length(from - *s.centre) : 0;
    if (s.to.y > from.y) out.push_back({from, s.to, s.centre, bulge, Part::Cutter});
    from = s.to;
  }
  const auto add = [&](const std::vector<Frustum>& pieces, Part part) {
    for (const Frustum& f : pieces) out.push_back({{f.r0, f.z0}, {f.r1, f.z1}, {}, 0, part});
  };
  add(tool.shank(), Part::Shank), add(tool.holder(), Part::Holder);
  return out;
}

/// Heights at which a line, or the circle about `c`, meets the circle about `centre`.
void meet_line(const OutlineEdge& line, const Vec2& centre, double radius, std::vector<double>& heights) {
  const Vec2 way = line.to - line.from, off = line.from - centre;
  const double a = glm::dot(way, way), b = glm::dot(way, off), c = glm::dot(off, off) - radius * radius;
  const double disc = b * b - a * c;
  if (disc < 0) return;
  for (const double sign : {-1.0, 1.0}) heights.push_back(line.from.y + way.y * (-b + sign * std::sqrt(disc)) / a);
}

void meet_circle(const Vec2& c, double r, const Vec2& centre, double radius, std::vector<double>& heights) {
  const Vec2 apart = centre - c;
  const double square = glm::dot(apart, apart);
  if (square == 0) return;
  const double along = (square + r * r - radius * radius) / (2 * square), rest = r * r / square - along * along;
  if (rest < 0) return;
  for (const double sign : {-1.0, 1.0}) heights.push_back(c.y + along * apart.y + sign * std::sqrt(rest) * apart.x);
}

/// Heights between which no two curves cross, ascending.
std::vector<double> levels(const std::vector<OutlineEdge>& curves) {
  std::vector<double> out;
  for (const OutlineEdge& a : curves) {
    out.push_back(a.from.y), out.push_back(a.to.y);
    for (const OutlineEdge& b : curves) {
      const double low = std::max(a.from.y, b.from.y), high = std::min(a.to.y, b.to.y);
      if (&a <= &b || !(low < high)) continue;
      std::vector<double> crossings;
      if (a.centre && b.centre) {
        meet_circle(*a.centre, std::abs(a.bulge), *b.centre, std::abs(b.bulge), crossings);
      } else if (a.centre || b.centre) {
        const OutlineEdge &arc = a.centre ? a : b, &line = a.centre ? b : a;
        meet_line(line, *arc.centre, std::abs(arc.bulge), crossings);
      } else {
        const double below = radius_at(a, low) - radius_at(b, low), above = radius_at(a, high) - radius_at(b, high);
        if (below != above) crossings.push_back(low + (high - low) * below / (below - above));
      }
      for (const double z : crossings)
        if (low < z && z < high) out.push_back(z);
    }
  }
  base::sort_unique(out);
  return out;
}

/// The nearest foot on the edges examined so far.
class Search {
 public:
  explicit Search(const Vec2& p) : p_(p) {}

  void add(const OutlineEdge& e) {
    if (e.centre ? on_arc(e) : on_line(e)) return;
    corner(e.from, e), corner(e.to, e);
  }
  Outline::Nearest found(bool inside) const {
    const double sign = inside ? -1 : 1, d = std::sqrt(square_);
    const Vec2 out = (p_ - point_) * sign;
    return {sign * d, point_, on_corner_ && d > 0 ? out / d : normal_, part_};
  }

 private:
  bool on_line(const OutlineEdge& e) {
    const Vec2 way = e.to - e.from, w = p_ - e.from;
    const double length = glm::dot(way, way), along = glm::dot(w, way);
    if (along < 0 || along > length) return false;
    const Vec2 foot = e.from + way * (along / length);
    take(foot, Vec2(way.y, -way.x) / std::sqrt(length), e.part, false);
    return true;
  }
  bool on_arc(const OutlineEdge& e) {
    const Vec2 w = p_ - *e.centre;
    const double length = glm::length(w), side = e.bulge > 0 ? 1 : -1;
    if (length == 0 || !faces(e, p_)) return false;
    const Vec2 out = w / length;
    take(*e.centre + std::abs(e.bulge) * out, side * out, e.part, false);
    return true;
  }
  void corner(const Vec2& c, const OutlineEdge& e) {
    const Vec2 way = e.to - e.from;
    take(c, Vec2(way.y, -way.x) / glm::length(way), e.part, true);
  }
  void take(const Vec2& foot, const Vec2& normal, Part part, bool on_corner) {
    const Vec2 off = p_ - foot;
    const double square = glm::dot(off, off);
    if (!(square < square_)) return;
    square_ = square, point_ = foot, normal_ = normal, part_ = part, on_corner_ = on_corner;
  }

  Vec2 p_, point_{0, 0}, normal_{0, 0};
  double square_ = std::numeric_limits<double>::infinity();
  Part part_ = Part::Cutter;
  bool on_corner_ = false;
};

}  // namespace

bool faces(const OutlineEdge& arc, const Vec2& p) {
  const Vec2 w = p - *arc.centre, from = arc.from - *arc.centre, to = arc.to - *arc.centre;
  const double side = arc.bulge > 0 ? 1 : -1;
  return side * (from.x * w.y - from.y * w.x) >= 0 && side * (w.x * to.y - w.y * to.x) >= 0;
}

double radius_at(const OutlineEdge& e, double z) {
  if (!e.centre) return e.from.x + (e.to.x - e.from.x) * ((z - e.from.y) / (e.to.y - e.from.y));
  const double up = z - e.centre->y, r = std::abs(e.bulge), half = std::sqrt(std::max(0.0, (r - up) * (r + up)));
  return std::max(0.0, e.centre->x + (e.bulge > 0 ? half : -half));
}

Outline::Outline(const Tool& tool) {
  const std::vector<OutlineEdge> curves = curves_of(tool);
  const std::vector<double> heights = levels(curves);
  double radius = 0;  // current radius of the outline
  Part part = Part::Cutter;
  const auto step = [&](double to, double z, Part next) {
    if (to != radius) edges_.push_back({{radius, z}, {to, z}, {}, 0, to > radius ? next : part});
    radius = to, part = next;
  };
  const OutlineEdge* last = nullptr;
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
    const double low = heights[k], high = heights[k + 1], middle = 0.5 * (low + high);
    const OutlineEdge* widest = nullptr;
    for (const OutlineEdge& e : curves)
      if (reaches(e, middle) && (!widest || radius_at(e, middle) > radius_at(*widest, middle))) widest = &e;
    if (!widest) {
      step(0, low, part);
    } else if (widest == last) {
      edges_.back().to = {radius_at(*widest, high), high};
    } else {
      // Keep the given end points of curves, so that neighbours meet without a step.
      step(low == widest->from.y ? widest->from.x : radius_at(*widest, low), low, widest->part);
      edges_.push_back(*widest);
      edges_.back().from = {radius, low}, edges_.back().to = {radius_at(*widest, high), high};
    }
    if (widest && high == widest->to.y) edges_.back().to = widest->to;
    radius = widest ? edges_.back().to.x : 0;
    last = widest;
  }
  step(0, heights.back(), part);
}

bool Outline::inside(double rho, double z) const {
  return std::any_of(edges_.begin(), edges_.end(), [&](const OutlineEdge& e) {
    return e.from.y < e.to.y && reaches(e, z) && rho <= radius_at(e, z);
  });
}

Outline::Nearest Outline::nearest(double rho, double z) const {
  Search search({rho, z});
  for (const OutlineEdge& e : edges_) search.add(e);
  return search.found(inside(rho, z));
}

std::vector<Vec2> polyline(const OutlineEdge& edge, double tolerance) {
  std::vector<Vec2> out{edge.from};
  if (edge.centre) {
    // from the sagitta r (1 − cos(turn / 2)) of a chord
    const Vec2 a = edge.from - *edge.centre, b = edge.to - *edge.centre;
    const double r = std::abs(edge.bulge), turn = base::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
    const double most = 4 * base::asin(std::sqrt(std::min(0.5, tolerance / (2 * r))));
    const int steps = static_cast<int>(std::min(1e4, std::ceil(std::abs(turn) / most)));
    for (int k = 1; k < steps; ++k) {
      const double c = base::cos(turn * k / steps), s = base::sin(turn * k / steps);
      out.push_back(*edge.centre + Vec2(a.x * c - a.y * s, a.x * s + a.y * c));
    }
  }
  out.push_back(edge.to);
  return out;
}

}  // namespace riffler::tool
