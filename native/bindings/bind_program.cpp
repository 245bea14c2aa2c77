// riffler.Program, riffler.machines
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "bindings/bindings.hpp"
#include "bindings/one_caller.hpp"
#include "bindings/shared_volume.hpp"
#include "nc/follow.hpp"
#include "nc/limits.hpp"
#include "nc/machine/machines.hpp"
#include "nc/machine/option_texts.hpp"
#include "riffler/nc/cutter_path.hpp"
#include "riffler/nc/edit.hpp"
#include "riffler/nc/program.hpp"
#include "riffler/nc/read/reader.hpp"
#include "riffler/nc/write/writer.hpp"
#include "verify/motion_check.hpp"

namespace riffler::bindings {

namespace {

Doubles to_doubles(const py::handle& object, const std::string& name) {
  auto array = Doubles::ensure(object);
  if (!array) {
    PyErr_Clear();
    throw py::value_error(name + " must be numbers");
  }
  return array;
}

/// One number for all rows, or one per row. A single number stays single where `spread` is false.
std::vector<double> to_column(const py::handle& object, std::size_t rows, const std::string& name, bool spread = true) {
  const Doubles array = to_doubles(object, name);
  if (array.ndim() == 0) return std::vector<double>(spread ? rows : 1, *array.data());
  if (array.ndim() != 1 || static_cast<std::size_t>(array.shape(0)) != rows)
    throw py::value_error(name + " must be one number or have the shape (" + std::to_string(rows) + ",)");
  return {array.data(), array.data() + rows};
}

int to_int(double value, const std::string& name, std::size_t row) {
  if (!(value >= 0 && value <= nc::kMaxNumber && value == std::floor(value)))
    throw py::value_error(name + ", row " + std::to_string(row) + ": must be a whole number from 0 to " +
                          std::to_string(nc::kMaxNumber));
  return static_cast<int>(value);
}

std::map<int, Tool> to_tools(const py::object& object) {
  std::map<int, Tool> out;
  if (object.is_none()) return out;
  if (!py::isinstance<py::dict>(object)) throw py::value_error("tools must be a dict: number to Tool");
  for (const auto& [key, value] : py::cast<py::dict>(object)) {
    if (!py::isinstance<py::int_>(key) || !py::isinstance<Tool>(value))
      throw py::value_error("tools must be a dict: number to Tool");
    const double number = py::cast<double>(key);
    if (number < 1) throw py::value_error("tools: numbers begin at 1");
    out.emplace(to_int(number, "tools", out.size()), py::cast<const Tool&>(value));
  }
  return out;
}

nc::Provenance to_provenance(const py::object& object) {
  nc::Provenance out;
  if (object.is_none()) return out;
  if (!py::isinstance<py::dict>(object)) throw py::value_error("provenance must be a dict of strings");
  for (const auto& [key, value] : py::cast<py::dict>(object))
    out.emplace_back(py::cast<std::string>(py::str(key)), py::cast<std::string>(py::str(value)));
  return out;
}

using Via = std::shared_ptr<const std::vector<Pose>>;

std::map<std::size_t, Via> to_vias(const py::object& object, std::size_t rows) {
  std::map<std::size_t, Via> out;
  if (object.is_none()) return out;
  if (!py::isinstance<py::dict>(object)) throw py::value_error("via must be a dict: row to poses (k, 6)");
  for (const auto& [key, value] : py::cast<py::dict>(object)) {
    if (!py::isinstance<py::int_>(key)) throw py::value_error("via must be a dict: row to poses (k, 6)");
    const int row = to_int(py::cast<double>(key), "via", out.size());
    if (row < 1 || static_cast<std::size_t>(row) >= rows)
      throw py::value_error("via: no row to lead to: " + std::to_string(row));
    const std::string name = "via[" + std::to_string(row) + "]";
    out.emplace(row, std::make_shared<const std::vector<Pose>>(to_poses(to_doubles(value, name), name.c_str())));
  }
  return out;
}

py::dict vias_of(const nc::Program& program) {
  py::dict out;
  for (const auto& [row, via] : program.via()) {
    py::array_t<double> poses({static_cast<py::ssize_t>(via->size()), py::ssize_t{6}});
    std::memcpy(poses.mutable_data(), via->data(), via->size() * sizeof(Pose));
    out[py::int_(row)] = poses;
  }
  return out;
}

nc::Program make_program(const Doubles& poses, const py::object& feed, const py::object& rapid, const py::object& tool,
                         const py::object& line, const py::object& spindle, const py::object& tools,
                         const py::object& provenance, const std::vector<nc::Note>& notes, const py::object& at_machine,
                         const py::object& via) {
  const std::vector<Pose> rows = to_poses(poses, "poses");
  const std::size_t n = rows.size();
  const auto column = [&](const py::object& object, const char* name) { return to_column(object, n, name); };
  const std::vector<double> feeds = column(feed, "feed"), rapids = column(rapid, "rapid"),
                            numbers = column(tool, "tool"), lines = column(line, "line"),
                            speeds = column(spindle, "spindle"), away = column(at_machine, "at_machine");
  const std::map<std::size_t, Via> ways = to_vias(via, n);
  nc::Program program;
  program.reserve(n);
  for (std::size_t row = 0; row < n; ++row)
    program.append({rows[row], feeds[row], speeds[row], to_int(numbers[row], "tool", row),
                    to_int(lines[row], "line", row), rapids[row] != 0, away[row] != 0,
                    ways.contains(row) ? ways.at(row) : nullptr});
  program.tools = to_tools(tools);
  program.provenance = to_provenance(provenance);
  program.notes = notes;
  return program;
}

/// The tool's number for every path: one tool for all or one each; equal tools share a number. A dict keeps its
/// numbers.
std::vector<int> number_tools(const py::object& object, std::size_t paths, std::map<int, Tool>& tools) {
  if (object.is_none()) return std::vector<int>(paths, 1);
  std::vector<py::object> list;
  for (const py::handle& tool : object) {
    if (!py::isinstance<Tool>(tool)) throw py::value_error("tools must be a list of Tool");
    list.push_back(py::reinterpret_borrow<py::object>(tool));
  }
  if (list.size() != 1 && list.size() != paths)
    throw py::value_error("tools must be one for all arrays or one for each: " + std::to_string(paths) + ", not " +
                          std::to_string(list.size()));
  std::vector<py::object> different;
  std::vector<int> numbers;
  for (const py::object& tool : list) {
    std::size_t k = 0;
    while (k < different.size() && !different[k].equal(tool)) ++k;
    if (k == different.size()) {
      different.push_back(tool);
      tools.emplace(static_cast<int>(k) + 1, py::cast<const Tool&>(tool));
    }
    numbers.push_back(static_cast<int>(k) + 1);
  }
  if (numbers.size() < paths) numbers.assign(paths, 1);
  return numbers;
}

/// The value for path `k`: `object` itself, or its k-th entry where it is a list or tuple.
py::object for_path(const py::object& object, std::size_t k, std::size_t paths, const char* name) {
  if (!py::isinstance<py::list>(object) && !py::isinstance<py::tuple>(object)) return object;
  const auto list = py::cast<py::sequence>(object);
  if (list.size() != paths) throw py::value_error(std::string(name) + " must be one for all arrays or one for each");
  return list[k];
}

nc::Program from_cl(const py::iterable& cl, const py::object& tools, const py::object& feed, const py::object& spindle,
                    const std::optional<double>& safe_height, double clearance, const py::object& occupied,
                    const py::object& provenance, const std::shared_ptr<collide::Collider>& collider,
                    const std::optional<double>& retract, const py::object& direction,
                    const std::optional<double>& lead_in, double contact_tolerance) {
  std::vector<py::object> arrays;
  for (const py::handle& array : cl) arrays.push_back(py::reinterpret_borrow<py::object>(array));
  std::map<int, Tool> by_number;
  const std::vector<int> numbers = number_tools(tools, arrays.size(), by_number);
  std::vector<nc::CutterPath> paths;
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    const std::string name = "cl[" + std::to_string(k) + "]";
    nc::CutterPath path;
    path.poses = to_poses(to_doubles(arrays[k], name), name.c_str());
    path.feed = to_column(for_path(feed, k, arrays.size(), "feed"), path.poses.size(), "feed", false);
    path.spindle = to_column(for_path(spindle, k, arrays.size(), "spindle"), 1, "spindle")[0];
    path.tool = numbers[k];
    paths.push_back(std::move(path));
  }
  nc::Clearance room{safe_height, clearance, {}};
  if (!occupied.is_none()) {
    const auto box = py::cast<std::pair<py::object, py::object>>(occupied);
    room.occupied = {to_vec3(box.first, "occupied lower"), to_vec3(box.second, "occupied upper")};
  }
  nc::LinkRule links{collider.get(), contact_tolerance, retract, {}, lead_in};
  if (!direction.is_none()) links.direction = to_vec3(direction, "direction");
  if (!collider && (links.retract || links.direction))
    throw py::value_error("retract and direction choose among ways that are checked: they need a collider");
  const nc::Provenance origin = to_provenance(provenance);
  const NoGil release;
  nc::Program program = program_from_paths(paths, std::move(by_number), room, links);
  program.provenance = origin;
  return program;
}

/// A read-only view of a column of the program that `self` holds.
template <class T, class V>
py::array view(const py::object& self, const std::vector<V>& column, py::ssize_t wide = 0) {
  const auto n = static_cast<py::ssize_t>(column.size());
  const std::vector<py::ssize_t> shape = wide ? std::vector<py::ssize_t>{n, wide} : std::vector<py::ssize_t>{n};
  py::array out(py::dtype::of<T>(), shape, reinterpret_cast<const T*>(column.data()), self);
  out.attr("setflags")(py::arg("write") = false);
  return out;
}

static_assert(sizeof(Pose) == 6 * sizeof(double));

template <class V>
auto column_getter(const std::vector<V>& (nc::Program::*column)() const) {
  return [column](const py::object& self) { return view<V>(self, (py::cast<const nc::Program&>(self).*column)()); };
}

py::array poses(const py::object& self) {
  return view<double>(self, py::cast<const nc::Program&>(self).poses(), 6);
}

py::list cuts(const py::object& self) {
  py::list out;
  const auto& given = py::cast<const nc::Program&>(self);
  const py::object whole = given.via().empty() ? self : py::cast(followed(given));
  const py::array all = poses(whole);
  for (const nc::ToolRun& run : py::cast<const nc::Program&>(whole).runs())
    out.append(py::make_tuple(
        run.tool, all[py::slice(static_cast<py::ssize_t>(run.begin), static_cast<py::ssize_t>(run.end), 1)]));
  return out;
}

py::dict tools_of(const nc::Program& program) {
  py::dict out;
  for (const auto& [number, tool] : program.tools) out[py::int_(number)] = tool;
  return out;
}

py::dict machine_list() {
  py::dict out;
  for (const base::DescriptionEntry& entry : nc::machines()) out[py::str(entry.name)] = entry.description;
  return out;
}

py::object value_of(const nc::OptionValue& value) {
  return std::visit([](const auto& v) -> py::object { return py::cast(v); }, value);
}

const char* name_of(nc::OptionFact::Kind kind) {
  static constexpr const char* kNames[] = {"number", "positive", "numbers", "range", "flag", "word", "path"};
  return kNames[static_cast<std::size_t>(kind)];
}

py::list option_list(const std::string& machine, const py::object& options) {
  using namespace py::literals;
  py::list out;
  for (const nc::MachineOption& option : nc::machine_options(machine, to_options(options))) {
    const nc::OptionFact& fact = option.fact;
    out.append(py::dict("name"_a = fact.name, "kind"_a = name_of(fact.kind), "count"_a = fact.most,
                        "unit"_a = option.unit, "words"_a = fact.words,
                        "value"_a = fact.value ? value_of(*fact.value) : py::object(py::none()),
                        "needed"_a = fact.needed, "own"_a = option.own, "about"_a = fact.about));
  }
  return out;
}

struct SharedStream : Guarded {
  explicit SharedStream(nc::NcStream&& s) : stream(std::move(s)) {}
  nc::NcStream stream;
};

py::dict to_dict(const nc::WriteReport& report) {
  using namespace py::literals;
  py::list passages;
  for (const nc::PolePassage& p : report.passages)
    passages.append(py::dict("first_row"_a = p.first, "last_row"_a = p.last, "tool_degrees"_a = p.tool,
                             "rotary_degrees"_a = p.rotary, "slowed"_a = p.slowed));
  return py::dict("blocks"_a = report.blocks, "slowed_blocks"_a = report.slowed, "rewinds"_a = report.rewinds,
                  "pole_passages"_a = passages);
}

py::dict write(const nc::Program& self, const std::filesystem::path& path, const std::string& post, double tolerance,
               double axis_tolerance, const py::object& options, const std::shared_ptr<collide::Collider>& collider,
               SharedVolume* stock, double contact_tolerance) {
  const nc::WriteOptions how{post, tolerance, axis_tolerance, to_options(options), collider || stock};
  std::optional<Volume> material;
  if (stock) material = Reading(*stock).volume.snapshot();
  nc::WriteReport report;
  {
    const NoGil release;
    report = write_nc(self, path, how, [&](const nc::WriteReport& written) {
      if (collider) verify::refuse_collisions(self, written.motion, *collider, contact_tolerance);
      if (material) verify::refuse_strikes(self, written.motion, *material, std::max(tolerance, 0.01));
    });
  }
  return to_dict(report);
}

nc::Program edited_transform(const nc::Program& program, const py::object& matrix) {
  const auto [turn, shift] = to_affine(matrix, "matrix");
  return transformed(program, turn, shift);
}

std::string repr(const nc::Program& program) {
  std::string text = "<riffler.Program: " + std::to_string(program.size()) + " rows, ";
  const std::size_t runs = program.runs().size();
  return text + std::to_string(runs) + (runs == 1 ? " tool run>" : " tool runs>");
}

}  // namespace

