// Contact: Collider and what a query gives.
#include <cmath>
#include <memory>
#include <mutex>
#include <variant>

#include "bindings/results.hpp"
#include "bindings/shared_volume.hpp"
#include "bindings/task.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/haptics/material.hpp"

namespace riffler::bindings {

namespace {

RIFFLER_TYPED(PushLike, "typing.Literal['normal', 'centre']")
RIFFLER_TYPED(StiffnessLike,
              "float | riffler._core.Material | collections.abc.Sequence[float | riffler._core.Material]")

bool same(const std::vector<tool::Frustum>& a, const std::vector<tool::Frustum>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const tool::Frustum& f, const tool::Frustum& g) {
    return f.z0 == g.z0 && f.r0 == g.r0 && f.z1 == g.z1 && f.r1 == g.r1;
  });
}

/// Whether two tools have the same shape; their names do not matter.
bool same(const Tool& a, const Tool& b) {
  const auto &s = a.profile().segments(), &t = b.profile().segments();
  return std::equal(s.begin(), s.end(), t.begin(), t.end(),
                    [](const tool::ProfileSegment& p, const tool::ProfileSegment& q) {
                      return p.to == q.to && p.centre == q.centre;
                    }) &&
         same(a.shank(), b.shank()) && same(a.holder(), b.holder());
}

/// The tool ready for contact: those asked for last are kept, for all colliders.
std::shared_ptr<const collide::Assembly> prepared(const Tool& tool) {
  tool.require_revolved("a collider");
  constexpr std::size_t kMax = 8;
  static std::mutex mutex;
  static std::vector<std::shared_ptr<const collide::Assembly>> kept;
  const std::lock_guard lock(mutex);
  for (const auto& a : kept)
    if (same(a->tool(), tool)) return a;
  if (kept.size() == kMax) kept.erase(kept.begin());
  return kept.emplace_back(std::make_shared<const collide::Assembly>(tool));
}

/// A number or a Material.
double to_stiffness(const py::handle& object) {
  if (py::isinstance<haptics::Material>(object)) return py::cast<const haptics::Material&>(object).stiffness;
  try {
    return py::cast<double>(object);
  } catch (const py::cast_error&) {
    throw py::type_error("fixture_stiffness must be a number or a Material, or a list of one for each fixture");
  }
}

using ColliderPtr = std::shared_ptr<collide::Collider>;

collide::Collider::FixturePush to_push(const PushLike& push) {
  const std::string name = py::isinstance<py::str>(push) ? py::cast<std::string>(push) : "";
  if (name == "normal") return collide::Collider::FixturePush::Normal;
  if (name == "centre") return collide::Collider::FixturePush::Centre;
  throw py::value_error("fixture_push must be \"normal\" or \"centre\", not " + py::cast<std::string>(py::repr(push)));
}

collide::Collider::Settings settings_of(const std::optional<double>& spacing, double stiffness, double holder_stiffness,
                                        const StiffnessLike& fixture_stiffness, const PushLike& fixture_push) {
  collide::Collider::Settings settings;
  settings.fixture_push = to_push(fixture_push);
  if (spacing && !(*spacing > 0)) throw py::value_error("spacing must be positive");
  if (spacing) settings.spacing = *spacing;
  settings.stiffness = stiffness, settings.holder_stiffness = holder_stiffness;
  if (py::isinstance<py::list>(fixture_stiffness) || py::isinstance<py::tuple>(fixture_stiffness))
    for (const py::handle one : fixture_stiffness) settings.stiffness_of_each.push_back(to_stiffness(one));
  else
    settings.fixture_stiffness = to_stiffness(fixture_stiffness);
  return settings;
}

/// A mesh, or an exact surface.
using PartPtr = std::variant<std::shared_ptr<Mesh>, std::shared_ptr<Surface>>;

