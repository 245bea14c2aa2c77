// riffler.Program.read, .stream and .write: programs as NC code.
#include <algorithm>
#include <optional>

#include "bindings/one_caller.hpp"
#include "bindings/program_arguments.hpp"
#include "bindings/shared_volume.hpp"
#include "riffler/nc/read/reader.hpp"
#include "riffler/nc/write/writer.hpp"
#include "verify/motion_check.hpp"

namespace riffler::bindings {

namespace {

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

}  // namespace

void bind_nc_types(py::module_& m) {
  py::class_<nc::Note>(m, "Note", "What a reader of NC code assumed or passed over.")
      .def_readonly(
          "kind", &nc::Note::kind,
          "\"skipped\", \"coordinates\" (what follows may be elsewhere), \"work offset\", \"units\", "
          "\"machine position\", "
          "\"rapid\", \"motion\", \"start\", \"tool length\", \"cutter compensation\", \"user code\" or \"end\".")
      .def_readonly("line", &nc::Note::line, "Line of the source, from 1.")
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
}

void bind_nc(py::module_& m) {
  program_class(m)
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
would take).)");
}

}  // namespace riffler::bindings
