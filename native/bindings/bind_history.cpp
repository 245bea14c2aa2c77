// riffler.History: strokes that stay editable.
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings/history_class.hpp"
#include "bindings/one_caller.hpp"
#include "bindings/volume_class.hpp"
#include "riffler/sweep/history.hpp"

namespace riffler::bindings {

namespace {

using sweep::HistoryStroke;
using sweep::StrokeId;

struct SharedHistory : Guarded {
  explicit SharedHistory(sweep::History h) : history(std::move(h)) {}
  sweep::History history;
};

/// Held through every call.
OneCaller lock(SharedHistory& h) {
  return {h, "the history"};
}

std::optional<Volume> snapshot_of(SharedVolume* volume) {
  if (!volume) return std::nullopt;
  return Reading(*volume).volume.snapshot();
}

std::unique_ptr<SharedHistory> make_history(SharedVolume& base, std::size_t memory_limit) {
  return std::make_unique<SharedHistory>(sweep::History(Reading(base).volume, memory_limit));
}

HistoryStroke to_stroke(const Tool& tool, const Doubles& poses, const std::string& mode, double tolerance,
                        SharedVolume* protect) {
  PosesOf path = to_poses_of(tool, poses, "poses");
  return {tool, std::move(path.plain), to_carve_mode(mode), tolerance, snapshot_of(protect), std::move(path.rolled)};
}

/// Runs an edit, body(history, progress), without Python's lock, and alone.
template <class Body>
auto edited(SharedHistory& self, const ProgressLike& progress, const Body& body) {
  const Progress listener = to_progress(progress);
  const NoGil release;
  const auto held = lock(self);
  return body(self.history, listener);
}

StrokeId add_stroke(SharedHistory& self, const Tool& tool, const Doubles& poses, const std::string& mode,
                    double tolerance, SharedVolume* protect, const ProgressLike& progress) {
  HistoryStroke stroke = to_stroke(tool, poses, mode, tolerance, protect);
  return edited(self, progress, [&](sweep::History& h, const Progress& p) { return h.add(std::move(stroke), p); });
}

StrokeId insert(SharedHistory& self, const Tool& tool, const Doubles& poses, StrokeId before, const std::string& mode,
                double tolerance, SharedVolume* protect, const ProgressLike& progress) {
  HistoryStroke stroke = to_stroke(tool, poses, mode, tolerance, protect);
  return edited(self, progress,
                [&](sweep::History& h, const Progress& p) { return h.insert(std::move(stroke), before, p); });
}

void replace(SharedHistory& self, StrokeId id, const Tool* tool, const std::optional<Doubles>& poses,
             const std::optional<std::string>& mode, std::optional<double> tolerance, SharedVolume* protect,
             const ProgressLike& progress) {
  HistoryStroke stroke = (lock(self), self.history.stroke(id));
  if (tool) stroke.tool = *tool;
  if (poses) {
    PosesOf path = to_poses_of(stroke.tool, *poses, "poses");
    stroke.poses = std::move(path.plain), stroke.rolled = std::move(path.rolled);
  }
  if (mode) stroke.mode = to_carve_mode(*mode);
  if (tolerance) stroke.tolerance = *tolerance;
  if (protect) stroke.protect = snapshot_of(protect);
  edited(self, progress, [&](sweep::History& h, const Progress& p) { h.replace(id, std::move(stroke), p); });
}

void remove(SharedHistory& self, StrokeId id, const ProgressLike& progress) {
  edited(self, progress, [&](sweep::History& h, const Progress& p) { h.remove(id, p); });
}

void move(SharedHistory& self, StrokeId id, std::optional<StrokeId> before, const ProgressLike& progress) {
  edited(self, progress, [&](sweep::History& h, const Progress& p) { h.move(id, before, p); });
}

void enable(SharedHistory& self, StrokeId id, bool enabled, const ProgressLike& progress) {
  edited(self, progress, [&](sweep::History& h, const Progress& p) { h.enable(id, enabled, p); });
}

HistoryStrokeResult stroke(SharedHistory& self, StrokeId id) {
  const auto held = lock(self);
  const HistoryStroke& s = self.history.stroke(id);
  using namespace py::literals;
  return make_result(
      "HistoryStroke",
      py::dict("id"_a = id, "tool"_a = s.tool,
               "poses"_a = s.tool.revolved() ? from_poses(s.poses) : from_poses(s.rolled),
               "mode"_a = s.mode == sweep::CarveMode::Add ? "add" : "remove", "tolerance"_a = s.tolerance,
               "protect"_a = s.protect ? py::cast(share(s.protect->snapshot())) : py::none(),
               "enabled"_a = self.history.enabled(id)));
}

HistoryStatsResult stats(SharedHistory& self) {
  const sweep::HistoryStats s = (lock(self), self.history.stats());
  using namespace py::literals;
  return make_result(
      "HistoryStats",
      py::dict("edits"_a = s.edits, "tiles_restored"_a = s.tiles_restored, "strokes_run"_a = s.strokes_run,
               "tiles_run"_a = s.tiles_run, "moves_run"_a = s.moves_run, "tiles_changed"_a = s.tiles_changed,
               "strokes"_a = s.strokes, "versions"_a = s.versions, "version_bytes"_a = s.version_bytes,
               "stroke_bytes"_a = s.stroke_bytes, "stride"_a = s.stride));
}

using HistoryClass = py::class_<SharedHistory>;

const char* const kEditErrors = R"(
Raises
------
ValueError
    The history has no such stroke; or names argument and row: no poses, a wrong shape, an axis that is not a unit vector, opposite
    axes, a protected volume with another grid. The history is unchanged.
Cancelled
    ``progress`` returned False; the history is unchanged.
)";

std::string with_errors(const char* before, const char* after) {
  return std::string(before) + kEditErrors + after;
}

void bind_insertions(HistoryClass& history) {
  history.def("add", &add_stroke, py::arg("tool"), py::arg("poses"), py::kw_only(), py::arg("mode") = "remove",
              py::arg("tolerance") = 0.01, py::arg("protect") = py::none(), py::arg("progress") = py::none(),
              with_errors(R"(Adds a stroke at the end. It carves like ``volume.carve`` with the same arguments.

Parameters
----------
tool : Tool
    Its cutter is swept.
poses : array_like of shape (n, 6), tip in mm and unit axis
    Tip xyz, then unit axis xyz from the tip to the spindle; n - 1 moves. For a hand tool (n, 9), as in `Volume.carve`.
mode : "remove" or "add"
    "add" puts material on wherever the cutter sweeps within the volume's box.
tolerance : float, mm
    Tolerance of moves that turn the axis; others are exact.
protect : Volume or None
    Of the base's lower, upper, pitch and directions; what lies in it stays unchanged by this stroke. Kept as a snapshot.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
int
    The stroke's id, for the other calls. Ids are never reused.
)",
                          R"(
Examples
--------
>>> block = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5)
>>> history = riffler.History(block)
>>> history.add(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
1
)")
                  .c_str());
  history.def("insert", &insert, py::arg("tool"), py::arg("poses"), py::kw_only(), py::arg("before"),
              py::arg("mode") = "remove", py::arg("tolerance") = 0.01, py::arg("protect") = py::none(),
              py::arg("progress") = py::none(),
              with_errors(R"(Adds a stroke before another one; see `add`.

Parameters
----------
tool : Tool
    Its cutter is swept.
poses : array_like of shape (n, 6), tip in mm and unit axis
    As for `add`.
before : int
    Id of the stroke that follows the new one.
mode : "remove" or "add"
    As for `add`.
tolerance : float, mm
    Tolerance of moves that turn the axis; others are exact.
protect : Volume or None
    As for `add`.
progress : callable or None
    Called with the finished share; returning False cancels.

Returns
-------
int
    The new stroke's id.
)",
                          R"(
Examples
--------
>>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
>>> ball = riffler.Tool.ball(6, 30)
>>> last = history.add(ball, [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
>>> first = history.insert(ball, [[5, 5, 8, 0, 0, 1], [15, 5, 8, 0, 0, 1]], before=last)
>>> history.ids == [first, last]
True
)")
                  .c_str());
}

void bind_edits(HistoryClass& history) {
  history.def("replace", &replace, py::arg("stroke"), py::kw_only(), py::arg("tool") = py::none(),
              py::arg("poses") = py::none(), py::arg("mode") = py::none(), py::arg("tolerance") = py::none(),
              py::arg("protect") = py::none(), py::arg("progress") = py::none(),
              with_errors(R"(Changes a stroke. It keeps its id, its place in the order, and whether it is enabled.

Parameters
----------
stroke : int
    Its id.
tool : Tool or None
    None: unchanged.
poses : array_like of shape (n, 6), tip in mm and unit axis, or None
    None: unchanged.
mode : "remove", "add" or None
    None: unchanged.
tolerance : float, mm, or None
    None: unchanged.
protect : Volume or None
    None: unchanged; an empty volume protects nothing.
progress : callable or None
    Called with the finished share; returning False cancels.
)",
                          R"(
Examples
--------
>>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
>>> stroke = history.add(riffler.Tool.flat(6, 30), [[-5, 10, 8, 0, 0, 1], [25, 10, 8, 0, 0, 1]])
>>> history.replace(stroke, tool=riffler.Tool.flat(4, 30))
>>> round(history.volume.volume, 6)
3840.0
)")
                  .c_str());
  history.def("remove", &remove, py::arg("stroke"), py::kw_only(), py::arg("progress") = py::none(),
              with_errors(R"(Removes a stroke for good; `enable` can bring a disabled stroke back.

Parameters
----------
stroke : int
    Its id.
progress : callable or None
    Called with the finished share; returning False cancels.
)",
                          R"(
Examples
--------
>>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
>>> stroke = history.add(riffler.Tool.flat(6, 30), [[-5, 10, 8, 0, 0, 1], [25, 10, 8, 0, 0, 1]])
>>> history.remove(stroke)
>>> history.volume.volume, history.ids
(4000.0, [])
)")
                  .c_str());
  history.def("move", &move, py::arg("stroke"), py::kw_only(), py::arg("before"), py::arg("progress") = py::none(),
              with_errors(R"(Moves a stroke to another place in the order.

Parameters
----------
stroke : int
    Its id.
before : int or None
    Id of the stroke to move it before; None: to the end. Its own id: no change.
progress : callable or None
    Called with the finished share; returning False cancels.
)",
                          R"(
Examples
--------
>>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
>>> poses = [[-5, 10, 8, 0, 0, 1], [25, 10, 8, 0, 0, 1]]
>>> cut = history.add(riffler.Tool.flat(6, 30), poses)
>>> fill = history.add(riffler.Tool.flat(4, 30), poses, mode="add")
>>> history.move(cut, before=None)
>>> history.ids == [fill, cut], round(history.volume.volume, 6)
(True, 3760.0)
)")
                  .c_str());
  history.def("enable", &enable, py::arg("stroke"), py::arg("enabled") = true, py::kw_only(),
              py::arg("progress") = py::none(),
              with_errors(R"(Enables or disables a stroke. A disabled stroke keeps its place and cuts nothing.

Parameters
----------
stroke : int
    Its id.
enabled : bool
    False disables it.
progress : callable or None
    Called with the finished share; returning False cancels.
)",
                          R"(
Examples
--------
>>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
>>> stroke = history.add(riffler.Tool.flat(6, 30), [[-5, 10, 8, 0, 0, 1], [25, 10, 8, 0, 0, 1]])
>>> history.enable(stroke, False)
>>> history.volume.volume
4000.0
)")
                  .c_str());
}

