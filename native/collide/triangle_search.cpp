#include "collide/triangle_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geom/math.hpp"

namespace riffler::collide {

namespace {

double size_of(const Corners& t) {
  double size = 0;
  for (const Vec3& p : {t.a, t.b, t.c}) size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return size;
}

/// Minimum over a triangle of the maximum of two linear functions, given at its corners: it lies at a corner, or where
/// a side crosses the line on which they are equal.
double least_of_greater(const std::array<double, 3>& f, const std::array<double, 3>& g) {
  double least = kInfinity;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    least = std::min(least, std::max(f[i], g[i]));
    const double here = f[i] - g[i], there = f[j] - g[j];
    if ((here < 0) == (there < 0)) continue;
    const double s = here / (here - there), at = f[i] + s * (f[j] - f[i]);
    least = std::min(least, std::min(at, g[i] + s * (g[j] - g[i])));
  }
  return least;
}

/// A quadratic about a point: value + slope · e + ½ e · bend e.
struct Quadratic {
  double value;
  Vec3 slope;
  Mat3 bend;

  double operator()(const Vec3& e) const { return value + glm::dot(slope, e) + 0.5 * glm::dot(e, bend * e); }
};

Quadratic mix(const Quadratic& a, const Quadratic& b, double share) {
  return {a.value + share * (b.value - a.value), a.slope + share * (b.slope - a.slope),
          a.bend + share * (b.bend - a.bend)};
}

/// Minimum of a convex quadratic about `middle` on a triangle.
Vec3 least_place(const Quadratic& q, const Vec3& middle, const Corners& t) {
  const Vec3 e1 = t.b - t.a, e2 = t.c - t.a, from = t.a - middle;
  const Vec3 h1 = q.bend * e1, h2 = q.bend * e2, slope = q.slope + q.bend * from;
  const double a = glm::dot(e1, h1), b = glm::dot(e1, h2), c = glm::dot(e2, h2), det = a * c - b * b;
  if (det > 1e-12 * a * c) {
    const double f = -glm::dot(slope, e1), g = -glm::dot(slope, e2);
    const double s = (c * f - b * g) / det, u = (a * g - b * f) / det;
    if (s >= 0 && u >= 0 && s + u <= 1) return t.a + s * e1 + u * e2;
  }
  Vec3 best = t.a;
  double least = kInfinity;
  const std::array<Vec3, 3> corner{t.a, t.b, t.c};
  for (int i = 0; i < 3; ++i) {
    const Vec3 p = corner[i], e = corner[(i + 1) % 3] - p;
    const double down = -glm::dot(q.slope + q.bend * (p - middle), e), bend = glm::dot(e, q.bend * e);
    const double s = down <= 0 ? 0 : down >= bend ? 1 : down / bend;
    const Vec3 at = s == 1 ? corner[(i + 1) % 3] : p + s * e;
    if (const double value = q(at - middle); value < least) least = value, best = at;
  }
  return best;
}

/// Minimum of the maximum of two quadratics: the weighted mean of both whose minimum lies where they are equal. The
/// weight is found by false position with a halved end (Dowell and Jarratt, BIT 11 (1971) 168), and by halving where
/// that is slow.
Vec3 least_place(const Quadratic& f, const Quadratic& g, const Vec3& middle, const Corners& t) {
  constexpr int kMost = 40;
  struct End {
    double share, value, ahead;  // of g; f there; how much greater f is
    Vec3 place;

    double bound() const { return value - share * ahead; }  // the mean's minimum
  };
  const auto end = [&](double share, const Vec3& place) {
    const double value = f(place - middle);
    return End{share, value, value - g(place - middle), place};
  };
  End low = end(0, least_place(f, middle, t)), high = end(1, least_place(g, middle, t));
  if (low.ahead >= 0) return low.place;
  if (high.ahead <= 0) return high.place;
  const auto between = [&] { return low.ahead / (low.ahead - high.ahead); };
  double by_low = low.ahead, by_high = high.ahead, before = 1;
  for (int k = 0, side = 0; k < kMost; ++k) {
    const double width = high.share - low.share, part = std::clamp(by_low / (by_low - by_high), 0.01, 0.99);
    const bool slow = k % 2 == 1 && width > 0.5 * before;
    if (k % 2 == 1) before = width;
    const double share = low.share + (slow ? 0.5 : part) * width;
    const End at = end(share, least_place(mix(f, g, share), middle, t));
    if (std::abs(at.ahead) <= 1e-13 * std::abs(at.value)) return at.place;
    if (at.ahead > 0)
      by_low *= side > 0 ? 0.5 : 1, high = at, by_high = at.ahead, side = 1;
    else
      by_high *= side < 0 ? 0.5 : 1, low = at, by_low = at.ahead, side = -1;
    // Between the ends' places neither function is greater than this, and no place is below the bound of either end.
    // Where the functions are not convex a bound may be above: then it proves nothing.
    const double most = low.value + between() * (high.value - low.value);
    if (std::abs(most - std::max(low.bound(), high.bound())) <= 1e-16 * std::abs(most)) break;
  }
  // A flat mean has many minima: the one sought lies between those of slightly larger weights of either function.
  return low.place + between() * (high.place - low.place);
}

}  // namespace

