// riffler.Volume.smooth
#include <optional>

#include "bindings/typed.hpp"
#include "bindings/volume_class.hpp"
#include "riffler/dexel/smooth/smooth_dabs.hpp"

namespace riffler::bindings {

namespace {

/// (n, 3), or (3,) for one.
std::vector<Vec3> to_centres(Doubles array) {
  if (array.ndim() == 1 && array.shape(0) == 3) array = array.reshape({1, 3});
  return to_vec3s(array, "centres");
}

dexel::SmoothResult smooth_brush(SharedVolume& self, const Doubles& centres, double radius, double strength,
                                 SharedVolume* protect, const ProgressLike& progress) {
  const std::vector<Vec3> dabs = to_centres(centres);
  dexel::SmoothOptions options{radius, strength, nullptr, to_progress(progress)};
  std::optional<Volume> kept;  // which may be `self`
  if (protect) options.protect = &kept.emplace(Reading(*protect).volume.snapshot());
  Writing writing(self);
  const NoGil release;
  return smooth_dabs(writing.volume, dabs, options);
}

}  // namespace

void bind_smooth_dabs(py::module_& m) {
  py::class_<dexel::SmoothResult>(
      m, "Smoothed", "The effect of each dab of a smooth brush; arrays with one number per dab. See `Volume.smooth`.")
      .def_property_readonly(
          "removed", [](const dexel::SmoothResult& s) { return take<double>(std::vector<double>(s.removed)); },
          "(n,) mm³ removed.")
      .def_property_readonly(
          "added", [](const dexel::SmoothResult& s) { return take<double>(std::vector<double>(s.added)); },
          "(n,) mm³ added.")
      .def("__len__", [](const dexel::SmoothResult& s) { return s.removed.size(); });

  py::reinterpret_borrow<VolumeClass>(m.attr("Volume"))
      .def("smooth", &smooth_brush, py::arg("centres"), py::arg("radius"), py::kw_only(),
           py::arg("strength") = dexel::SmoothOptions{}.strength, py::arg("protect") = py::none(),
           py::arg("progress") = py::none(),
           R"(Smooths the surface by dabs of a round brush, one after the other; volumes with directions "xyz" only.

A dab levels what is finer than about four pitches and moves nothing by more than one pitch; repeat it for more. Planes
stay planes, edges become round, convex places lose material and concave ones get some, within the volume's box only.

Parameters
----------
centres : array_like of shape (n, 3) or (3,), mm
    Centres of the dabs.
radius : float, mm
    Radius of the brush; material beyond it is unchanged.
strength : float, from 0 to 1
    Blend factor at the brush's centre: 0 unchanged, 1 fully smoothed; less towards the rim.
protect : Volume or None
    Region that must not change, material and air; a volume with the same lower, upper, pitch and directions.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Smoothed
    The volumes that each dab removed and added.

Raises
------
ValueError
    The volume has one direction only; the protected volume's grid is another; names argument and row.
Cancelled
    ``progress`` returned False; the volume is unchanged.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz")
>>> moved = volume.smooth((20, 10, 10), radius=4)
>>> bool(moved.removed[0] > 0), len(moved)
(True, 1)
)");
}

}  // namespace riffler::bindings