namespace {

/// Of a dict of numbers, such as tool_diameters: each key before its value.
std::vector<double> to_pairs(const py::dict& dict, const std::string& name) {
  std::vector<double> out;
  for (const auto& [key, value] : dict) {
    try {
      out.push_back(py::cast<double>(py::float_(py::reinterpret_borrow<py::object>(key))));
      out.push_back(py::cast<double>(py::float_(py::reinterpret_borrow<py::object>(value))));
    } catch (const py::error_already_set&) {
      throw py::value_error("option " + name + " must have numbers only");
    }
  }
  return out;
}

}  // namespace

nc::Options to_options(const py::object& object) {
  nc::Options out;
  if (object.is_none()) return out;
  if (!py::isinstance<py::dict>(object)) throw py::value_error("options must be a dict");
  for (const auto& [key, value] : py::cast<py::dict>(object)) {
    const std::string name = py::cast<std::string>(py::str(key));
    if (py::isinstance<py::bool_>(value)) {
      out[name] = py::cast<bool>(value);
    } else if (py::isinstance<py::str>(value)) {
      out[name] = py::cast<std::string>(value);
    } else if (py::isinstance<py::dict>(value)) {
      out[name] = to_pairs(py::reinterpret_borrow<py::dict>(value), name);
    } else {
      const Doubles array = to_doubles(value, "option " + name);
      if (array.ndim() > 1)
        throw py::value_error("option " + name + " must be a number, a list of them, a bool or a str");
      if (array.ndim() == 0)
        out[name] = *array.data();
      else
        out[name] = std::vector<double>(array.data(), array.data() + array.size());
    }
  }
  return out;
}