TriangleSearch::Look TriangleSearch::look(const Vec3& p) {
  Look l = look_beside(p);
  if (!on_chord_ && l.at.distance < least_.distance) least_ = {l.at.distance, p, l.at.part};
  return l;
}

TriangleSearch::Look TriangleSearch::look_beside(const Vec3& p) {
  ++cells_;
  const double rho = std::sqrt(p.x * p.x + p.y * p.y);
  // A radius whose square vanishes has no direction.
  Look l{p, rho > 1e-150 ? Vec3(p.x / rho, p.y / rho, 0) : Vec3(0), {rho, p.z}, {}};
  l.at = runs_.at(l.place, at_.data());
  return l;
}

/// Values at the corners of the tangent plane of a slope, minus the corners' drift. That makes them values of a concave
/// function, so the plane through them is a lower bound.
std::array<double, 3> TriangleSearch::plane(const OutlineRuns::Slope& s, const Corners& t, const Look& from) const {
  const Vec3 g = s.normal.x * from.radial + Vec3(0, 0, s.normal.y);
  const auto value = [&](const Vec3& p) {
    return s.distance + glm::dot(g, p - from.point) - (drift_ ? drift_->along(g, p) : 0);
  };
  return {value(t.a), value(t.b), value(t.c)};
}

/// The same for the ball that touches the foot: the distance to its surface is concave.
std::array<double, 3> TriangleSearch::ball(const OutlineRuns::Slope& s, const Corners& t, const Look& from) const {
  const Vec3 out = s.normal.x * from.out() + Vec3(0, 0, s.normal.y), centre = from.point + (s.reach - s.distance) * out;
  const auto value = [&](const Vec3& p) { return s.reach - glm::length(p - centre) - drift_of(p); };
  return {value(t.a), value(t.b), value(t.c)};
}

/// The depth at a point is at most its distance from any one point of the surface. As a negative number, the distance
/// from the foot is concave, so the plane through its values at the corners is a lower bound. The depth is also at most
/// the distance from the foot's edge, if all feet on that edge lie between its ends. For a hollow this is the bound of
/// a ball, otherwise that of a plane, as long as the points are on the edge's inner side: all of them, or those that
/// are as near to p as the edge is.
std::array<double, 3> TriangleSearch::outer(const Corners& t, const Look& from, double radius) const {
  if (from.at.margin >= radius && (from.at.outermost || from.at.distance + radius <= 0))
    return from.at.reach < kInfinity ? ball(from.at, t, from) : plane(from.at, t, from);
  const Vec3 foot = from.at.foot.x * from.out() + Vec3(0, 0, from.at.foot.y);
  const auto value = [&](const Vec3& p) { return -glm::length(p - foot) - drift_of(p); };
  return {value(t.a), value(t.b), value(t.c)};
}

/// Bound for a triangle with feet beyond a run's ends: outer(), or planes of edges that have all feet between their
/// ends.
double TriangleSearch::by_facing(const OutlineRuns::RunAt& at, const Corners& t, const Look& from, double radius,
                                 const std::array<double, 3>& outer) const {
  if (at.margin[0] < radius) return std::min({outer[0], outer[1], outer[2]});
  const std::array<double, 3> first = plane(at.facing[0], t, from);
  const double by_first = least_of_greater(outer, first);
  return at.margin[1] < radius ? by_first : std::max(by_first, least_of_greater(first, plane(at.facing[1], t, from)));
}

/// Bound for a triangle with feet beyond a run's ends: those points of the run's solid by beyond_ends(), all others by
/// the planes.
double TriangleSearch::by_zones(std::size_t run, const Corners& t, const Look& from) const {
  const auto rho = [&](const Vec3& p) { return glm::dot(p, from.radial); };
  const double beyond = runs_.beyond_ends(run, std::min({rho(t.a), rho(t.b), rho(t.c)}),
                                          std::min({t.a.z, t.b.z, t.c.z}), std::max({t.a.z, t.b.z, t.c.z}));
  return std::min(beyond, least_of_greater(plane(at_[run].behind[0], t, from), plane(at_[run].behind[1], t, from)));
}

