// riffler.Program: columns and edits.
#include <cstring>
#include <functional>

#include "bindings/program_arguments.hpp"
#include "nc/follow.hpp"
#include "riffler/nc/edit.hpp"

namespace riffler::bindings {

namespace {

using Via = std::shared_ptr<const std::vector<Pose>>;

std::map<std::size_t, Via> to_vias(const py::object& object, std::size_t rows) {
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

void bind_program(py::module_& m) {
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
