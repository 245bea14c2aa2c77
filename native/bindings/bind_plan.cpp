// Planning with a tool: lift, drop, cutter locations, free orientations. The docstrings are in riffler.plan.
#include <limits>
#include <memory>

#include "bindings/program_types.hpp"
#include "bindings/task.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/plan/contact_location.hpp"
#include "riffler/plan/cutter_locations.hpp"
#include "riffler/plan/drop.hpp"
#include "riffler/plan/least_tilt.hpp"
#include "riffler/plan/lift.hpp"

namespace riffler::bindings {

namespace {

using namespace py::literals;
using Path = std::shared_ptr<plan::PencilPath>;
using Obstacle = std::shared_ptr<collide::Collider>;

std::vector<Vec3> to_units(const Doubles& array, const char* name, std::size_t n) {
  std::vector<Vec3> out = to_vec3s(array, name);
  if (out.size() != n) throw py::value_error(std::string(name) + " must have " + std::to_string(n) + " rows");
  for (std::size_t i = 0; i < n; ++i)
    out[i] = plan::unit_axis(out[i], std::string(name) + ", row " + std::to_string(i));
  return out;
}

/// Poses with unit axes.
std::vector<Pose> to_unit_poses(const Doubles& array) {
  std::vector<Pose> out = to_poses(array, "poses");
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i].axis = plan::unit_axis(out[i].axis, "poses, row " + std::to_string(i) + ": the axis");
  return out;
}

py::array_t<double> contact_locations(const Tool& tool, const Doubles& contacts, const Doubles& normals,
                                      const Doubles& axes, const OptionalArrayLike& feeds) {
  tool.require_revolved("plan.contact_locations");
  const std::vector<Vec3> at = to_vec3s(contacts, "contacts");
  const std::vector<Vec3> n = to_units(normals, "normals", at.size()), o = to_units(axes, "axes", at.size());
  std::vector<Vec3> feed(at.size(), Vec3(0));
  if (!feeds.is_none()) feed = to_vec3s(py::cast<Doubles>(feeds), "feeds");
  if (feed.size() != at.size()) throw py::value_error("feeds must have " + std::to_string(at.size()) + " rows");
  const plan::CutterSupport cutter(tool);
  std::vector<Pose> out;
  for (std::size_t i = 0; i < at.size(); ++i) {
    try {
      out.push_back(location_of_contact(cutter, at[i], n[i], o[i], feed[i]));
    } catch (const std::invalid_argument& error) {
      throw py::value_error("contacts, row " + std::to_string(i) + ": " + error.what());
    }
  }
  return take<double>(std::move(out), 6);
}

py::list names_of(const std::vector<collide::Touch>& touches) {
  py::list out;
  for (const collide::Touch t : touches) out.append(name_of(t));
  return out;
}

LiftResult lift_all(const Tool& tool, const Doubles& array, const collide::Collider& collider, double clearance,
                    double tolerance, double max_lift, int max_evaluations, const ProgressLike& callable) {
  tool.require_revolved("plan.lift");
  const std::vector<Pose> poses = to_unit_poses(array);
  const plan::LiftRule rule{clearance, tolerance, max_lift, max_evaluations};
  validate(rule);
  std::vector<plan::Lift> lifts(poses.size());
  {
    const Progress progress = to_progress(callable);
    const NoGil release;
    const collide::Assembly assembly(tool);
    const auto body = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) lifts[i] = lift(collider, assembly, poses[i], rule);
    };
    base::parallel_for(poses.size(), 1, body, progress);
  }
  std::vector<double> height, before, after;
  std::vector<std::uint8_t> free;
  std::vector<int> evaluations;
  std::vector<Vec3> points;
  std::vector<collide::Touch> touches;
  for (const plan::Lift& l : lifts) {
    height.push_back(l.height), before.push_back(l.before), after.push_back(l.clearance);
    free.push_back(l.free), evaluations.push_back(l.evaluations), points.push_back(l.point), touches.push_back(l.touch);
  }
  return plan_result("locations", "LiftReport",
                     py::dict("lift"_a = take<double>(std::move(height)), "free"_a = take<bool>(std::move(free)),
                              "before"_a = take<double>(std::move(before)),
                              "clearance"_a = take<double>(std::move(after)), "points"_a = from_vec3s(points),
                              "pieces"_a = names_of(touches), "evaluations"_a = take<int>(std::move(evaluations))));
}

