#include "riffler/plan/pencil.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "base/functions.hpp"
#include "plan/passes.hpp"
#include "plan/valley_index.hpp"
#include "plan/valley_starts.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/mesh/orient.hpp"
#include "riffler/mesh/smooth.hpp"
#include "riffler/plan/contact_location.hpp"

namespace riffler::plan {

namespace {

constexpr double kWidestStep = 10;    // radii: stepover between passes
constexpr double kLargestBall = 100;  // sizes of the part: radius of the ball
constexpr double kMaxCells = 1e9;     // cells of the net

/// Length scales of a search, mm.
struct Scales {
  double spacing;  ///< of the net: width of the unreachable strip at the bottom of the flattest valley
  double depth;    ///< depth that a ball may enter before its contact counts as unreached
  double touch;    ///< width of cracks to ignore

  Scales(const Mesh& part, double radius, double tolerance) {
    const Box3 box = bounds(part);
    const double largest = glm::length(glm::max(glm::abs(box.lower), glm::abs(box.upper)));
    spacing = std::clamp(std::sqrt(2 * tolerance * radius), 0.02 * radius, 0.25 * radius);
    depth = 1e-3 * std::min(tolerance, radius) + 1e-12 * largest;
    touch = 0.1 * std::min(tolerance, 0.01 * radius) + 1e-12 * largest;
  }
};

/// Groups places that seem to lie on one valley and keeps the first of each group.
std::vector<std::size_t> one_of_each(const std::vector<Station>& places, double near) {
  std::vector<std::size_t> parent(places.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto alike = [&](const Station& a, const Station& b) {
    constexpr double kTurn = 0.4;
    const auto far = [&](int i) { return glm::length(a.feet[0].away - b.feet[i].away) > kTurn; };
    const auto far_too = [&](int i) { return glm::length(a.feet[1].away - b.feet[i].away) > kTurn; };
    return glm::length(a.centre - b.centre) <= near && !((far(0) || far_too(1)) && (far(1) || far_too(0)));
  };
  Cubes<std::size_t> cubes(near);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3& c = places[i].centre;
    cubes.look(c - Vec3(near), c + Vec3(near), [&](std::size_t j) {
      const std::size_t a = root(i), b = root(j);
      if (a != b && alike(places[i], places[j])) parent[std::max(a, b)] = std::min(a, b);
    });
    cubes.add(c, c, i);
  }
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (root(i) == i) out.push_back(i);
  return out;
}

/// Traces valleys in rounds: follows one start of each group; starts that then lie on a traced valley are done.
class Tracing {
 public:
  Tracing(const RollingBall& ball, const ValleyTracer& tracer, const ValleyRules& rules, double near)
      : ball_(ball),
        tracer_(tracer),
        near_(near),
        index_(0.5 * ball.radius(), 2 * rules.tolerance, 2 * rules.jump),
        corners_(1e-3 * ball.radius()) {}

  std::vector<Valley> run(std::vector<Station> pending, PencilStats& stats, const Progress& progress) {
    const std::size_t all = std::max<std::size_t>(1, pending.size());
    while (!pending.empty()) {
      const double done_share = 1 - static_cast<double>(std::min(all, pending.size())) / static_cast<double>(all);
      base::report(progress, done_share);
      const std::vector<std::size_t> chosen = one_of_each(pending, near_);
      std::vector<Valley> traced(chosen.size());
      std::vector<std::size_t> steps(chosen.size(), 0);
      base::parallel_for(
          chosen.size(), 1,
          [&](std::size_t i, std::size_t) { traced[i] = tracer_.trace(pending[chosen[i]], steps[i]); },
          progress ? Progress([&](double) { return progress(done_share); }) : Progress());
      std::vector<Station> more;
      for (std::size_t i = 0; i < traced.size(); ++i) {
        ++stats.traces, stats.steps += steps[i];
        if (index_.covers(traced[i])) continue;
        index_.add(traced[i]);
        meet(traced[i], more);
        valleys_.push_back(std::move(traced[i]));
      }
      std::vector<char> done(pending.size(), 0);
      for (const std::size_t i : chosen) done[i] = 1;
      for (std::size_t i = 0; i < pending.size(); ++i)
        if (!done[i] && !index_.covers(pending[i])) more.push_back(pending[i]);
      std::erase_if(more, [&](const Station& s) { return index_.covers(s); });
      pending = std::move(more);
    }
    return std::move(valleys_);
  }

