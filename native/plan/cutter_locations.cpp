#include "riffler/plan/cutter_locations.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/plan/contact_location.hpp"
#include "riffler/plan/lift.hpp"

namespace riffler::plan {

namespace {

constexpr int kMaxInserted = 100'000;

constexpr const char* kOf[] = {"the cutter meets the part", "the shank meets the part", "the holder meets the part",
                               "the tool meets a fixture"};

std::string text(const char* format, double value) {
  char out[64];
  std::snprintf(out, sizeof out, format, value);
  return out;
}

std::string why_not_free(const Lift& lift, const LocationRule& rule) {
  if (lift.swallowed && lift.height == 0) return "the tool is entirely inside the part's material";
  const std::string where =
      std::string(kOf[static_cast<int>(lift.touch)]) + text(", clearance %.6g mm", lift.before) + " before any lift";
  if (lift.swallowed) return where + ", and a lift only pushes the tool into the material";
  return where + (lift.height > rule.max_lift ? text(", not free within %g mm along the axis", rule.max_lift)
                                              : text(", not shown to be free, blocked up to %g mm", lift.height));
}

void check(const LocationRule& rule) {
  base::require(std::isfinite(rule.clearance), "clearance", "must be finite");
  base::require_tolerance(rule.tolerance);
  base::require_not_negative(rule.max_lift, "max_lift", base::kFiniteAndNotNegative);
  if (rule.max_inserted < 0 || rule.max_inserted > kMaxInserted)
    throw std::invalid_argument("max_inserted must be from 0 to " + std::to_string(kMaxInserted));
  if (rule.max_evaluations < 1) throw std::invalid_argument("max_evaluations must be at least 1");
}

class Planner {
 public:
  Planner(const collide::Assembly& assembly, const collide::Collider& collider, const LocationRule& rule)
      : assembly_(assembly), collider_(collider), rule_(rule) {}

  /// The result for one pose.
  struct Try {
    LocationRow row;
    std::string blocked;
    int evaluations = 0;
  };
  Try try_pose(const Pose& pose, std::ptrdiff_t point) const {
    LiftRule how{rule_.clearance - 0.5 * rule_.tolerance, std::min(1e-9, 1e-3 * rule_.tolerance), rule_.max_lift, 1000};
    const Lift found = lift(collider_, assembly_, pose, how);
    const Pose at{pose.tip + found.height * pose.axis, pose.axis};
    Try out{{at, point, found.height, found.before, found.clearance, found.touch}, {}, found.evaluations};
    if (!found.free) out.blocked = why_not_free(found, rule_);
    return out;
  }
  /// `pose_at(k)`: the initial pose of the tool; throws std::invalid_argument if it cannot stand there.
  template <class PoseAt>
  Try try_point(const PoseAt& pose_at, std::size_t k) const {
    try {
      return try_pose(pose_at(k), static_cast<std::ptrdiff_t>(k));
    } catch (const std::invalid_argument& error) {
      return {{}, error.what(), 0};
    }
  }

  /// The move between two rows.
  struct Way {
    std::vector<LocationRow> inserted;
    std::vector<UnsafeWay> unsafe;  // row numbers relative to the move's first row
    double least = std::numeric_limits<double>::infinity(), bound = least;
    std::size_t evaluations = 0;
    int made = 0;  // rows to insert, including pending ones
  };
  Way way(const LocationRow& from, const LocationRow& to) const {
    Way out;
    // Rows still to be joined, the next on top. A stack instead of recursion, for parts of any shape.
    std::vector<LocationRow> ahead{to};
    LocationRow here = from;
    while (!ahead.empty()) {
      const LocationRow next = ahead.back();
      if (std::optional<LocationRow> between = join(here, next, out)) {
        ahead.push_back(*between);
        continue;
      }
      here = next;
      ahead.pop_back();
      if (!ahead.empty()) out.inserted.push_back(here);
    }
    return out;
  }

