// riffler.Volume: boxes, balls and cylinders.
#include "bindings/task.hpp"
#include "bindings/typed.hpp"
#include "bindings/volume_class.hpp"
#include "riffler/dexel/quadrics.hpp"

namespace riffler::bindings {

namespace {

std::shared_ptr<SharedVolume> empty(const ArrayLike& lower, const ArrayLike& upper, double pitch,
                                    const std::string& directions) {
  return share(Volume({{to_vec3(lower, "lower"), to_vec3(upper, "upper")}, pitch, directions}));
}

auto sphere_volume(const ArrayLike& centre, double radius, double pitch, const std::string& directions,
                   const OptionalArrayLike& lower, const OptionalArrayLike& upper, const ProgressLike& progress) {
  const dexel::Sphere solid{to_vec3(centre, "centre"), radius};
  const dexel::Frame frame{box_or(bounds(solid), lower, upper), pitch, directions};
  const auto work = [solid, frame](const Progress& listener) { return share(sphere(solid, frame, listener)); };
  return long_call(progress, work, Identity());
}

auto cylinder_volume(const ArrayLike& centre, double radius, double height, double pitch, const std::string& directions,
                     const ArrayLike& axis, const OptionalArrayLike& lower, const OptionalArrayLike& upper,
                     const ProgressLike& progress) {
  const dexel::Cylinder solid{to_vec3(centre, "centre"), radius, height, to_vec3(axis, "axis")};
  const dexel::Frame frame{box_or(bounds(solid), lower, upper), pitch, directions};
  const auto work = [solid, frame](const Progress& listener) { return share(cylinder(solid, frame, listener)); };
  return long_call(progress, work, Identity());
}

std::shared_ptr<SharedVolume> block(const ArrayLike& lower, const ArrayLike& upper, double pitch,
                                    const std::string& directions) {
  const dexel::Frame frame{{to_vec3(lower, "lower"), to_vec3(upper, "upper")}, pitch, directions};
  return share(Volume::block(frame));
}

}  // namespace

void bind_volume_solids(VolumeClass& volume) {
  volume
      .def_static("block", &block, py::arg("lower"), py::arg("upper"), py::arg("pitch"), py::arg("directions") = "z",
                  R"(A box full of material.

Parameters
----------
lower, upper : array_like of shape (3,), mm
    Opposite corners of the box.
pitch : float, mm
    Distance of neighbouring rays.
directions : "z" or "xyz"
    One grid of rays, or three.

Returns
-------
Volume
    A new volume.

Raises
------
ValueError
    Before anything is allocated, if it does not fit in memory.

Examples
--------
>>> riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5).volume
24.0
)")
      .def_static("empty", &empty, py::arg("lower"), py::arg("upper"), py::arg("pitch"), py::arg("directions") = "z",
                  R"(A box without material, to add material to (``carve`` with mode "add", ``|=``).

Parameters
----------
lower, upper : array_like of shape (3,), mm
    Opposite corners of the box.
pitch : float, mm
    Distance of neighbouring rays.
directions : "z" or "xyz"
    One grid of rays, or three.

Returns
-------
Volume
    A new volume.

Raises
------
ValueError
    The box is empty or does not fit in memory.

Examples
--------
>>> riffler.Volume.empty((0, 0, 0), (4, 3, 2), pitch=0.5).volume
0.0
)")
      .def_static("sphere", &sphere_volume, py::arg("centre"), py::arg("radius"), py::arg("pitch"),
                  py::arg("directions") = "z", py::kw_only(), py::arg("lower") = py::none(),
                  py::arg("upper") = py::none(), py::arg("progress") = py::none(),
                  R"(A ball of material, made of exact rays: it has no facets.

Each end of a span is at the ray's intersection with the sphere, to rounding, with the sphere's normal.

Parameters
----------
centre : array_like of shape (3,), mm
    Of the ball.
radius : float, mm
    Of the ball.
pitch : float, mm
    Distance of neighbouring rays.
directions : "z" or "xyz"
    One grid of rays, or three.
lower, upper : array_like of shape (3,), mm, or None
    The volume's box; material outside it is clipped. Default: the ball's own.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Volume
    A new volume.

Raises
------
ValueError
    All rays of a direction miss the ball. The message names a pitch at which they do not.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> ball = riffler.Volume.sphere((0, 0, 0), 5, pitch=0.1)
>>> round(ball.volume)
524
)")
      .def_static("cylinder", &cylinder_volume, py::arg("centre"), py::arg("radius"), py::arg("height"),
                  py::arg("pitch"), py::arg("directions") = "z", py::kw_only(),
                  py::arg("axis") = py::make_tuple(0, 0, 1), py::arg("lower") = py::none(),
                  py::arg("upper") = py::none(), py::arg("progress") = py::none(),
                  R"(A cylinder of material, made of exact rays as `sphere`.

The caps are planes, and meet the side at a sharp edge in volumes of three directions.

Parameters
----------
centre : array_like of shape (3,), mm
    The middle of the cylinder.
radius : float, mm
    Of the cylinder.
height : float, mm
    Along the axis.
pitch : float, mm
    Distance of neighbouring rays.
directions : "z" or "xyz"
    One grid of rays, or three.
axis : array_like of shape (3,), of any length but 0
    Direction of the axis.
lower, upper : array_like of shape (3,), mm, or None
    The volume's box; material outside it is clipped. Default: the cylinder's own.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Volume
    A new volume.

Raises
------
ValueError
    As for `sphere`.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> rod = riffler.Volume.cylinder((0, 0, 0), 2, 10, pitch=0.1, axis=(1, 0, 0))
>>> round(rod.volume)
126
)");
}

}  // namespace riffler::bindings
