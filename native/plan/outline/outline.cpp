#include "riffler/plan/outline.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "plan/lead_arc.hpp"
#include "plan/operation_moves.hpp"
#include "plan/outline/offset.hpp"
#include "riffler/base/check.hpp"
#include "riffler/mesh/orient.hpp"
#include "riffler/plan/drop.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::plan {

namespace {

constexpr double kMostPlaces = 4e6;
constexpr double kThin = 1e-6;      // mm: thinner layers are not cut
constexpr double kShortest = 0.05;  // mm: smallest piece of a loop
constexpr double kPin = 0.1;        // mm, diameter of a pin that probes for stock in openings
constexpr double kLeadShare = 0.5;  // radius of arcs without the option, as a share of the cutter's

void check(const OutlineOptions& o, const Tool& tool) {
  base::require_not_negative(o.depth, "depth", base::kFiniteAndNotNegative);
  base::require_length(o.stepdown, "stepdown");
  base::require_not_negative(o.tab_height, "tab_height", base::kFiniteAndNotNegative);
  base::require_length(o.tab_width, "tab_width");
  base::require_not_negative(o.allowance, "allowance", base::kFiniteAndNotNegative);
  base::require_tolerance(o.tolerance);
  base::require_tolerance_for(o.tolerance, tool.length() + tool.diameter());
  base::require_positive(o.feed, "feed", base::kPositiveAndFinite);
  base::require_positive(o.plunge, "plunge", base::kPositiveAndFinite);
  if (o.lead) base::require_not_negative(*o.lead, "lead", base::kFiniteAndNotNegative);
  if (!(o.slope > 0 && o.slope < kPi / 2)) throw std::invalid_argument("slope must be an angle in rad from 0 to π/2");
  require_upright_cutter(tool, "an outline");
}

/// The shape from which the loops keep their distance.
struct Shape {
  std::vector<std::vector<Vec2>> curves;
  std::vector<SetBorder::Segment> segments;
  double top = 0;  ///< height of the highest point, z of the frame, mm
};

Shape shape_of(const TurnedScene& in, const OutlineOptions& options) {
  Shape out;
  if (options.curves.empty()) {
    out.segments = silhouette_segments(in.part), out.top = mesh::bounds(in.part).upper.z;
    return out;
  }
  out.top = -kInfinity;
  for (std::size_t k = 0; k < options.curves.size(); ++k) {
    const std::string name = "curves[" + std::to_string(k) + "]";
    if (options.curves[k].size() < 3) throw std::invalid_argument(name + " has fewer than three points");
    auto& curve = out.curves.emplace_back();
    for (const Vec3& p : options.curves[k]) {
      if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
        throw std::invalid_argument(name + " has a point that is not finite");
      const Vec3 here = p * in.frame;
      curve.emplace_back(here), out.top = std::max(out.top, here.z);
    }
  }
  out.segments = curve_segments(out.curves);
  return out;
}

/// A grid for the loops, fine enough for the tool and the border.
PlaceGrid grid_around(const SetBorder& border, double distance) {
  const double room = 2 * distance;
  const Vec2 size = border.upper() - border.lower() + Vec2(2 * room);
  PlaceGrid out;
  out.spacing = std::max(distance / 8, std::sqrt(size.x * size.y / kMostPlaces));
  out.lower = border.lower() - Vec2(room + 0.37 * out.spacing, room + 0.29 * out.spacing);
  out.columns = static_cast<int>(size.x / out.spacing) + 3, out.rows = static_cast<int>(size.y / out.spacing) + 3;
  return out;
}

double area(const std::vector<Vec2>& loop) {
  double out = 0;
  for (std::size_t k = 0, j = loop.size() - 1; k < loop.size(); j = k++)
    out += loop[j].x * loop[k].y - loop[k].x * loop[j].y;
  return 0.5 * out;
}

/// A loop whose points are found by their distance along it from its first point.
class Loop {
 public:
  explicit Loop(std::vector<Vec2> points) : points_(std::move(points)), at_{0} {
    points_.push_back(points_.front());
    for (std::size_t k = 1; k < points_.size(); ++k)
      at_.push_back(at_.back() + glm::length(points_[k] - points_[k - 1]));
  }
  double length() const { return at_.back(); }
  const std::vector<double>& at() const { return at_; }
  Vec2 point(double s) const {
    s = std::fmod(s, length());
    const auto k = static_cast<std::size_t>(std::upper_bound(at_.begin(), at_.end(), s) - at_.begin());
    if (k >= points_.size()) return points_.back();
    const double way = at_[k] - at_[k - 1];
    return way > 0 ? glm::mix(points_[k - 1], points_[k], (s - at_[k - 1]) / way) : points_[k];
  }