double TriangleSearch::run_bound(std::size_t run, const Corners& t, const Look& from, double radius,
                                 const std::array<double, 3>& outer) const {
  const OutlineRuns::RunAt& at = at_[run];
  // The ball that touches the foot from outside without entering the run's solid; a half-space for a convex run.
  const auto closed = [&] {
    const double far = at.closed.distance - radius;
    if (at.closed.distance >= at.closed.reach) return far;
    const std::array<double, 3> by = at.closed.reach < kInfinity ? ball(at.closed, t, from) : plane(at.closed, t, from);
    const double least = std::min({by[0], by[1], by[2]});
    return at.closed.reach < kInfinity ? std::max(far, least) : least;
  };
  if (!at.inside && at.closed.distance >= radius) return closed();
  if (!runs_.behind_ends(run, at, from.place, radius) && !(at.hollow && in_sector(run, t, from))) {
    if (!at.inside)
      if (const double by_closed = closed(); by_closed >= 0) return by_closed;
    return std::max(by_facing(at, t, from, radius, outer), at.hollow || drift_ ? -kInfinity : by_zones(run, t, from));
  }
  if (at.hollow) return least_of_greater(ball(at.behind[0], t, from), outer);
  const std::array<double, 3> first = plane(at.behind[0], t, from);
  const double by_steps = least_of_greater(first, plane(at.behind[1], t, from));
  return from.at.distance < 0 ? std::max(by_steps, least_of_greater(first, outer)) : by_steps;
}

/// How far a run's solid is at least, or how deep the triangle is at most below one of its planes.
double TriangleSearch::solid_bound(std::size_t run, const Corners& t, const Look& from, double radius) const {
  const OutlineRuns::RunAt& at = at_[run];
  if (at.hollow) return !at.inside && at.closed.distance >= radius ? at.closed.distance - radius : -kInfinity;
  return least_of_greater(plane(at.behind[0], t, from), plane(at.behind[1], t, from));
}

/// From the corners alone: ρ is convex. Where a larger ρ could leave the sector, its maximum is at a corner; where a
/// smaller ρ could, it is at least the component along the radial direction.
bool TriangleSearch::in_sector(std::size_t run, const Corners& t, const Look& from) const {
  if (drift_) return false;
  const auto in = [&](const Vec3& p) {
    return runs_.in_sector(run, std::sqrt(p.x * p.x + p.y * p.y), glm::dot(p, from.radial), p.z);
  };
  return in(t.a) && in(t.b) && in(t.c);
}

double TriangleSearch::lower(const Corners& t, const Look& from) const {
  const double radius = farthest(t, from.point) + std::max({drift_of(t.a), drift_of(t.b), drift_of(t.c)});
  const std::array<double, 3> by_surface = outer(t, from, radius);
  double by_runs = kInfinity, least = kInfinity, second = kInfinity;
  for (std::size_t j = 0; j < runs_.size(); ++j) {
    by_runs = std::min(by_runs, run_bound(j, t, from, radius, by_surface));
    const double far = solid_bound(j, t, from, radius);
    second = std::min(second, std::max(least, far)), least = std::min(least, far);
  }
  // Below one run's plane the way out of its solid leaves the tool where the others are at least as far.
  if (second >= -least) by_runs = std::max(by_runs, least);
  return std::max(by_runs, from.at.distance - radius);
}

double TriangleSearch::bound(const Corners& t) {
  return lower(t, look((t.a + t.b + t.c) / 3.0));
}

double TriangleSearch::bound(const Corners& t, const Drift& drift) {
  drift_ = &drift;
  const Look middle = look((t.a + t.b + t.c) / 3.0);
  double low = lower(t, middle);
  const Look lowest = downhill(t, middle);
  if (lowest.point != middle.point) low = std::max(low, lower(t, look(lowest.point)));
  drift_ = nullptr;
  return low;
}