 private:
  /// A row to insert between two, or no value if the move between them is settled, free or not.
  std::optional<LocationRow> join(const LocationRow& from, const LocationRow& to, Way& out) const {
    const auto unsafe = [&](double clearance, double bound, std::string reason) {
      out.unsafe.push_back({out.inserted.size(), clearance, bound, std::move(reason)});
      out.least = std::min(out.least, clearance), out.bound = std::min(out.bound, bound);
      return std::nullopt;
    };
    if (glm::dot(from.pose.axis, to.pose.axis) < -1 + 1e-12)
      return unsafe(std::min(from.clearance, to.clearance), -assembly_.reach(), "opposite axes: no motion joins them");
    const Motion motion(from.pose, to.pose);
    const double wanted = rule_.clearance - rule_.tolerance;
    const collide::Swept check =
        collider_.sweep(assembly_, motion, wanted, static_cast<std::size_t>(rule_.max_evaluations));
    const double least = std::min({check.clearance, from.clearance, to.clearance}),
                 bound = std::min(check.bound, least);
    out.evaluations += check.evaluations;
    if (check.answer == collide::Swept::Answer::Clear) {
      out.least = std::min(out.least, least), out.bound = std::min(out.bound, bound);
      return std::nullopt;
    }
    if (check.answer == collide::Swept::Answer::Unknown) return unsafe(least, bound, "the evaluations ran out");
    if (out.made >= rule_.max_inserted)
      return unsafe(least, bound,
                    std::string(kOf[static_cast<int>(check.touch)]) + ", and no more points may be inserted");
    const Try middle = try_pose(motion.at(check.at), -1);
    out.evaluations += static_cast<std::size_t>(middle.evaluations);
    if (!middle.blocked.empty()) return unsafe(least, bound, middle.blocked);
    ++out.made;
    return middle.row;
  }

  const collide::Assembly& assembly_;
  const collide::Collider& collider_;
  const LocationRule& rule_;
};

template <class PoseAt>
CutterLocations located(std::size_t n, bool closed, const PoseAt& pose_at, const Planner& planner,
                        const Progress& progress) {
  std::vector<Planner::Try> points(n);
  base::parallel_for(
      n, 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) points[k] = planner.try_point(pose_at, k);
      },
      base::part(progress, 0, 0.3));
  CutterLocations out;
  out.least_clearance = std::numeric_limits<double>::infinity();
  std::vector<LocationRow> rows;
  for (std::size_t k = 0; k < points.size(); ++k) {
    out.evaluations += static_cast<std::size_t>(points[k].evaluations);
    if (points[k].blocked.empty())
      rows.push_back(points[k].row), out.least_clearance = std::min(out.least_clearance, points[k].row.clearance);
    else
      out.blocked.push_back({k, points[k].blocked});
  }
  if (closed && rows.size() > 1) rows.push_back(rows.front());
  std::vector<Planner::Way> ways(rows.empty() ? 0 : rows.size() - 1);
  base::parallel_for(
      ways.size(), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) ways[k] = planner.way(rows[k], rows[k + 1]);
      },
      base::part(progress, 0.3, 1));
  out.bound = out.least_clearance;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    out.rows.push_back(rows[k]);
    if (k == ways.size()) break;
    const Planner::Way& way = ways[k];
    for (UnsafeWay unsafe : way.unsafe) unsafe.row += out.rows.size() - 1, out.unsafe.push_back(unsafe);
    out.rows.insert(out.rows.end(), way.inserted.begin(), way.inserted.end());
    out.least_clearance = std::min(out.least_clearance, way.least), out.bound = std::min(out.bound, way.bound);
    out.evaluations += way.evaluations;
  }
  return out;
}

}  // namespace

CutterLocations cutter_locations(const PencilPath& path, const collide::Assembly& assembly,
                                 const collide::Collider& collider, const LocationRule& rule,
                                 const Progress& progress) {
  if (path.axes.size() != path.size() || path.axes.empty())
    throw std::invalid_argument("path: has no axes; orient it first");
  check(rule);
  const CutterSupport cutter(assembly.tool());
  const auto pose_at = [&](std::size_t k) { return location_on_path(cutter, path, k, path.axes[k]); };
  return located(path.size(), path.closed, pose_at, Planner(assembly, collider, rule), progress);
}

CutterLocations cutter_locations(const std::vector<Pose>& poses, const collide::Assembly& assembly,
                                 const collide::Collider& collider, const LocationRule& rule,
                                 const Progress& progress) {
  if (poses.empty()) throw std::invalid_argument("path: has no poses");
  check(rule);
  return located(
      poses.size(), false, [&](std::size_t k) { return poses[k]; }, Planner(assembly, collider, rule), progress);
}

}  // namespace riffler::plan