void bind_state(HistoryClass& history) {
  history
      .def_property_readonly(
          "volume", [](SharedHistory& h) { return share((lock(h), h.history.volume().snapshot())); },
          "Volume: the base with the enabled strokes. An independent volume that shares its tiles: costs pointers "
          "only.")
      .def_property_readonly(
          "base", [](SharedHistory& h) { return share((lock(h), h.history.base().snapshot())); },
          "Volume: the base before all strokes; an independent volume that shares its tiles.")
      .def_property_readonly(
          "ids", [](SharedHistory& h) { return (lock(h), h.history.ids()); },
          "list of int: the ids of all strokes in order, disabled ones included.")
      .def("__len__", [](SharedHistory& h) { return (lock(h), h.history.ids().size()); })
      .def("stroke", &stroke, py::arg("stroke"), R"(A stroke's content.

Parameters
----------
stroke : int
    Its id.

Returns
-------
HistoryStroke
    A copy.

Raises
------
ValueError
    The history has no such stroke.

Examples
--------
>>> history = riffler.History(riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5))
>>> stroke = history.add(riffler.Tool.ball(6, 30), [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
>>> history.stroke(stroke).mode, history.stroke(stroke).poses.shape, history.stroke(stroke).enabled
('remove', (2, 6), True)
)")
      .def("stats", &stats, R"(The work of the last edit, and the size of the history.

Returns
-------
HistoryStats
    An edit restores only the tiles that the edited stroke touches, and runs only later strokes, in these tiles.

Examples
--------
>>> history = riffler.History(riffler.Volume.block((0, 0, 0), (80, 20, 10), pitch=0.5))
>>> ball = riffler.Tool.ball(6, 30)
>>> left = history.add(ball, [[5, 8, 8, 0, 0, 1], [8, 8, 8, 0, 0, 1]])
>>> right = history.add(ball, [[70, 8, 8, 0, 0, 1], [74, 8, 8, 0, 0, 1]])
>>> history.replace(left, poses=[[5, 8, 7, 0, 0, 1], [8, 8, 7, 0, 0, 1]])
>>> history.stats().tiles_restored, history.stats().strokes_run
(1, 1)
)");
}

}  // namespace