 private:
  std::vector<Vec2> points_;
  std::vector<double> at_;
};

/// Ranges along the loop, from and to, of the cutter's axis.
using Ranges = std::vector<std::pair<double, double>>;

class Cutter {
 public:
  Cutter(OutlineResult& out, const TurnedScene& in, const Tool& tool, const OutlineOptions& options,
         const SetBorder& border, const Mesh& stock, double pitch)
      : out_(out),
        in_(in),
        options_(options),
        border_(border),
        radius_(0.5 * tool.diameter()),
        lead_(options.lead.value_or(kLeadShare * radius_)),
        pitch_(pitch),
        part_triangles_(in.part.triangles.size()),
        obstacles_(joined(in.part, in.fixtures), tool, {0, 0, 1}, options.allowance),
        stock_(stock, cutters::flat(tool.diameter(), tool.length())),
        moves_(out, in.frame, options.feed, options.plunge) {}

  /// Cuts one loop in layers down to `bottom`. Returns whether there was material to cut.
  bool cut(const Loop& loop, double bottom) {
    const double top = top_over(loop, bottom);
    if (top - bottom < kThin) return false;
    const auto layers = static_cast<std::size_t>(std::ceil((top - bottom) / options_.stepdown - 1e-9));
    const Ranges tabs = tabs_on(loop);
    const Ranges free = free_on(loop, bottom);
    if (free.empty()) return true;
    const bool whole = free.size() == 1 && free.front().second - free.front().first >= loop.length() - kThin;
    double before = top;
    for (std::size_t k = 1; k <= layers; ++k) {
      const double z =
          k == layers ? bottom : top - static_cast<double>(k) * (top - bottom) / static_cast<double>(layers);
      if (whole)
        around(loop, before, z, k == 1, bottom, tabs);
      else
        for (const auto& [from, to] : free) stretch(loop, from, to, z, top, bottom, tabs);
      before = z, ++out_.levels;
    }
    if (whole) {
      const double back = std::min(0.1 * radius_, 0.1 * loop.length());
      if (moves_.last().z <= bottom + kThin) arc_away(loop.point(start_ + loop.length() - back));
      leave();
    }
    ++out_.loops, out_.tabs += tabs.size();
    return true;
  }

