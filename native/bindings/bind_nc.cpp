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

WriteReport to_result(const nc::WriteReport& report) {
  using namespace py::literals;
  py::list passages;
  for (const nc::PolePassage& p : report.passages)
    passages.append(program_result("PolePassage",
                                   py::dict("first_row"_a = p.first, "last_row"_a = p.last, "tool_degrees"_a = p.tool,
                                            "rotary_degrees"_a = p.rotary, "slowed"_a = p.slowed)));
  return program_result("WriteReport", py::dict("blocks"_a = report.blocks, "slowed_blocks"_a = report.slowed,
                                                "rewinds"_a = report.rewinds, "pole_passages"_a = passages));
}

WriteReport write_nc(const nc::Program& self, const std::filesystem::path& path, const std::string& post,
                     double tolerance, double axis_tolerance, const OptionsLike& options,
                     const std::shared_ptr<collide::Collider>& collider, SharedVolume* stock,
                     double contact_tolerance) {
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
  return to_result(report);
}

}  // namespace

void bind_nc_types(py::module_& m) {
  py::class_<nc::Note>(m, "Note", "An assumption of a reader of NC code, or code that it skipped: see `Program.read`.")
      .def_readonly(
          "kind", &nc::Note::kind,
          "\"skipped\", \"coordinates\" (what follows may be elsewhere), \"work offset\", \"units\", "
          "\"machine position\", "
          "\"rapid\", \"motion\", \"start\", \"tool length\", \"cutter compensation\", \"user code\" or \"end\".")
      .def_readonly("line", &nc::Note::line, "Line of the source, from 1.")
      .def_readonly("message", &nc::Note::message, "A sentence on what the reader assumed or skipped.")
      .def("__repr__", [](const nc::Note& n) {
        return "<riffler.Note: line " + std::to_string(n.line) + ", " + n.kind + ": " + n.message + ">";
      });

  py::class_<SharedStream>(m, "ProgramStream", "An iterator over programs: see `Program.stream`.")
      .def("__iter__", [](const py::object& self) -> Self { return self; })
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
          [](const std::filesystem::path& path, const std::string& machine, const OptionsLike& options,
             const ProgressLike& progress) {
            const nc::ReadOptions how{machine, to_options(options), to_progress(progress)};
            const NoGil release;
            return read_nc(path, how);
          },
          py::arg("path"), py::kw_only(), py::arg("machine") = "tcp", py::arg("options") = py::none(),
          py::arg("progress") = py::none(),
          R"(Reads NC code as a machine's control has it: RS-274, APT, Heidenhain's Klartext or Sinumerik.

Poses are in the coordinates in which the first move is programmed. Code that the reader does not understand is an error,
unless ``unknown`` is "skip".

Parameters
----------
path : path_like
    The file.
machine : str
    A name of ``machines``, or the path of a .toml file.
options : dict, optional
    Options of the machine, and of reading:

    - ``chord_tolerance`` (mm, 0.002): for curves.
    - ``axis_tolerance`` (rad): blocks whose rotary axes leave the great circle by more become several rows; without it a
      block is one row, and the poses in between are in ``via``.
    - ``block_delete`` (True): skips lines that begin with /.
    - ``unknown``: "error" or "skip"; ``notes`` and ``provenance`` list what was skipped.
    - ``cutter_compensation``: "error", "ignore" (points are those of the tool's centre) or "offset" (points are the
      contour's, and the tool's centre is offset from it); ``tool_diameters`` for that, mm: one number, or a dict by
      the number of the offset D or of the tool.
    - ``units``: "mm" or "inch", before the program declares them.
    - ``arc_tolerance`` (mm, 0.005): by which an arc's end may miss its circle.
    - ``arc_centres``: "relative" (to the arc's start) or "absolute", until G90.1 or G91.1.
    - ``first_feed`` (mm/min): of feed moves before the first F.
    - ``first_motion``: "none", "G0" or "G1": of axis words before the first motion.
    - ``g54`` … ``g59``, ``g59_1`` … ``g59_3``, ``g28``, ``g30``: machine positions of work offsets and homes, three to
      six numbers.
    - ``subroutines``: a folder of files name.ngc; ``parameters``: a file of LinuxCNC's parameters; ``max_turns`` (1e6) of
      loops and calls.
progress : callable, optional
    Called with the finished share; returning False cancels.

Returns
-------
Program

Raises
------
FormatError
    Naming file, line and block.
ValueError
    Naming the option that is wrong.

Examples
--------
>>> text = "G21 G90\nT1 M6\nG1 X10 Y0 Z5 F600\nX20\nM2\n"
>>> from pathlib import Path
>>> _ = Path("part.ngc").write_text(text)
>>> riffler.Program.read("part.ngc", machine="3-axis").poses[-1, :3]
array([20.,  0.,  5.])
)")
      .def_static(
          "stream",
          [](const std::filesystem::path& path, const std::string& machine, const OptionsLike& options, double rows) {
            if (!(rows >= 2 && rows <= 1e9)) throw py::value_error("rows must be 2 to 1e9");
            return std::make_unique<SharedStream>(
                nc::NcStream(path, nc::ReadOptions{machine, to_options(options), to_progress(py::none())},
                             static_cast<std::size_t>(rows)));
          },
          py::arg("path"), py::kw_only(), py::arg("machine") = "tcp", py::arg("options") = py::none(),
          py::arg("rows") = 65536,
          R"(Reads as ``read`` does, in memory that does not grow with the file.

Parameters
----------
path : path_like
    The file.
machine : str
    A name of ``machines``, or the path of a .toml file.
options : dict, optional
    As for ``read``.
rows : int
    Largest number of rows of a program.

Returns
-------
ProgramStream
    An iterator of programs; each after the first begins with the row at which the one before ended.

Examples
--------
>>> text = "G21 G90\nT1 M6\nG1 X10 Y0 Z5 F600\nX20\nX30\nM2\n"
>>> from pathlib import Path
>>> _ = Path("part.ngc").write_text(text)
>>> [len(part) for part in riffler.Program.stream("part.ngc", machine="3-axis", rows=2)]
[2, 2]
)")
      .def("write", &write_nc, py::arg("path"), py::kw_only(), py::arg("post") = "tcp", py::arg("tolerance") = 0.01,
           py::arg("axis_tolerance") = 0.00175, py::arg("options") = py::none(), py::arg("collider") = py::none(),
           py::arg("stock") = py::none(), py::arg("contact_tolerance") = 0.05,
           R"(Writes NC code: the whole file or none. The same program gives the same bytes.

Every row is the end of a block; more blocks come between two rows where machine axes that move linearly would take the
tip more than ``tolerance`` off the straight line or the axis more than ``axis_tolerance`` off the great circle. Where a
rotary axis moves together with linear ones that are written as they stand, blocks are under G93, each with
F = 1 / minutes: the tip's travel at the feed, or longer where an axis's rate asks for it.

Parameters
----------
path : path_like
    The file.
post : str
    A name of ``machines``, or the path of a .toml file.
tolerance : float
    mm.
axis_tolerance : float
    rad.
options : dict, optional
    The machine's (``rot_point``, ``offset``, ``tool_offset`` of LinuxCNC's tables, named as its pins; ``pivot_length`` of
    heads), and those of all: ``tcp`` (False: X Y Z are where the axes stand; True: the tip in part coordinates),
    ``direction`` ("linuxcnc" or "iso", of tables), ``limits_x`` … ``limits_c`` [low, high], ``rate_x`` … ``rate_c``,
    ``max_rotary`` (deg/min), ``line_numbers``, ``coolant``, ``retract``, ``safe_height``, ``arcs``, ``vectors``:
    docs/machines.md and ``machine_options``.
collider : Collider, optional
    Checks the machine's own motion between the ends of blocks, with cutter, shank and holder against part and
    fixtures.
stock : Volume, optional
    Stock to check that motion in, as in a verification.
contact_tolerance : float
    mm by which part and fixtures may be entered.

Returns
-------
WriteReport

Raises
------
ValueError
    Naming the row, the place and the remedy: a row that the machine cannot hold, a collision with part or fixtures, a rapid in the
    stock, or shank or holder in it. Nothing is written.

Examples
--------
>>> cut = [(0, 0, 0, 0, 0, 1), (20, 0, 0, 0, 0, 1)]
>>> program = riffler.Program.from_cl([cut], [riffler.Tool.ball(diameter=6, length=30)], feed=600)
>>> program.write("part.ngc", post="linuxcnc-xyzac", options={"rot_point": (0, 0, 0)}).rewinds
[]
)");
}

}  // namespace riffler::bindings
