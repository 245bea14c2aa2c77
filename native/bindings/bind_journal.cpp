// riffler.Journal, riffler.JournalWriter
#include <variant>

#include "bindings/bindings.hpp"
#include "bindings/one_caller.hpp"
#include "bindings/shared_volume.hpp"
#include "bindings/task.hpp"
#include "riffler/session/journal.hpp"
#include "riffler/session/journal_file.hpp"
#include "riffler/session/replay.hpp"

namespace riffler::bindings {

namespace {

using SharedJournal = std::shared_ptr<session::Journal>;

/// Syncing waits for the disk without the GIL.
struct SharedWriter : session::JournalWriter, Guarded {
  using session::JournalWriter::JournalWriter;
};

/// Held while a journal is written to: nothing for one in memory, which never releases the GIL.
OneCaller only_caller(SharedWriter& writer) {
  return {writer, "the journal"};
}
std::monostate only_caller(const session::Journal&) {
  return {};
}

/// Stroke `index` of a journal, which it keeps alive.
struct StrokeView {
  SharedJournal journal;
  std::size_t index;

  const session::JournalStroke& get() const {
    if (index >= journal->strokes().size()) throw py::index_error("the stroke was taken back");
    return journal->strokes()[index];
  }
};

/// (n,), or empty for None.
std::vector<double> to_column(const py::object& column, const char* name, std::size_t rows) {
  if (column.is_none()) return {};
  const auto array = Doubles::ensure(column);
  if (!array || array.ndim() != 1) {
    PyErr_Clear();
    throw py::value_error(std::string(name) + " must have the shape (n,)");
  }
  // An empty column would mean that there is none.
  if (static_cast<std::size_t>(array.size()) != rows)
    throw py::value_error(std::string(name) + " must be as many as poses");
  return {array.data(), array.data() + array.size()};
}

/// (n, 6), or empty for None.
std::vector<Wrench> to_forces(const py::object& forces, std::size_t rows) {
  if (forces.is_none()) return {};
  const Doubles array = py::cast<Doubles>(forces);
  if (check_rows(array, 6, "forces") != rows) throw py::value_error("forces must be as many as poses");
  std::vector<Wrench> out(rows);
  const double* p = array.data();
  for (Wrench& wrench : out)
    for (int k = 0; k < haptics::kCoordinates; ++k) wrench[k] = *p++;
  return out;
}

/// A stroke without its name and tool.
session::JournalStroke to_rows(const Doubles& poses, const py::object& times, const py::object& forces,
                               const py::object& removed) {
  session::JournalStroke out;
  out.poses = to_poses(poses, "poses");
  const std::size_t rows = out.poses.size();
  out.times = to_column(times, "times", rows);
  out.forces = to_forces(forces, rows);
  out.removed = to_column(removed, "removed", rows);
  return out;
}

session::JournalStock to_stock(const py::object& lower, const py::object& upper, double pitch,
                               const std::string& directions, const std::string& snapshot, const std::string& mask) {
  return {{to_vec3(lower, "lower"), to_vec3(upper, "upper")}, pitch, directions, snapshot, mask};
}

constexpr const char* kModes[session::kStrokeModes] = {"remove", "add", "mask", "unmask", "soften", "beside", "build"};

session::StrokeMode to_stroke_mode(const std::string& name) {
  for (std::uint32_t k = 0; k < session::kStrokeModes; ++k)
    if (name == kModes[k]) return static_cast<session::StrokeMode>(k);
  throw py::value_error(R"(mode must be "remove", "add", "mask", "unmask", "soften", "beside" or "build")");
}

py::object json() {
  return py::module_::import("json");
}

py::dict tools(const session::Journal& journal) {
  py::dict out;
  for (const auto& [number, text] : journal.tools()) out[py::int_(number)] = json().attr("loads")(text);
  return out;
}

py::object stock(const session::Journal& journal) {
  if (!journal.stock()) return py::none();
  const session::JournalStock& s = *journal.stock();
  py::dict out;
  out["lower"] = from_vec3(s.box.lower);
  out["upper"] = from_vec3(s.box.upper);
  out["pitch"] = s.pitch;
  out["directions"] = s.directions;
  out["snapshot"] = s.snapshot;
  out["mask"] = s.mask;
  return out;
}

py::dict notes(const session::Journal& journal) {
  py::dict out;
  for (const auto& [key, value] : journal.notes()) out[py::str(key)] = value;
  return out;
}

py::list strokes(const SharedJournal& journal) {
  if (!journal) throw py::type_error("None is no Journal");
  py::list out;
  for (std::size_t k = 0; k < journal->strokes().size(); ++k) out.append(StrokeView{journal, k});
  return out;
}

py::array_t<double> poses(const StrokeView& stroke) {
  return take<double>(std::vector<Pose>(stroke.get().poses), 6);
}

std::map<int, Tool> tools_of(const session::Journal& journal) {
  std::map<int, Tool> out;
  const py::object from_dict = py::type::of<Tool>().attr("from_dict");
  for (const auto& [number, text] : journal.tools())
    out.emplace(number, py::cast<Tool>(from_dict(json().attr("loads")(text))));
  return out;
}

nc::Program program(const session::Journal& journal, const std::optional<double>& feed, double spindle,
                    const std::optional<double>& safe_height, double clearance) {
  return to_program(journal, tools_of(journal), {feed, spindle, {safe_height, clearance, {}}});
}

auto replayed(const session::Journal& journal, const std::optional<std::filesystem::path>& folder,
              const py::object& progress, bool with_mask) {
  // another thread may go on recording
  const auto work = [copy = journal, tools = tools_of(journal), folder](const Progress& listener) {
    return replay_all(copy, tools, folder.value_or(""), listener);
  };
  return long_call(progress, work, [with_mask](session::Replayed&& found) -> py::object {
    py::object volume = py::cast(std::make_shared<SharedVolume>(std::move(found.volume)));
    if (!with_mask) return volume;
    py::object mask = py::none();
    if (found.mask) mask = py::cast(std::make_shared<SharedVolume>(std::move(*found.mask)));
    return py::make_tuple(volume, mask);
  });
}

void close(SharedWriter& writer) {
  const OneCaller only = only_caller(writer);
  writer.close();
}

/// The functions that Journal and JournalWriter share.
template <class Class>
void add_records(Class& c) {
  using T = typename Class::type;
  c.def(
       "set_stock",
       [](T& self, const py::object& lower, const py::object& upper, double pitch, const std::string& directions,
          const std::string& snapshot, const std::string& mask) {
         [[maybe_unused]] const auto only = only_caller(self);
         self.set_stock(to_stock(lower, upper, pitch, directions, snapshot, mask));
       },
       py::arg("lower"), py::arg("upper"), py::arg("pitch"), py::arg("directions") = "z", py::arg("snapshot") = "",
       py::kw_only(), py::arg("mask") = "",
       "The frame of the stock, the file name of its snapshot where it is not a full block, and that of what is "
       "protected where something is. Once.")
      .def(
          "add_tool",
          [](T& self, int number, const py::object& tool) {
            const std::string text = tool_json(tool);
            [[maybe_unused]] const auto only = only_caller(self);
            self.add_tool(number, text);
          },
          py::arg("number"), py::arg("tool"),
          "A Tool, its dict or JSON text. The same number again is allowed for the same tool only.")
      .def(
          "add_note",
          [](T& self, const std::string& key, const std::string& value) {
            [[maybe_unused]] const auto only = only_caller(self);
            self.add_note(key, value);
          },
          py::arg("key"), py::arg("value"), "Provenance.")
      .def(
          "add_stroke",
          [](T& self, int tool, const Doubles& poses, const py::object& times, double tolerance,
             const std::string& name, const py::object& forces, const py::object& removed, const std::string& mode,
             double strength) {
            session::JournalStroke stroke = to_rows(poses, times, forces, removed);
            stroke.tool = tool, stroke.tolerance = tolerance, stroke.name = name, stroke.mode = to_stroke_mode(mode);
            stroke.strength = strength;
            [[maybe_unused]] const auto only = only_caller(self);
            self.add_stroke(stroke);
          },
          py::arg("tool"), py::arg("poses"), py::arg("times") = py::none(), py::arg("tolerance") = 0.01,
          py::arg("name") = "", py::kw_only(), py::arg("forces") = py::none(), py::arg("removed") = py::none(),
          py::arg("mode") = "remove", py::arg("strength") = 0.5,
          R"(A stroke with a tool that was added: poses (n, 6), n ≥ 1; each of the others may be None. times (n,) s that
never fall; forces (n, 6) N, N·mm that the device was told to give the hand, about the grip; removed (n,) mm³ by the move that
ends at the row. mode says what the tool does where it sweeps: "remove" and "add" material, but not where it is protected;
"mask" and "unmask": protect it, or no longer; "soften": a dab of ``strength`` at each row's tip, as wide as the tool;
"beside": remove as a Session does beside what is protected; "build": put on as a Session does. To replay to the bit what
was put on, or cut beside a mask, by ``carve``, each carve has to be a stroke.)")
      .def(
          "extend_stroke",
          [](T& self, const Doubles& poses, const py::object& times, const py::object& forces,
             const py::object& removed) {
            const session::JournalStroke more = to_rows(poses, times, forces, removed);
            [[maybe_unused]] const auto only = only_caller(self);
            self.extend_stroke(more.rows());
          },
          py::arg("poses"), py::arg("times") = py::none(), py::kw_only(), py::arg("forces") = py::none(),
          py::arg("removed") = py::none(), "More rows for the last stroke, with the same columns.")
      .def(
          "take_back",
          [](T& self, std::size_t n) {
            [[maybe_unused]] const auto only = only_caller(self);
            self.undo(n);
          },
          py::arg("n") = 1, "The last n strokes no longer count: undo.")
      .def(
          "bring_back",
          [](T& self, std::size_t n) {
            [[maybe_unused]] const auto only = only_caller(self);
            self.redo(n);
          },
          py::arg("n") = 1, "The last n that were taken back count again: redo. A new stroke ends that.");
}

}  // namespace

std::string tool_json(const py::object& tool) {
  py::object dict = tool;
  if (py::isinstance<Tool>(tool)) dict = tool.attr("to_dict")();
  if (py::isinstance<py::str>(tool)) dict = json().attr("loads")(tool);
  if (!py::isinstance<py::dict>(dict)) throw py::value_error("tool must be a Tool, its dict or JSON text of it");
  return py::cast<std::string>(json().attr("dumps")(dict));
}

void bind_journal(py::module_& m) {
  py::class_<StrokeView>(m, "JournalStroke", "One stroke of a Journal.")
      .def_property_readonly("poses", &poses, "(n, 6) copy.")
      .def_property_readonly(
          "times",
          [](const StrokeView& s) -> py::object {
            if (s.get().times.empty()) return py::none();
            return take<double>(std::vector<double>(s.get().times));
          },
          "(n,) s, or None.")
      .def_property_readonly(
          "forces",
          [](const StrokeView& s) -> py::object {
            if (s.get().forces.empty()) return py::none();
            return take<double>(std::vector<Wrench>(s.get().forces), 6);
          },
          "(n, 6) N, N·mm about the grip: what the device was told to give the hand; or None.")
      .def_property_readonly(
          "removed",
          [](const StrokeView& s) -> py::object {
            if (s.get().removed.empty()) return py::none();
            return take<double>(std::vector<double>(s.get().removed));
          },
          "(n,) mm³ by the move that ends at the row, or None.")
      .def_property_readonly("tool", [](const StrokeView& s) { return s.get().tool; })
      .def_property_readonly(
          "tolerance", [](const StrokeView& s) { return s.get().tolerance; }, "mm")
      .def_property_readonly("name", [](const StrokeView& s) { return s.get().name; })
      .def_property_readonly(
          "mode", [](const StrokeView& s) { return kModes[static_cast<std::uint32_t>(s.get().mode)]; },
          R"("remove", "add", "mask", "unmask", "soften", "beside" or "build".)")
      .def_property_readonly(
          "strength", [](const StrokeView& s) { return s.get().strength; }, "0 to 1, of one that softens.")
      .def("__len__", [](const StrokeView& s) { return s.get().poses.size(); });

  py::class_<session::Journal, SharedJournal> journal(m, "Journal",
                                                      R"(What a session did: stock, tools, strokes as poses, notes.

Replaying the strokes on the stock gives the session again. Files end in .rjournal.)");
  journal.def(py::init<>())
      .def_static(
          "read",
          [](const std::filesystem::path& path, const py::object& progress) {
            const Progress listener = to_progress(progress);
            const NoGil release;
            return session::read_journal(path, listener);
          },
          py::arg("path"), py::kw_only(), py::arg("progress") = py::none(),
          R"(Reads a file. One that a crash has cut gives all whole records, and ``cut_at`` says where it was cut; a
damaged record that others follow is a FormatError naming the byte.)")
      .def(
          "write",
          [](const session::Journal& self, const std::filesystem::path& path) {
            const session::Journal copy = self;  // another thread may go on recording
            const NoGil release;
            write_journal(copy, path);
          },
          py::arg("path"), "Writes the whole journal; the file is whole or not there.")
      .def_property_readonly("stock", &stock, "dict: lower, upper, pitch, directions, snapshot, mask; or None.")
      .def_property_readonly("tools", &tools, "dict: number to the tool's dict.")
      .def_property_readonly("strokes", &strokes, "list of JournalStroke: those that count.")
      .def_property_readonly("notes", &notes, "dict of strings; of a key given twice the later value.")
      .def_readonly("cut_at", &session::Journal::cut_at, "Byte at which the file had been cut, or None.")
      .def("program", &program, py::arg("feed") = py::none(), py::arg("spindle") = 0.0, py::kw_only(),
           py::arg("safe_height") = py::none(), py::arg("clearance") = 10.0,
           R"(The strokes as a Program, each one cut as in Program.from_cl. ``feed`` in mm/min; None: from the times,
held within 1 to 100 000 mm/min. The stock counts as occupied. Strokes that do not remove are left out: no machine can make
them.)")
      .def(
          "replay", &replayed, py::arg("folder") = py::none(), py::arg("progress") = py::none(), py::kw_only(),
          py::arg("with_mask") = false,
          R"(The Volume that the strokes leave of the stock, to the bit as the session left it: a block, or the snapshot
in ``folder``. A row that stands where the row before stood is no move; a stroke that never moves cuts where it stands
if it has two rows or more. ``with_mask``: a tuple of it and the Volume of what is protected, or None.)")
      .def("__repr__", [](const session::Journal& self) {
        const std::size_t n = self.strokes().size();
        return "<riffler.Journal: " + std::to_string(n) + (n == 1 ? " stroke>" : " strokes>");
      });
  add_records(journal);

  py::class_<SharedWriter> writer(m, "JournalWriter", R"(Appends to a journal file, record by record.

Goes on with a file that is there, after cutting off a damaged tail, or begins a new one. Each record is handed to the
system before the call returns. ``keep=False`` holds no strokes in memory, so that ``journal`` cannot be asked for: for
long sessions. Context manager.)");
  writer
      .def(py::init([](const std::filesystem::path& path, bool keep) {
             return std::make_unique<SharedWriter>(
                 path, keep ? session::JournalWriter::Keep::Everything : session::JournalWriter::Keep::Rules);
           }),
           py::arg("path"), py::kw_only(), py::arg("keep") = true)
      .def(
          "sync",
          [](SharedWriter& self) {
            const OneCaller only = only_caller(self);
            const NoGil release;
            self.sync();
          },
          "Waits until the disk has it.")
      .def("close", &close, "Ends writing; calls after it raise RuntimeError.")
      .def_property_readonly(
          "journal", [](const SharedWriter& self) { return std::make_shared<session::Journal>(self.journal()); },
          "A copy of everything in the file.")
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](SharedWriter& self, const py::args&) { close(self); });
  add_records(writer);
}

}  // namespace riffler::bindings
