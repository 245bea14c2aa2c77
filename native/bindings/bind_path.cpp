// Paths along a part: PencilPath.
#include <cmath>
#include <memory>

#include "bindings/bindings.hpp"
#include "plan/pick.hpp"
#include "riffler/base/check.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "riffler/plan/orientation.hpp"

namespace riffler::bindings {

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

Path make(double radius, const Doubles& centres, const Doubles& contacts, const Doubles& normals, bool closed) {
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

plan::OrientationKeys to_keys(const py::object& object) {
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

py::dict from_keys(const plan::PencilPath& path) {
  py::dict out;
  for (const auto& [k, axis] : path.keys) out[py::int_(k)] = from_vec3(axis);
  return out;
}

Path orient(const plan::PencilPath& path, const py::object& keys, const std::string& interpolation,
            const py::object& limit, bool project) {
  return std::make_shared<plan::PencilPath>(
      oriented(path, to_keys(keys), plan::interpolation_named(interpolation), to_axis_limit(limit, project)));
}

py::dict from_picked(const plan::Picked& p) {
  using namespace py::literals;
  return py::dict("index"_a = p.index, "side"_a = p.side, "distance"_a = p.distance, "point"_a = from_vec3(p.point),
                  "normal"_a = from_vec3(p.normal));
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
  py::class_<plan::PencilPath, Path>(
      m, "PencilPath",
      R"(A curve of ball centres along a part, with what the ball touches at each. See riffler.plan. Immutable.)")
      .def(py::init(&make), py::arg("radius"), py::arg("centres"), py::arg("contacts"), py::arg("normals"),
           py::arg("closed") = false,
           R"(centres (n, 3), contacts (n, 2, 3) mm and normals (n, 2, 3), unit, out of the material.)")
      .def_readonly("radius", &plan::PencilPath::radius, "Of the ball, mm.")
      .def_readonly("closed", &plan::PencilPath::closed, "A loop: its last point is joined to its first.")
      .def_property_readonly("length", &plan::PencilPath::length, "mm, of the closing edge too.")
      .def_property_readonly(
          "centres", [](const plan::PencilPath& p) { return from_vec3s(p.centres); }, "(n, 3) mm")
      .def_property_readonly(
          "contacts", [](const plan::PencilPath& p) { return from_pairs(p.contacts); }, "(n, 2, 3) mm")
      .def_property_readonly(
          "normals", [](const plan::PencilPath& p) { return from_pairs(p.normals); },
          "(n, 2, 3): unit normals of the part at the contacts, out of the material.")
      .def_property_readonly(
          "axes", [](const plan::PencilPath& p) { return from_vec3s(p.axes); },
          "(n, 3): unit tool axes, tip to spindle; (0, 3) until the path is oriented.")
      .def_property_readonly("keys", &from_keys, "dict: index to axis, of what the axes were interpolated from.")
      .def_readonly("interpolation", &plan::PencilPath::interpolation, "How; empty until the path is oriented.")
      .def_property_readonly("frames", &frames, R"((n, 3, 3): the rows x, y, z of the frame at every point.

x is the feed, z halves the angle between the directions from the contacts to the ball's centre, y = z × x.)")
      .def(
          "oriented", &orient, py::arg("keys"), py::arg("interpolation") = "smooth", py::kw_only(),
          py::arg("limit") = py::none(), py::arg("project") = false,
          R"(A new path with tool axes at all points, interpolated from ``keys``: a dict of index (from 0) to unit axis.

``interpolation``: ``"linear"``, straight between two axes by number of points and made unit, the source's (4.4)-(4.5);
``"slerp"``, the great circle at constant rate by arc length; ``"smooth"``, by arc length with a continuous derivative,
at most 1.7 times as fast as slerp. Constant before the first key and after the last; on a closed path also from the
last to the first. To adjust an interpolated axis, make it a key: ``p.oriented({**p.keys, i: axis})``.
``limit``: (axis, angle), the cone in which the machine's rotary axes keep the tool; an axis beyond it is a ValueError
naming the first point, or is moved onto the cone with ``project=True``. ValueError names the point of a key that is
outside the path, not a unit vector, or opposite to the key before it.)")
      .def(
          "with_axes",
          [](const plan::PencilPath& p, const Doubles& axes, const py::object& keys, const std::string& interpolation) {
            return std::make_shared<plan::PencilPath>(
                with_axes(p, to_vec3s(axes, "axes"), to_keys(keys), interpolation));
          },
          py::arg("axes"), py::arg("keys") = py::dict(), py::arg("interpolation") = "",
          "A new path with these axes (n, 3), which came about elsewhere; keys and interpolation are kept beside them.")
      .def(
          "axis",
          [](const plan::PencilPath& p, std::size_t index, double inclination, double tilt) {
            base::require_angle(inclination, "inclination"), base::require_angle(tilt, "tilt");
            return from_vec3(axis_of(frame_of(p, index), {inclination, tilt}));
          },
          py::arg("index"), py::arg("inclination"), py::arg("tilt"),
          "Unit axis at a point that leans forward by ``inclination`` and to the left by ``tilt``, rad: "
          "cos(tilt) (sin(inclination) x + cos(inclination) z) + sin(tilt) y.")
      .def(
          "lean",
          [](const plan::PencilPath& p, std::size_t index, const py::object& axis) {
            const plan::Lean lean = lean_of(frame_of(p, index), plan::unit_axis(to_vec3(axis, "axis"), "axis"));
            return py::make_tuple(lean.inclination, lean.tilt);
          },
          py::arg("index"), py::arg("axis"), "(inclination, tilt) of an axis at a point, rad: the inverse of ``axis``.")
      .def(
          "nearest",
          [](const plan::PencilPath& p, const py::object& point, const py::object& direction) {
            const Vec3 at = to_vec3(point, "point");
            return from_picked(direction.is_none() ? nearest_contact(p, at)
                                                   : nearest_contact(p, at, to_vec3(direction, "direction")));
          },
          py::arg("point"), py::arg("direction") = py::none(),
          R"(The contact nearest to a point, or to the ray from it in a direction: what a pen or a mouse points at.

A dict: ``index`` of the path's point, ``side`` (0 or 1) of its two contacts, ``distance`` mm, ``point``, ``normal``.)")
      .def(
          "divided",
          [](const plan::PencilPath& path, double step) {
            return std::make_shared<plan::PencilPath>(divided(path, step));
          },
          py::arg("step"),
          "With further points, evenly between two that are more than ``step`` mm apart (a straight valley has only "
          "its ends), so that keys can be set there. Without axes.")
      .def("__len__", &plan::PencilPath::size);
}

}  // namespace riffler::bindings
