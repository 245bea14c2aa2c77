// riffler.Program: columns and edits.
#include <cstring>
#include <functional>

#include "bindings/program_arguments.hpp"
#include "nc/follow.hpp"
#include "riffler/nc/edit.hpp"

namespace riffler::bindings {

RIFFLER_TYPED(VolumeObject, "riffler._core.Volume")
RIFFLER_TYPED(ProgramObject, "riffler._core.Program")

namespace {

using Via = std::shared_ptr<const std::vector<Pose>>;

std::map<std::size_t, Via> to_vias(const ViaLike& object, std::size_t rows) {
  std::map<std::size_t, Via> out;
  if (object.is_none()) return out;
  if (!py::isinstance<py::dict>(object)) throw py::value_error("via must be a dict: row to poses (k, 6)");
  for (const auto& [key, value] : py::cast<py::dict>(object)) {
    if (!py::isinstance<py::int_>(key)) throw py::value_error("via must be a dict: row to poses (k, 6)");
    const int row = to_number(py::cast<double>(key), "via", out.size());
    if (row < 1 || static_cast<std::size_t>(row) >= rows)
      throw py::value_error("via: no row to lead to: " + std::to_string(row));
    const std::string name = "via[" + std::to_string(row) + "]";
    out.emplace(row, std::make_shared<const std::vector<Pose>>(to_poses(to_doubles(value, name), name.c_str())));
  }
  return out;
}

ArrayDict vias_of(const nc::Program& program) {
  py::dict out;
  for (const auto& [row, via] : program.via()) {
    py::array_t<double> poses({static_cast<py::ssize_t>(via->size()), py::ssize_t{6}});
    std::memcpy(poses.mutable_data(), via->data(), via->size() * sizeof(Pose));
    out[py::int_(row)] = poses;
  }
  return out;
}

nc::Program make_program(const Doubles& poses, const ArrayLike& feed, const ArrayLike& rapid, const ArrayLike& tool,
                         const ArrayLike& line, const ArrayLike& spindle, const ToolsLike& tools,
                         const StringsLike& provenance, const std::vector<nc::Note>& notes, const ArrayLike& at_machine,
                         const ViaLike& via) {
  const std::vector<Pose> rows = to_poses(poses, "poses");
  const std::size_t n = rows.size();
  const auto column = [&](const ArrayLike& object, const char* name) { return to_column(object, n, name); };
  const std::vector<double> feeds = column(feed, "feed"), rapids = column(rapid, "rapid"),
                            numbers = column(tool, "tool"), lines = column(line, "line"),
                            speeds = column(spindle, "spindle"), away = column(at_machine, "at_machine");
  const std::map<std::size_t, Via> ways = to_vias(via, n);
  nc::Program program;
  program.reserve(n);
  for (std::size_t row = 0; row < n; ++row)
    program.append({rows[row], feeds[row], speeds[row], to_number(numbers[row], "tool", row),
                    to_number(lines[row], "line", row), rapids[row] != 0, away[row] != 0,
                    ways.contains(row) ? ways.at(row) : nullptr});
  program.tools = to_tools(tools, 1);
  program.provenance = to_provenance(provenance);
  program.notes = notes;
  return program;
}

/// A read-only view of a column of the program that `self` holds.
template <class T, class V>
py::array_t<T> view(const py::object& self, const std::vector<V>& column, py::ssize_t wide = 0) {
  const auto n = static_cast<py::ssize_t>(column.size());
  const std::vector<py::ssize_t> shape = wide ? std::vector<py::ssize_t>{n, wide} : std::vector<py::ssize_t>{n};
  py::array_t<T> out(shape, reinterpret_cast<const T*>(column.data()), self);
  out.attr("setflags")(py::arg("write") = false);
  return out;
}

static_assert(sizeof(Pose) == 6 * sizeof(double));

template <class V>
auto column_getter(const std::vector<V>& (nc::Program::*column)() const) {
  return [column](const py::object& self) { return view<V>(self, (py::cast<const nc::Program&>(self).*column)()); };
}

py::array_t<double> program_poses(const py::object& self) {
  return view<double>(self, py::cast<const nc::Program&>(self).poses(), 6);
}

CutList cuts(const py::object& self) {
  py::list out;
  const auto& given = py::cast<const nc::Program&>(self);
  const py::object whole = given.via().empty() ? self : py::cast(followed(given));
  const py::array all = program_poses(whole);
  for (const nc::ToolRun& run : py::cast<const nc::Program&>(whole).runs())
    out.append(py::make_tuple(
        run.tool, all[py::slice(static_cast<py::ssize_t>(run.begin), static_cast<py::ssize_t>(run.end), 1)]));
  return out;
}

ToolDict tools_of(const nc::Program& program) {
  py::dict out;
  for (const auto& [number, tool] : program.tools) out[py::int_(number)] = tool;
  return out;
}

StringDict provenance_of(const nc::Program& program) {
  py::dict out;
  for (const auto& [key, value] : program.provenance) out[py::str(key)] = value;
  return out;
}

nc::Program edited_transform(const nc::Program& program, const ArrayLike& matrix) {
  const auto [turn, shift] = to_affine(matrix, "matrix");
  return transformed(program, turn, shift);
}

std::string describe_program(const nc::Program& program) {
  std::string text = "<riffler.Program: " + std::to_string(program.size()) + " rows, ";
  const std::size_t runs = program.runs().size();
  return text + std::to_string(runs) + (runs == 1 ? " tool run>" : " tool runs>");
}

}  // namespace

void bind_program(py::module_& m) {
  ProgramClass(m, "Program", R"(A program: poses, feeds and tools; immutable.

One row per move end. Between two rows the tip moves on a line and the axis on the great circle at constant rate, by way
of the poses in ``via`` where there are any.

Parameters
----------
poses : array_like, shape (n, 6)
    Tip in mm and unit axis, tip to spindle.
feed : array_like, shape (n,), or float
    mm/min at the tip.
rapid : array_like of bool, shape (n,), or bool
    Rows that end a rapid.
tool : array_like of int, shape (n,), or int
    Tool numbers; 0: none.
line : array_like of int, shape (n,), or int
    Source lines from 1; 0: no source.
spindle : array_like, shape (n,), or float
    rev/min; negative counter-clockwise, 0 stopped.
tools : dict, optional
    Number to Tool, of the tools whose shape is known.
provenance : dict, optional
    Strings that the NC code repeats in its header comment.
notes : list of Note
    Assumptions of the reader of NC code, and skipped code.
at_machine : array_like of bool, shape (n,), or bool
    Rows that end at a position of the machine whose place in the part is not known.
via : dict, optional
    Row to poses (k, 6) on the move to it.

Raises
------
ValueError
    Naming the row: not finite, not a unit axis, a feed of 0 where the tip moves, ``at_machine`` with another pose than
    the row before.

Examples
--------
>>> program = riffler.Program([(0, 0, 5, 0, 0, 1), (20, 0, 5, 0, 0, 1)], feed=600, rapid=[True, False])
>>> program.feed
array([  0., 600.])
)")
      .def(py::init(&make_program), py::arg("poses"), py::arg("feed"), py::kw_only(), py::arg("rapid") = false,
           py::arg("tool") = 1, py::arg("line") = 0, py::arg("spindle") = 0.0, py::arg("tools") = py::none(),
           py::arg("provenance") = py::none(), py::arg_v("notes", std::vector<nc::Note>(), "[]"),
           py::arg("at_machine") = false, py::arg("via") = py::none())
      .def_property_readonly("poses", &program_poses,
                             "(n, 6): tip xyz, unit axis xyz (tip to spindle). Read-only view.")
      .def_property_readonly("feed", column_getter(&nc::Program::feed), "(n,) mm/min at the tip; 0 for rapids.")
      .def_property_readonly(
          "rapid", [](const py::object& self) { return view<bool>(self, py::cast<const nc::Program&>(self).rapid()); },
          "(n,) bool: rows that end a rapid.")
      .def_property_readonly(
          "at_machine",
          [](const py::object& self) { return view<bool>(self, py::cast<const nc::Program&>(self).at_machine()); },
          "(n,) bool: rows that end at a position of the machine (G28, G30, G53) whose place in the part is not known. "
          "Their pose is that of the row before; the motions there and from there are neither cut nor compared.")
      .def_property_readonly("tool", column_getter(&nc::Program::tool), "(n,) int32 tool numbers; 0: none.")
      .def_property_readonly("line", column_getter(&nc::Program::line), "(n,) int32 source lines from 1; 0: no source.")
      .def_property_readonly("spindle", column_getter(&nc::Program::spindle),
                             "(n,) rev/min; negative counter-clockwise, 0 stopped.")
      .def_property_readonly("tools", &tools_of, "Tools whose shape is known, by number.")
      .def_property_readonly("provenance", &provenance_of, "Strings that the NC code repeats in its header comment.")
      .def_property_readonly(
          "notes", [](const nc::Program& self) { return self.notes; },
          "Assumptions of the reader, and skipped code. Programs made from arrays have none.")
      .def_property_readonly(
          "via", &vias_of,
          "(k, 6) poses on the move to a row, by row: where rotary axes that turn evenly take the tool off the great "
          "circle by more than 0.002 rad, in programs that were read without ``axis_tolerance``.")
      .def(
          "followed", [](const nc::Program& self) { return followed(self); },
          R"(The program with the poses of ``via`` as rows of their own.

Between its rows the tool moves as on the machine.

Returns
-------
Program

Examples
--------
>>> program = riffler.Program([(0, 0, 5, 0, 0, 1), (20, 0, 5, 0, 0, 1)], feed=600, rapid=[True, False])
>>> len(program.followed())
2
)")
      .def("trimmed", &nc::trimmed, py::arg("first"), py::arg("last"), R"(Some rows as a program.

Parameters
----------
first, last : int
    Rows ``first`` to ``last`` - 1. The first of them becomes a rapid; the caller adds an approach before it.

Returns
-------
Program

Examples
--------
>>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
>>> len(program.trimmed(1, 4))
3
)")
      .def("transformed", &edited_transform, py::arg("matrix"), R"(The program in another clamping.

Parameters
----------
matrix : array_like, shape (4, 4)
    Turns and moves (mm) the part, without scale or mirror.

Returns
-------
Program

Examples
--------
>>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
>>> program.transformed(np.diag([-1, -1, 1, 1])).poses[1, :3]
array([-1.,  0.,  5.])
)")
      .def("scale_feeds", &nc::scale_feeds, py::arg("factor"), R"(The program with other feeds; rapids are unchanged.

Parameters
----------
factor : float
    Factor on the feeds.

Returns
-------
Program

Examples
--------
>>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(2)], feed=600)
>>> program.scale_feeds(0.5).feed
array([300., 300.])
)")
      .def(
          "scheduled",
          [](const py::object& self, const VolumeObject& stock, std::optional<double> removal_rate,
             std::optional<double> force, double lowest, std::optional<double> highest, double removal_constant,
             const ToolsLike& tools, const ProgressLike& progress) {
            return ProgramObject(py::module_::import("riffler.scheduling")
                                     .attr("scheduled")(self, stock, removal_rate, force, lowest, highest,
                                                        removal_constant, tools, progress));
          },
          py::arg("stock"), py::kw_only(), py::arg("removal_rate") = py::none(), py::arg("force") = py::none(),
          py::arg("lowest") = 1.0, py::arg("highest") = py::none(), py::arg("removal_constant") = 0.05,
          py::arg("tools") = py::none(), py::arg("progress") = py::none(),
          R"(The program with feeds at which the simulated removal rate, or force, stays below a limit.

The program runs on a copy of the stock, in steps of four pitches or a quarter of the cutter's radius. Where the feed that
a step needs differs from the one before, the row is divided there; nothing else changes.

Parameters
----------
stock : Volume
    At the beginning of the program. Not changed.
removal_rate : float, optional
    mm³/min; this or ``force``, or both.
force : float, optional
    N, of removal: ``removal_constant`` times the removal rate.
lowest : float
    mm/min, the smallest feed.
highest : float, optional
    mm/min, to which feeds may rise; None: to the program's own.
removal_constant : float
    N·s/mm³, as for ``Volume.carve``.
tools : dict, optional
    Number to Tool; takes the place of the program's own.
progress : callable, optional
    Called with the finished share; returning False cancels.

Returns
-------
Program

Raises
------
ValueError
    Naming the row and the place where the limit needs a feed below ``lowest``, a tool of unknown shape, or the argument.

Examples
--------
>>> stock = riffler.Volume.block((0, 0, 0), (40, 20, 10), pitch=0.5)
>>> cut = [(-5, 10, 8, 0, 0, 1), (45, 10, 8, 0, 0, 1)]
>>> program = riffler.Program(cut, feed=1200, spindle=9000, tools={1: riffler.Tool.flat(diameter=6, length=20)})
>>> slower = program.scheduled(stock, removal_rate=6000)
>>> bool(slower.feed.min() < 600), float(slower.feed.max()), len(slower) > len(program)
(True, 1200.0, True)
)")
      .def_static(
          "joined",
          [](const std::vector<std::reference_wrapper<const nc::Program>>& programs) {
            std::vector<const nc::Program*> all;
            for (const nc::Program& program : programs) all.push_back(&program);
            return joined(all);
          },
          py::arg("programs"), R"(Programs one after the other.

Parameters
----------
programs : list of Program
    In their order.

Returns
-------
Program

Raises
------
ValueError
    If one number is used for two shapes.

Examples
--------
>>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600)
>>> len(riffler.Program.joined([program, program]))
10
)")
      .def("renumber_tools", &nc::renumber_tools, py::arg("numbers"), R"(The program with other tool numbers.

Parameters
----------
numbers : dict
    Old number to new; a tool that is not in it keeps its number.

Returns
-------
Program

Raises
------
ValueError
    If two shapes would share a number.

Examples
--------
>>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(2)], feed=600, tool=1)
>>> program.renumber_tools({1: 7}).tool
array([7, 7], dtype=int32)
)")
      .def("cuts", &cuts, R"(The poses for a replay, tool by tool.

Returns
-------
list of tuple
    (tool number, poses (k, 6)), one for each run of rows in the part with one tool; rapids and the poses of ``via`` are
    included.

Examples
--------
>>> program = riffler.Program([(x, 0, 5, 0, 0, 1) for x in range(5)], feed=600, tool=3)
>>> [(number, poses.shape) for number, poses in program.cuts()]
[(3, (5, 6))]
)")
      .def("__len__", &nc::Program::size)
      .def("__repr__", &describe_program);
}

}  // namespace riffler::bindings