 private:
  /// Merges corners reached from several valleys, and starts along the branches of a new corner.
  void meet(Valley& valley, std::vector<Station>& more) {
    for (int end = 0; end < 2; ++end) {
      if (valley.ends[end] != ValleyEnd::Corner) continue;
      Vec3& centre = (end ? valley.stations.back() : valley.stations.front()).centre;
      const double same = 1e-6 * ball_.radius();
      std::optional<Vec3> known;
      corners_.look(centre - Vec3(same), centre + Vec3(same), [&](const Vec3& c) {
        if (!known && glm::length(c - centre) <= same) known = c;
      });
      if (known) {
        centre = *known;
        continue;
      }
      corners_.add(centre, centre, centre);
      for (const Station& station : tracer_.branches(centre)) more.push_back(station);
    }
  }

  const RollingBall& ball_;
  const ValleyTracer& tracer_;
  double near_;
  ValleyIndex index_;
  Cubes<Vec3> corners_;
  std::vector<Valley> valleys_;
};

PencilPath path_of(const Valley& valley, double radius) {
  PencilPath path;
  path.radius = radius, path.closed = valley.closed();
  for (const Station& s : valley.stations) {
    path.centres.push_back(s.centre);
    path.contacts.push_back({s.feet[0].point, s.feet[1].point});
    path.normals.push_back(s.normals);
  }
  return path;
}

const char* name_of(ValleyEnd end) {
  constexpr const char* kNames[] = {"loop", "corner", "part", "faded", "cut", "joined"};
  return kNames[static_cast<int>(end)];
}

std::string reason_of(const PencilStats& stats, const PencilOptions& options) {
  if (stats.entered == 0) return "the ball reaches every point of the part: nothing is concave for its radius";
  std::string reason = "the ball cannot reach " + std::to_string(stats.entered) + " of " + std::to_string(stats.balls) +
                       " contact points, but rests on no two faces there";
  if (stats.faceting > 0)
    reason += "; gaps within the tolerance or angles too small: " + std::to_string(stats.faceting);
  if (stats.edges > 0) reason += "; on sharp or open edges: " + std::to_string(stats.edges);
  if (stats.stuck > 0) reason += "; no room for it: " + std::to_string(stats.stuck);
  if (options.minimum_length > 0) reason += "; or paths are shorter than the minimum length";
  return reason;
}

/// The valleys of one ball, and the area that it cannot reach.
struct Search {
  std::vector<Valley> valleys;
  double area = 0;
  std::vector<double> areas;  // mm² per triangle
};

void count(const ContactNet& net, const ValleyStarts& starts, Search& out, PencilStats& stats) {
  stats.balls += net.balls, stats.entered += net.points.size();
  stats.starts += starts.pressed, stats.stuck += starts.stuck;
  stats.faceting += starts.faceting, stats.edges += starts.edges;
  for (std::size_t i = 0; i < net.points.size(); ++i) {
    if (!starts.is_rest[i]) continue;
    out.area += net.points[i].area;
    out.areas[net.points[i].triangle] += net.points[i].area;
  }
}

Search search(const Mesh& part, const RollingBall& ball, const Scales& scales, const PencilOptions& options,
              PencilStats& stats, const Progress& progress) {
  ValleyRules rules;
  rules.tolerance = options.tolerance;
  const double gap_angle = bitangency_angle_of_gap(ball.radius(), options.tolerance);
  rules.jump = std::min(gap_angle, mesh::kFeatureAngle);
  rules.least_angle = options.bitangency_angle.value_or(gap_angle);
  rules.least_gap = options.bitangency_angle ? 0 : options.tolerance;
  const ContactNet net =
      contact_net(part, ball, scales.spacing, scales.depth, rules.least_angle, base::part(progress, 0, 0.4));
  const ValleyTracer tracer(ball, rules);
  ValleyStarts starts = valley_starts(tracer, net.points, std::max(2 * scales.spacing, ball.radius() / 6),
                                      4 * scales.spacing, base::part(progress, 0.4, 0.8));
  Search out;
  out.areas.assign(part.triangles.size(), 0);
  count(net, starts, out, stats);
  Tracing tracing(ball, tracer, rules, 6 * scales.spacing);
  out.valleys = tracing.run(std::move(starts.stations), stats, base::part(progress, 0.8, 1));
  return out;
}

/// Valleys of larger balls, with the ball laid into them where no valley exists yet.
class Additions {
 public:
  Additions(const RollingBall& ball, std::vector<Valley>& valleys)
      : ball_(ball), near_(0.25 * ball.radius()), valleys_(valleys), index_(0.5 * ball.radius(), near_, kAlike) {
    for (const Valley& valley : valleys) index_.add(valley);
  }