/// Newton's method on the triangle while the distance falls. Inside, near an inner corner of the tool, the distance is
/// the maximum of two.
TriangleSearch::Look TriangleSearch::downhill(const Corners& t, Look from) {
  const double enough = 0.1 * slack(size_of(t));
  const auto model = [&](const OutlineRuns::Slope& s) {
    const Vec3 meridian = Vec3(0, 0, s.normal.x) - s.normal.y * from.radial, round(-from.radial.y, from.radial.x, 0);
    const double around = std::max(0.0, s.normal.x) / std::max(from.place.x, 1e-9);
    const Vec3 normal = s.normal.x * from.radial + Vec3(0, 0, s.normal.y);
    // Along the normal, too, so that steps do not end beyond the minimum: as in lowest_places.cpp.
    return Quadratic{s.distance, normal,
                     s.curvature * glm::outerProduct(meridian, meridian) + around * glm::outerProduct(round, round) +
                         std::max(s.curvature, around) * glm::outerProduct(normal, normal)};
  };
  for (int step = 0; step < 10; ++step) {
    const OutlineRuns::Slope& second = from.at.second;
    const bool two = second.distance + 2 * farthest(t, from.point) > from.at.distance;
    const Vec3 next =
        two ? least_place(model(from.at), model(second), from.point, t) : least_place(model(from.at), from.point, t);
    if (next == from.point) break;
    const Look there = look(next);
    const double won = from.at.distance - there.at.distance;
    if (won > 0 || (won == 0 && step == 0)) from = there;
    if (won <= enough) break;
  }
  return from;
}

/// Halves a cell across its longest side; false if rounding leaves nothing to halve.
bool TriangleSearch::halve(const Corners& s, double low) {
  const double ab = glm::length(s.b - s.a), bc = glm::length(s.c - s.b), ca = glm::length(s.a - s.c);
  const double longest = std::max({ab, bc, ca});
  if (longest <= 1e-15 * size_of(s)) return false;
  if (glm::length(glm::cross(s.b - s.a, s.c - s.a)) <= 1e-12 * longest) {  // degenerate: a line
    const auto [p, q] = ab == longest ? std::pair(s.a, s.b) : bc == longest ? std::pair(s.b, s.c) : std::pair(s.c, s.a);
    const Vec3 m = 0.5 * (p + q);
    push({{p, m, m}, low}), push({{m, q, q}, low});
    return true;
  }
  if (ab == longest) {
    const Vec3 m = 0.5 * (s.a + s.b);
    push({{s.a, m, s.c}, low}), push({{m, s.b, s.c}, low});
  } else if (bc == longest) {
    const Vec3 m = 0.5 * (s.b + s.c);
    push({{s.a, s.b, m}, low}), push({{s.a, m, s.c}, low});
  } else {
    const Vec3 m = 0.5 * (s.c + s.a);
    push({{s.a, s.b, m}, low}), push({{m, s.b, s.c}, low});
  }
  return true;
}

void TriangleSearch::push(const Cell& cell) {
  heap_.push_back(cell);
  std::push_heap(heap_.begin(), heap_.end());
}

void TriangleSearch::search(const Corners& t, double low_of_all, Deadline& deadline) {
  const double near = std::max(slack(size_of(t)), loose_);
  const std::size_t before = cells_;
  const auto enough_cells = [&] {
    return cells_ > before + kMaxCells &&
           (heap_.front().low >= least_.distance - kLeftOut || cells_ > before + kMostCells);
  };
  heap_.assign(1, {t, low_of_all});
  while (!heap_.empty() && heap_.front().low < least_.distance - near && least_.distance >= enough_) {
    if (enough_cells() || deadline.passed()) {
      left_ = std::min(left_, heap_.front().low);
      return;
    }
    std::pop_heap(heap_.begin(), heap_.end());
    const Cell cell = heap_.back();
    heap_.pop_back();
    const Look middle = look((cell.t.a + cell.t.b + cell.t.c) / 3.0);
    double low = std::max(cell.low, lower(cell.t, middle));
    const auto done = [&] { return low >= least_.distance - near; };
    if (done()) continue;
    const Look lowest = downhill(cell.t, middle);
    if (lowest.point != middle.point) low = std::max(low, lower(cell.t, look(lowest.point)));
    if (done()) continue;
    // The axis is another kink, which Newton's method overshoots. The tool occupies everything between its outline and
    // the axis; moving a ball inside it towards the axis, or a ball outside it away from the axis, keeps it inside or
    // outside. No point is therefore lower than the axis point at its height.
    if (lowest.place.x < farthest(cell.t, lowest.point)) {
      const auto on_axis = [](const Vec3& p) { return Vec3(0, 0, p.z); };
      low = std::max(
          low, lower({on_axis(cell.t.a), on_axis(cell.t.b), on_axis(cell.t.c)}, look_beside(on_axis(lowest.point))));
      if (done()) continue;
      const Quadratic square{0, middle.place.x * middle.radial, Mat3(1, 0, 0, 0, 1, 0, 0, 0, 0)};
      low = std::max(low, lower(cell.t, look(least_place(square, middle.point, cell.t))));
      if (done()) continue;
    }
    halve(cell.t, low);
  }
}

}  // namespace riffler::collide