void bind_history(py::module_& m) {
  HistoryClass history(m, "History", R"(A base volume and strokes in order that stay editable.

``h.volume`` is always, byte for byte, what ``base.carve(...)`` with the enabled strokes in order gives. Each tile keeps
its versions after the strokes that touch it. An edit sets the tiles that its stroke touches back to the version before
it, and carves only the later strokes that touch these tiles, only there; it stops where a tile has its old content again.

The base is a snapshot: carving the volume later does not change the history. An edit that fails or is cancelled leaves
everything unchanged. Edits release Python's lock and use the number of threads of any long call.

Parameters
----------
base : Volume
    The volume that the strokes are carved into.
memory_limit : int, bytes
    For the versions of tiles, about 25 kB each with rays in three directions. Beyond it, the history keeps every second,
    fourth, … version of a tile, and an edit carves up to as many more strokes there. An edit needs as much again while it
    runs.

Examples
--------
>>> block = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz")
>>> history = riffler.History(block)
>>> ball = riffler.Tool.ball(6, 30)
>>> first = history.add(ball, [[5, 10, 8, 0, 0, 1], [15, 10, 8, 0, 0, 1]])
>>> second = history.add(ball, [[10, 5, 8, 0, 0, 1], [10, 15, 8, 0, 0, 1]])
>>> history.replace(first, poses=[[5, 12, 7, 0, 0, 1], [15, 12, 7, 0, 0, 1]])
>>> cut = block.carve(ball, [[5, 12, 7, 0, 0, 1], [15, 12, 7, 0, 0, 1]])
>>> cut = block.carve(ball, [[10, 5, 8, 0, 0, 1], [10, 15, 8, 0, 0, 1]])
>>> history.volume.to_bytes() == block.to_bytes()
True
)");
  history.def(py::init(&make_history), py::arg("base"), py::kw_only(),
              py::arg("memory_limit") = sweep::History::kMemoryLimit);
  bind_insertions(history);
  bind_edits(history);
  bind_state(history);
}

}  // namespace riffler::bindings
