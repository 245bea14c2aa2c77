// riffler.Volume: other volumes made of it, clipping, and what it holds.
#include <pybind11/typing.h>

#include "bindings/task.hpp"
#include "bindings/typed.hpp"
#include "bindings/volume_class.hpp"
#include "riffler/dexel/clip.hpp"
#include "riffler/dexel/contains.hpp"
#include "riffler/dexel/from_mesh/from_mesh.hpp"
#include "riffler/dexel/grown.hpp"
#include "riffler/dexel/parts.hpp"
#include "riffler/marching/to_mesh.hpp"

namespace riffler::bindings {

namespace {

/// A list whose items the signature names.
using VolumeList = py::typing::List<std::shared_ptr<SharedVolume>>;

auto grown_volume(SharedVolume& self, const OptionalArrayLike& lower, const OptionalArrayLike& upper,
                  const ProgressLike& progress) {
  const Volume state = Reading(self).volume.snapshot();
  const Box3 wanted = box_or(state.frame().box, lower, upper);
  const auto work = [state, wanted](const Progress& listener) { return share(grown(state, wanted, listener)); };
  return long_call(progress, work, Identity());
}

std::shared_ptr<SharedVolume> clip_volume(const std::shared_ptr<SharedVolume>& self, const ArrayLike& point,
                                          const ArrayLike& normal, const ProgressLike& progress) {
  const Vec3 p = to_vec3(point, "point"), n = to_vec3(normal, "normal");
  const Progress listener = to_progress(progress);
  Writing writing(*self);
  const NoGil release;
  clip(writing.volume, p, n, listener);
  return self;
}

auto parts_of(SharedVolume& self, double minimum, const ProgressLike& progress) {
  const auto work = [state = Reading(self).volume.snapshot(), minimum](const Progress& listener) {
    return parts(state, minimum, listener);
  };
  return long_call(progress, work, [](std::vector<Volume>&& found) {
    VolumeList out;
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

auto resampled(SharedVolume& self, double pitch, const std::optional<std::string>& directions,
               const OptionalArrayLike& lower, const OptionalArrayLike& upper, const ProgressLike& progress) {
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
      .def("grow", &grown_volume, py::arg("lower") = py::none(), py::arg("upper") = py::none(), py::kw_only(),
           py::arg("progress") = py::none(),
           R"(This volume in a larger box: a new volume with the same spans and normals, bit for bit.

Rays stay in place, and rays without material are added next to them: each side of the box moves outward by
whole pitches until it lies at or beyond that of ``lower`` to ``upper``, to 1e-6 of a pitch. A side that does already
stays. Where a box's size is not a whole number of pitches, an upper side may move one pitch more; ``volume`` then counts
the rays that were last with whole cells.

Parameters
----------
lower, upper : array_like of shape (3,), mm, or None
    The box to reach. Default: this volume's own.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Volume
    A new volume.

Raises
------
ValueError
    Before anything is allocated, if the box does not fit in memory.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
>>> volume.grow(upper=(6, 3, 2)).upper.tolist()
[6.0, 3.0, 2.0]
)")
      .def("clip", &clip_volume, py::arg("point"), py::arg("normal"), py::kw_only(), py::arg("progress") = py::none(),
           R"(Removes the material in front of a plane, in place; the plane's normal is that of the new face.

Parameters
----------
point : array_like of shape (3,), mm
    A point on the plane.
normal : array_like of shape (3,), of any length but 0
    Points to the side that is removed.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Volume
    This volume.

Raises
------
ValueError
    A normal of length 0.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
>>> volume.clip(point=(0, 0, 1), normal=(0, 0, 1)).volume
12.0
)")
      .def("parts", &parts_of, py::kw_only(), py::arg("minimum") = 0.0, py::arg("progress") = py::none(),
           R"(The connected pieces of this volume as volumes on the same grid, the largest first.

Spans of neighbouring rays are connected where they overlap. The parts' volumes sum to this one's.

Parameters
----------
minimum : float, mm³
    Smaller pieces stay with the largest.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
list of Volume
    New volumes.

Raises
------
ValueError
    More than 1000 pieces, or a negative ``minimum``.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
>>> cut = volume.carve(riffler.Tool.flat(4, 30), [[-5, 12, 0, 0, 0, 1], [25, 12, 0, 0, 0, 1]])
>>> [part.volume for part in volume.parts()]
[2000.0, 1200.0]
)")
      .def(
          "contains", &contains_points, py::arg("points"),
          R"(Whether points are in the material, by the nearest ray of each direction; with three directions, by the majority.

Parameters
----------
points : array_like of shape (n, 3), mm
    Anywhere.

Returns
-------
ndarray of shape (n,), bool
    One for each point.

Examples
--------
>>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).contains([[1, 1, 1], [1, 1, 3]]).tolist()
[True, False]
)")
      .def("resample", &resampled, py::arg("pitch"), py::arg("directions") = py::none(), py::kw_only(),
           py::arg("lower") = py::none(), py::arg("upper") = py::none(), py::arg("progress") = py::none(),
           R"(This volume at another pitch, with other directions or in another box: a new volume.

Material outside the new box is left out. Resamples the mesh of `to_mesh`, so a finer pitch brings no
detail back. A volume with the same pitch, directions and box is a copy, bit for bit.

Parameters
----------
pitch : float, mm
    Distance of neighbouring rays.
directions : "z", "xyz" or None
    Default: this volume's own.
lower, upper : array_like of shape (3,), mm, or None
    The box. Default: this volume's own.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Volume
    A new volume.

Raises
------
ValueError
    The volume does not fit in memory.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> fine = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5, directions="xyz").resample(0.25)
>>> round(fine.volume, 3), fine.pitch
(24.0, 0.25)
)");
}

}  // namespace riffler::bindings
