// riffler.Mesh: its arrays, and its files.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/path_text.hpp"
#include "bindings/mesh_class.hpp"
#include "bindings/task.hpp"
#include "bindings/typed.hpp"
#include "mesh/io/scan.hpp"
#include "mesh/weld.hpp"
#include "riffler/mesh/io/io.hpp"

namespace riffler::bindings {

namespace {

/// A read-only view of a vector that `owner` keeps; a Mesh never changes once Python has it.
template <class T, class V>
py::array view(const base::BulkVector<V>& values, py::handle owner) {
  const std::array<py::ssize_t, 2> shape{static_cast<py::ssize_t>(values.size()), 3};
  py::array array(py::dtype::of<T>(), shape, values.data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// (0,) counts as (0, 3), so that empty lists make an empty mesh.
bool is_empty(const py::array& array) {
  return array.ndim() == 1 && array.shape(0) == 0;
}

mesh::Vertices to_vertices(const py::object& object) {
  Doubles array = Doubles::ensure(object);
  if (!array) {
    PyErr_Clear();
    throw py::value_error("vertices must be numbers of the shape (n, 3)");
  }
  if (is_empty(array)) return {};
  const std::size_t n = check_rows(array, 3, "vertices");
  mesh::Vertices vertices(n);
  if (n > 0) std::memcpy(vertices.data(), array.data(), n * sizeof(Vec3));
  return vertices;
}

mesh::Triangles to_triangles(const py::object& object) {
  const py::array given = py::array::ensure(object);
  if (!given) {
    PyErr_Clear();
    throw py::value_error("triangles must be integers of the shape (k, 3)");
  }
  if (is_empty(given)) return {};
  if (given.ndim() != 2 || given.shape(1) != 3)
    throw py::value_error("triangles must have the shape (k, 3), not " +
                          py::str(given.attr("shape")).cast<std::string>());
  const char kind = given.dtype().kind();
  if (given.size() > 0 && kind != 'i' && kind != 'u')
    throw py::value_error("triangles must be integers, not " + py::str(given.dtype()).cast<std::string>());
  // What does not fit 64 bits becomes negative there, and so is out of range as well.
  const auto array = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>::ensure(given);
  mesh::Triangles triangles(static_cast<std::size_t>(array.shape(0)));
  const std::int64_t* p = array.data();
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int k = 0; k < 3; ++k, ++p) {
      if (*p < 0 || *p > 0x7fffffff)
        throw py::value_error("triangles, row " + std::to_string(t) + ": no vertex has the index " +
                              std::to_string(*p));
      triangles[t][k] = static_cast<int>(*p);
    }
  return triangles;
}

MeshPtr make_mesh(const ArrayLike& vertices, const ArrayLike& triangles) {
  auto mesh = std::make_shared<Mesh>(Mesh{to_vertices(vertices), to_triangles(triangles)});
  validate(*mesh);
  return mesh;
}

/// What `riffler.threemf` reads, as files are read: equal vertices become one.
MeshPtr read_3mf(const std::filesystem::path& path) {
  const py::tuple found = py::module_::import("riffler.threemf").attr("read")(path);
  const MeshPtr mesh = make_mesh(found[0], found[1]);
  mesh::Welder<Vec3> welder(mesh->vertices.size());
  std::vector<int> places(mesh->vertices.size());
  welder.add(mesh->vertices, places.data());
  mesh->vertices.assign(welder.points().begin(), welder.points().end());
  for (Vec3i& t : mesh->triangles) t = {places[t.x], places[t.y], places[t.z]};
  return mesh;
}

bool is_3mf(const std::filesystem::path& path) {
  return mesh::equal_ignoring_case(base::path_text(path.extension()), ".3mf");
}

bool is_cad(const std::filesystem::path& path) {
  const std::string extension = base::path_text(path.extension());
  constexpr std::array names{".step", ".stp", ".iges", ".igs", ".brep"};
  return std::any_of(names.begin(), names.end(),
                     [&](const char* name) { return mesh::equal_ignoring_case(extension, name); });
}

/// `riffler.cad.read` runs OpenCASCADE in a process of its own.
MeshPtr read_cad(const std::filesystem::path& path, double tolerance, const ProgressLike& progress) {
  using namespace py::literals;
  if (!progress.is_none()) to_progress(progress);  // refuses what is no callable, and requests for a task
  const py::object part =
      py::module_::import("riffler.cad").attr("read")(path, "tolerance"_a = tolerance, "progress"_a = progress);
  return part.attr("mesh").cast<MeshPtr>();
}

MeshPtr read_mesh_file(const std::filesystem::path& path, double tolerance, const ProgressLike& progress) {
  if (is_3mf(path)) return read_3mf(path);
  if (is_cad(path)) return read_cad(path, tolerance, progress);
  if (!(tolerance > 0) || !std::isfinite(tolerance)) throw py::value_error("tolerance must be a positive number of mm");
  const Progress listener = to_progress(progress);
  const NoGil no_gil;
  return std::make_shared<Mesh>(mesh::read_mesh(path, listener));
}

auto write_mesh_file(const MeshPtr& mesh, const std::filesystem::path& path, const ProgressLike& progress) {
  const auto work = [=](const Progress& listener) {
    write_mesh(*mesh, path, listener);
    return path;
  };
  const auto nothing = [](const std::filesystem::path&) { return py::none(); };
  if (!is_3mf(path)) return long_call(progress, work, nothing);
  if (!progress.is_none()) throw py::value_error("a .3mf file is written by lib3mf, which tells no progress");
  const py::object self = py::cast(mesh);
  py::module_::import("riffler.threemf").attr("write")(path, self.attr("vertices"), self.attr("triangles"));
  return decltype(long_call(progress, work, nothing))(py::none());
}

py::array_t<double> bounds_array(const Mesh& mesh) {
  if (mesh.empty()) throw py::value_error("a mesh without triangles has no bounds");
  const Box3 box = bounds(mesh);
  return take<double>(std::vector<Vec3>{box.lower, box.upper}, 3);
}

std::string describe_mesh(const Mesh& mesh) {
  return "<riffler.Mesh: " + std::to_string(mesh.vertices.size()) + " vertices, " +
         std::to_string(mesh.triangles.size()) + " triangles>";
}

}  // namespace

void bind_mesh(py::module_& m) {
  using namespace py::literals;
  MeshClass mesh(m, "Mesh",
                 R"(A triangle mesh, mm. It never changes: a method that changes a mesh returns a new one.

Parameters
----------
vertices : array_like of shape (n, 3), mm
    Positions; they are not welded.
triangles : array_like of shape (k, 3), integers
    Indices of vertices, counter-clockwise seen from outside.

Raises
------
ValueError
    Names argument and row: a wrong shape, a vertex that is not finite or beyond 1e30, an index out of range.

Examples
--------
>>> mesh = riffler.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
>>> mesh.area
0.5
)");
  mesh.def(py::init(&make_mesh), "vertices"_a, "triangles"_a);
  mesh.def_static(
      "read", &read_mesh_file, "path"_a, py::kw_only(), "tolerance"_a = 0.01, "progress"_a = py::none(),
      R"(Reads a .stl (binary or ASCII), .obj, .ply or .3mf file, in which equal vertices become one, or a CAD file.

From a .3mf file reads all build items, in place, converted to mm; this needs the package lib3mf. From a .step, .stp, .iges,
.igs or .brep file reads all bodies, in place, converted to mm, healed and tessellated; this needs the extra riffler[cad].
`riffler.cad.read` returns their faces, names and colours as well.

Parameters
----------
path : path_like, with one of these extensions
    The file.
tolerance : float, mm
    Chord error of a CAD file. Other files have triangles already, and it has no effect.
progress : callable or None
    Called with the finished share of the part of the file at hand, of .stl and .3mf not after the beginning. Returning
    False cancels.

Returns
-------
Mesh
    In mm.

Raises
------
FormatError
    Names the byte or line of a bad file (of .3mf and CAD files what was expected), among them files without a triangle.
ValueError
    Another extension, or an extra that is missing.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
>>> volume.to_mesh().write("block.stl")
>>> riffler.Mesh.read("block.stl")
<riffler.Mesh: 210 vertices, 416 triangles>
)");
  mesh.def("write", &write_mesh_file, "path"_a, py::kw_only(), "progress"_a = py::none(),
           R"(Writes a .stl (binary), .obj, .ply (binary) or .3mf file, whole or not at all.

Coordinates of .stl are rounded to float32, those of .3mf (mm) are float32 to the last step; .3mf needs the package
lib3mf, which reports no progress.

Parameters
----------
path : path_like, with one of these extensions
    The file; an existing one is replaced.
progress : callable or None
    Called with the finished share; returning False cancels.

Raises
------
RuntimeError
    The file cannot be written.
ValueError
    Another extension.
Cancelled
    ``progress`` returned False. No file is written; an existing one is unchanged.

Examples
--------
>>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh().write("block.ply")
)");
  mesh.def_property_readonly(
      "vertices", [](const py::object& self) { return view<double>(self.cast<const Mesh&>().vertices, self); },
      "(n, 3) float64, mm, read-only, no copy.");
  mesh.def_property_readonly(
      "triangles", [](const py::object& self) { return view<int>(self.cast<const Mesh&>().triangles, self); },
      "(k, 3) int32, read-only, no copy.");
  // pybind11 takes no call_guard for properties: up to 3.0 it ignored one.
  const auto unlocked = [](auto measure) {
    return [measure](const Mesh& self) {
      const NoGil release;
      return measure(self);
    };
  };
  mesh.def_property_readonly("volume", unlocked(&mesh::volume), "mm³, signed; defined for closed meshes.");
  mesh.def_property_readonly("area", unlocked(&mesh::area), "mm².");
  mesh.def_property_readonly("bounds", &bounds_array,
                             "(2, 3) float64, mm: lower and upper corner of the triangles' box. ValueError without "
                             "triangles.");
  bind_mesh_edits(mesh);
  mesh.def("__repr__", &describe_mesh);
  mesh.def("__copy__", [](const MeshPtr& self) { return self; });
  mesh.def("__deepcopy__", [](const MeshPtr& self, const py::dict&) { return self; }, "memo"_a);
  mesh.def(
      py::pickle([](const py::object& self) { return py::make_tuple(self.attr("vertices"), self.attr("triangles")); },
                 [](const py::tuple& state) {
                   if (state.size() != 2) throw py::value_error("a pickled Mesh has two arrays");
                   return make_mesh(py::object(state[0]), py::object(state[1]));
                 }));
}

}  // namespace riffler::bindings
