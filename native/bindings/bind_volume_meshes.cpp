// riffler.Volume: made of a mesh, and its own mesh.
#include <optional>

#include "bindings/lost.hpp"
#include "bindings/results.hpp"
#include "bindings/task.hpp"
#include "bindings/typed.hpp"
#include "bindings/volume_class.hpp"
#include "riffler/dexel/from_mesh/from_mesh.hpp"
#include "riffler/marching/to_mesh.hpp"

namespace riffler::bindings {

namespace {

/// The box of a volume from a mesh: what is given, else the mesh's own. Said here, where the words "flat" and "lower"
/// mean something to the caller, what Frame would refuse without them.
Box3 box_around(const Mesh& mesh, const py::object& lower, const py::object& upper) {
  validate(mesh);
  if (mesh.empty()) throw py::value_error("mesh has no triangles, so no volume");
  Box3 box = bounds(mesh);
  for (int k = 0; k < 3 && (lower.is_none() || upper.is_none()); ++k)
    if (!(box.lower[k] < box.upper[k]))
      throw py::value_error(std::string("mesh is flat in ") + "xyz"[k] + ", so it has no volume");
  if (!lower.is_none()) box.lower = to_vec3(lower, "lower");
  if (!upper.is_none()) box.upper = to_vec3(upper, "upper");
  return box;
}

py::dict to_dict(const dexel::MeshReport& r) {
  using namespace py::literals;
  return py::dict("triangles"_a = r.triangles, "degenerate"_a = r.degenerate, "duplicates"_a = r.duplicates,
                  "open_edges"_a = r.open_edges, "nonmanifold_edges"_a = r.nonmanifold_edges,
                  "inconsistent_edges"_a = r.inconsistent_edges, "openings"_a = r.openings, "turned"_a = r.turned,
                  "left_out"_a = r.left_out, "one_sided"_a = r.one_sided, "flipped_shells"_a = r.flipped_shells,
                  "inside_out"_a = r.inside_out, "overlap"_a = r.overlap, "doubtful_rays"_a = r.doubtful_rays);
}

struct VolumeOfMesh {
  std::shared_ptr<SharedVolume> volume;
  dexel::MeshReport report;
  Lost lost;
};

/// The work of both functions below: with a report, or without one.
auto making_of(const std::shared_ptr<Mesh>& mesh, double pitch, const std::string& directions, const py::object& lower,
               const py::object& upper, bool reports) {
  const dexel::Frame frame{box_around(*mesh, lower, upper), pitch, directions};
  return [mesh, frame, reports](const Progress& listener) {
    VolumeOfMesh out;
    dexel::MissedMaterial missed;
    Volume volume = dexel::from_mesh(*mesh, frame, listener, reports ? &out.report : nullptr, &missed);
    out.lost = lost_in(volume, missed);
    out.volume = share(std::move(volume));
    return out;
  };
}

auto volume_from_mesh(const std::shared_ptr<Mesh>& mesh, double pitch, const std::string& directions,
                      const OptionalArrayLike& lower, const OptionalArrayLike& upper, const ProgressLike& progress) {
  return long_call(progress, making_of(mesh, pitch, directions, lower, upper, false), [](VolumeOfMesh&& found) {
    warn(found.lost);
    return found.volume;
  });
}

auto volume_from_mesh_with_report(const std::shared_ptr<Mesh>& mesh, double pitch, const std::string& directions,
                                  const OptionalArrayLike& lower, const OptionalArrayLike& upper,
                                  const ProgressLike& progress) {
  return long_call(progress, making_of(mesh, pitch, directions, lower, upper, true), [](VolumeOfMesh&& found) {
    py::dict fields = to_dict(found.report);
    put(found.lost, fields);
    return VolumeAndReport(py::make_tuple(found.volume, make_result("VolumeReport", fields)));
  });
}

struct MeshOfVolume {
  std::shared_ptr<Mesh> mesh;
  std::size_t all = 0;  // triangles without a tolerance
  Lost lost;
};

auto meshing_of(SharedVolume& self, const std::optional<double>& tolerance) {
  return [state = Reading(self).volume.snapshot(), tolerance](const Progress& listener) {
    MeshOfVolume out;
    Mesh mesh =
        tolerance ? marching::to_mesh(state, *tolerance, listener, &out.all) : marching::to_mesh(state, listener);
    if (!tolerance) out.all = mesh.triangles.size();
    out.lost = lost_by_meshing(state, mesh.triangles.size());
    out.mesh = std::make_shared<Mesh>(std::move(mesh));
    return out;
  };
}

auto volume_to_mesh(SharedVolume& self, const std::optional<double>& tolerance, const ProgressLike& progress) {
  return long_call(progress, meshing_of(self, tolerance), [](MeshOfVolume&& made) {
    warn(made.lost);
    return made.mesh;
  });
}

auto volume_to_mesh_with_report(SharedVolume& self, const std::optional<double>& tolerance,
                                const ProgressLike& progress) {
  return long_call(progress, meshing_of(self, tolerance), [](MeshOfVolume&& made) {
    py::dict fields;
    put(made.lost, fields);
    fields["all_triangles"] = made.all;
    return MeshAndReport(py::make_tuple(made.mesh, make_result("SurfaceReport", fields)));
  });
}

}  // namespace

void bind_volume_meshes(VolumeClass& volume) {
  volume
      .def_static("from_mesh", &volume_from_mesh, py::arg("mesh").none(false), py::arg("pitch"),
                  py::arg("directions") = "z", py::kw_only(), py::arg("lower") = py::none(),
                  py::arg("upper") = py::none(), py::arg("progress") = py::none(),
                  R"(The solid within a mesh: points whose absolute generalized winding number exceeds 1/2.

Inside-out, overlapping, touching and open parts are fine, as are triangles that face against their neighbours and
repeated ones (`Mesh.orient`). Material thinner than the pitch may be lost: more than crumbs of it raise a
UserWarning; `from_mesh_with_report` puts it into its report.

Parameters
----------
mesh : Mesh
    A mesh with a volume greater than 0.
pitch : float, mm
    Distance of neighbouring rays.
directions : "z" or "xyz"
    One grid of rays, or three.
lower, upper : array_like of shape (3,), mm, or None
    The volume's box; material outside it is clipped. Default: the mesh's own.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Volume
    A new volume.

Raises
------
ValueError
    The mesh is flat or empty, or the volume does not fit in memory.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> mesh = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5, directions="xyz").to_mesh()
>>> round(riffler.Volume.from_mesh(mesh, 0.25).volume, 3)
24.0
)")
      .def_static("from_mesh_with_report", &volume_from_mesh_with_report, py::arg("mesh").none(false), py::arg("pitch"),
                  py::arg("directions") = "z", py::kw_only(), py::arg("lower") = py::none(),
                  py::arg("upper") = py::none(), py::arg("progress") = py::none(),
                  R"(The same as `from_mesh`, with a report on the mesh's faults and the lost material.

Parameters
----------
mesh : Mesh
    A mesh with a volume greater than 0.
pitch : float, mm
    Distance of neighbouring rays.
directions : "z" or "xyz"
    One grid of rays, or three.
lower, upper : array_like of shape (3,), mm, or None
    The volume's box; material outside it is clipped. Default: the mesh's own.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
(Volume, VolumeReport)
    The volume, and the report.

Raises
------
ValueError
    As `from_mesh`.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> mesh = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh()
>>> volume, report = riffler.Volume.from_mesh_with_report(mesh, 0.25)
>>> report.open_edges, report.lost_note
(0, '')
)")
      .def("to_mesh", &volume_to_mesh, py::kw_only(), py::arg("tolerance") = py::none(),
           py::arg("progress") = py::none(),
           R"(The surface: closed, outward, two-manifold, and still so in a binary STL.

Material thinner than the pitch is not part of it. A UserWarning reports more than crumbs of such material;
`to_mesh_with_report` puts it into its report.

Parameters
----------
tolerance : float, mm, or None
    Leaves out triangles that the shape does not need: no point of the mesh is farther than this from the surface of
    all triangles, and the reverse. It is as closed and as sharp at edges, and its vertices are some of theirs. None, or
    less than the step of float32 at the box's largest coordinate (0 too): all triangles. More than the size of the part
    keeps at least four triangles of each shell.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Mesh
    Without triangles for an empty volume.

Raises
------
ValueError
    A tolerance that is negative or not finite.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh().audit().open_edges
0
>>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.25, directions="xyz")
>>> len(volume.to_mesh().triangles) > 100 * len(volume.to_mesh(tolerance=0.02).triangles)
True
)")
      .def(
          "to_mesh_with_report", &volume_to_mesh_with_report, py::kw_only(), py::arg("tolerance") = py::none(),
          py::arg("progress") = py::none(),
          R"(The same as `to_mesh`, with a report on material that is too thin for the pitch and so not part of the mesh.

Parameters
----------
tolerance : float, mm, or None
    Leaves out triangles that the shape does not need: no point of the mesh is farther than this from the surface of
    all triangles, and the reverse. It is as closed and as sharp at edges, and its vertices are some of theirs. None, or
    less than the step of float32 at the box's largest coordinate (0 too): all triangles. More than the size of the part
    keeps at least four triangles of each shell.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
(Mesh, SurfaceReport)
    The mesh, and the report.

Raises
------
ValueError
    A tolerance that is negative or not finite.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> mesh, report = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).to_mesh_with_report()
>>> report.lost, report.lost_box, report.all_triangles == len(mesh.triangles)
(0.0, None, True)
)");
}

}  // namespace riffler::bindings
