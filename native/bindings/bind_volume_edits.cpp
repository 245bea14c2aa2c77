// riffler.Volume: what is done to it as a whole.
#include "bindings/task.hpp"
#include "bindings/volume_class.hpp"
#include "dexel/clip.hpp"
#include "dexel/contains.hpp"
#include "dexel/from_mesh.hpp"
#include "dexel/parts.hpp"
#include "marching/to_mesh.hpp"

namespace riffler {

namespace {

std::shared_ptr<SharedVolume> empty(const py::object& lower, const py::object& upper, double pitch,
                                    const std::string& directions) {
  return share(Volume({{to_vec3(lower, "lower"), to_vec3(upper, "upper")}, pitch, directions}));
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
  const Frame& old = state.frame();
  const Frame frame{{lower.is_none() ? old.box.lower : to_vec3(lower, "lower"),
                     upper.is_none() ? old.box.upper : to_vec3(upper, "upper")},
                    pitch,
                    directions.value_or(old.directions)};
  const auto work = [state, fresh = Volume(frame)](const Progress& listener) {
    if (fresh.frame() == state.frame()) return share(state.snapshot());
    const Mesh mesh = to_mesh(state, part(listener, 0, 0.5));
    if (mesh.empty()) return share(fresh.snapshot());
    return share(from_mesh(mesh, fresh.frame(), part(listener, 0.5, 1)));
  };
  return long_call(progress, work, AsItIs());
}

}  // namespace

void bind_volume_edits(VolumeClass& volume) {
  volume
      .def_static("empty", &empty, py::arg("lower"), py::arg("upper"), py::arg("pitch"), py::arg("directions") = "z",
                  "The box without material: what is put on (``carve``, ``add``) is all that it has. mm.")
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

}  // namespace riffler
