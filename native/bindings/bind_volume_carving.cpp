// riffler.Volume: carving, operators of sets, snapshots.
#include <optional>

#include "bindings/typed.hpp"
#include "bindings/volume_class.hpp"
#include "riffler/dexel/boolean.hpp"
#include "riffler/sweep/carve.hpp"

namespace riffler::bindings {

namespace {

/// A volume's state at one time; shares its tiles.
struct Snapshot {
  Volume volume;
};

std::vector<double> to_times(const py::object& dt, std::size_t moves) {
  if (dt.is_none()) return {};
  const Doubles array = py::cast<Doubles>(dt);
  if (array.ndim() == 0) return std::vector<double>(moves, *array.data());
  if (array.ndim() != 1 || static_cast<std::size_t>(array.shape(0)) != moves)
    throw py::value_error("dt must be a number or have the shape (" + std::to_string(moves) + ",), one per move");
  return {array.data(), array.data() + moves};
}

sweep::Cut carve_poses(SharedVolume& self, const Tool& tool, const Doubles& poses, double tolerance,
                       const OptionalArrayLike& dt, double removal_constant, const std::string& mode,
                       SharedVolume* protect, const ProgressLike& progress) {
  const PosesOf path = to_poses_of(tool, poses, "poses");
  sweep::CarveOptions options{tolerance,           to_times(dt, path.rows() == 0 ? 0 : path.rows() - 1),
                              removal_constant,    to_progress(progress),
                              to_carve_mode(mode), nullptr};
  std::optional<Volume> kept;  // which may be `self`
  if (protect) options.protect = &kept.emplace(Reading(*protect).volume.snapshot());
  Writing writing(self);
  const NoGil release;
  return tool.revolved() ? sweep::carve(writing.volume, tool, path.plain, options)
                         : sweep::carve(writing.volume, tool, path.rolled, options);
}

/// v.subtract(w) and its like: changes v and returns it.
auto boolean(dexel::Boolean op) {
  return [op](const std::shared_ptr<SharedVolume>& self, SharedVolume& other, const ProgressLike& progress) {
    const Progress listener = to_progress(progress);
    const Volume operand = Reading(other).volume.snapshot();  // which may be `self`
    Writing writing(*self);
    const NoGil release;
    apply(op, writing.volume, operand, listener);
    return self;
  };
}

/// v | w and its like: a new volume.
auto operator_of(dexel::Boolean op) {
  return [op](SharedVolume& self, SharedVolume& other) {
    Volume out = Reading(self).volume.snapshot();
    const Volume operand = Reading(other).volume.snapshot();
    const NoGil release;
    apply(op, out, operand, Progress());
    return share(std::move(out));
  };
}

/// v |= w and its like.
auto in_place(dexel::Boolean op) {
  return [op](const std::shared_ptr<SharedVolume>& self, SharedVolume& other) {
    return boolean(op)(self, other, ProgressLike(py::none()));
  };
}

void bind_cut(py::module_& m) {
  py::class_<sweep::Cut>(
      m, "Cut", "The volume and force of each move of a carve; arrays with one row per move. See `Volume.carve`.")
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

void bind_snapshot(py::module_& m) {
  py::class_<Snapshot>(
      m, "Snapshot",
      "The state of a volume at one time; shares its tiles until they are written. See `Volume.snapshot`.")
      .def_property_readonly(
          "volume", [](const Snapshot& s) { return s.volume.volume(); }, "mm³ of material.")
      .def_property_readonly(
          "revision", [](const Snapshot& s) { return s.volume.revision(); }, "The volume's revision at that time.")
      .def_property_readonly(
          "nbytes", [](const Snapshot& s) { return s.volume.nbytes(); }, "Bytes held, shared tiles counted once.");
}

void bind_snapshots(VolumeClass& volume) {
  volume
      .def(
          "snapshot", [](SharedVolume& v) { return Snapshot{Reading(v).volume.snapshot()}; },
          R"(The present state, for `restore`; costs pointers only.

Returns
-------
Snapshot
    The state of this volume at the call.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
>>> before = volume.snapshot()
>>> cut = volume.carve(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
>>> volume.restore(before)
>>> volume.volume
4000.0
)")
      .def(
          "restore", [](SharedVolume& v, const Snapshot& s) { Writing(v).volume.restore(s.volume); },
          py::arg("snapshot"), R"(Restores a snapshot of this volume.

Parameters
----------
snapshot : Snapshot
    A result of `snapshot`.

Raises
------
ValueError
    The snapshot is of a volume with another box, pitch or directions.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
>>> before = volume.snapshot()
>>> half = volume.clip((2, 0, 0), (1, 0, 0))
>>> volume.restore(before)
>>> volume.volume
24.0
)")
      .def(
          "copy", [](SharedVolume& v) { return share(Reading(v).volume.snapshot()); },
          R"(An independent volume; shares its tiles until one of the two is written.

Returns
-------
Volume
    A new volume.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
>>> volume.copy().to_bytes() == volume.to_bytes()
True
)")
      .def("__copy__", [](SharedVolume& v) { return share(Reading(v).volume.snapshot()); })
      .def("__deepcopy__", [](SharedVolume& v, const py::dict&) { return share(Reading(v).volume.snapshot()); });
}

void bind_sets(VolumeClass& volume) {
  using dexel::Boolean;
  const char* const kSubtract = R"(Removes the other volume's material, in place: ``v -= other`` with progress.

Parameters
----------
other : Volume
    Of the same lower, upper, pitch and directions.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Volume
    This volume.

Raises
------
ValueError
    The other volume's grid is another.
Cancelled
    ``progress`` returned False.

Examples
--------
>>> block = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
>>> block.copy().subtract(block).volume
0.0
)";
  const char* const kAdd = R"(Adds the other volume's material, in place: ``v |= other`` with progress; see `subtract`.

Parameters
----------
other : Volume
    Of the same lower, upper, pitch and directions.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Volume
    This volume.

Examples
--------
>>> block = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
>>> riffler.Volume.empty((0, 0, 0), (4, 3, 2), pitch=0.5).add(block).volume
24.0
)";
  const char* const kIntersect =
      R"(Keeps the material that both volumes have, in place: ``v &= other`` with progress; see `subtract`.

Parameters
----------
other : Volume
    Of the same lower, upper, pitch and directions.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Volume
    This volume.

Examples
--------
>>> block = riffler.Volume.block((0, 0, 0), (4, 3, 2), pitch=0.5)
>>> block.copy().intersect(block).volume
24.0
)";
  volume
      .def("subtract", boolean(Boolean::Subtract), py::arg("other"), py::kw_only(), py::arg("progress") = py::none(),
           kSubtract)
      .def("add", boolean(Boolean::Add), py::arg("other"), py::kw_only(), py::arg("progress") = py::none(), kAdd)
      .def("intersect", boolean(Boolean::Intersect), py::arg("other"), py::kw_only(), py::arg("progress") = py::none(),
           kIntersect)
      .def("__sub__", operator_of(Boolean::Subtract), py::is_operator())
      .def("__or__", operator_of(Boolean::Add), py::is_operator())
      .def("__and__", operator_of(Boolean::Intersect), py::is_operator())
      .def("__isub__", in_place(Boolean::Subtract), py::is_operator())
      .def("__ior__", in_place(Boolean::Add), py::is_operator())
      .def("__iand__", in_place(Boolean::Intersect), py::is_operator());
}

}  // namespace