auto made(const PartPtr& part, const std::vector<SharedVolume*>& fixtures, const std::optional<double>& spacing,
          double stiffness, double holder_stiffness, const StiffnessLike& fixture_stiffness,
          const PushLike& fixture_push, const ProgressLike& progress) {
  std::vector<Volume> volumes;
  for (SharedVolume* v : fixtures) {
    if (!v) throw py::value_error("fixtures, volume " + std::to_string(volumes.size()) + ": None");
    volumes.push_back(Reading(*v).volume.snapshot());
  }
  const auto work = [part, volumes = std::move(volumes),
                     settings = settings_of(spacing, stiffness, holder_stiffness, fixture_stiffness, fixture_push)](
                        const Progress& listener) {
    base::report(listener, 0);
    auto collider = std::visit(
        [&](const auto& some) { return std::make_shared<collide::Collider>(*some, volumes, settings); }, part);
    base::report(listener, 1);
    return collider;
  };
  return long_call(progress, work, Identity());
}

ColliderPtr make_collider(const PartPtr& part, const std::vector<SharedVolume*>& fixtures,
                          const std::optional<double>& spacing, double stiffness, double holder_stiffness,
                          const StiffnessLike& fixture_stiffness, const PushLike& fixture_push) {
  return made(part, fixtures, spacing, stiffness, holder_stiffness, fixture_stiffness, fixture_push,
              ProgressLike(py::none()))
      .cast<ColliderPtr>();
}

/// The row of `array` whose axis is not of unit length is named.
std::vector<Pose> checked_poses(const Doubles& array) {
  const std::vector<Pose> poses = to_poses(array, "poses");
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (!(std::abs(glm::length(poses[i].axis) - 1) <= 1e-6))
      throw py::value_error("poses, row " + std::to_string(i) + ": the axis is not a unit vector");
  return poses;
}

Pose one_pose(const Doubles& array) {
  if (array.ndim() != 1 || array.shape(0) != 6) throw py::value_error("pose must be 6 numbers: tip xyz, unit axis xyz");
  const double* p = array.data();
  const Pose pose{{p[0], p[1], p[2]}, {p[3], p[4], p[5]}};
  if (!geom::finite(pose.tip) || !geom::finite(pose.axis)) throw py::value_error("pose: not finite");
  if (!(std::abs(glm::length(pose.axis) - 1) <= 1e-6)) throw py::value_error("pose: the axis is not a unit vector");
  return pose;
}

collide::Contact query(const collide::Collider& self, const Tool& tool, const Doubles& array,
                       const std::optional<double>& budget_us) {
  const Pose pose = one_pose(array);
  if (budget_us && !(*budget_us >= 0)) throw py::value_error("budget_us must not be negative");
  const std::shared_ptr<const collide::Assembly> assembly = prepared(tool);
  const NoGil release;
  return self.query(*assembly, pose, budget_us ? std::optional(1e-6 * *budget_us) : std::nullopt);
}

std::vector<double> clearances(const collide::Collider& self, const Tool& tool, const Doubles& array) {
  const std::vector<Pose> poses = checked_poses(array);
  const std::shared_ptr<const collide::Assembly> assembly = prepared(tool);
  std::vector<double> out(poses.size());
  const NoGil release;
  base::parallel_for(poses.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out[i] = self.clearance(*assembly, poses[i]);
  });
  return out;
}

NearestResult nearest(const collide::Collider& self, const Tool& tool, const Doubles& array) {
  const Pose pose = one_pose(array);
  const std::shared_ptr<const collide::Assembly> assembly = prepared(tool);
  const collide::Collider::Nearest at = [&] {
    const NoGil release;
    return self.nearest(*assembly, pose);
  }();
  using namespace py::literals;
  return make_result(
      "Nearest", py::dict("distance"_a = at.distance, "point"_a = from_vec3(at.point), "part"_a = name_of(at.touch)));
}

std::string describe_collider(const collide::Collider& self) {
  const collide::Collider& c = self;
  return "<riffler.Collider: " + std::to_string(c.triangles()) + " triangles, " + std::to_string(c.points()) +
         " points " + py::cast<std::string>(py::str(py::float_(c.spacing()))) + " mm apart, " +
         std::to_string(c.fixtures()) + " fixtures>";
}

