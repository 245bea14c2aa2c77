// riffler.Volume.soften
#include <optional>

#include "bindings/bindings.hpp"
#include "bindings/shared_volume.hpp"
#include "riffler/dexel/smooth/smooth_dabs.hpp"

namespace riffler::bindings {

namespace {

using VolumeClass = py::class_<SharedVolume, std::shared_ptr<SharedVolume>>;

/// (n, 3), or (3,) for one.
std::vector<Vec3> to_centres(Doubles array) {
  if (array.ndim() == 1 && array.shape(0) == 3) array = array.reshape({1, 3});
  return to_vec3s(array, "centres");
}

dexel::SmoothResult smooth_brush(SharedVolume& self, const Doubles& centres, double radius, double strength,
                                 SharedVolume* protect, const py::object& progress) {
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
  py::class_<dexel::SmoothResult>(m, "Softened", "What each dab of a smooth brush did; arrays with one number per dab.")
      .def_property_readonly(
          "removed", [](const dexel::SmoothResult& s) { return take<double>(std::vector<double>(s.removed)); },
          "(n,) mm³ taken away.")
      .def_property_readonly(
          "added", [](const dexel::SmoothResult& s) { return take<double>(std::vector<double>(s.added)); },
          "(n,) mm³ put on.")
      .def("__len__", [](const dexel::SmoothResult& s) { return s.removed.size(); });

  py::reinterpret_borrow<VolumeClass>(m.attr("Volume"))
      .def("soften", &smooth_brush, py::arg("centres"), py::arg("radius"),
           py::arg("strength") = dexel::SmoothOptions{}.strength, py::arg("protect") = py::none(),
           py::arg("progress") = py::none(),
           R"(Smooths the surface by dabs of a round brush at ``centres`` (n, 3) or (3,), one after the other.

``radius``: mm, of the brush; what lies beyond it stays as it is. ``strength``: 0 to 1, the share of the way to the
smoothed surface at the brush's centre, less towards its rim. A dab levels what is finer than about four pitches and
moves nothing by more than one pitch; repeat it for more. Planes stay as they are, edges become round, convex places
lose material and concave ones get some, within the volume's box only.

Tri-dexel volumes ("xyz") only, whose ends have normals; ValueError for others. ``protect``: a volume of the same lower,
upper, pitch and directions; what lies in it stays as it is, material and air. ``progress``: called with the finished
share; returning False cancels, raises Cancelled and leaves the volume as it was.)");
}

}  // namespace riffler::bindings