ArrayPair drop_all(const Tool& tool, const Doubles& array, const Mesh& part, const ArrayLike& axis,
                   const ProgressLike& callable) {
  tool.require_revolved("plan.drop");
  const std::vector<Vec3> points = to_vec3s(array, "points");
  const Vec3 up = plan::unit_axis(to_vec3(axis, "axis"), "axis");
  std::vector<double> heights(points.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<Vec3> contacts(points.size(), Vec3(std::numeric_limits<double>::quiet_NaN()));
  {
    const Progress progress = to_progress(callable);
    const NoGil release;
    const std::vector<plan::DropCutter::Landing> landings = plan::DropCutter(part, tool, up)(points, progress);
    for (std::size_t i = 0; i < landings.size(); ++i)
      if (landings[i].touches) heights[i] = landings[i].height, contacts[i] = landings[i].point;
  }
  return py::make_tuple(take<double>(std::move(heights)), from_vec3s(contacts));
}

LocationsResult from_locations(const plan::CutterLocations& found) {
  std::vector<Pose> poses;
  std::vector<std::int64_t> points;
  std::vector<double> lift, before, clearance;
  std::vector<collide::Touch> touches;
  for (const plan::LocationRow& row : found.rows) {
    poses.push_back(row.pose), points.push_back(row.point), lift.push_back(row.lift), before.push_back(row.before);
    clearance.push_back(row.clearance), touches.push_back(row.touch);
  }
  const py::module_ module = py::module_::import("riffler.plan.locations");
  const py::object blocked_point = module.attr("BlockedPoint"), unsafe_move = module.attr("UnsafeMove");
  py::list blocked, unsafe;
  for (const plan::BlockedPoint& b : found.blocked) blocked.append(blocked_point(b.point, b.reason));
  for (const plan::UnsafeWay& u : found.unsafe) unsafe.append(unsafe_move(u.row, u.clearance, u.bound, u.reason));
  const py::object report =
      plan_result("locations", "LocationReport",
                  py::dict("points"_a = take<std::int64_t>(std::move(points)), "lift"_a = take<double>(std::move(lift)),
                           "before"_a = take<double>(std::move(before)),
                           "clearance"_a = take<double>(std::move(clearance)), "pieces"_a = names_of(touches),
                           "blocked"_a = blocked, "unsafe"_a = unsafe, "min_clearance"_a = found.least_clearance,
                           "bound"_a = found.bound, "evaluations"_a = found.evaluations, "ok"_a = found.good()));
  return py::make_tuple(take<double>(std::move(poses), 6), report);
}

/// `from`: a shared path or vector of poses.
template <class From>
auto locate(const std::shared_ptr<From>& from, const Tool& tool, const Obstacle& collider, double clearance,
            double tolerance, double max_lift, int max_inserted, const ProgressLike& progress) {
  tool.require_revolved("plan.cutter_locations");
  plan::LocationRule rule;
  rule.clearance = clearance, rule.tolerance = tolerance, rule.max_lift = max_lift, rule.max_inserted = max_inserted;
  const auto work = [=](const Progress& listener) {
    return cutter_locations(*from, collide::Assembly(tool), *collider, rule, listener);
  };
  return long_call(progress, work, &from_locations);
}

auto locate_poses(const Doubles& poses, const Tool& tool, const Obstacle& collider, double clearance, double tolerance,
                  double max_lift, int max_inserted, const ProgressLike& progress) {
  const auto from = std::make_shared<const std::vector<Pose>>(to_unit_poses(poses));
  return locate(from, tool, collider, clearance, tolerance, max_lift, max_inserted, progress);
}

plan::MapRule to_rule(const std::vector<double>& inclinations, const std::vector<double>& tilts, double clearance,
                      double tolerance, const ConeLike& limit) {
  return {inclinations, tilts, clearance, tolerance, to_axis_limit(limit)};
}

py::object from_map(const plan::OrientationMap& map) {
  std::vector<std::uint8_t> states;
  for (const plan::OrientationMap::State s : map.state) states.push_back(static_cast<std::uint8_t>(s));
  const std::optional<std::size_t> least = map.least_tilt();
  return plan_result(
      "orientations", "MapValues",
      py::dict("axes"_a = from_vec3s(map.axes), "clearance"_a = take<double>(std::vector<double>(map.clearance)),
               "state"_a = take<std::uint8_t>(std::move(states)), "pieces"_a = names_of(map.touch),
               "suggestion"_a = least ? py::object(from_vec3(map.axes[*least])) : py::object(py::none()),
               "reason"_a = map.why_none()));
}

MapResults from_maps(const std::vector<plan::OrientationMap>& found) {
  py::list out;
  for (const plan::OrientationMap& map : found) out.append(from_map(map));
  return out;
}

auto maps(const Path& path, const std::vector<std::size_t>& points, const Tool& tool, const Obstacle& collider,
          const std::vector<double>& inclinations, const std::vector<double>& tilts, double clearance, double tolerance,
          const ConeLike& limit, const ProgressLike& progress) {
  tool.require_revolved("plan.free_orientations");
  const plan::MapRule rule = to_rule(inclinations, tilts, clearance, tolerance, limit);
  const auto work = [=](const Progress& listener) {
    return orientation_maps(*path, points, collide::Assembly(tool), *collider, rule, listener);
  };
  return long_call(progress, work, &from_maps);
}

TiltResult from_answer(plan::TiltAnswer&& found) {
  const py::object report =
      plan_result("orientations", "TiltReport",
                  py::dict("found"_a = found.found, "angles"_a = take<double>(std::move(found.angles)),
                           "cost"_a = found.cost, "point"_a = found.point, "reason"_a = found.reason));
  return py::make_tuple(from_vec3s(found.axes), report);
}

auto choose(const Path& path, const Tool& tool, const Obstacle& collider, const std::vector<double>& inclinations,
            const std::vector<double>& tilts, double clearance, double tolerance, const ConeLike& limit,
            double max_change, double smoothness, const ProgressLike& progress) {
  tool.require_revolved("plan.min_tilt");
  const plan::TiltRule rule{to_rule(inclinations, tilts, clearance, tolerance, limit), max_change, smoothness};
  const auto work = [=](const Progress& listener) {
    return least_tilt(*path, collide::Assembly(tool), *collider, rule, listener);
  };
  return long_call(progress, work, &from_answer);
}

}  // namespace