void bind_contact(py::module_& m) {
  py::class_<collide::Contact>(
      m, "Contact", "Contact of a tool at a pose. Forces act on the tool, in the part's frame. See `Collider.query`.")
      .def_property_readonly(
          "force", [](const collide::Contact& c) { return from_vec3(c.force); },
          "N, (3,): pushes the tool out of contact.")
      .def_property_readonly(
          "torque", [](const collide::Contact& c) { return from_vec3(c.torque); }, "N·mm, (3,), about the tip.")
      .def_readonly("depth", &collide::Contact::depth, "mm; 0 without contact.")
      .def_readonly("checked", &collide::Contact::checked,
                    "Share of the candidate triangles that was examined; 1 without a budget.")
      .def_readonly("missed_depth_bound", &collide::Contact::missed_depth_bound,
                    "mm: the true depth is at most depth + missed_depth_bound.")
      .def_property_readonly(
          "points", [](const collide::Contact& c) { return from_vec3s(c.points); },
          "(k, 3) mm: the deepest point, then the sample points and pieces of fixtures that are in the tool.")
      .def_property_readonly(
          "parts",
          [](const collide::Contact& c) {
            std::vector<std::string> names;
            for (const collide::Touch t : c.touches) names.emplace_back(name_of(t));
            return names;
          },
          "What touches at each point: \"cutter\", \"shank\", \"holder\", or \"fixture\" where it is one that is "
          "touched.")
      .def("__repr__", [](const collide::Contact& c) {
        return "<riffler.Contact: depth " + py::cast<std::string>(py::str(py::float_(c.depth))) + " mm, force " +
               py::cast<std::string>(py::str(py::float_(glm::length(c.force)))) + " N, " +
               std::to_string(c.points.size()) + " points>";
      });
}

}  // namespace

const char* name_of(collide::Touch touch) {
  constexpr const char* kNames[] = {"cutter", "shank", "holder", "fixture"};
  return kNames[static_cast<int>(touch)];
}