void bind_program(py::module_& m) {
  m.def("machines", &machine_list,
        "Machines that programs are written for and read from, ours and your own: name to description. A post has its "
        "machine's name; the path of a .toml file that describes one will do as well.");

  m.def(
      "machine_options", &option_list, py::arg("machine"), py::arg("options") = py::none(),
      R"(The options that a machine takes, its own first, and those of the code that is written for it: a list of dicts.

``name``; ``kind``: "number", "positive", "numbers", "range" (two that grow), "flag" (a bool) or "word"; ``count`` of
numbers; ``unit``: "mm", "deg", "mm/min", "deg/min" or ""; ``words``: of which it is one; ``value``: where it is not
given, None where there is none then; ``needed``: it must be given, with these ``options``; ``own``: of this machine's
file, the others are of many; ``about``: one sentence.
ValueError for a machine that is not known, and for options that are wrong.)");

  py::class_<nc::Note>(m, "Note", "What a reader of NC code assumed or passed over.")
      .def_readonly(
          "kind", &nc::Note::kind,
          "\"skipped\", \"coordinates\" (what follows may be elsewhere), \"work offset\", \"units\", "
          "\"machine position\", "
          "\"rapid\", \"motion\", \"start\", \"tool length\", \"cutter compensation\", \"user code\" or \"end\".")
      .def_readonly("line", &nc::Note::line, "Of the source, from 1.")
      .def_readonly("message", &nc::Note::message)
      .def("__repr__", [](const nc::Note& n) {
        return "<riffler.Note: line " + std::to_string(n.line) + ", " + n.kind + ": " + n.message + ">";
      });

  py::class_<SharedStream>(m, "ProgramStream", "What Program.stream gives: an iterator of programs.")
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", [](SharedStream& self) {
        const OneCaller only(self, "the stream");
        nc::Program program;
        bool more;
        {
          const NoGil release;
          more = self.stream.next(program);
        }
        if (!more) throw py::stop_iteration();
        return program;
      });

  py::class_<nc::Program, std::shared_ptr<nc::Program>>(m, "Program",
                                                        R"(Where the tool goes, how fast and with which tool; immutable.

One row per move end. Between two rows the tip moves on a line and the axis on the great circle at constant rate, by way
of the poses in ``via`` where there are any.
``tools`` is a dict of the tools whose shape is known, by number; ``provenance`` a dict of strings that the header
comment of the NC code repeats. Lengths in mm, feed in mm/min at the tip, spindle in rev/min.)")
      .def(py::init(&make_program), py::arg("poses"), py::arg("feed"), py::arg("rapid") = false, py::arg("tool") = 1,
           py::arg("line") = 0, py::arg("spindle") = 0.0, py::arg("tools") = py::none(),
           py::arg("provenance") = py::none(), py::arg_v("notes", std::vector<nc::Note>(), "[]"),
           py::arg("at_machine") = false, py::arg("via") = py::none(),
           R"(From columns: poses (n, 6), everything else one value for all rows or (n,).

ValueError names the row: not finite, not a unit axis, a feed of 0 where the tip moves, ``at_machine`` with another pose
than the row before.)")
      .def_static("from_cl", &from_cl, py::arg("cl"), py::arg("tools"), py::arg("feed"), py::arg("spindle") = 0.0,
                  py::kw_only(), py::arg("safe_height") = py::none(), py::arg("clearance") = 10.0,
                  py::arg("occupied") = py::none(), py::arg("provenance") = py::none(),
                  py::arg("collider") = py::none(), py::arg("retract") = py::none(), py::arg("direction") = py::none(),
                  py::arg("lead_in") = py::none(), py::arg("contact_tolerance") = 0.02,
                  R"(From cutter locations: every (n, 6) array is one cut.

Its rows become feed moves in order, none merged. Before it a rapid at safe height to above its first point, along the
tool's axis, and the feed in; after it a rapid out along the axis. ``tools``: one for all arrays or one for each
(None: tool 1 of unknown shape). ``feed`` (mm/min at the tip) and ``spindle`` (rev/min, negative counter-clockwise): one
for all, or a list of one for each array; a feed may be an array of one per row.
``safe_height``: z (mm) above everything, the clearance plane; by default ``clearance`` (mm) above all tips and
``occupied``, a pair of corners around stock, part and fixtures.

With a ``collider``, its part and fixtures are occupied too, and approaches, retracts and the moves between cuts are
resolved with cutter, shank and holder: along the tool's axis where that is clear, otherwise by another way, the axis
kept; such a way is fed, since it may cross stock. ``retract``: mm of the first stretch out of a cut; ``direction``: a
unit vector, which way that goes. Not given, what is clear is looked for. ``lead_in``: mm before a cut that are fed, what
is above it being air; not given, all of it is fed. ``contact_tolerance``: mm that a tool may enter part and fixtures by,
as cuts touch the part. ValueError names the path, the row, the place and the remedy where nothing is clear.)")
      .def_static(
          "read",
          [](const std::filesystem::path& path, const std::string& machine, const py::object& options,
             const py::object& progress) {
            const nc::ReadOptions how{machine, to_options(options), to_progress(progress)};
            const NoGil release;
            return read_nc(path, how);
          },
          py::arg("path"), py::arg("machine") = "tcp", py::arg("options") = py::none(), py::kw_only(),
          py::arg("progress") = py::none(),
          R"(Reads NC code for ``machine``, a name of machines(), as its control has it: RS-274, APT, Heidenhain's Klartext or Sinumerik.

Options: those of the machine; ``chord_tolerance`` (mm, default 0.002) for curves; ``axis_tolerance`` (rad): where it is
given, blocks whose rotary axes leave the great circle by more become several rows, otherwise a block is one row, and the
poses on its way are in ``via``;
``block_delete`` (default True: lines that begin with / are passed over); ``unknown``: "error" or "skip" (what was skipped
is listed in ``notes`` and ``provenance``); ``cutter_compensation``: "error", "ignore" (points are those of the tool's
centre) or "offset" (points are the contour's, and the tool's centre goes beside it); ``tool_diameters`` for that, in mm: one
number, or a dict by the number of the offset D or of the tool; ``units``: "mm" or "inch", before the program says which; ``arc_tolerance`` (mm, default 0.005) by which an arc's
end may miss its circle; ``g54`` … ``g59``, ``g59_1`` … ``g59_3``, ``g28``, ``g30``: where on the machine work offsets and homes
lie, three to six numbers; ``subroutines``: a folder of files name.ngc; ``parameters``: a file of LinuxCNC's parameters;
``max_turns`` of loops and calls (default 1e6). Poses are in the coordinates in which the first move is
programmed. FormatError names file, line and block; nothing that is not understood is skipped unasked.)")
      .def_static(
          "stream",
          [](const std::filesystem::path& path, const std::string& machine, const py::object& options, double rows) {
            if (!(rows >= 2 && rows <= 1e9)) throw py::value_error("rows must be 2 to 1e9");
            return std::make_unique<SharedStream>(
                nc::NcStream(path, nc::ReadOptions{machine, to_options(options), to_progress(py::none())},
                             static_cast<std::size_t>(rows)));
          },
          py::arg("path"), py::arg("machine") = "tcp", py::arg("options") = py::none(), py::arg("rows") = 65536,
          R"(Reads as ``read`` does, in memory that does not grow with the file: an iterator of programs of at most ``rows``
rows. Each after the first begins with the row at which the one before ended.)")
      .def("write", &write, py::arg("path"), py::arg("post") = "tcp", py::arg("tolerance") = 0.01,
           py::arg("axis_tolerance") = 0.00175, py::arg("options") = py::none(), py::kw_only(),
           py::arg("collider") = py::none(), py::arg("stock") = py::none(), py::arg("contact_tolerance") = 0.05,
           R"(Writes NC code; ``post`` is a name of machines(). The file is whole or not there.

Every row is the end of a block; more blocks come between two rows where machine axes that move linearly would take the
tip more than ``tolerance`` (mm) off the straight line or the axis more than ``axis_tolerance`` (rad) off the great
circle. The same program gives the same bytes.

Options are the machine's (``rot_point``, ``offset``, ``tool_offset`` of LinuxCNC's tables, named as its pins;
``pivot_length`` of heads), and of all: ``tcp`` (False: X Y Z are where the axes stand; True: the tip in part
coordinates), ``direction`` (``"linuxcnc"`` or ``"iso"``, of tables), ``limits_x`` … ``limits_c`` [low, high], ``rate_x`` …
``rate_c``, ``max_rotary`` (deg/min), ``line_numbers``, ``coolant``, ``retract``, ``safe_height``, ``arcs``, ``vectors``: docs/machines.md. Where a
rotary axis moves beside linear ones that are written as they stand, blocks are under G93, each with F = 1 / minutes: the
tip's way at the feed, or longer where an axis's rate asks for it.