  /// Whether any of these valleys of a larger ball goes where none goes so far.
  bool any(const std::vector<Valley>& wide) const {
    return std::any_of(wide.begin(), wide.end(), [&](const Valley& v) { return !runs(laid_into(v, ball_)).empty(); });
  }

  void add(const std::vector<Valley>& wide) {
    for (const Valley& valley : wide) {
      const Valley laid = laid_into(valley, ball_);
      std::vector<Valley> found;
      for (const auto& [first, last] : runs(laid)) found.push_back(piece(laid, first, last));
      for (Valley& v : found) index_.add(v), valleys_.push_back(std::move(v));
    }
  }

 private:
  using Run = std::pair<std::size_t, std::size_t>;  // first and last station

  /// Runs not covered by a valley so far, extended at both ends by the distance that counts as near, so that paths
  /// leave no gap.
  std::vector<Run> runs(const Valley& laid) const {
    const std::vector<Station>& s = laid.stations;
    std::vector<Run> out;
    for (std::size_t k = 0; k < s.size(); ++k) {
      if (index_.covers(s[k])) continue;
      Run run{k, k};
      while (run.second + 1 < s.size() && !index_.covers(s[run.second + 1])) ++run.second;
      k = run.second;
      for (double way = 0; run.first > 0 && way < near_; --run.first)
        way += glm::length(s[run.first].centre - s[run.first - 1].centre);
      for (double way = 0; run.second + 1 < s.size() && way < near_; ++run.second)
        way += glm::length(s[run.second].centre - s[run.second + 1].centre);
      if (!out.empty() && run.first <= out.back().second)
        out.back().second = run.second;
      else
        out.push_back(run);
    }
    return out;
  }