void bind_collide(py::module_& m) {
  bind_contact(m);
  py::class_<collide::Collider, std::shared_ptr<collide::Collider>>(
      m, "Collider",
      R"(A part and its fixtures, for contact and clearance of tools; immutable.

A pose is 6 numbers: tip in mm, unit axis from the tip to the spindle. Calls may come from several threads; they release
Python's lock.

Parameters
----------
part : Mesh or Surface
    The surface; an empty one is ignored. With an exact `Surface`, whose normals point out of the material, depth and
    clearance are those of the exact surface, to 1e-6 mm, and the force has no facets.
fixtures : list of Volume
    Each may have its own pitch; empty ones are ignored.
spacing : float, mm, or None
    Spacing of the points on the part over which forces are summed. Default: √(area / 100 000), of an exact
    `Surface` √(area / 400 000).
stiffness : float, N per mm of depth and mm² of surface
    Against the cutter.
holder_stiffness : float, N per mm of depth and mm² of surface
    Against shank and holder.
fixture_stiffness : float, N per mm³ of a fixture in the tool, or a Material, or a list of one for each fixture
    Against the whole tool.
fixture_push : {"normal", "centre"}
    Direction in which a fixture pushes: off the wall that the tool touches, or, as in the dissertation, towards the middle
    of cutter, shank or holder, which slides the tool along a wall.

Raises
------
ValueError
    Names the argument: a spacing that is not positive, another number of stiffnesses than of fixtures.

Examples
--------
>>> part = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz").to_mesh()
>>> collider = riffler.Collider(part)
>>> collider.clearance(riffler.Tool.ball(6, 30), [[10, 10, 12, 0, 0, 1]]).round(3).tolist()
[2.0]
)")
      .def(py::init(&make_collider), py::arg("part").none(false), py::kw_only(), py::arg("fixtures") = py::list(),
           py::arg("spacing") = py::none(), py::arg("stiffness") = 1.0, py::arg("holder_stiffness") = 10.0,
           py::arg("fixture_stiffness") = 10.0, py::arg("fixture_push") = "normal")
      .def_static("made", &made, py::arg("part").none(false), py::kw_only(), py::arg("fixtures") = py::list(),
                  py::arg("spacing") = py::none(), py::arg("stiffness") = 1.0, py::arg("holder_stiffness") = 10.0,
                  py::arg("fixture_stiffness") = 10.0, py::arg("fixture_push") = "normal",
                  py::arg("progress") = py::none(),
                  R"(The same as ``Collider(…)``, as a function with progress: what `riffler.submit` calls.

Parameters
----------
part : Mesh or Surface
    The surface; an empty one is ignored. With an exact `Surface`, whose normals point out of the material, depth and
    clearance are those of the exact surface, to 1e-6 mm, and the force has no facets.
fixtures : list of Volume
    Each may have its own pitch; empty ones are ignored.
spacing : float, mm, or None
    Spacing of the points on the part over which forces are summed. Default: √(area / 100 000), of an exact
    `Surface` √(area / 400 000).
stiffness : float, N per mm of depth and mm² of surface
    Against the cutter.
holder_stiffness : float, N per mm of depth and mm² of surface
    Against shank and holder.
fixture_stiffness : float, N per mm³ of a fixture in the tool, or a Material, or a list of one for each fixture
    Against the whole tool.
fixture_push : {"normal", "centre"}
    Direction in which a fixture pushes: off the wall that the tool touches, or, as in the dissertation, towards the middle
    of cutter, shank or holder, which slides the tool along a wall.
progress : callable or None
    Called at the beginning and at the end only.

Returns
-------
Collider
    A new collider.

Examples
--------
>>> part = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5).to_mesh()
>>> riffler.submit(riffler.Collider, part, spacing=0.5).result().spacing
0.5
)")
      .def("query", &query, py::arg("tool"), py::arg("pose"), py::kw_only(), py::arg("budget_us") = py::none(),
           R"(Force, torque, depth and points of a tool in contact.

Parameters
----------
tool : Tool
    Cutter, shank and holder.
pose : array_like of shape (6,), tip in mm and unit axis
    Poses of the tool.
budget_us : float, µs, or None
    Time after which the rest is only bounded: see ``checked`` and ``missed_depth_bound``.

Returns
-------
Contact
    A contact; its depth is 0 if nothing touches.

Raises
------
ValueError
    Names the argument: an axis that is not a unit vector, a number that is not finite, a negative budget.

Examples
--------
>>> part = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz").to_mesh()
>>> collider = riffler.Collider(part)
>>> hit = collider.query(riffler.Tool.ball(6, 30), [10, 10, 9.5, 0, 0, 1])
>>> round(hit.depth, 3), hit.parts[0], bool(hit.force[2] > 0)
(0.5, 'cutter', True)
)")
      .def(
          "clearance",
          [](const collide::Collider& self, const Tool& tool, const Doubles& poses) {
            return take<double>(clearances(self, tool, poses));
          },
          py::arg("tool"), py::arg("poses"),
          R"(The smallest signed distance between the part's surface and a tool at each pose, on all threads.

The tool is the union of cutter, shank and holder. Fixtures do not count.

Parameters
----------
tool : Tool
    Cutter, shank and holder.
poses : array_like of shape (n, 6), tip in mm and unit axis
    Poses of the tool.

Returns
-------
ndarray of shape (n,), float64, mm
    Negative where they overlap.

Raises
------
ValueError
    Names argument and row.

Examples
--------
>>> part = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz").to_mesh()
>>> collider = riffler.Collider(part)
>>> collider.clearance(riffler.Tool.flat(6, 30), [[10, 10, 11, 0, 0, 1], [10, 10, 9, 0, 0, 1]]).round(3).tolist()
[1.0, -1.0]
)")
      .def("nearest", &nearest, py::arg("tool"), py::arg("pose"),
           R"(The point of part and fixtures that is nearest to a tool.

Parameters
----------
tool : Tool
    Cutter, shank and holder.
pose : array_like of shape (6,), tip in mm and unit axis
    Poses of the tool.

Returns
-------
Nearest
    Distance, point on part or fixture, and the nearest part of the tool, or "fixture".

Examples
--------
>>> part = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz").to_mesh()
>>> collider = riffler.Collider(part)
>>> distance, point, part = collider.nearest(riffler.Tool.ball(6, 30), [10, 10, 12, 0, 0, 1])
>>> round(distance, 3), part
(2.0, 'cutter')
)")
      .def_property_readonly(
          "spacing", [](const collide::Collider& self) { return self.spacing(); },
          "Spacing of the points on the part, mm.")
      .def("__repr__", &describe_collider);
}

}  // namespace riffler::bindings
