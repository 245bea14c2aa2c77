// riffler.Volume
#include <optional>

#include "bindings/lost.hpp"
#include "bindings/task.hpp"
#include "bindings/volume_class.hpp"
#include "riffler/dexel/boolean.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/dexel/from_mesh/from_mesh.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/sweep/carve.hpp"

namespace riffler::bindings {

namespace {

/// A volume's state at one time; shares its tiles.
struct Snapshot {
  Volume volume;
};

std::shared_ptr<SharedVolume> block(const py::object& lower, const py::object& upper, double pitch,
                                    const std::string& directions) {
  const dexel::Frame frame{{to_vec3(lower, "lower"), to_vec3(upper, "upper")}, pitch, directions};
  return share(Volume::block(frame));
}

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

void fill(py::dict& d, const dexel::MeshReport& r) {
  d["triangles"] = r.triangles, d["degenerate"] = r.degenerate, d["duplicates"] = r.duplicates;
  d["open_edges"] = r.open_edges, d["nonmanifold_edges"] = r.nonmanifold_edges;
  d["inconsistent_edges"] = r.inconsistent_edges, d["openings"] = r.openings;
  d["turned"] = r.turned, d["left_out"] = r.left_out, d["one_sided"] = r.one_sided;
  d["flipped_shells"] = r.flipped_shells, d["inside_out"] = r.inside_out, d["overlap"] = r.overlap;
  d["doubtful_rays"] = r.doubtful_rays;
}

auto volume_from_mesh(const std::shared_ptr<Mesh>& mesh, double pitch, const std::string& directions,
                      const py::object& lower, const py::object& upper, const py::object& progress,
                      std::optional<py::dict> report) {
  struct Made {
    std::shared_ptr<SharedVolume> volume;
    dexel::MeshReport report;
    Lost lost;
  };
  const dexel::Frame frame{box_around(*mesh, lower, upper), pitch, directions};
  const auto work = [mesh, frame, reports = report.has_value()](const Progress& listener) {
    Made out;
    dexel::MissedMaterial missed;
    Volume volume = dexel::from_mesh(*mesh, frame, listener, reports ? &out.report : nullptr, &missed);
    out.lost = lost_in(volume, missed);
    out.volume = share(std::move(volume));
    return out;
  };
  return long_call(progress, work, [report](Made&& found) mutable {
    if (report) fill(*report, found.report);
    tell(found.lost, report);
    return found.volume;
  });
}

auto volume_to_mesh(SharedVolume& self, const py::object& progress, std::optional<py::dict> report) {
  using Made = std::pair<std::shared_ptr<Mesh>, Lost>;
  const auto work = [state = Reading(self).volume.snapshot()](const Progress& listener) {
    Made out{std::make_shared<Mesh>(marching::to_mesh(state, listener)), {}};
    out.second = lost_by_meshing(state, out.first->triangles.size());
    return out;
  };
  return long_call(progress, work, [report](Made&& made) mutable {
    tell(made.second, report);
    return made.first;
  });
}

const dexel::Grid& grid_of(const Volume& volume, const std::string& direction) {
  const std::vector<Axis> axes = dexel::parse_directions(direction);
  const dexel::Grid* grid = axes.size() == 1 ? volume.grid(axes[0]) : nullptr;
  if (!grid)
    throw py::value_error("direction must be one of the volume's own, \"" + volume.frame().directions + "\", not \"" +
                          direction + "\"");
  return *grid;
}

/// Calls f(i, j) for every ray in C order.
template <class F>
void for_each_ray(const dexel::Grid& grid, const F& f) {
  for (int i = 0; i < grid.nu(); ++i)
    for (int j = 0; j < grid.nv(); ++j) f(i, j);
}

py::tuple intervals(SharedVolume& self, const std::string& direction) {
  const Reading reading(self);
  const dexel::Grid& grid = grid_of(reading.volume, direction);
  py::array_t<std::uint32_t> counts({grid.nu(), grid.nv()});
  py::array_t<double> spans({static_cast<py::ssize_t>(grid.span_count()), py::ssize_t{2}});
  std::uint32_t* count = counts.mutable_data();
  double* out = spans.mutable_data();
  for_each_ray(grid, [&](int i, int j) {
    const std::span<const dexel::Span> ray = grid.ray(i, j);
    *count++ = static_cast<std::uint32_t>(ray.size());
    for (const dexel::Span& s : ray) *out++ = s.near, *out++ = s.far;
  });
  return py::make_tuple(counts, spans);
}

py::array_t<double> normals(SharedVolume& self, const std::string& direction) {
  const Reading reading(self);
  const dexel::Grid& grid = grid_of(reading.volume, direction);
  if (!grid.has_normals()) throw py::value_error("a volume of one direction stores no normals");
  py::array_t<double> out({static_cast<py::ssize_t>(grid.span_count()), py::ssize_t{2}, py::ssize_t{3}});
  double* p = out.mutable_data();
  for_each_ray(grid, [&](int i, int j) {
    for (const dexel::SpanNormals& n : grid.ray_normals(i, j))
      for (const Vec3& v : {n.near.unpack(), n.far.unpack()})
        for (int k = 0; k < 3; ++k) *p++ = v[k];
  });
  return out;
}

std::vector<double> to_times(const py::object& dt, std::size_t moves) {
  if (dt.is_none()) return {};
  const Doubles array = py::cast<Doubles>(dt);
  if (array.ndim() == 0) return std::vector<double>(moves, *array.data());
  if (array.ndim() != 1 || static_cast<std::size_t>(array.shape(0)) != moves)
    throw py::value_error("dt must be a number or have the shape (" + std::to_string(moves) + ",), one per move");
  return {array.data(), array.data() + moves};
}

sweep::CarveMode to_mode(const std::string& mode) {
  if (mode == "remove") return sweep::CarveMode::Remove;
  if (mode == "add") return sweep::CarveMode::Add;
  throw py::value_error("mode must be \"remove\" or \"add\", not \"" + mode + "\"");
}

sweep::Cut carve_poses(SharedVolume& self, const Tool& tool, const Doubles& poses, double tolerance,
                       const py::object& dt, double removal_constant, const py::object& progress,
                       const std::string& mode, SharedVolume* protect) {
  const std::vector<Pose> path = to_poses(poses, "poses");
  sweep::CarveOptions options{tolerance,        to_times(dt, path.empty() ? 0 : path.size() - 1),
                              removal_constant, to_progress(progress),
                              to_mode(mode),    nullptr};
  std::optional<Volume> kept;  // which may be `self`
  if (protect) options.protect = &kept.emplace(Reading(*protect).volume.snapshot());
  Writing writing(self);
  const NoGil release;
  return sweep::carve(writing.volume, tool, path, options);
}

/// v.subtract(w) and its like: changes v and returns it.
auto boolean(dexel::Boolean op) {
  return [op](const std::shared_ptr<SharedVolume>& self, SharedVolume& other, const py::object& progress) {
    const Progress listener = to_progress(progress);
    const Volume operand = Reading(other).volume.snapshot();  // which may be `self`
    Writing writing(*self);
    const NoGil release;
    apply(op, writing.volume, operand, listener);
    return self;
  };
}

auto save_volume(SharedVolume& self, const std::filesystem::path& path, const py::object& progress) {
  const auto work = [state = Reading(self).volume.snapshot(), path](const Progress& listener) {
    save(state, path, listener);
    return path;
  };
  return long_call(progress, work, [](const std::filesystem::path&) { return py::none(); });
}

std::shared_ptr<SharedVolume> load_volume(const std::filesystem::path& path, const py::object& progress) {
  const Progress listener = to_progress(progress);
  const NoGil release;
  return share(dexel::load(path, listener));
}

auto volume_to_bytes(SharedVolume& self, const py::object& progress) {
  const auto work = [state = Reading(self).volume.snapshot()](const Progress& listener) {
    return to_bytes(state, listener);
  };
  return long_call(progress, work, [](const std::vector<std::uint8_t>& bytes) {
    return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  });
}

std::shared_ptr<SharedVolume> volume_from_bytes(const py::buffer& data, const std::string& name) {
  const py::buffer_info info = data.request();
  const std::span bytes(static_cast<const std::uint8_t*>(info.ptr),
                        static_cast<std::size_t>(info.size * info.itemsize));
  const NoGil release;
  return share(dexel::from_bytes(bytes, name));
}

py::dict stats(SharedVolume& self) {
  Writing writing(self);
  const dexel::Stats s = writing.volume.take_stats();
  py::dict d;
  d["moves"] = s.moves, d["steps"] = s.steps, d["tiles_visited"] = s.tiles_visited;
  d["tiles_changed"] = s.tiles_changed, d["rays_tested"] = s.rays_tested, d["hits"] = s.hits,
  d["rays_changed"] = s.rays_changed;
  d["tiles_meshed"] = s.tiles_meshed, d["triangles_tested"] = s.triangles_tested, d["bytes_copied"] = s.bytes_copied;
  return d;
}

std::string describe(SharedVolume& self) {
  const Reading reading(self);
  const Volume& v = reading.volume;
  std::string rays;
  for (const dexel::Grid& g : v.grids())
    rays += (rays.empty() ? "" : " + ") + std::to_string(g.nu()) + " × " + std::to_string(g.nv());
  return "<riffler.Volume \"" + v.frame().directions + "\", pitch " +
         py::cast<std::string>(py::str(py::float_(v.frame().pitch))) + " mm, " + rays + " rays>";
}

void bind_cut(py::module_& m) {
  py::class_<sweep::Cut>(m, "Cut", "What each move of a carve took away; arrays with one row per move.")
      .def_property_readonly(
          "removed", [](const sweep::Cut& c) { return take<double>(std::vector<double>(c.removed)); }, "(n,) mm³.")
      .def_property_readonly(
          "force", [](const sweep::Cut& c) { return from_vec3s(c.force); },
          "(n, 3) N on the tool, against its motion; zeros unless dt was given.")
      .def_property_readonly(
          "torque", [](const sweep::Cut& c) { return from_vec3s(c.torque); },
          "(n, 3) N·mm about the tip at the move's end.")
      .def("__len__", [](const sweep::Cut& c) { return c.removed.size(); });
}

}  // namespace

void bind_volume(py::module_& m) {
  bind_cut(m);
  py::class_<Snapshot>(m, "Snapshot", "The state of a volume at one time; shares its tiles until they are written.")
      .def_property_readonly("volume", [](const Snapshot& s) { return s.volume.volume(); })
      .def_property_readonly("revision", [](const Snapshot& s) { return s.volume.revision(); })
      .def_property_readonly("nbytes", [](const Snapshot& s) { return s.volume.nbytes(); });

  VolumeClass volume(m, "Volume", R"(A dexel volume: material as spans along parallel rays.

``directions`` is "z" for one grid of rays or "xyz" for three (a tri-dexel volume, which also keeps the surface's
normals and so its sharp edges). Ray (i, j) of "z" stands at lower + ((i + .5) h, (j + .5) h); "x" rays are indexed
(y, z), "y" rays (z, x). Lengths in mm.)");
  volume
      .def_static("block", &block, py::arg("lower"), py::arg("upper"), py::arg("pitch"), py::arg("directions") = "z",
                  "A box full of material. ValueError, before anything is allocated, if it does not fit in memory.")
      .def_static("from_mesh", &volume_from_mesh, py::arg("mesh").none(false), py::arg("pitch"),
                  py::arg("directions") = "z", py::arg("lower") = py::none(), py::arg("upper") = py::none(),
                  py::arg("progress") = py::none(), py::arg("report") = py::none(),
                  R"(The points whose absolute generalized winding number in ``mesh`` exceeds 1/2.

Covers the mesh's box, or ``lower`` to ``upper`` (clipping what lies outside). Inside-out, overlapping, touching and open
parts are fine, as are triangles that face the other way than their neighbours and repeated ones (Mesh.oriented); a mesh
without volume is a ValueError.

``report``: a dict that is filled with what was wrong with the mesh, all 0 but ``triangles`` for one that is closed and
well oriented: ``degenerate`` and ``duplicates``, triangles; ``open_edges`` of one triangle, ``nonmanifold_edges`` of
three or more, ``inconsistent_edges`` of two that run it in the same direction; ``turned`` triangles, turned to agree with
their neighbours, ``left_out``, repeated ones that tear the surface open, ``one_sided`` pieces, like a Möbius strip;
``openings``, walks along which the surface ends; ``flipped_shells`` that face into the material; of the volume, the shares ``inside_out``, where the
winding number is negative, and ``overlap``, where it is 2 or more; ``doubtful_rays``, the share of the rays with
material that end within an opening instead of on the surface; and with ``lost``, ``lost_box``, ``lost_pitch`` and
``lost_note`` as by to_mesh(): what rays miss, or a mesh of the volume will lack. Without a report the note is a
UserWarning.)")
      .def_static("from_bytes", &volume_from_bytes, py::arg("data"), py::arg("name") = "volume",
                  "The volume whose to_bytes() these are; ``name`` stands in messages.")
      .def_property_readonly("pitch", [](SharedVolume& v) { return v.volume.frame().pitch; })
      .def_property_readonly("directions", [](SharedVolume& v) { return v.volume.frame().directions; })
      .def_property_readonly("lower", [](SharedVolume& v) { return from_vec3(v.volume.frame().box.lower); })
      .def_property_readonly("upper", [](SharedVolume& v) { return from_vec3(v.volume.frame().box.upper); })
      .def_property_readonly(
          "volume", [](SharedVolume& v) { return Reading(v).volume.volume(); },
          "mm³: lengths of the z rays × their areas (of the only rays, where there are no z rays). An area is h², but "
          "for the "
          "last rays, whose cells end with the box.")
      .def_property_readonly(
          "nbytes", [](SharedVolume& v) { return Reading(v).volume.nbytes(); },
          "Bytes held, shared tiles counted once.")
      .def_property_readonly(
          "revision", [](SharedVolume& v) { return Reading(v).volume.revision(); }, "Changes with the content.")
      .def_property_readonly(
          "rays",
          [](SharedVolume& v) {
            std::size_t n = 0;
            for (const dexel::Grid& g : v.volume.grids()) n += static_cast<std::size_t>(g.nu()) * g.nv();
            return n;
          },
          "Number of rays, all directions.")
      .def("intervals", &intervals, py::arg("direction"),
           "(counts (nu, nv) uint32, spans (counts.sum(), 2) [near, far]), rays in C order.")
      .def("normals", &normals, py::arg("direction"),
           "(spans, 2, 3): unit normals at the ends of the spans of ``intervals``; tri-dexel volumes only.")
      .def("carve", &carve_poses, py::arg("tool"), py::arg("poses"), py::arg("tolerance") = 0.01,
           py::arg("dt") = py::none(), py::arg("removal_constant") = sweep::CarveOptions{}.removal_constant,
           py::arg("progress") = py::none(), py::arg("mode") = "remove", py::arg("protect") = py::none(),
           R"(Takes away what the cutter sweeps along ``poses`` (n, 6): tip xyz, unit axis xyz; n - 1 moves.

``tolerance``: mm, for moves that turn the axis; others are exact. ``dt``: s, a number or (n - 1,), asks for force.
``removal_constant``: N·s/mm³. Shank and holder never cut. ``progress``: called with the finished share; returning
False cancels, raises Cancelled and leaves the volume as it was.

``mode``: "remove", or "add", which puts material on wherever the cutter sweeps within the volume's box; ``removed`` is
then what was put on. ``protect``: a volume of the same lower, upper, pitch and directions; what lies in it stays as it
is, material and air. ValueError if its grid is another.)")
      .def(
          "snapshot", [](SharedVolume& v) { return Snapshot{Reading(v).volume.snapshot()}; },
          "The state to come back to with restore(); costs pointers only.")
      .def(
          "restore", [](SharedVolume& v, const Snapshot& s) { Writing(v).volume.restore(s.volume); },
          py::arg("snapshot"), "Back to a snapshot of this volume.")
      .def(
          "copy", [](SharedVolume& v) { return share(Reading(v).volume.snapshot()); },
          "An independent volume; shares its tiles until one of the two is written.")
      .def("__copy__", [](SharedVolume& v) { return share(Reading(v).volume.snapshot()); })
      .def("__deepcopy__", [](SharedVolume& v, const py::dict&) { return share(Reading(v).volume.snapshot()); })
      .def(
          "subtract", boolean(dexel::Boolean::Subtract), py::arg("other"), py::arg("progress") = py::none(),
          "Takes the other volume's material away, in place; returns this volume. ValueError unless both have the same "
          "lower, upper, pitch and directions.")
      .def("add", boolean(dexel::Boolean::Add), py::arg("other"), py::arg("progress") = py::none(),
           "Adds the other volume's material, in place; see subtract.")
      .def("intersect", boolean(dexel::Boolean::Intersect), py::arg("other"), py::arg("progress") = py::none(),
           "Keeps what both volumes have, in place; see subtract.")
      .def("save", &save_volume, py::arg("path"), py::arg("progress") = py::none(),
           "Writes a .rvol file, whole or not at all. Equal volumes are equal files.")
      .def_static("load", &load_volume, py::arg("path"), py::arg("progress") = py::none(),
                  "Reads a .rvol file; FormatError where it is damaged or not one.")
      .def("to_bytes", &volume_to_bytes, py::arg("progress") = py::none(), "The bytes of the .rvol file.")
      .def("to_mesh", &volume_to_mesh, py::arg("progress") = py::none(), py::arg("report") = py::none(),
           R"(The surface: closed, outward, two-manifold, and still so in a binary STL.

``report``: a dict that is filled with what is no part of it, since it is thinner than the pitch: ``lost`` (mm³),
``lost_box``, where, as two corners, or None; ``lost_pitch`` (mm) that keeps it, or None; ``lost_note``, a sentence where
there is more than crumbs, otherwise empty. Without a report that sentence is a UserWarning.)")
      .def(py::pickle([](SharedVolume& v) { return py::bytes(volume_to_bytes(v, py::none())); },
                      [](const py::bytes& b) { return volume_from_bytes(py::buffer(b), "pickle"); }))
      .def("stats", &stats, "Operation counters since the last call of stats().")
      .def("__repr__", &describe);
  bind_volume_edits(volume);
}

}  // namespace riffler::bindings