With a ``collider`` the machine's own motion is checked, block by block as its axes make it, with cutter, shank and
holder against part and fixtures; with a ``stock`` (a Volume) it is run on that, as a verification does. What enters them
by more than ``contact_tolerance`` (mm), a rapid in the stock, or shank or holder in it, is a ValueError with the row, the
place and the remedy, and nothing is written.

Returns a dict: ``blocks``; ``slowed_blocks``, longer than their feed asks; ``rewinds``, the rows at which the tool leaves
the material because a limit asks to turn an axis back; ``pole_passages``, near the singular direction: a list of dicts of
``first_row``, ``last_row``, ``tool_degrees``, ``rotary_degrees`` and ``slowed`` (the worst block's time by what its feed
would take).)")
      .def_property_readonly("poses", &poses, "(n, 6): tip xyz, unit axis xyz (tip to spindle). Read-only view.")
      .def_property_readonly("feed", column_getter(&nc::Program::feed), "(n,) mm/min at the tip; 0 for rapids.")
      .def_property_readonly(
          "rapid", [](const py::object& self) { return view<bool>(self, py::cast<const nc::Program&>(self).rapid()); },
          "(n,) bool.")
      .def_property_readonly(
          "at_machine",
          [](const py::object& self) { return view<bool>(self, py::cast<const nc::Program&>(self).at_machine()); },
          "(n,) bool: rows that end at a position of the machine (G28, G30, G53) whose place in the part is not known. "
          "Their pose is that of the row before; the motions there and from there are neither cut nor compared.")
      .def_property_readonly("tool", column_getter(&nc::Program::tool), "(n,) int32 tool numbers; 0: none.")
      .def_property_readonly("line", column_getter(&nc::Program::line), "(n,) int32 source lines from 1; 0: no source.")
      .def_property_readonly("spindle", column_getter(&nc::Program::spindle),
                             "(n,) rev/min; negative counter-clockwise, 0 stopped.")
      .def_property_readonly("tools", &tools_of, "dict: number to Tool, of the tools whose shape is known.")
      .def_property_readonly(
          "provenance",
          [](const nc::Program& self) {
            py::dict out;
            for (const auto& [key, value] : self.provenance) out[py::str(key)] = value;
            return out;
          },
          "dict of strings.")
      .def_property_readonly(
          "notes", [](const nc::Program& self) { return self.notes; },
          "What the reader assumed or passed over: a list of Note. Programs that are made of numbers have none.")
      .def_property_readonly(
          "via", &vias_of,
          "dict: row to (k, 6) poses on the way there, where rotary axes that turn evenly take the tool another way "
          "than the "
          "great circle: by more than 0.002 rad, in programs that were read without ``axis_tolerance``.")
      .def(
          "followed", [](const nc::Program& self) { return followed(self); },
          "With the poses of ``via`` as rows of their own: between its rows the tool moves as the machine moves it.")
      .def("trimmed", &nc::trimmed, py::arg("first"), py::arg("last"),
           "Rows [first, last) as a program. The first of them is a rapid; an approach is yours to put before it.")
      .def("transformed", &edited_transform, py::arg("matrix"),
           "In another clamping: ``matrix`` (4, 4) turns and moves (mm) the part, without scale or mirror.")
      .def("retimed", &nc::scale_feeds, py::arg("factor"), "Feeds times ``factor``; rapids as they are.")
      .def_static(
          "joined",
          [](const std::vector<std::reference_wrapper<const nc::Program>>& programs) {
            std::vector<const nc::Program*> all;
            for (const nc::Program& program : programs) all.push_back(&program);
            return joined(all);
          },
          py::arg("programs"), "One after the other. ValueError where one number stands for tools of two shapes.")
      .def("retooled", &nc::renumber_tools, py::arg("numbers"),
           "Tool numbers by a dict old: new; those that are not in it stay. ValueError where two shapes would share "
           "one.")
      .def("cuts", &cuts,
           "For replay: a list of (tool number, poses (k, 6)), one per run of rows in the part with one tool, rapids "
           "and the "
           "poses of ``via`` included.")
      .def("__len__", &nc::Program::size)
      .def("__repr__", &repr);
}

}  // namespace riffler::bindings
