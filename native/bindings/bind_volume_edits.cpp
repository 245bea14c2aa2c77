// riffler.Volume: what is done to it as a whole.
#include "bindings/task.hpp"
#include "bindings/volume_class.hpp"
#include "riffler/dexel/clip.hpp"
#include "riffler/dexel/contains.hpp"
#include "riffler/dexel/from_mesh/from_mesh.hpp"
#include "riffler/dexel/grown.hpp"
#include "riffler/dexel/parts.hpp"
#include "riffler/dexel/quadrics.hpp"
#include "riffler/marching/to_mesh.hpp"

namespace riffler::bindings {

namespace {

std::shared_ptr<SharedVolume> empty(const py::object& lower, const py::object& upper, double pitch,
                                    const std::string& directions) {
  return share(Volume({{to_vec3(lower, "lower"), to_vec3(upper, "upper")}, pitch, directions}));
}

/// What is given of a box, and of `own` what is not.
Box3 box_or(const Box3& own, const py::object& lower, const py::object& upper) {
  return {lower.is_none() ? own.lower : to_vec3(lower, "lower"), upper.is_none() ? own.upper : to_vec3(upper, "upper")};
}

auto sphere_volume(const py::object& centre, double radius, double pitch, const std::string& directions,
                   const py::object& lower, const py::object& upper, const py::object& progress) {
  const dexel::Sphere solid{to_vec3(centre, "centre"), radius};
  const dexel::Frame frame{box_or(bounds(solid), lower, upper), pitch, directions};
  const auto work = [solid, frame](const Progress& listener) { return share(sphere(solid, frame, listener)); };
  return long_call(progress, work, Identity());
}

auto cylinder_volume(const py::object& centre, double radius, double height, double pitch,
                     const std::string& directions, const py::object& axis, const py::object& lower,
                     const py::object& upper, const py::object& progress) {
  const dexel::Cylinder solid{to_vec3(centre, "centre"), radius, height, to_vec3(axis, "axis")};
  const dexel::Frame frame{box_or(bounds(solid), lower, upper), pitch, directions};
  const auto work = [solid, frame](const Progress& listener) { return share(cylinder(solid, frame, listener)); };
  return long_call(progress, work, Identity());
}

auto grown_volume(SharedVolume& self, const py::object& lower, const py::object& upper, const py::object& progress) {
  const Volume state = Reading(self).volume.snapshot();
  const Box3 wanted = box_or(state.frame().box, lower, upper);
  const auto work = [state, wanted](const Progress& listener) { return share(grown(state, wanted, listener)); };
  return long_call(progress, work, Identity());
}

std::shared_ptr<SharedVolume> clip_volume(const std::shared_ptr<SharedVolume>& self, const py::object& point,
                                          const py::object& normal, const py::object& progress) {
  const Vec3 p = to_vec3(point, "point"), n = to_vec3(normal, "normal");
  const Progress listener = to_progress(progress);
  Writing writing(*self);
  const NoGil release;
  clip(writing.volume, p, n, listener);
  return self;
}

auto parts_of(SharedVolume& self, double least, const py::object& progress) {
  const auto work = [state = Reading(self).volume.snapshot(), least](const Progress& listener) {
    return parts(state, least, listener);
  };
  return long_call(progress, work, [](std::vector<Volume>&& found) {
    py::list out;
    for (Volume& v : found) out.append(share(std::move(v)));
    return out;
  });
}

py::array_t<bool> contains_points(SharedVolume& self, const Doubles& points) {
  const std::vector<Vec3> asked = to_vec3s(points, "points");
  const Volume state = Reading(self).volume.snapshot();
  std::vector<char> inside;
  {
    const NoGil release;
    inside = contains(state, asked);
  }
  py::array_t<bool> out(static_cast<py::ssize_t>(inside.size()));
  for (std::size_t k = 0; k < inside.size(); ++k) out.mutable_at(k) = inside[k] != 0;
  return out;
}

auto resampled(SharedVolume& self, double pitch, const std::optional<std::string>& directions, const py::object& lower,
               const py::object& upper, const py::object& progress) {
  const Volume state = Reading(self).volume.snapshot();
  const dexel::Frame& old = state.frame();
  const dexel::Frame frame{box_or(old.box, lower, upper), pitch, directions.value_or(old.directions)};
  const auto work = [state, fresh = Volume(frame)](const Progress& listener) {
    if (fresh.frame() == state.frame()) return share(state.snapshot());
    const Mesh mesh = marching::to_mesh(state, base::part(listener, 0, 0.5));
    if (mesh.empty()) return share(fresh.snapshot());
    return share(dexel::from_mesh(mesh, fresh.frame(), base::part(listener, 0.5, 1)));
  };
  return long_call(progress, work, Identity());
}

}  // namespace

void bind_volume_edits(VolumeClass& volume) {
  volume
      .def_static("empty", &empty, py::arg("lower"), py::arg("upper"), py::arg("pitch"), py::arg("directions") = "z",
                  "The box without material: what is put on (``carve``, ``add``) is all that it has. mm.")
      .def_static("sphere", &sphere_volume, py::arg("centre"), py::arg("radius"), py::arg("pitch"),
                  py::arg("directions") = "z", py::arg("lower") = py::none(), py::arg("upper") = py::none(),
                  py::arg("progress") = py::none(),
                  R"(A ball of material around ``centre``, mm, made of exact rays: it has no facets.

Each end of a span is where its ray crosses the sphere, to the rounding of doubles, and has the sphere's normal. Covers
the ball's box, or ``lower`` to ``upper``, clipping what lies outside. ValueError where all rays of a direction miss a
ball that lies in the box: the message has a pitch at which they do not.)")
      .def_static("cylinder", &cylinder_volume, py::arg("centre"), py::arg("radius"), py::arg("height"),
                  py::arg("pitch"), py::arg("directions") = "z", py::arg("axis") = py::make_tuple(0, 0, 1),
                  py::arg("lower") = py::none(), py::arg("upper") = py::none(), py::arg("progress") = py::none(),
                  R"(A cylinder of material along ``axis``, of any length but 0; ``centre`` is the middle of it. mm.

Made of exact rays as ``sphere``: the caps are planes, and meet the side at a sharp edge in volumes of three directions.
Box and errors as there.)")
      .def("grown", &grown_volume, py::arg("lower") = py::none(), py::arg("upper") = py::none(),
           py::arg("progress") = py::none(),
           R"(This volume in a larger box: a new volume with the same spans and normals, bit for bit.

Rays stay where they stand, and others, without material, are put beside them: each side of the box moves outward by
whole pitches until it lies at or beyond that of ``lower`` to ``upper`` (mm; default: its own), to 1e-6 of a pitch. A
side that does already stays. Where a box's size is no whole number of pitches, an upper side may move one pitch more;
``volume`` then counts the rays that were last with whole cells. ValueError, before anything is allocated, if the box
does not fit in memory.)")
      .def(
          "clip", &clip_volume, py::arg("point"), py::arg("normal"), py::arg("progress") = py::none(),
          "Takes away what lies in front of the plane through ``point`` (mm) with ``normal``, of any length, in place: "
          "the new face looks out along it. Returns this volume.")
      .def("parts", &parts_of, py::arg("least") = 0.0, py::arg("progress") = py::none(),
           R"(A list of volumes on this one's grid, one for each piece that hangs together, the largest first.

Spans of neighbouring rays hang together where they overlap. Pieces smaller than ``least`` mm³ stay with the largest.
The parts' volumes sum to this one's. ValueError for more than 1000 pieces.)")
      .def("contains", &contains_points, py::arg("points"),
           "(n,) bool for ``points`` (n, 3) mm: in the material, by the nearest ray of each direction; of three, two "
           "decide.")
      .def("resampled", &resampled, py::arg("pitch"), py::arg("directions") = py::none(), py::arg("lower") = py::none(),
           py::arg("upper") = py::none(), py::arg("progress") = py::none(),
           R"(This volume at another pitch, with other directions or in another box (default: its own): a new volume.

Material outside of the new box is left out. What is resampled is the mesh of ``to_mesh``, so a finer pitch brings no
detail back. A volume with the same pitch, directions and box is a copy, bit for bit.)");
}

}  // namespace riffler::bindings
