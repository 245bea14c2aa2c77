// riffler.Mesh: triangle meshes, their files, audit, decimation and smoothing.
#include "riffler/mesh/mesh.hpp"

#include <array>
#include <cstring>
#include <memory>

#include "bindings/task.hpp"
#include "mesh/closest.hpp"
#include "mesh/io/scan.hpp"
#include "mesh/weld.hpp"
#include "riffler/mesh/audit.hpp"
#include "riffler/mesh/decimate/decimate.hpp"
#include "riffler/mesh/io/io.hpp"
#include "riffler/mesh/orient.hpp"
#include "riffler/mesh/smooth.hpp"

namespace riffler::bindings {

namespace {

using MeshPtr = std::shared_ptr<Mesh>;
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

MeshPtr make(const py::object& vertices, const py::object& triangles) {
  auto mesh = std::make_shared<Mesh>(Mesh{to_vertices(vertices), to_triangles(triangles)});
  validate(*mesh);
  return mesh;
}

/// What `riffler.threemf` reads, as files are read: equal vertices become one.
MeshPtr read_3mf(const std::filesystem::path& path) {
  const py::tuple found = py::module_::import("riffler.threemf").attr("read")(path);
  const MeshPtr mesh = make(found[0], found[1]);
  mesh::Welder<Vec3> welder(mesh->vertices.size());
  std::vector<int> places(mesh->vertices.size());
  welder.add(mesh->vertices, places.data());
  mesh->vertices.assign(welder.points().begin(), welder.points().end());
  for (Vec3i& t : mesh->triangles) t = {places[t.x], places[t.y], places[t.z]};
  return mesh;
}

bool is_3mf(const std::filesystem::path& path) {
  return mesh::equal_ignoring_case(path.extension().string(), ".3mf");
}

MeshPtr read(const std::filesystem::path& path, const py::object& progress) {
  if (is_3mf(path)) return read_3mf(path);
  const Progress listener = to_progress(progress);
  const NoGil no_gil;
  return std::make_shared<Mesh>(mesh::read_mesh(path, listener));
}

auto write(const MeshPtr& mesh, const std::filesystem::path& path, const py::object& progress) {
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

py::dict audit_dict(const Mesh& mesh, const py::object& progress) {
  mesh::Audit a;
  {
    const Progress listener = to_progress(progress);
    const NoGil no_gil;
    a = audit(mesh, listener);
  }
  using namespace py::literals;
  return py::dict("open_edges"_a = a.open_edges, "nonmanifold_edges"_a = a.nonmanifold_edges,
                  "nonmanifold_vertices"_a = a.nonmanifold_vertices, "degenerate"_a = a.degenerate,
                  "duplicates"_a = a.duplicates, "folds"_a = a.folds, "components"_a = a.components,
                  "volume"_a = a.volume);
}

py::array_t<double> bounds_array(const Mesh& mesh) {
  if (mesh.empty()) throw py::value_error("a mesh without triangles has no bounds");
  const Box3 box = bounds(mesh);
  return take<double>(std::vector<Vec3>{box.lower, box.upper}, 3);
}

std::optional<std::size_t> to_count(const std::optional<std::int64_t>& triangles) {
  if (!triangles) return {};
  if (*triangles < 0) throw py::value_error("triangles must not be negative, not " + std::to_string(*triangles));
  return static_cast<std::size_t>(*triangles);
}

auto decimated(const MeshPtr& mesh, std::optional<std::int64_t> triangles, std::optional<double> tolerance,
               const py::object& progress) {
  const mesh::DecimateLimits limits{to_count(triangles), tolerance};
  const auto work = [=](const Progress& listener) { return std::make_shared<Mesh>(decimate(*mesh, limits, listener)); };
  return long_call(progress, work, Identity());
}

auto smoothed(const MeshPtr& mesh, int iterations, std::optional<double> tolerance, double feature_angle,
              const py::object& progress) {
  const auto work = [=](const Progress& listener) {
    return std::make_shared<Mesh>(smooth(*mesh, iterations, tolerance, feature_angle, listener));
  };
  return long_call(progress, work, Identity());
}

auto deviation_array(const MeshPtr& mesh, const MeshPtr& other, bool with_sign, const py::object& progress) {
  const auto work = [=](const Progress& listener) { return deviation(*mesh, *other, with_sign, listener); };
  return long_call(progress, work, [](std::vector<double>&& distances) { return take<double>(std::move(distances)); });
}

MeshPtr oriented_mesh(const MeshPtr& mesh, std::optional<py::dict> report, bool hollow) {
  mesh::Orientation found;
  std::optional<Mesh> better;
  {
    const NoGil no_gil;
    better = oriented(*mesh, found, hollow ? mesh::Hollow::Kept : mesh::Hollow::Turned);
  }
  if (report) {
    py::dict& d = *report;
    d["turned"] = found.turned, d["turned_shells"] = found.turned_shells;
    d["left_out"] = found.left_out, d["one_sided"] = found.one_sided;
  }
  return better ? std::make_shared<Mesh>(*std::move(better)) : mesh;
}

std::string repr(const Mesh& mesh) {
  return "<riffler.Mesh: " + std::to_string(mesh.vertices.size()) + " vertices, " +
         std::to_string(mesh.triangles.size()) + " triangles>";
}

}  // namespace

void bind_mesh(py::module_& m) {
  using namespace py::literals;
  py::class_<Mesh, MeshPtr> mesh(m, "Mesh",
                                 R"(A triangle mesh, mm. It never changes: what changes a mesh returns a new one.

Mesh(vertices, triangles): (n, 3) numbers and (k, 3) integers, indices of vertices, counter-clockwise seen from outside.
ValueError naming the argument and the row for a wrong shape, a vertex that is not finite or beyond 1e30, an index out of
range. Vertices are not welded; files are, when they are read.)");
  mesh.def(py::init(&make), "vertices"_a, "triangles"_a);
  mesh.def_static(
      "read", &read, "path"_a, py::kw_only(), "progress"_a = py::none(),
      R"(The mesh in a .stl (binary or ASCII), .obj, .ply or .3mf file; equal vertices become one. A .3mf file gives
all that it says to build, placed, in mm whatever its unit; it needs the package lib3mf. FormatError naming the byte or
line for a bad file (for .3mf what was expected), among them those with no triangle; ValueError for another extension.
``progress`` is called with a share of the part of the file at hand, of .stl and .3mf not after the beginning.)");
  mesh.def(
      "write", &write, "path"_a, "progress"_a = py::none(),
      R"(Writes .stl (binary, coordinates rounded to float32), .obj, .ply (binary) or .3mf (mm, float32 to its last step; needs the package
lib3mf, which tells no progress), whole or not at all.)");
  mesh.def_property_readonly(
      "vertices", [](const py::object& self) { return view<double>(self.cast<const Mesh&>().vertices, self); },
      "(n, 3) float64, read-only, no copy.");
  mesh.def_property_readonly(
      "triangles", [](const py::object& self) { return view<std::int32_t>(self.cast<const Mesh&>().triangles, self); },
      "(k, 3) int32, read-only, no copy.");
  mesh.def_property_readonly("volume", &mesh::volume, py::call_guard<NoGil>(), "mm³, signed; of a closed mesh.");
  mesh.def_property_readonly("area", &mesh::area, py::call_guard<NoGil>(), "mm².");
  mesh.def_property_readonly(
      "bounds", &bounds_array,
      "(2, 3) float64, lower and upper corner of the triangles' box. ValueError without triangles.");
  mesh.def("audit", &audit_dict, py::kw_only(), "progress"_a = py::none(),
           R"(A dict of counts, all 0 but the last two for a closed two-manifold without defects:
open_edges (of one triangle), nonmanifold_edges (of three or more, or of two in the same direction),
nonmanifold_vertices (whose triangles are not one fan), degenerate (a vertex twice, or area exactly 0),
duplicates (the vertices of an earlier triangle), folds (edges whose two triangles lie on each other),
components (pieces connected across edges), volume (mm³, signed).)");
  mesh.def(
      "decimate", &decimated, "triangles"_a = py::none(), "tolerance"_a = py::none(), py::kw_only(),
      "progress"_a = py::none(),
      R"(A mesh with fewer triangles: down to `triangles`, or as far as old and new surface stay within `tolerance` (mm) of
each other, or until the first of both. Closed and two-manifold where this one is; sharp edges and borders stay. The
vertices are some of the old ones, or where that fits better new ones between them.)");
  mesh.def(
      "smooth", &smoothed, "iterations"_a = 10, "tolerance"_a = py::none(), py::kw_only(),
      "feature_angle"_a = mesh::kFeatureAngle, "progress"_a = py::none(),
      R"(A smoother mesh of the same triangles (Taubin) and the same volume; no vertex moves farther than `tolerance`
(mm) in all. Edges whose sides turn by more than `feature_angle` (rad) stay sharp, and corners stay where they are, as
do vertices on borders.)");
  mesh.def(
      "deviation", &deviation_array, "other"_a.none(false), py::kw_only(), "signed"_a = false,
      "progress"_a = py::none(),
      R"((n,) float64: how far (mm) each vertex is from the surface of `other`; with signed=True negative inside.)");
  mesh.def("oriented", &oriented_mesh, "report"_a = py::none(), py::kw_only(), "hollow"_a = false,
           R"(This mesh as the surface of a solid: the mesh itself, or one in which triangles are turned.

What takes a mesh as a solid (Volume.from_mesh, Collider, verify, plan.pencil, plan.engrave, deviation with signs) does
this by itself. In closed pieces orientation is carried over edges that two triangles share, the larger area decides, and
they then face outwards, but for cavities: pieces within another that are oriented the other way round. Open pieces, and
pieces with one side only, stay as they are. ``hollow``: leave closed pieces that all face inwards, as
plans and Collider do: room in endless material.

``report``: a dict that is filled with ``turned`` triangles; ``turned_shells``, closed pieces that faced inwards as a
whole; ``left_out``, repeated triangles that tear the surface open, which name one vertex three times in the result;
``one_sided``, pieces like a Möbius strip.)");
  mesh.def("__repr__", &repr);
  mesh.def("__copy__", [](const MeshPtr& self) { return self; });
  mesh.def("__deepcopy__", [](const MeshPtr& self, const py::dict&) { return self; }, "memo"_a);
  mesh.def(
      py::pickle([](const py::object& self) { return py::make_tuple(self.attr("vertices"), self.attr("triangles")); },
                 [](const py::tuple& state) {
                   if (state.size() != 2) throw py::value_error("a pickled Mesh has two arrays");
                   return make(state[0], state[1]);
                 }));
}

}  // namespace riffler::bindings