void bind_plan(py::module_& m) {
  m.def("contact_locations", &contact_locations, "tool"_a, "contacts"_a, "normals"_a, "axes"_a, "feeds"_a);
  m.def("lift", &lift_all, "tool"_a, "poses"_a, "collider"_a, py::kw_only(), "clearance"_a, "tolerance"_a, "max_lift"_a,
        "max_evaluations"_a, "progress"_a);
  m.def("drop", &drop_all, "tool"_a, "points"_a, "part"_a, "axis"_a, "progress"_a);
  m.def("cutter_locations", &locate<plan::PencilPath>, "path"_a.none(false), "tool"_a, "collider"_a.none(false),
        py::kw_only(), "clearance"_a, "tolerance"_a, "max_lift"_a, "max_inserted"_a, "progress"_a);
  m.def("cutter_locations", &locate_poses, "path"_a.none(false), "tool"_a, "collider"_a.none(false), py::kw_only(),
        "clearance"_a, "tolerance"_a, "max_lift"_a, "max_inserted"_a, "progress"_a);
  m.def("orientation_maps", &maps, "path"_a.none(false), "points"_a, "tool"_a, "collider"_a.none(false), py::kw_only(),
        "inclinations"_a, "tilts"_a, "clearance"_a, "tolerance"_a, "limit"_a, "progress"_a);
  m.def("min_tilt", &choose, "path"_a.none(false), "tool"_a, "collider"_a.none(false), py::kw_only(), "inclinations"_a,
        "tilts"_a, "clearance"_a, "tolerance"_a, "limit"_a, "max_change"_a, "smoothness"_a, "progress"_a);
}

}  // namespace riffler::bindings