void bind_volume_carving(py::module_& m, VolumeClass& volume) {
  bind_cut(m);
  bind_snapshot(m);
  volume.def("carve", &carve_poses, py::arg("tool"), py::arg("poses"), py::kw_only(), py::arg("tolerance") = 0.01,
             py::arg("dt") = py::none(), py::arg("removal_constant") = sweep::CarveOptions{}.removal_constant,
             py::arg("mode") = "remove", py::arg("protect") = py::none(), py::arg("progress") = py::none(),
             R"(Removes what the cutter sweeps along a path, or adds it. Shank and holder never cut.

Parameters
----------
tool : Tool
    Its cutter is swept.
poses : array_like of shape (n, 6), tip in mm and unit axis
    Tip xyz, then unit axis xyz from the tip to the spindle; n - 1 moves. A hand tool (`Tool.convex` and its like) needs
    the shape (n, 9): then its unit forward direction xyz, square to the axis.
tolerance : float, mm
    Tolerance of moves that turn the axis; others are exact.
dt : array_like, a number or of shape (n - 1,), s, or None
    Duration of the moves; needed for force.
removal_constant : float, N·s/mm³
    Force for each rate of removal.
mode : "remove" or "add"
    "add" adds material wherever the cutter sweeps within the volume's box; ``removed`` then has the added volume.
protect : Volume or None
    Region that must not change, material and air; a volume with the same lower, upper, pitch and directions.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
Cut
    The volume that each move removed.

Raises
------
ValueError
    Names argument and row: a wrong shape, an axis that is not a unit vector, opposite axes, for a hand tool a forward
    direction that is not square to the axis and a half turn; or the protected volume's grid is another.
Cancelled
    ``progress`` returned False; the volume is unchanged.

Examples
--------
>>> volume = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
>>> cut = volume.carve(riffler.Tool.flat(6, 30), [[-5, 10, 8, 0, 0, 1], [25, 10, 8, 0, 0, 1]], dt=1.0)
>>> cut.removed.round(3).tolist(), bool(cut.force[0, 0] < 0)
([240.0], True)
)");
  bind_snapshots(volume);
  bind_sets(volume);
}

}  // namespace riffler::bindings
