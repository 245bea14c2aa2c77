// riffler.Volume: its frame, its rays, its counters.
#include "bindings/results.hpp"
#include "bindings/typed.hpp"
#include "bindings/volume_class.hpp"

namespace riffler::bindings {

namespace {

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

std::string describe_volume(SharedVolume& self) {
  const Reading reading(self);
  const Volume& v = reading.volume;
  std::string rays;
  for (const dexel::Grid& g : v.grids())
    rays += (rays.empty() ? "" : " + ") + std::to_string(g.nu()) + " × " + std::to_string(g.nv());
  return "<riffler.Volume \"" + v.frame().directions + "\", pitch " +
         py::cast<std::string>(py::str(py::float_(v.frame().pitch))) + " mm, " + rays + " rays>";
}

py::object result_of(const dexel::Stats& s) {
  using namespace py::literals;
  return make_result("VolumeCounters",
                     py::dict("moves"_a = s.moves, "steps"_a = s.steps, "tiles_visited"_a = s.tiles_visited,
                              "tiles_changed"_a = s.tiles_changed, "rays_tested"_a = s.rays_tested, "hits"_a = s.hits,
                              "rays_changed"_a = s.rays_changed, "tiles_meshed"_a = s.tiles_meshed,
                              "triangles_tested"_a = s.triangles_tested, "bytes_copied"_a = s.bytes_copied));
}

/// All that was counted since the last `take_counters`: the volume's own counters are moved here when they are read.
dexel::Stats& counted(SharedVolume& self) {
  Writing writing(self);
  return self.counted += writing.volume.take_stats();
}

VolumeCountersResult counters(SharedVolume& self) {
  return result_of(counted(self));
}

VolumeCountersResult take_counters(SharedVolume& self) {
  return result_of(std::exchange(counted(self), {}));
}

std::size_t ray_count(SharedVolume& v) {
  std::size_t n = 0;
  for (const dexel::Grid& g : v.volume.grids()) n += static_cast<std::size_t>(g.nu()) * g.nv();
  return n;
}

void bind_properties(VolumeClass& volume) {
  volume
      .def_property_readonly(
          "pitch", [](SharedVolume& v) { return v.volume.frame().pitch; }, "Distance of neighbouring rays, mm.")
      .def_property_readonly(
          "directions", [](SharedVolume& v) { return v.volume.frame().directions; }, "\"z\" or \"xyz\".")
      .def_property_readonly(
          "lower", [](SharedVolume& v) { return from_vec3(v.volume.frame().box.lower); },
          "(3,) mm: the box's corner with the smallest coordinates.")
      .def_property_readonly(
          "upper", [](SharedVolume& v) { return from_vec3(v.volume.frame().box.upper); },
          "(3,) mm: the box's corner with the largest coordinates.")
      .def_property_readonly(
          "volume", [](SharedVolume& v) { return Reading(v).volume.volume(); },
          "mm³: sum of length × area of the z rays, or of the only rays if there are no z rays. The area is h², except "
          "for the last rays, whose cells end with the box.")
      .def_property_readonly(
          "nbytes", [](SharedVolume& v) { return Reading(v).volume.nbytes(); },
          "Bytes held, shared tiles counted once.")
      .def_property_readonly(
          "revision", [](SharedVolume& v) { return Reading(v).volume.revision(); },
          "Number that changes with the content.")
      .def_property_readonly("rays", &ray_count, "Number of rays, all directions.")
      .def_property_readonly("counters", &counters,
                             "VolumeCounters: the work since the volume was made, or since `take_counters`. Reading "
                             "them changes nothing.")
      .def("take_counters", &take_counters, R"(The counters, which start again from 0.

Returns
-------
VolumeCounters
    The work since the volume was made, or since the last call.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
>>> cut = volume.carve(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
>>> volume.take_counters().moves, volume.counters.moves
(1, 0)
)")
      .def("__repr__", &describe_volume);
}

void bind_rays(VolumeClass& volume) {
  volume
      .def("intervals", &intervals, py::arg("direction"),
           R"(The material along every ray of a direction.

Parameters
----------
direction : "x", "y" or "z", one that the volume has
    Of the rays.

Returns
-------
counts : ndarray of shape (nu, nv), uint32
    Spans of each ray.
spans : ndarray of shape (counts.sum(), 2), float64, mm
    Near and far end of each span: coordinates along the ray, rays in C order.

Raises
------
ValueError
    The volume has no such rays.

Examples
--------
>>> counts, spans = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).intervals("z")
>>> counts.shape, spans[0].tolist()
((8, 6), [0.0, 2.0])
)")
      .def("normals", &normals, py::arg("direction"),
           R"(The surface's normals at the ends of the spans of `intervals`; volumes with directions "xyz" only.

Parameters
----------
direction : "x", "y" or "z", one that the volume has
    Of the rays.

Returns
-------
ndarray of shape (spans, 2, 3), float64
    Unit normals at near and far ends, out of the material.

Raises
------
ValueError
    The volume has no such rays, or no normals.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5, directions="xyz")
>>> volume.normals("z")[0].round(3).tolist()
[[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]
)");
}

}  // namespace

void bind_volume(py::module_& m) {
  VolumeClass volume(m, "Volume", R"(A dexel volume: material as spans along parallel rays.

``directions`` is "z" for one grid of rays or "xyz" for three (a tri-dexel volume, which also keeps the surface's
normals and so its sharp edges). Ray (i, j) of "z" is at lower + ((i + .5) h, (j + .5) h); "x" rays are indexed
(y, z), "y" rays (z, x). Lengths in mm.

Make volumes with `block`, `empty`, `sphere`, `cylinder`, `from_mesh` and `load`. Set operators work on volumes
with the same lower, upper, pitch and directions: ``v | w``, ``v & w``, ``v - w`` give a new volume, ``v |= w``,
``v &= w``, ``v -= w`` change v.

Examples
--------
>>> block = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
>>> ball = riffler.Volume.sphere((10, 10, 10), 6, pitch=0.5, lower=block.lower, upper=block.upper)
>>> dish = block - ball
>>> bool(dish.volume < block.volume), (dish | ball).volume == block.volume
(True, True)
)");
  bind_volume_solids(volume);
  bind_volume_meshes(volume);
  bind_properties(volume);
  bind_rays(volume);
  bind_volume_carving(m, volume);
  bind_volume_files(volume);
  bind_volume_edits(volume);
}

}  // namespace riffler::bindings
