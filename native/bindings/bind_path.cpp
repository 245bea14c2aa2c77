// Paths along a part: PencilPath.
#include <cmath>
#include <memory>

#include "bindings/program_types.hpp"
#include "plan/pick.hpp"
#include "riffler/base/check.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "riffler/plan/orientation.hpp"

namespace riffler::bindings {

plan::OrientationKeys to_keys(const KeysLike& object) {
  if (!py::isinstance<py::dict>(object)) throw py::value_error("keys must be a dict: index to axis");
  plan::OrientationKeys out;
  for (const auto& [key, value] : py::cast<py::dict>(object)) {
    const std::string name = "keys, point " + py::cast<std::string>(py::str(key));
    const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(key.ptr()));
    if (!index) {
      PyErr_Clear();
      throw py::value_error(name + ": the index must be a whole number");
    }
    const Vec3 axis = to_vec3(py::reinterpret_borrow<py::object>(value), name.c_str());
    if (index < py::int_(0)) throw py::value_error(name + ": indices begin at 0");
    out[py::cast<std::size_t>(index)] = axis;
  }
  return out;
}

ArrayDict from_keys(const plan::OrientationKeys& keys) {
  py::dict out;
  for (const auto& [k, axis] : keys) out[py::int_(k)] = from_vec3(axis);
  return out;
}

namespace {

using Pairs = std::vector<std::array<Vec3, 2>>;
using Path = std::shared_ptr<plan::PencilPath>;

static_assert(sizeof(std::array<Vec3, 2>) == 6 * sizeof(double));

py::array_t<double> from_pairs(const Pairs& pairs) {
  return take<double>(Pairs(pairs), 6)
      .reshape({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}, py::ssize_t{3}});
}

/// (n, 2, 3) copy; every pair is one row of six.
Pairs to_pairs(const Doubles& array, std::size_t n, const char* name) {
  if (array.ndim() != 3 || static_cast<std::size_t>(array.shape(0)) != n || array.shape(1) != 2 || array.shape(2) != 3)
    throw py::value_error(std::string(name) + " must have the shape (" + std::to_string(n) + ", 2, 3)");
  const auto rows = Doubles(py::object(array).attr("reshape")(n, 6));
  check_rows(rows, 6, name);
  Pairs out(n);
  const double* p = rows.data();
  for (std::array<Vec3, 2>& pair : out) {
    pair = {Vec3{p[0], p[1], p[2]}, Vec3{p[3], p[4], p[5]}};
    p += 6;
  }
  return out;
}

Path make_path(double radius, const Doubles& centres, const Doubles& contacts, const Doubles& normals, bool closed) {
  if (!std::isfinite(radius) || !(radius > 0)) throw py::value_error("radius must be positive and finite");
  auto out = std::make_shared<plan::PencilPath>();
  out->radius = radius, out->closed = closed;
  out->centres = to_vec3s(centres, "centres");
  const std::size_t n = out->size();
  if (n == 0) throw py::value_error("centres: at least one is needed");
  out->contacts = to_pairs(contacts, n, "contacts"), out->normals = to_pairs(normals, n, "normals");
  for (std::size_t k = 0; k < n; ++k)
    for (Vec3& normal : out->normals[k]) normal = plan::unit_axis(normal, "normals, row " + std::to_string(k));
  return out;
}

Path orient(const plan::PencilPath& path, const KeysLike& keys, const std::string& interpolation, const ConeLike& limit,
            bool project) {
  return std::make_shared<plan::PencilPath>(
      oriented(path, to_keys(keys), plan::interpolation_named(interpolation), to_axis_limit(limit, project)));
}

NearestContactResult from_picked(const plan::Picked& p) {
  using namespace py::literals;
  return program_result("NearestContact", py::dict("index"_a = p.index, "side"_a = p.side, "distance"_a = p.distance,
                                                   "point"_a = from_vec3(p.point), "normal"_a = from_vec3(p.normal)));
}

/// (n, 3, 3): rows x, y, z.
py::array_t<double> frames(const plan::PencilPath& path) {
  std::vector<plan::CcFrame> out;
  for (std::size_t k = 0; k < path.size(); ++k) out.push_back(frame_at(path, k));
  return take<double>(std::move(out), 9)
      .reshape({static_cast<py::ssize_t>(path.size()), py::ssize_t{3}, py::ssize_t{3}});
}

