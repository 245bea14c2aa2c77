// riffler.Volume.brush
#include <array>
#include <optional>

#include "bindings/brush_names.hpp"
#include "bindings/typed.hpp"
#include "bindings/volume_class.hpp"
#include "riffler/brush/brush_dabs.hpp"

namespace riffler::bindings {

namespace {

constexpr std::array<const char*, brush::kKinds> kBrushes{"clay", "inflate",    "flatten", "scrape", "fill",
                                                          "grab", "snake_hook", "pinch",   "crease", "twist"};
constexpr std::array<const char*, brush::kFalloffs> kFalloffs{
    "smooth", "smoother", "sphere", "root", "sharp", "linear", "sharper", "inverse_square", "constant"};

template <std::size_t n>
std::uint32_t place_of(const std::array<const char*, n>& names, const std::string& name, const char* what) {
  std::string all;
  for (std::uint32_t k = 0; k < n; ++k) {
    if (name == names[k]) return k;
    all += (k == 0 ? "\"" : k + 1 < n ? "\", \"" : "\" or \"") + std::string(names[k]);
  }
  throw py::value_error(std::string(what) + " must be " + all + "\"");
}

brush::BrushResult apply_brush(SharedVolume& self, const std::string& kind, const Doubles& dabs, double radius,
                               double strength, double amount, const std::string& falloff, SharedVolume* protect,
                               const ProgressLike& progress) {
  const std::vector<Pose> poses = to_poses(dabs, "dabs");
  brush::BrushOptions options{to_brush(kind),       radius, strength, amount, to_falloff(falloff), nullptr,
                              to_progress(progress)};
  std::optional<Volume> kept;  // which may be `self`
  if (protect) options.protect = &kept.emplace(Reading(*protect).volume.snapshot());
  Writing writing(self);
  const NoGil release;
  return brush_dabs(writing.volume, poses, options);
}

}  // namespace

const char* brush_name(brush::Kind kind) {
  return kBrushes[static_cast<std::uint32_t>(kind)];
}

const char* falloff_name(brush::Falloff falloff) {
  return kFalloffs[static_cast<std::uint32_t>(falloff)];
}

brush::Kind to_brush(const std::string& name) {
  return static_cast<brush::Kind>(place_of(kBrushes, name, "kind"));
}

brush::Falloff to_falloff(const std::string& name) {
  return static_cast<brush::Falloff>(place_of(kFalloffs, name, "falloff"));
}

void bind_brush_dabs(py::module_& m) {
  py::class_<brush::BrushResult>(m, "Brushed", "The effect of the dabs of a brush. See `Volume.brush`.")
      .def_readonly("removed", &brush::BrushResult::removed, "mm³ removed, summed over the dabs.")
      .def_readonly("added", &brush::BrushResult::added, "mm³ added, summed over the dabs.")
      .def_readonly("lost", &brush::BrushResult::lost,
                    "mm³ of walls thinner than the pitch that a displacement sideways by more than a pitch dropped.")
      .def_readonly("clipped", &brush::BrushResult::clipped,
                    "Whether material reached the volume's box and was cut off there; `Volume.grow` enlarges it.");

  m.def(
      "falloff", [](const std::string& name, double t) { return brush::falloff_at(to_falloff(name), t); },
      py::arg("name"), py::arg("t"),
      R"(The falloff of a brush: 1 at its centre, 0 at its radius and beyond.

Parameters
----------
name : str
    As in ``Volume.brush``.
t : float
    Distance from the centre as a fraction of the radius.

Examples
--------
>>> riffler.falloff("smooth", 0.5), riffler.falloff("linear", 0.25)
(0.5, 0.75)
)");

  py::reinterpret_borrow<VolumeClass>(m.attr("Volume"))
      .def("brush", &apply_brush, py::arg("kind"), py::arg("dabs"), py::arg("radius"), py::kw_only(),
           py::arg("strength") = brush::BrushOptions{}.strength, py::arg("amount") = brush::BrushOptions{}.amount,
           py::arg("falloff") = "smooth", py::arg("protect") = py::none(), py::arg("progress") = py::none(),
           R"(Displaces the surface by dabs of a round brush with falloff; volumes with directions "xyz" only.

With f the falloff at a point times ``strength``, and the axis that of the dab:

============ =========================================================================================
"clay"       adds a layer of f · amount along the axis where the surface faces it; a negative one digs
"inflate"    f · amount along the surface's own normal; a negative one deflates
"flatten"    f of the distance to the mean plane of the surface in the radius, raised by amount
"scrape"     as "flatten", only what stands above the plane
"fill"       as "flatten", only what lies below the plane
"grab"       f times the vector from the first dab's centre to the last one's, as one displacement
"snake_hook" f times the vector from each dab's centre to the next one's
"pinch"      f / 2 of the distance to the line through the centre along the axis
"crease"     as "pinch", and f² / strength · amount along the axis: negative for a furrow, positive for a ridge
"twist"      turns by f · amount, in rad, about that line
============ =========================================================================================

Nothing changes, to the bit, farther than the radius from the centres; for "grab" and "snake_hook", from the line that
the centre moves on. Detail as fine as a pitch moves along where the displacement is along the surface's normal; a
displacement along the surface resamples it. Material never leaves the volume's box.

Parameters
----------
kind : str
    One of the names above.
dabs : array_like of shape (n, 6), mm
    Centre of each dab and its unit axis, out of the material.
radius : float, mm
    Radius of the brush.
strength : float, from 0 to 1
    Factor of the displacement.
amount : float
    Displacement at the centre, mm, or rad for "twist".
falloff : str
    "smooth", "smoother", "sphere", "root", "sharp", "linear", "sharper", "inverse_square" or "constant": see
    ``riffler.falloff``.
protect : Volume or None
    Region that must not change, material and air; a volume with the same lower, upper, pitch and directions.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Brushed
    The volumes removed and added, and what was cut off.

Raises
------
ValueError
    The volume has one direction only; the protected volume's grid is another; names argument and row.
Cancelled
    ``progress`` returned False; the volume is unchanged.

Examples
--------
>>> volume = riffler.Volume.sphere((0, 0, 0), 20, 0.5, "xyz", lower=(-23,) * 3, upper=(23,) * 3)
>>> made = volume.brush("clay", [(0, 0, 20, 0, 0, 1)], 8, amount=1)
>>> bool(made.added > 0), made.clipped
(True, False)
)");
}

}  // namespace riffler::bindings
