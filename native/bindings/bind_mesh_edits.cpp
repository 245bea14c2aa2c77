// riffler.Mesh: audit, decimation, smoothing, deviation and orientation.
#include <utility>

#include "bindings/mesh_class.hpp"
#include "bindings/results.hpp"
#include "bindings/task.hpp"
#include "mesh/closest.hpp"
#include "riffler/mesh/audit.hpp"
#include "riffler/mesh/decimate/decimate.hpp"
#include "riffler/mesh/orient.hpp"
#include "riffler/mesh/smooth.hpp"

namespace riffler::bindings {

namespace {

AuditResult audited(const Mesh& mesh, const ProgressLike& progress) {
  mesh::Audit a;
  {
    const Progress listener = to_progress(progress);
    const NoGil no_gil;
    a = audit(mesh, listener);
  }
  using namespace py::literals;
  return make_result("Audit", py::dict("open_edges"_a = a.open_edges, "nonmanifold_edges"_a = a.nonmanifold_edges,
                                       "nonmanifold_vertices"_a = a.nonmanifold_vertices, "degenerate"_a = a.degenerate,
                                       "duplicates"_a = a.duplicates, "folds"_a = a.folds,
                                       "components"_a = a.components, "volume"_a = a.volume));
}

std::optional<std::size_t> to_count(const std::optional<std::int64_t>& triangles) {
  if (!triangles) return {};
  if (*triangles < 0) throw py::value_error("triangles must not be negative, not " + std::to_string(*triangles));
  return static_cast<std::size_t>(*triangles);
}

auto decimated(const MeshPtr& mesh, std::optional<std::int64_t> triangles, std::optional<double> tolerance,
               const ProgressLike& progress) {
  const mesh::DecimateLimits limits{to_count(triangles), tolerance};
  const auto work = [=](const Progress& listener) { return std::make_shared<Mesh>(decimate(*mesh, limits, listener)); };
  return long_call(progress, work, Identity());
}

auto smoothed(const MeshPtr& mesh, int iterations, std::optional<double> tolerance, double feature_angle,
              const ProgressLike& progress) {
  const auto work = [=](const Progress& listener) {
    return std::make_shared<Mesh>(smooth(*mesh, iterations, tolerance, feature_angle, listener));
  };
  return long_call(progress, work, Identity());
}

auto deviation_array(const MeshPtr& mesh, const MeshPtr& other, bool with_sign, const ProgressLike& progress) {
  const auto work = [=](const Progress& listener) { return deviation(*mesh, *other, with_sign, listener); };
  return long_call(progress, work, [](std::vector<double>&& distances) { return take<double>(std::move(distances)); });
}

std::pair<MeshPtr, mesh::Orientation> oriented_pair(const MeshPtr& mesh, bool hollow) {
  mesh::Orientation found;
  std::optional<Mesh> better;
  {
    const NoGil no_gil;
    better = oriented(*mesh, found, hollow ? mesh::Hollow::Kept : mesh::Hollow::Turned);
  }
  return {better ? std::make_shared<Mesh>(*std::move(better)) : mesh, found};
}

MeshAndOrientation orient_with_report(const MeshPtr& mesh, bool hollow) {
  using namespace py::literals;
  const auto [better, found] = oriented_pair(mesh, hollow);
  const py::object report =
      make_result("Orientation", py::dict("turned"_a = found.turned, "turned_shells"_a = found.turned_shells,
                                          "left_out"_a = found.left_out, "one_sided"_a = found.one_sided));
  return py::object(py::make_tuple(better, report));
}

}  // namespace

void bind_mesh_edits(MeshClass& mesh) {
  using namespace py::literals;
  mesh.def("audit", &audited, py::kw_only(), "progress"_a = py::none(),
           R"(Counts the defects of a mesh.

Parameters
----------
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Audit
    All counts are 0 for a closed two-manifold without defects.

Examples
--------
>>> mesh = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh()
>>> audit = mesh.audit()
>>> audit.open_edges, audit.components
(0, 1)
)");
  mesh.def("decimate", &decimated, py::kw_only(), "triangles"_a = py::none(), "tolerance"_a = py::none(),
           "progress"_a = py::none(),
           R"(A mesh with fewer triangles.

It is closed and two-manifold if this one is; sharp edges and borders stay. The vertices are some of the old ones,
or, if that fits better, new ones between them.

Parameters
----------
triangles : int, how many triangles to keep, or None
    Number of triangles to stop at.
tolerance : float, mm, or None
    Largest distance between old and new surface. With both limits, decimation stops at the first one reached.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Mesh
    A new mesh.

Raises
------
ValueError
    Neither limit is given, or one is negative or not finite.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> ball = riffler.Volume.sphere((0, 0, 0), 5, pitch=0.5, directions="xyz").to_mesh()
>>> len(ball.decimate(triangles=500).triangles)
500
)");
  mesh.def("smooth", &smoothed, py::kw_only(), "iterations"_a = 10, "tolerance"_a = py::none(),
           "feature_angle"_a = mesh::kFeatureAngle, "progress"_a = py::none(),
           R"(A smoother mesh of the same triangles (Taubin's filter) and the same volume.

Edges whose sides turn by more than ``feature_angle`` stay sharp; corners stay in their place, and so do vertices on
borders.

Parameters
----------
iterations : int, steps of the filter
    Not negative.
tolerance : float, mm, or None
    Largest total move of a vertex.
feature_angle : float, rad
    Between the normals of an edge's two sides.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Mesh
    A new mesh.

Raises
------
ValueError
    A negative number, or an angle that is not positive.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> ball = riffler.Volume.sphere((0, 0, 0), 5, pitch=0.5, directions="xyz").to_mesh()
>>> smoother = ball.smooth(iterations=5, tolerance=0.05)
>>> bool(abs(smoother.vertices - ball.vertices).max() <= 0.05)
True
)");
  mesh.def("deviation", &deviation_array, "other"_a.none(false), py::kw_only(), "signed"_a = false,
           "progress"_a = py::none(),
           R"(Distance of each vertex from the surface of another mesh.

Parameters
----------
other : Mesh
    The surface to measure from.
signed : bool
    Whether distances inside of ``other`` are negative.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
ndarray of shape (n,), float64, mm
    One distance for each vertex.

Raises
------
ValueError
    ``other`` has no triangles.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> ball = riffler.Volume.sphere((0, 0, 0), 5, pitch=0.5, directions="xyz").to_mesh()
>>> bool(abs(ball.decimate(tolerance=0.02).deviation(ball)).max() <= 0.02)
True
)");
  mesh.def(
      "orient", [](const MeshPtr& self, bool hollow) { return oriented_pair(self, hollow).first; }, py::kw_only(),
      "hollow"_a = false,
      R"(This mesh as the surface of a solid: the mesh itself, or one in which triangles are turned.

What takes a mesh as a solid (Volume.from_mesh, Collider, verify, plan.pencil, plan.engrave, deviation with signs) does
this by itself. In closed pieces orientation is carried over edges that two triangles share, the larger area decides, and
they then face outwards, but for cavities: pieces within another that are oriented the opposite way round. Open pieces,
and pieces with one side only, stay unchanged.

Parameters
----------
hollow : bool
    Leave closed pieces that all face inwards, as plans and Collider do: room in endless material.

Returns
-------
Mesh
    This mesh where nothing had to be turned.

Examples
--------
>>> block = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh()
>>> inside_out = riffler.Mesh(block.vertices, block.triangles[:, ::-1])
>>> bool(inside_out.volume < 0 < inside_out.orient().volume)
True
)");
  mesh.def("orient_with_report", &orient_with_report, py::kw_only(), "hollow"_a = false,
           R"(The same as `orient`, with a report of the faults.

Parameters
----------
hollow : bool
    As of `orient`.

Returns
-------
(Mesh, Orientation)
    The mesh, and the counts of turned and unused triangles.

Examples
--------
>>> block = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh()
>>> inside_out = riffler.Mesh(block.vertices, block.triangles[:, ::-1])
>>> mesh, report = inside_out.orient_with_report()
>>> report.turned_shells
1
)");
}

}  // namespace riffler::bindings
