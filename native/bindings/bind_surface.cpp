// riffler.Surface: exact surfaces of NURBS patches.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings/mesh_class.hpp"
#include "bindings/surface_class.hpp"
#include "bindings/task.hpp"
#include "bindings/typed.hpp"
#include "riffler/nurbs/surface.hpp"

namespace riffler::bindings {

namespace {

using SurfacePtr = std::shared_ptr<Surface>;
using Array = py::array_t<double>;

/// A numeric array of so many dimensions; ValueError naming the argument, with what it must be.
Doubles numbers(const py::object& object, py::ssize_t dimensions, const char* name, const char* must) {
  Doubles array = Doubles::ensure(object);
  if (!array) {
    PyErr_Clear();
    throw py::value_error(std::string(name) + " must be " + must);
  }
  if (array.ndim() != dimensions)
    throw py::value_error(std::string(name) + " must be " + must + ", not an array of the shape " +
                          py::str(array.attr("shape")).cast<std::string>());
  return array;
}

std::vector<double> to_knots(const py::object& object, const char* name) {
  const Doubles array = numbers(object, 1, name, "a list of numbers");
  return {array.data(), array.data() + array.size()};
}

RIFFLER_TYPED(TrimsLike, "collections.abc.Sequence[numpy.typing.ArrayLike] | None")

std::vector<std::vector<Vec2>> to_trims(const TrimsLike& object) {
  std::vector<std::vector<Vec2>> loops;
  if (object.is_none()) return loops;
  if (!py::isinstance<py::sequence>(object))
    throw py::value_error("trims must be a list of arrays of the shape (k, 2)");
  for (const py::handle one : object) {
    const std::string loop = "trims, loop " + std::to_string(loops.size());
    const Doubles rows =
        numbers(py::reinterpret_borrow<py::object>(one), 2, loop.c_str(), "numbers of the shape (k, 2)");
    if (rows.shape(1) != 2) throw py::value_error(loop + " must be numbers of the shape (k, 2)");
    loops.emplace_back();
    for (py::ssize_t i = 0; i < rows.shape(0); ++i) loops.back().emplace_back(rows.at(i, 0), rows.at(i, 1));
  }
  return loops;
}

SurfacePtr read_surface_file(const std::filesystem::path& path, double tolerance, const ProgressLike& progress) {
  using namespace py::literals;
  return py::module_::import("riffler.cad.reading")
      .attr("read_surface")(path, "tolerance"_a = tolerance, "progress"_a = progress)
      .cast<SurfacePtr>();
}

std::size_t to_patch(const Surface& surface, std::int64_t patch) {
  if (patch < 0 || static_cast<std::size_t>(patch) >= surface.patches().size())
    throw py::value_error("patch " + std::to_string(patch) + " does not exist; the surface has " +
                          std::to_string(surface.patches().size()) + ", counted from 0");
  return static_cast<std::size_t>(patch);
}

py::array_t<bool> inside(const Surface& surface, const Doubles& uv, std::int64_t patch) {
  const std::size_t n = check_rows(uv, 2, "uv");
  std::vector<Vec2> at;
  for (std::size_t i = 0; i < n; ++i) at.emplace_back(uv.data()[2 * i], uv.data()[2 * i + 1]);
  const std::vector<char> found = surface.inside(at, to_patch(surface, patch));
  py::array_t<bool> out(static_cast<py::ssize_t>(n));
  std::copy(found.begin(), found.end(), out.mutable_data());
  return out;
}

SurfacePtr make_nurbs(const ArrayLike& points, const ArrayLike& weights, const ArrayLike& knots_u,
                      const ArrayLike& knots_v, int degree_u, int degree_v, const TrimsLike& trims,
                      const std::string& name) {
  const Doubles p = numbers(points, 3, "points", "numbers of the shape (nu, nv, 3), mm");
  if (p.shape(2) != 3)
    throw py::value_error("points must have the shape (nu, nv, 3), not " +
                          py::str(p.attr("shape")).cast<std::string>() +
                          "; weights are an argument of their own, and points are not multiplied by them");
  const Doubles w = numbers(weights, 2, "weights", "numbers of the shape (nu, nv)");
  if (w.shape(0) != p.shape(0) || w.shape(1) != p.shape(1))
    throw py::value_error("weights must have the shape (" + std::to_string(p.shape(0)) + ", " +
                          std::to_string(p.shape(1)) + ") of points, not " +
                          py::str(w.attr("shape")).cast<std::string>());
  nurbs::Patch patch;
  patch.count_u = static_cast<std::size_t>(p.shape(0)), patch.count_v = static_cast<std::size_t>(p.shape(1));
  const double* x = p.data();
  for (std::size_t i = 0; i < patch.count_u * patch.count_v; ++i, x += 3) patch.points.emplace_back(x[0], x[1], x[2]);
  patch.weights.assign(w.data(), w.data() + w.size());
  patch.knots_u = to_knots(knots_u, "knots_u"), patch.knots_v = to_knots(knots_v, "knots_v");
  patch.degree_u = degree_u, patch.degree_v = degree_v;
  patch.trims = to_trims(trims), patch.name = name;
  std::vector<nurbs::Patch> patches;
  patches.push_back(std::move(patch));
  const NoGil release;
  return std::make_shared<Surface>(std::move(patches));
}

SurfacePtr joined(const std::vector<SurfacePtr>& surfaces) {
  std::vector<nurbs::Patch> patches;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (!surfaces[i]) throw py::value_error("surfaces, row " + std::to_string(i) + ": None");
    patches.insert(patches.end(), surfaces[i]->patches().begin(), surfaces[i]->patches().end());
  }
  const NoGil release;
  return std::make_shared<Surface>(std::move(patches));
}

auto evaluate(const SurfacePtr& surface, const Doubles& uv, std::int64_t patch, const ProgressLike& progress) {
  const std::size_t n = check_rows(uv, 2, "uv");
  std::vector<Vec2> at;
  for (std::size_t i = 0; i < n; ++i) at.emplace_back(uv.data()[2 * i], uv.data()[2 * i + 1]);
  const auto work = [surface, at = std::move(at), which = to_patch(*surface, patch)](const Progress& listener) {
    return surface->evaluate(at, which, listener);
  };
  return long_call(progress, work, [](std::vector<nurbs::SurfacePoint>&& found) {
    std::vector<Vec3> points, normals;
    for (const nurbs::SurfacePoint& f : found) points.push_back(f.point), normals.push_back(f.normal);
    return std::tuple<Array, Array>(take<double>(std::move(points), 3), take<double>(std::move(normals), 3));
  });
}

auto closest(const SurfacePtr& surface, const Doubles& points, const ProgressLike& progress) {
  const auto work = [surface, at = to_vec3s(points, "points")](const Progress& listener) {
    return surface->closest(at, listener);
  };
  return long_call(progress, work, [](std::vector<nurbs::Foot>&& found) {
    std::vector<Vec3> feet, normals;
    std::vector<double> distance;
    for (const nurbs::Foot& f : found)
      feet.push_back(f.point), normals.push_back(f.normal), distance.push_back(f.distance);
    return std::tuple<Array, Array, Array>(take<double>(std::move(feet), 3), take<double>(std::move(normals), 3),
                                           take<double>(std::move(distance)));
  });
}

auto surface_to_mesh(const SurfacePtr& surface, double tolerance, const ProgressLike& progress) {
  const auto work = [surface, tolerance](const Progress& listener) {
    return std::make_shared<Mesh>(surface->to_mesh(tolerance, listener));
  };
  return long_call(progress, work, Identity());
}

Array domain(const Surface& surface, std::int64_t patch) {
  const nurbs::Patch& p = surface.patches()[to_patch(surface, patch)];
  return take<double>(std::vector<Vec2>{p.lower(), p.upper()}, 2);
}

}  // namespace

