// riffler.Journal
#include <variant>

#include "bindings/bindings.hpp"
#include "bindings/journal_records.hpp"
#include "bindings/shared_volume.hpp"
#include "bindings/task.hpp"
#include "riffler/session/journal_file.hpp"
#include "riffler/session/replay.hpp"
#include "session/stroke_search.hpp"

namespace riffler::bindings {

namespace {

using SharedJournal = std::shared_ptr<session::Journal>;

/// Stroke `index` of a journal, which it keeps alive.
struct StrokeView {
  SharedJournal journal;
  std::size_t index;

  const session::JournalStroke& get() const {
    if (index >= journal->strokes().size()) throw py::index_error("the stroke was taken back");
    return journal->strokes()[index];
  }
};

ToolDictDict tools(const session::Journal& journal) {
  py::dict out;
  for (const auto& [number, text] : journal.tools()) out[py::int_(number)] = json().attr("loads")(text);
  return out;
}

OptionalStock stock(const session::Journal& journal) {
  if (!journal.stock()) return py::none();
  const session::JournalStock& s = *journal.stock();
  using namespace py::literals;
  return program_result("JournalStock", py::dict("lower"_a = from_vec3(s.box.lower), "upper"_a = from_vec3(s.box.upper),
                                                 "pitch"_a = s.pitch, "directions"_a = s.directions,
                                                 "snapshot"_a = s.snapshot, "mask"_a = s.mask));
}

StringDict notes(const session::Journal& journal) {
  py::dict out;
  for (const auto& [key, value] : journal.notes()) out[py::str(key)] = value;
  return out;
}

StrokeList strokes(const SharedJournal& journal) {
  if (!journal) throw py::type_error("None is not a Journal");
  py::list out;
  for (std::size_t k = 0; k < journal->strokes().size(); ++k) out.append(StrokeView{journal, k});
  return out;
}

py::array_t<double> stroke_poses(const StrokeView& stroke) {
  const session::JournalStroke& s = stroke.get();
  if (s.forward.empty()) return from_poses(s.poses);
  std::vector<RolledPose> rolled;
  for (std::size_t row = 0; row < s.poses.size(); ++row)
    rolled.push_back({s.poses[row].tip, s.poses[row].axis, s.forward[row]});
  return from_poses(rolled);
}

std::map<int, Tool> journal_tools(const session::Journal& journal) {
  std::map<int, Tool> out;
  const py::object from_dict = py::type::of<Tool>().attr("from_dict");
  for (const auto& [number, text] : journal.tools())
    out.emplace(number, py::cast<Tool>(from_dict(json().attr("loads")(text))));
  return out;
}

nc::Program program(const session::Journal& journal, const std::optional<double>& feed, double spindle,
                    const std::optional<double>& safe_height, double clearance) {
  return to_program(journal, journal_tools(journal), {feed, spindle, {safe_height, clearance, {}}});
}

/// What is done of a replay, of a copy: another thread may continue to record.
auto replay_work(const session::Journal& journal, const std::optional<std::filesystem::path>& folder) {
  return [copy = journal, tools = journal_tools(journal), folder](const Progress& listener) {
    return replay_all(copy, tools, folder.value_or(""), listener);
  };
}

auto replayed(const session::Journal& journal, const std::optional<std::filesystem::path>& folder,
              const ProgressLike& progress) {
  return long_call(progress, replay_work(journal, folder),
                   [](session::Replayed&& found) { return std::make_shared<SharedVolume>(std::move(found.volume)); });
}

auto replayed_with_mask(const session::Journal& journal, const std::optional<std::filesystem::path>& folder,
                        const ProgressLike& progress) {
  return long_call(progress, replay_work(journal, folder), [](session::Replayed&& found) -> VolumeAndMask {
    py::object mask = py::none();
    if (found.mask) mask = py::cast(std::make_shared<SharedVolume>(std::move(*found.mask)));
    return py::make_tuple(std::make_shared<SharedVolume>(std::move(found.volume)), mask);
  });
}

auto strokes_at(const session::Journal& journal, const Doubles& points, double tolerance,
                const ProgressLike& progress) {
  const auto work = [copy = journal, tools = journal_tools(journal), places = to_vec3s(points, "points"),
                     tolerance](const Progress& listener) {
    return session::stroke_search(copy, tools, tolerance).find(places, listener);
  };
  return long_call(progress, work,
                   [](std::vector<std::int32_t>&& found) { return take<std::int32_t>(std::move(found)); });
}

OptionalArray column(const std::vector<double>& values) {
  if (values.empty()) return py::none();
  return take<double>(std::vector<double>(values));
}

void bind_stroke(py::module_& m) {
  py::class_<StrokeView>(m, "JournalStroke", "One stroke of a journal: see `Journal.add_stroke`.")
      .def_property_readonly(
          "poses", &stroke_poses,
          "(n, 6): tip in mm and unit axis; of a hand tool (n, 9), with its forward direction. A copy.")
      .def_property_readonly(
          "times", [](const StrokeView& s) { return column(s.get().times); }, "(n,) s, or None.")
      .def_property_readonly(
          "forces",
          [](const StrokeView& s) -> OptionalArray {
            if (s.get().forces.empty()) return py::none();
            return take<double>(std::vector<Wrench>(s.get().forces), 6);
          },
          "(n, 6) N, N·mm about the grip, as sent to the device for the hand; or None.")
      .def_property_readonly(
          "removed", [](const StrokeView& s) { return column(s.get().removed); },
          "(n,) mm³ by the move that ends at the row, or None.")
      .def_property_readonly(
          "tool", [](const StrokeView& s) { return s.get().tool; }, "Number of the tool.")
      .def_property_readonly(
          "tolerance", [](const StrokeView& s) { return s.get().tolerance; }, "mm.")
      .def_property_readonly(
          "name", [](const StrokeView& s) { return s.get().name; }, "Name for users.")
      .def_property_readonly(
          "mode", [](const StrokeView& s) { return stroke_mode_name(s.get().mode); },
          R"("remove", "add", "mask", "unmask", "soften", "beside", "build" or a brush: see ``Journal.add_stroke``.)")
      .def_property_readonly(
          "strength", [](const StrokeView& s) { return s.get().strength; }, R"(0 to 1, for "soften" and brushes.)")
      .def_property_readonly(
          "amount", [](const StrokeView& s) { return s.get().amount; }, "mm or rad, for brushes.")
      .def_property_readonly(
          "falloff", [](const StrokeView& s) { return falloff_name(s.get().falloff); }, "For brushes.")
      .def("__len__", [](const StrokeView& s) { return s.get().poses.size(); });
}

}  // namespace

void bind_journal(py::module_& m) {
  bind_stroke(m);
  py::class_<session::Journal, SharedJournal> journal(m, "Journal",
                                                      R"(Record of a session: stock, tools, strokes as poses, notes.

Replaying the strokes on the stock gives the session again. Files end in .rjournal.

Examples
--------
>>> journal = riffler.Journal()
>>> journal.set_stock((0, 0, 0), (20, 20, 10), 0.5)
>>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
>>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0, 0, 1)])
>>> journal.replay().volume < 20 * 20 * 10
True
)");
  journal.def(py::init<>())
      .def_static(
          "load",
          [](const std::filesystem::path& path, const ProgressLike& progress) {
            const Progress listener = to_progress(progress);
            const NoGil release;
            return session::read_journal(path, listener);
          },
          py::arg("path"), py::kw_only(), py::arg("progress") = py::none(),
          R"(Reads a .rjournal file. One that a crash has cut gives all whole records; ``cut_at`` is where it was cut.

Parameters
----------
path : path_like
    The file.
progress : callable, optional
    Called with the finished share; returning False cancels.

Returns
-------
Journal

Raises
------
FormatError
    Naming the byte of a damaged record that others follow.

Examples
--------
>>> riffler.Journal().save("a.rjournal")
>>> riffler.Journal.load("a.rjournal")
<riffler.Journal: 0 strokes>
)")
      .def(
          "save",
          [](const session::Journal& self, const std::filesystem::path& path) {
            const session::Journal copy = self;  // another thread may continue to record
            const NoGil release;
            write_journal(copy, path);
          },
          py::arg("path"), R"(Writes the journal: the whole file or none.

Parameters
----------
path : path_like
    The file.

Examples
--------
>>> riffler.Journal().save("a.rjournal")
)")
      .def_property_readonly("stock", &stock, "Frame and files of the stock, or None.")
      .def_property_readonly("tools", &tools, "Each tool's dict, by number.")
      .def_property_readonly("strokes", &strokes, "The strokes that count.")
      .def_property_readonly("notes", &notes,
                             "Notes on where the journal comes from, by key; the later value of a key given twice.")
      .def_readonly("cut_at", &session::Journal::cut_at, "Byte at which the file had been cut, or None.")
      .def("program", &program, py::kw_only(), py::arg("feed") = py::none(), py::arg("spindle") = 0.0,
           py::arg("safe_height") = py::none(), py::arg("clearance") = 10.0,
           R"(The strokes as a Program, each one cut as in ``Program.from_cl``. The stock counts as occupied.

Strokes that do not remove are left out: no machine can make them.

Parameters
----------
feed : float, optional
    mm/min; None: from the times, limited to 1 to 100 000 mm/min.
spindle : float
    rev/min.
safe_height : float, optional
    z (mm) above everything; None: ``clearance`` above everything.
clearance : float
    mm.

Returns
-------
Program

Examples
--------
>>> journal = riffler.Journal()
>>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
>>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0, 0, 1)])
>>> program = journal.program(feed=600, spindle=9000)
>>> program.tools[1].diameter
6.0
)")
      .def("replay", &replayed, py::arg("folder") = py::none(), py::kw_only(), py::arg("progress") = py::none(),
           R"(The stock after the strokes, to the bit as the session left it.

A row with the same pose as the row before is not a move; a stroke that never moves cuts where it stands if it has two rows
or more.

Parameters
----------
folder : path_like, optional
    Folder of the stock's snapshot, for a stock that is not a block.
progress : callable, optional
    Called with the finished share; returning False cancels.

Returns
-------
Volume

Examples
--------
>>> journal = riffler.Journal()
>>> journal.set_stock((0, 0, 0), (20, 20, 10), 0.5)
>>> journal.replay().volume
4000.0
)")
      .def("strokes_at", &strokes_at, py::arg("points"), py::kw_only(), py::arg("tolerance") = 0.05,
           py::arg("progress") = py::none(),
           R"(The stroke that made the surface at each point.

Parameters
----------
points : array_like, shape (n, 3)
    mm: points on the surface that the strokes leave, such as vertices of its mesh.
tolerance : float
    mm that a point may be off the surface; a quarter of the pitch fits vertices of a mesh.
progress : callable, optional
    Called with the finished share; returning False cancels.

Returns
-------
ndarray, shape (n,)
    The place in ``strokes`` of the one that swept along the point, the first if several did; -1 where none did: the
    stock's own surface, and what was smoothed.

Examples
--------
>>> journal = riffler.Journal()
>>> journal.set_stock((0, 0, 0), (20, 20, 10), 0.5)
>>> journal.add_tool(1, riffler.Tool.ball(diameter=6, length=30))
>>> journal.add_stroke(1, [(0, 10, 8, 0, 0, 1), (20, 10, 8, 0, 0, 1)])
>>> journal.strokes_at([(10, 10, 8), (10, 2, 10)])
array([ 0, -1], dtype=int32)
)")
      .def("replay_with_mask", &replayed_with_mask, py::arg("folder") = py::none(), py::kw_only(),
           py::arg("progress") = py::none(),
           R"(As ``replay``, with the region that is protected at the end.

Parameters
----------
folder : path_like, optional
    Folder of the snapshots of stock and mask.
progress : callable, optional
    Called with the finished share; returning False cancels.

Returns
-------
stock : Volume
mask : Volume or None

Examples
--------
>>> journal = riffler.Journal()
>>> journal.set_stock((0, 0, 0), (20, 20, 10), 0.5)
>>> stock, mask = journal.replay_with_mask()
>>> mask is None
True
)")
      .def("__repr__", [](const session::Journal& self) {
        const std::size_t n = self.strokes().size();
        return "<riffler.Journal: " + std::to_string(n) + (n == 1 ? " stroke>" : " strokes>");
      });
  // Nothing is held while a journal in memory is written to: it never releases the GIL.
  add_records(journal, [](const session::Journal&) { return std::monostate(); });
  bind_journal_writer(m);
}

}  // namespace riffler::bindings