 private:
  /// The highest place of the stock that the cutter meets along the loop; `bottom` if there is none.
  double top_over(const Loop& loop, double bottom) const {
    double top = bottom;
    const double step = std::max(0.5 * pitch_, loop.length() / 20000);
    for (double s = 0; s < loop.length(); s += step)
      if (const DropCutter::Landing found = stock_(Vec3(loop.point(s), 0)); found.touches)
        top = std::max(top, found.height + pitch_);
    return top - bottom <= pitch_ + kThin ? bottom : top;
  }
  /// Ranges of the tabs, at equal distances; fewer than requested if the loop is too short.
  Ranges tabs_on(const Loop& loop) {
    const double wide = options_.tab_width + 2 * radius_;
    const auto fit = static_cast<std::size_t>(loop.length() / (wide + options_.tab_width));
    const std::size_t count = std::min(options_.tabs, fit);
    if (count < options_.tabs)
      out_.blocked.push_back(
          {"only " + std::to_string(count) + " of " + std::to_string(options_.tabs) + " tabs fit on the loop",
           in_.frame * Vec3(loop.point(0), 0), 0});
    Ranges out;
    for (std::size_t k = 0; k < count; ++k) {
      const double middle = (static_cast<double>(k) + 0.5) * loop.length() / static_cast<double>(count);
      out.emplace_back(middle - 0.5 * wide, middle + 0.5 * wide);
    }
    return out;
  }
  /// The stretches of the loop where nothing obstructs the tool down to `bottom`. Adds the others to `blocked`.
  Ranges free_on(const Loop& loop, double bottom) {
    const double step = std::min(0.25 * radius_, 1.0);
    const auto count = static_cast<std::size_t>(std::ceil(loop.length() / step));
    std::vector<char> clear(count);
    for (std::size_t k = 0; k < count; ++k) {
      const double a = loop.length() * static_cast<double>(k) / static_cast<double>(count),
                   b = loop.length() * static_cast<double>(k + 1) / static_cast<double>(count);
      clear[k] = clear_between(loop, a, b, bottom);
    }
    const double share = loop.length() / static_cast<double>(count);
    Ranges out;
    if (std::all_of(clear.begin(), clear.end(), [](char c) { return c != 0; })) return {{0, loop.length()}};
    std::size_t start = 0;  // index of the first piece of a run of blocked pieces
    while (start < count && (clear[start] || !clear[(start + count - 1) % count])) ++start;
    start %= count;
    for (std::size_t k = 0; k < count;) {
      const std::size_t first = (start + k) % count;
      std::size_t end = k;
      while (end < count && clear[(start + end) % count] == clear[first]) ++end;
      const double from = static_cast<double>(start + k) * share, to = static_cast<double>(start + end) * share;
      if (clear[first] && to - from > kShortest)
        out.emplace_back(from, to);
      else if (!clear[first])
        add_blocked(loop, from, to, bottom);
      k = end;
    }
    return out;
  }
  bool clear_between(const Loop& loop, double a, double b, double z) const {
    Vec2 from = loop.point(a);
    const auto pass = [&](const Vec2& to) {
      const bool ok =
          obstacles_.rise(Vec3(from, z), Vec3(to, z), 0.1 * options_.tolerance).above <= 0.1 * options_.tolerance;
      from = to;
      return ok;
    };
    for (auto k = std::upper_bound(loop.at().begin(), loop.at().end(), a + kThin);
         k != loop.at().end() && *k < b - kThin; ++k)
      if (!pass(loop.point(*k))) return false;
    return pass(loop.point(b));
  }
  void add_blocked(const Loop& loop, double from, double to, double bottom) {
    std::string reason = "the cutter meets the part";
    const Vec2 p = loop.point(0.5 * (from + to));
    if (const DropCutter::Landing found = obstacles_(Vec3(p, 0)); found.touches) {
      if (static_cast<std::size_t>(found.triangle) >= part_triangles_)
        reason = "the tool meets a fixture";
      else if (found.part != tool::Part::Cutter)
        reason = found.part == tool::Part::Shank ? "the shank meets the part" : "the holder meets the part";
    }
    out_.blocked.push_back({reason, in_.frame * Vec3(loop.point(from), bottom), to - from});
  }
  double height(double s, double z, double bottom, const Ranges& tabs, double length) const {
    const double tab = bottom + options_.tab_height;
    if (z >= tab) return z;
    const double at = std::fmod(s, length);
    for (const auto& [from, to] : tabs)
      if (at > from && at < to) return tab;
    return z;
  }
  /// Distances between `from` and `to` along the loop at which height or direction changes.
  std::vector<double> stops(const Loop& loop, double from, double to, const Ranges& tabs) const {
    std::vector<double> out{to};
    for (double lap = std::floor(from / loop.length()) * loop.length(); lap < to; lap += loop.length()) {
      for (const double s : loop.at()) out.push_back(lap + s);
      for (const auto& [a, b] : tabs) out.push_back(lap + a), out.push_back(lap + b);
    }
    std::sort(out.begin(), out.end());
    out.erase(std::remove_if(out.begin(), out.end(), [&](double s) { return s <= from + 1e-9 || s > to; }), out.end());
    out.erase(std::unique(out.begin(), out.end(), [](double a, double b) { return b - a < 1e-9; }), out.end());
    return out;
  }
  /// Moves along the loop at `z`, and over the tabs.
  void along(const Loop& loop, double from, double to, double z, double bottom, const Ranges& tabs) {
    for (const double s : stops(loop, from, to, tabs)) {
      const Vec3 here = moves_.last();
      const double up = height(0.5 * (from + s), z, bottom, tabs, loop.length());
      const Vec2 p = loop.point(s);
      if (up > here.z) moves_.to({here.x, here.y, up}, MoveKind::Lead);
      if (up < here.z) moves_.to({here.x, here.y, up}, MoveKind::Lead);
      moves_.to(Vec3(p, up), MoveKind::Cut);
      from = s;
    }
  }
  /// Cuts a layer of a whole loop: down a ramp along the loop, then once round.
  void around(const Loop& loop, double before, double z, bool first, double bottom, const Ranges& tabs) {
    if (first) {
      if (!out_.poses.empty()) ++out_.retracts;
      moves_.approach(Vec3(loop.point(0), before), in_.plane, before + kAbove);
      start_ = 0;
    }
    const double slope = base::tan(options_.slope), length = (before - z) / slope;
    double s = start_;
    for (const double stop : stops(loop, start_, start_ + length, tabs)) {
      const Vec3 here = moves_.last();
      const double ramp = before - (stop - start_) * slope,
                   up = std::max(ramp, height(0.5 * (s + stop), ramp, bottom, tabs, loop.length()));
      if (up > here.z) moves_.to({here.x, here.y, up}, MoveKind::Lead);
      moves_.to(Vec3(loop.point(stop), up), MoveKind::Lead);
      s = stop;
    }
    along(loop, s, s + loop.length(), z, bottom, tabs);
    start_ = std::fmod(s, loop.length());
  }
  /// Cuts a layer of an open stretch; the cutter moves down at its beginning.
  void stretch(const Loop& loop, double from, double to, double z, double top, double bottom, const Ranges& tabs) {
    if (!out_.poses.empty()) ++out_.retracts;
    const Vec3 begin(loop.point(from), height(from, z, bottom, tabs, loop.length()));
    std::vector<Vec3> arc = arc_at(begin, loop.point(from + std::min(0.1 * radius_, 0.5 * (to - from))), false);
    arc.push_back(begin);
    double above = top;
    if (const DropCutter::Landing found = stock_(arc.front()); found.touches)
      above = std::max(above, found.height + pitch_);
    moves_.approach(arc.front(), in_.plane, above + kAbove);
    for (const Vec3& tip : arc) moves_.to(tip, MoveKind::Lead);
    along(loop, from, to, z, bottom, tabs);
    arc_away(loop.point(to - std::min(0.1 * radius_, 0.5 * (to - from))));
    leave();
  }
  /// A quarter circle that ends in `p`, from where the tool moves towards `next`; on the side away from the part, or
  /// without points if there is no room. `reversed`: the tool moves on it, and to `p`, in the opposite direction.
  std::vector<Vec3> arc_at(const Vec3& p, const Vec2& next, bool reversed) {
    const Vec2 way = next - Vec2(p);
    std::vector<Vec3> out;
    if (lead_ > 0 && glm::length(way) > 0) {
      const Vec2 along = glm::normalize(way), left(-along.y, along.x);
      out = lead_arc(p, Vec3(along, 0), Vec3((options_.climb != reversed ? 1.0 : -1.0) * left, 0), lead_, 0.5 * kPi);
      for (std::size_t k = 0; k < out.size(); ++k)
        if (const Vec3& to = k + 1 < out.size() ? out[k + 1] : p; !clear(out[k], to)) {
          out.clear();
          break;
        }
    }
    ++(out.empty() ? out_.straight : out_.arcs);
    return out;
  }
  bool clear(const Vec3& from, const Vec3& to) const {
    return border_.distance(Vec2(from), Vec2(to), 2 * radius_ + options_.allowance) >= radius_ + options_.allowance &&
           obstacles_.rise(from, to, 0).above <= 0;
  }
  /// Leaves the part on a quarter circle, if there is room for one. `before`: a place on the last move.
  void arc_away(const Vec2& before) {
    const std::vector<Vec3> arc = arc_at(moves_.last(), before, true);
    for (auto tip = arc.rbegin(); tip != arc.rend(); ++tip) moves_.to(*tip, MoveKind::Lead);
  }
  void leave() { moves_.retract(in_.plane); }