plan::CcFrame frame_of(const plan::PencilPath& path, std::size_t index) {
  if (index >= path.size())
    throw py::value_error("point " + std::to_string(index) + ": the path has " + std::to_string(path.size()) +
                          " points");
  return frame_at(path, index);
}

}  // namespace

std::optional<plan::AxisLimit> to_axis_limit(const py::object& object, bool project) {
  if (object.is_none()) return {};
  if (!py::isinstance<py::sequence>(object) || py::len(object) != 2)
    throw py::value_error("limit must be (axis, angle)");
  const auto pair = py::cast<py::sequence>(object);
  try {
    return plan::AxisLimit{to_vec3(pair[0], "limit"), py::cast<double>(pair[1]), project};
  } catch (const py::cast_error&) {
    throw py::value_error("limit: the angle must be a number");
  }
}

void bind_path(py::module_& m) {
  py::class_<plan::PencilPath, Path>(m, "PencilPath",
                                     R"(A curve of ball centres along a part, with the ball's contacts. Immutable.

Parameters
----------
radius : float
    Radius of the ball, mm.
centres : array_like, shape (n, 3)
    mm.
contacts : array_like, shape (n, 2, 3)
    Points of the part that the ball touches, mm.
normals : array_like, shape (n, 2, 3)
    The part's unit normals there, out of the material.
closed : bool
    A loop: its last point is joined to its first.

Examples
--------
>>> contacts = [[(x, -1.2, 1.6), (x, 1.2, 1.6)] for x in (0, 10)]
>>> normals = [[(0, 0.6, 0.8), (0, -0.6, 0.8)]] * 2
>>> path = riffler.plan.PencilPath(2.0, [(0, 0, 3.2), (10, 0, 3.2)], contacts, normals)
>>> path.length
10.0
)")
      .def(py::init(&make_path), py::arg("radius"), py::arg("centres"), py::arg("contacts"), py::arg("normals"),
           py::kw_only(), py::arg("closed") = false)
      .def_readonly("radius", &plan::PencilPath::radius, "Radius of the ball, mm.")
      .def_readonly("closed", &plan::PencilPath::closed, "A loop: its last point is joined to its first.")
      .def_property_readonly("length", &plan::PencilPath::length, "mm, with the closing edge.")
      .def_property_readonly(
          "centres", [](const plan::PencilPath& p) { return from_vec3s(p.centres); }, "(n, 3) mm.")
      .def_property_readonly(
          "contacts", [](const plan::PencilPath& p) { return from_pairs(p.contacts); }, "(n, 2, 3) mm.")
      .def_property_readonly(
          "normals", [](const plan::PencilPath& p) { return from_pairs(p.normals); },
          "(n, 2, 3): unit normals of the part at the contacts, out of the material.")
      .def_property_readonly(
          "axes", [](const plan::PencilPath& p) { return from_vec3s(p.axes); },
          "(n, 3): unit tool axes, tip to spindle; (0, 3) until the path is oriented.")
      .def_property_readonly(
          "keys", [](const plan::PencilPath& p) { return from_keys({p.keys.begin(), p.keys.end()}); },
          "The axes that the others were interpolated from, by index.")
      .def_readonly("interpolation", &plan::PencilPath::interpolation,
                    "How the axes were interpolated; empty until the path is oriented.")
      .def_property_readonly("frames", &frames, R"((n, 3, 3): the rows x, y, z of the frame at every point.

x is the feed, z halves the angle between the directions from the contacts to the ball's centre, y = z × x.)")
      .def("orient", &orient, py::arg("keys"), py::kw_only(), py::arg("interpolation") = "smooth",
           py::arg("limit") = py::none(), py::arg("project") = false,
           R"(A new path with tool axes at all points, interpolated from some.

To adjust an interpolated axis, make it a key: ``p.orient({**p.keys, i: axis})``.

Parameters
----------
keys : dict
    Index of a point, from 0, to unit axis. Axes are constant before the first key and after the last; on a closed path
    they are also interpolated from the last to the first.
interpolation : {"smooth", "slerp", "linear"}
    "linear": straight between two axes by number of points and made unit, the source's (4.4)-(4.5); "slerp": the great
    circle at constant rate by arc length; "smooth": by arc length with a continuous derivative, at most 1.7 times as
    fast as slerp.
limit : tuple of axis and angle, optional
    The cone in which the machine's rotary axes keep the tool: unit axis, half angle in rad.
project : bool
    Moves an axis beyond ``limit`` onto the cone; otherwise it is an error.

Returns
-------
PencilPath

Raises
------
ValueError
    Naming the first point beyond ``limit``, or the key that is outside the path, not a unit vector, or opposite to the key
    before it.

Examples
--------
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
>>> valley.divided(10).orient({0: (0, 0, 1), 3: (0.6, 0, 0.8)}).axes.shape
(4, 3)
)")
      .def(
          "with_axes",
          [](const plan::PencilPath& p, const Doubles& axes, const KeysLike& keys, const std::string& interpolation) {
            return std::make_shared<plan::PencilPath>(
                with_axes(p, to_vec3s(axes, "axes"), to_keys(keys), interpolation));
          },
          py::arg("axes"), py::kw_only(), py::arg("keys") = py::dict(), py::arg("interpolation") = "",
          R"(A new path with axes that were computed elsewhere.

Parameters
----------
axes : array_like, shape (n, 3)
    Unit tool axes, tip to spindle.
keys : dict, optional
    Index to axis; kept with the axes.
interpolation : str
    Kept likewise.

Returns
-------
PencilPath

Examples
--------
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
>>> valley.with_axes([(0, 0, 1)] * len(valley)).axes
array([[0., 0., 1.],
       [0., 0., 1.]])
)")
      .def(
          "axis",
          [](const plan::PencilPath& p, std::size_t index, double inclination, double tilt) {
            base::require_angle(inclination, "inclination"), base::require_angle(tilt, "tilt");
            return from_vec3(axis_of(frame_of(p, index), {inclination, tilt}));
          },
          py::arg("index"), py::arg("inclination"), py::arg("tilt"),
          R"(Unit axis that leans from the frame's z at a point: the inverse of ``lean``.

cos(tilt) (sin(inclination) x + cos(inclination) z) + sin(tilt) y.

Parameters
----------
index : int
    Number of the point, from 0.
inclination, tilt : float
    rad, forward and to the left.

Returns
-------
ndarray, shape (3,)

Examples
--------
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
>>> valley.axis(0, 0.0, 0.0).round(6) + 0.0
array([0., 0., 1.])
)")
      .def(
          "lean",
          [](const plan::PencilPath& p, std::size_t index, const ArrayLike& axis) -> Angles {
            const plan::Lean lean = lean_of(frame_of(p, index), plan::unit_axis(to_vec3(axis, "axis"), "axis"));
            return py::make_tuple(lean.inclination, lean.tilt);
          },
          py::arg("index"), py::arg("axis"),
          R"(Inclination and tilt of an axis at a point: the inverse of ``axis``.

Parameters
----------
index : int
    Number of the point, from 0.
axis : array_like, shape (3,)
    Unit axis.

Returns
-------
inclination, tilt : float
    rad.

Examples
--------
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
>>> inclination, tilt = valley.lean(0, valley.axis(0, 0.1, 0.2))
>>> round(inclination, 6), round(tilt, 6)
(0.1, 0.2)
)")
      .def(
          "nearest",
          [](const plan::PencilPath& p, const ArrayLike& point, const OptionalArrayLike& direction) {
            const Vec3 at = to_vec3(point, "point");
            return from_picked(direction.is_none() ? nearest_contact(p, at)
                                                   : nearest_contact(p, at, to_vec3(direction, "direction")));
          },
          py::arg("point"), py::kw_only(), py::arg("direction") = py::none(),
          R"(The contact nearest to a point, or to a ray of a pen or mouse.

Parameters
----------
point : array_like, shape (3,)
    mm.
direction : array_like, shape (3,), optional
    The ray's direction.

Returns
-------
NearestContact

Examples
--------
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
>>> valley.nearest((1, 12, 2)).index in (0, 1)
True
)")
      .def(
          "divided",
          [](const plan::PencilPath& path, double step) {
            return std::make_shared<plan::PencilPath>(divided(path, step));
          },
          py::arg("step"),
          R"(The path with further points, so that keys can be set there: a straight valley has only its ends.

Parameters
----------
step : float
    mm; points are inserted evenly between two that are further apart.

Returns
-------
PencilPath
    Without axes.

Examples
--------
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> (valley,) = riffler.plan.pencil(part, riffler.Tool.ball(diameter=4, length=20))
>>> len(valley), len(valley.divided(10))
(2, 4)
)")
      .def("__len__", &plan::PencilPath::size);
}

}  // namespace riffler::bindings