  static Valley piece(const Valley& laid, std::size_t first, std::size_t last) {
    const bool whole = first == 0 && last + 1 == laid.stations.size();
    if (whole) return laid;
    Valley out;
    out.stations.assign(laid.stations.begin() + static_cast<std::ptrdiff_t>(first),
                        laid.stations.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    out.ends = {first > 0 || laid.closed() ? ValleyEnd::Joined : laid.ends[0],
                last + 1 < laid.stations.size() || laid.closed() ? ValleyEnd::Joined : laid.ends[1]};
    return out;
  }

  static constexpr double kAlike = 0.5;  // rad: valleys whose sides differ by less count as one
  const RollingBall& ball_;
  double near_;
  std::vector<Valley>& valleys_;
  ValleyIndex index_;
};

void check(double radius, const PencilOptions& options) {
  base::require_positive(radius, "radius", base::kPositiveAndFinite);
  base::require_tolerance(options.tolerance);
  if (const auto& angle = options.bitangency_angle; angle && !(*angle > 0 && *angle < 3.14159))
    throw std::invalid_argument("bitangency_angle must be between 0 and pi");
  base::require_not_negative(options.minimum_length, "minimum_length", "must not be negative, and finite");
  base::require_not_negative(options.overthickness, "overthickness", "must not be negative, and finite");
  if (options.passes < 1 || options.passes > 1000) throw std::invalid_argument("passes must be from 1 to 1000");
  if (options.stepover) base::require_positive(*options.stepover, "stepover", base::kPositiveAndFinite);
  if (options.stepover && !(*options.stepover <= kWidestStep * radius))
    throw std::invalid_argument("stepover must be at most ten times the ball's radius");
}

/// Rejects balls much larger than the part, which touch it everywhere at once, and balls so small that the search would
/// not end.
void check_sizes(const Mesh& part, double radius, double spacing) {
  const double size = glm::length(bounds(part).size());
  if (radius > kLargestBall * size)
    throw std::invalid_argument("tool: the ball's radius is more than 100 times the part's size: check the units");
  if (area(part) > kMaxCells * spacing * spacing)
    throw std::invalid_argument(
        "tool: the ball is too small for the part, which it would have to be laid on more than a billion "
        "times: check the units");
}

/// Adds what a ball enlarged by the overthickness leaves beyond the ball's own valleys. If there is any, as in a blend,
/// balls of intermediate radii come first: smaller ones go further into corners.
void add_rest(const Mesh& part, const RollingBall& ball, const PencilOptions& options, std::vector<Valley>& valleys,
              PencilResult& result, const Progress& progress) {
  constexpr double kBetween[] = {1.0 / 16, 1.0 / 4};
  const auto search_with = [&](double share, const Progress& part_of) {
    const double wide = ball.radius() + share * options.overthickness;
    const Scales scales(part, wide, options.tolerance);
    return search(part, RollingBall(part, wide, scales.touch), scales, options, result.stats, part_of);
  };
  Search largest = search_with(1, base::part(progress, 0, 0.4));
  result.reference_area = largest.area, result.reference_areas = std::move(largest.areas);
  Additions additions(ball, valleys);
  if (!additions.any(largest.valleys)) return;
  double done = 0.4;
  for (const double share : kBetween) {
    additions.add(search_with(share, base::part(progress, done, done + 0.3)).valleys);
    done += 0.3;
  }
  additions.add(largest.valleys);
}

/// Whether an open path ends at a smaller x than it begins; at equal x (within `same`, mm) y decides, then z. A loop:
/// whether it runs clockwise, seen along the axis from which it is widest.
bool is_backwards(const Valley& valley, double same) {
  const std::vector<Station>& s = valley.stations;
  if (valley.closed()) {
    Vec3 area(0);
    for (std::size_t k = 1; k < s.size(); ++k)
      area += glm::cross(s[k - 1].centre - s[0].centre, s[k].centre - s[0].centre);
    const Vec3 size = glm::abs(area);
    return area[size.z >= size.x && size.z >= size.y ? 2 : size.y >= size.x ? 1 : 0] < 0;
  }
  const Vec3 way = s.back().centre - s.front().centre;
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(way[axis]) > same) return way[axis] < 0;
  return false;
}

/// The order of a mesh's triangles, which changes when objects are joined, must not decide where a tool begins.
void set_direction(Valley& valley, double same) {
  if (!is_backwards(valley, same)) return;
  std::reverse(valley.stations.begin(), valley.stations.end());
  for (Station& station : valley.stations) station = exchanged(station);
  std::swap(valley.ends[0], valley.ends[1]);
}

}  // namespace

double bitangency_angle_of_gap(double radius, double gap) {
  return 2 * base::acos(radius / (radius + gap));
}

double tip_ball_radius(const Tool& tool, std::string_view name) {
  const double radius = CutterSupport(tool).ball_radius();
  if (radius > 0) return radius;
  throw std::invalid_argument(std::string(name) + ": pencil cuts are the paths of a ball, and the tip of a \"" +
                              tool.kind() +
                              "\" cutter is not a ball: take a ball end, a taper with a ball tip, or a profile that "
                              "begins with an arc about the axis");
}

PencilResult pencil(const Mesh& given, double radius, const PencilOptions& options, const Progress& progress) {
  check(radius, options);
  validate(given);
  if (given.empty()) throw std::invalid_argument("part: a mesh without triangles has no valleys");
  std::optional<Mesh> storage;
  const Mesh& part = as_solid(given, storage, mesh::Hollow::Kept);
  const Scales scales(part, radius, options.tolerance);
  check_sizes(part, radius + options.overthickness, scales.spacing);
  const RollingBall ball(part, radius, scales.touch);
  base::report(progress, 0.05);

  PencilResult result;
  const double share = options.overthickness > 0 ? 0.3 : 1;
  Search own = search(part, ball, scales, options, result.stats, base::part(progress, 0.05, share));
  result.rest_area = own.area, result.rest_areas = std::move(own.areas);
  result.reference_area = result.rest_area, result.reference_areas = result.rest_areas;
  if (options.overthickness > 0) add_rest(part, ball, options, own.valleys, result, base::part(progress, share, 0.95));
  const double stepover = options.stepover.value_or(stepover_of_scallop(radius, std::min(radius, options.tolerance)));
  for (Valley& valley : own.valleys) {
    set_direction(valley, 1e-6 * radius);
    const std::vector<PencilPath> passes =
        passes_beside(ball, valley, options.passes - 1, stepover, base::part(progress, 0.95, 1));
    simplify(valley, options.tolerance);
    PencilPath path = path_of(valley, radius);
    for (const ValleyEnd end : valley.ends) result.stats.cut += end == ValleyEnd::Cut ? 1 : 0;
    if (path.length() < options.minimum_length || path.size() < 2) continue;
    result.paths.push_back(std::move(path));
    result.ends.push_back({name_of(valley.ends[0]), name_of(valley.ends[1])});
    for (const PencilPath& pass : passes) result.paths.push_back(pass), result.ends.push_back({"pass", "pass"});
  }
  if (result.paths.empty()) result.reason = reason_of(result.stats, options);
  base::report(progress, 1);
  return result;
}

}  // namespace riffler::plan