  OutlineResult& out_;
  const TurnedScene& in_;
  const OutlineOptions& options_;
  const SetBorder& border_;
  double radius_, lead_, pitch_, start_ = 0;
  std::size_t part_triangles_;
  DropCutter obstacles_, stock_;
  MoveWriter moves_;
};

/// Orders loops: those in holes first, because the loops around the part may cut it loose. In each group the nearest
/// loop is next.
void put_in_order(std::vector<std::vector<Vec2>>& loops) {
  const auto around =
      std::stable_partition(loops.begin(), loops.end(), [](const auto& loop) { return area(loop) < 0; });
  const auto nearest_next = [](auto first, auto last) {
    for (Vec2 from{0}; first != last; ++first) {
      std::iter_swap(first, std::min_element(first, last, [&](const auto& a, const auto& b) {
                       return glm::length(a.front() - from) < glm::length(b.front() - from);
                     }));
      from = first->front();
    }
  };
  nearest_next(loops.begin(), around), nearest_next(around, loops.end());
}

std::string size_text(double mm) {
  const auto tenths = static_cast<long long>(std::floor(10 * mm));
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

}  // namespace

OutlineResult outline(const SetupScene& scene, const Tool& tool, const OutlineOptions& options,
                      const Progress& progress) {
  check(options, tool);
  const TurnedScene in = turned(scene, 0);
  OutlineResult out;
  const Mesh left = turned_stock(scene, in.frame);
  const auto ended = [&](const std::string& reason) {
    if (out.poses.empty()) out.reason = reason;
    base::report(progress, 1);
    return std::move(out);
  };
  if (left.empty()) return ended("nothing is left of the stock");
  const Shape shape = shape_of(in, options);
  if (shape.segments.empty()) return ended("the curves enclose nothing");
  const double distance = 0.5 * tool.diameter() + options.allowance;
  const double under = mesh::bounds(left).lower.z, bottom = options.depth > 0 ? shape.top - options.depth : under;
  const SetBorder border(shape.segments, distance);
  const PlaceGrid grid = grid_around(border, distance);
  PlaceSet set = options.curves.empty() ? covered(grid, in.part) : within(grid, shape.curves);
  if (options.inside)
    for (char& k : set) k = !k;
  base::report(progress, 0.05);
  OffsetLoops found = offset_loops(grid, set, border, distance, options.tolerance);
  base::report(progress, 0.4);
  const DropCutter pin(left, cutters::flat(kPin, tool.length()));
  for (const NarrowPlace& one : found.narrow)
    if (const DropCutter::Landing there = pin(Vec3(one.place, 0)); there.touches && there.height > bottom)
      out.blocked.push_back({"an opening " + size_text(one.width) + " mm wide is narrower than the cutter",
                             in.frame * Vec3(one.place, bottom), one.length});
  put_in_order(found.loops);
  Cutter cutter(out, in, tool, options, border, left, scene.stock.frame().pitch);
  bool material = false;
  for (std::size_t k = 0; k < found.loops.size(); ++k) {
    std::vector<Vec2>& loop = found.loops[k];
    if (options.climb) std::reverse(loop.begin(), loop.end());
    material = cutter.cut(Loop(loop), bottom) || material;
    base::report(progress, 0.4 + 0.6 * static_cast<double>(k + 1) / static_cast<double>(found.loops.size()));
  }
  if (found.loops.empty()) return ended(out.blocked.empty() ? "there is no loop" : out.blocked.front().reason);
  if (!material) return ended("no stock stands on the outline down to its depth");
  return ended(out.blocked.empty() ? "nothing can be reached"
                                   : "nothing can be reached: " + out.blocked.front().reason);
}

}  // namespace riffler::plan