void bind_surface(py::module_& m) {
  using namespace py::literals;
  py::class_<Surface, SurfacePtr> surface(
      m, "Surface",
      R"(An exact surface of rational B-spline (NURBS) patches, mm. It never changes.

`Surface.nurbs` makes a surface of one patch; this makes one of several, which need not be connected.

Parameters
----------
surfaces : list of Surface
    Their patches, in this order.

Raises
------
ValueError
    No surface.

Examples
--------
>>> flat = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
...                              [0, 0, 1, 1], [0, 0, 1, 1], 1, 1)
>>> wall = riffler.Surface.nurbs([[[0, 0, 0], [4, 0, 0]], [[0, 0, 3], [4, 0, 3]]], [[1, 1], [1, 1]],
...                              [0, 0, 1, 1], [0, 0, 1, 1], 1, 1)
>>> riffler.Surface([flat, wall])
<riffler.Surface: 2 patches>
)");
  surface.def(py::init(&joined), "surfaces"_a);
  surface.def_static("nurbs", &make_nurbs, "points"_a, "weights"_a, "knots_u"_a, "knots_v"_a, "degree_u"_a,
                     "degree_v"_a, py::kw_only(), "trims"_a = py::none(), "name"_a = "",
                     R"(A surface of one patch.

Parameters
----------
points : array_like of shape (nu, nv, 3), mm
    Control points, not multiplied by the weights.
weights : array_like of shape (nu, nv)
    Positive, with a ratio of at most 1e12.
knots_u : array_like of nu + degree_u + 1 numbers
    Not decreasing; the patch's domain begins at knot degree_u and ends at knot nu.
knots_v : array_like of nv + degree_v + 1 numbers
    Likewise.
degree_u, degree_v : int, 1 to 15
    Degrees of the polynomials.
trims : list of array_like of shape (k, 2), or None
    Borders: closed polylines in (u, v) within the domain, the last point joined to the first. The patch is where an odd
    number of them encloses a parameter. None: the whole domain. With borders, degree_u + degree_v may be at most 15.
name : str
    See ``names``.

Returns
-------
Surface
    Its normals are in the direction of dS/du × dS/dv.

Raises
------
ValueError
    Names argument and row: a wrong shape or number of knots, knots that decrease or tear the surface, a weight that is
    not positive, a degree out of range, a number that is not finite, a border that leaves the domain or encloses nothing.

Examples
--------
>>> r = 0.5 ** 0.5
>>> quarter = riffler.Surface.nurbs([[[5, 0, 0], [5, 0, 9]], [[5, 5, 0], [5, 5, 9]], [[0, 5, 0], [0, 5, 9]]],
...                                 [[1, 1], [r, r], [1, 1]], [0, 0, 0, 1, 1, 1], [0, 0, 1, 1], 2, 1)
>>> points, normals, distance = quarter.closest([[6, 8, 4]])  # of a cylinder of radius 5
>>> points.round(9).tolist(), distance.round(9).tolist()
([[3.0, 4.0, 4.0]], [5.0])
)");
  surface.def_static("read", &read_surface_file, "path"_a, py::kw_only(), "tolerance"_a = 1e-4,
                     "progress"_a = py::none(),
                     R"(The exact faces of a STEP, IGES or BREP file: one patch for each face, in its place, in mm.

OpenCASCADE (``pip install 'riffler[cad]'``) converts the faces to rational B-splines, in a process of its own, without
approximating planes, quadrics and tori. Edges become borders. Normals point out of solids.

Parameters
----------
path : path_like
    A file with the extension .step, .stp, .iges, .igs or .brep.
tolerance : float, mm
    Of the borders: distance of their straight pieces from the edges, measured in their middles.
progress : callable or None
    Called with the finished share several times a second; returning False cancels.

Returns
-------
Surface
    Its ``names`` are those of the faces.

Raises
------
FormatError
    The file has no faces, is damaged, or has a face without an exact surface.
ValueError
    An argument is wrong, or the package is missing; the message then has the command that installs it.
riffler.cad.CadReaderError
    The reader's process crashed.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> part = riffler.Surface.read("part.step")
>>> part.patch_count, part.names[5]
(12, 'datum A')
)");
  surface.def("inside", &inside, "uv"_a, "patch"_a = 0,
              R"(Whether parameters are inside the borders of a patch.

Parameters
----------
uv : array_like of shape (n, 2)
    Parameters, within the domain of the patch.
patch : int
    Which patch, counted from 0.

Returns
-------
ndarray of shape (n,), bool
    True everywhere for a patch without borders.

Raises
------
ValueError
    Names the row of parameters that are not in the domain, or a patch that does not exist.

Examples
--------
>>> corner = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
...                                [0, 0, 1, 1], [0, 0, 1, 1], 1, 1, trims=[[[0, 0], [1, 0], [0, 1]]])
>>> corner.inside([[0.2, 0.2], [0.9, 0.9]]).tolist()
[True, False]
)");
  surface.def("evaluate", &evaluate, "uv"_a, py::kw_only(), "patch"_a = 0, "progress"_a = py::none(),
              R"(Points and unit normals at parameters.

At a pole, where a derivative is 0, the normal is the limit of those inside the patch. It is 0 where the patch has no
area.

Parameters
----------
uv : array_like of shape (n, 2)
    Parameters, within the domain of the patch.
patch : int
    Which patch, counted from 0.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
(points, normals) : ndarrays of shape (n, 3), float64
    mm, and unit vectors in the direction of dS/du × dS/dv.

Raises
------
ValueError
    Names the row of parameters that are not in the domain, or a patch that does not exist.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> flat = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
...                              [0, 0, 1, 1], [0, 0, 1, 1], 1, 1)
>>> points, normals = flat.evaluate([[0.5, 0.2]])
>>> points.tolist(), normals.tolist()
([[2.0, 1.0, 0.0]], [[0.0, 0.0, 1.0]])
)");
  surface.def("closest", &closest, "points"_a, py::kw_only(), "progress"_a = py::none(),
              R"(The nearest point of the surface to each point, of all patches: never a local minimum.

No point of the surface is nearer than the returned distance by more than 1e-9 mm, or 1e-13 of the largest coordinate of
surface and points if that is more: bounds from the control points prove it.

Parameters
----------
points : array_like of shape (n, 3), mm
    Anywhere.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
(points, normals, distance) : ndarrays of shape (n, 3), (n, 3) and (n,), float64
    The nearest points, mm; the surface's unit normals there, as by `evaluate`; the distances, mm, not negative.

Raises
------
ValueError
    Names the row of a point that is not finite.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> flat = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
...                              [0, 0, 1, 1], [0, 0, 1, 1], 1, 1)
>>> points, normals, distance = flat.closest([[1, 2, 3], [7, 5, 4]])
>>> points.round(9).tolist(), distance.round(9).tolist()
([[1.0, 2.0, 0.0], [4.0, 5.0, 0.0]], [3.0, 5.0])
)");
  surface.def("to_mesh", &surface_to_mesh, "tolerance"_a, py::kw_only(), "progress"_a = py::none(),
              R"(A mesh that deviates from the surface by at most a tolerance, in both directions.

Bounds of second derivatives prove it; vertices lie on the surface. Seams of closed patches, and patches that have an
edge in common (the same curve with the same parameters), share vertices, and a pole is one vertex: what is closed stays
closed. With borders, only equal corners are one vertex, and triangles that meet may have gaps within the tolerance
between them; `Mesh.read` makes closed meshes of CAD files.

Parameters
----------
tolerance : float, mm
    At least 1e-8, and 1e-10 of the largest coordinate.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Mesh
    Counter-clockwise seen from the side of the normals.

Raises
------
ValueError
    A tolerance that is too small, or that makes more than 50 million triangles.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> flat = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
...                              [0, 0, 1, 1], [0, 0, 1, 1], 1, 1)
>>> flat.to_mesh(0.01)
<riffler.Mesh: 4 vertices, 2 triangles>
)");
  surface.def("domain", &domain, "patch"_a = 0,
              R"(The domain of a patch.

Parameters
----------
patch : int
    Which patch, counted from 0.

Returns
-------
ndarray of shape (2, 2), float64
    Smallest and largest (u, v).

Raises
------
ValueError
    The patch does not exist.

Examples
--------
>>> flat = riffler.Surface.nurbs([[[0, 0, 0], [0, 5, 0]], [[4, 0, 0], [4, 5, 0]]], [[1, 1], [1, 1]],
...                              [0, 0, 1, 1], [2, 2, 3, 3], 1, 1)
>>> flat.domain().tolist()
[[0.0, 2.0], [1.0, 3.0]]
)");
  surface.def_property_readonly(
      "patch_count", [](const Surface& self) { return self.patches().size(); }, "Number of patches.");
  surface.def_property_readonly(
      "names",
      [](const Surface& self) {
        std::vector<std::string> names;
        for (const nurbs::Patch& patch : self.patches()) names.push_back(patch.name);
        return names;
      },
      "Names of the patches, often empty.");
  surface.def_property_readonly(
      "bounds",
      [](const Surface& self) {
        const Box3 box = self.bounds();
        return take<double>(std::vector<Vec3>{box.lower, box.upper}, 3);
      },
      "(2, 3) float64, mm: lower and upper corner of the control points' box, which contains the surface.");
  surface.def("__repr__", [](const Surface& self) {
    const std::size_t n = self.patches().size();
    return "<riffler.Surface: " + std::to_string(n) + (n == 1 ? " patch>" : " patches>");
  });
  surface.def("__copy__", [](const SurfacePtr& self) { return self; });
  surface.def("__deepcopy__", [](const SurfacePtr& self, const py::dict&) { return self; }, "memo"_a);
}

}  // namespace riffler::bindings
