// riffler.verify, riffler.Verification and what they report.
#include <memory>

#include "bindings/one_caller.hpp"
#include "bindings/shared_report.hpp"
#include "bindings/task.hpp"
#include "bindings/verify_arguments.hpp"
#include "riffler/verify/verification.hpp"
#include "verify/slab_run.hpp"

namespace riffler::bindings {

namespace {

struct SharedVerification : Guarded {
  SharedVerification(verify::VerifyArguments arguments, const Progress& progress)
      : verification(std::move(arguments), progress) {}
  verify::Verification verification;
};

/// Chunk by chunk; of how many there are nothing is known, so progress is that of each.
verify::VerifyReport run_stream(verify::SlabRun& run, const py::iterable& chunks, const Progress& progress) {
  for (const py::handle& item : chunks) {
    if (!py::isinstance<nc::Program>(item))
      throw py::value_error("program must be a Program or an iterable of Programs");
    const nc::Program& chunk = py::cast<const nc::Program&>(item);
    const NoGil release;
    run.feed(chunk, progress);
  }
  const NoGil release;
  return run.finish(progress);
}

verify::VerifyReport run_whole(verify::SlabRun& run, const nc::Program& program, const Progress& progress) {
  run.feed(program, base::part(progress, 0, 0.9));
  return run.finish(base::part(progress, 0.9, 1));
}

/// The engine, in the first tenth of the progress.
std::unique_ptr<verify::SlabRun> make_run(const GivenArguments& given, const Progress& progress) {
  return std::make_unique<verify::SlabRun>(to_arguments(given, base::part(progress, 0, 0.05)),
                                           base::part(progress, 0.05, 0.1));
}

auto verify(const ProgramLike& program, GivenArguments given, const ProgressLike& progress) {
  if (py::isinstance<nc::Program>(program)) {
    const auto work = [given = std::move(given),
                       whole = py::cast<std::shared_ptr<nc::Program>>(program)](const Progress& listener) {
      return run_whole(*make_run(given, listener), *whole, base::part(listener, 0.1, 1));
    };
    return long_call(progress, work, &share);
  }
  if (!py::isinstance<py::iterable>(program))
    throw py::value_error("program must be a Program or an iterable of Programs");
  if (is_task_request(progress)) {
    PyErr_SetString(task_refusal(), "program must be a Program for a native task, which runs no Python");
    throw py::error_already_set();
  }
  const Progress listener = to_progress(progress);
  std::unique_ptr<verify::SlabRun> run;
  {
    const NoGil release;
    run = make_run(given, listener);
  }
  verify::VerifyReport report =
      run_stream(*run, py::reinterpret_borrow<py::iterable>(program), base::part(listener, 0.1, 1));
  return ValueOrTask<std::shared_ptr<SharedReport>>(py::cast(share(std::move(report))));
}

auto run(const std::shared_ptr<SharedVerification>& self, const std::shared_ptr<nc::Program>& program,
         const ProgressLike& progress) {
  const auto work = [self, program](const Progress& listener) {
    const OneCaller only(*self, "the verification");
    return self->verification.run(*program, listener);
  };
  return long_call(progress, work, &share);
}

py::object made_deviation(const verify::VerifyReport& report) {
  const Progress listener = to_progress(py::none());
  std::pair<Mesh, std::vector<double>> found;
  {
    const NoGil release;
    found = verify::deviation_of(report.volume, *report.part, listener);
  }
  return py::make_tuple(std::make_shared<Mesh>(std::move(found.first)), take<double>(std::move(found.second)));
}

OptionalDeviation stock_deviation(SharedReport& self) {
  if (!self.report.part) return py::none();
  return self.stock_deviation.get([&] { return made_deviation(self.report); });
}

py::object made_part_deviation(SharedReport& self) {
  const auto left = py::cast<std::shared_ptr<Mesh>>(py::tuple(stock_deviation(self))[0]);
  std::vector<double> found;
  {
    const NoGil release;
    found = verify::part_map_of(*left, *self.report.part);
  }
  return take<double>(std::move(found));
}

OptionalArray part_deviation(SharedReport& self) {
  if (!self.report.part) return py::none();
  return self.part_deviation.get([&] { return made_part_deviation(self); });
}

py::array_t<double> rate(const SharedReport& self) {
  const verify::VerifyReport& r = self.report;
  std::vector<double> out(r.removed.size());
  for (std::size_t row = 0; row < out.size(); ++row)
    out[row] = r.seconds[row] > 0 ? 60 * r.removed[row] / r.seconds[row] : 0;
  return take<double>(std::move(out));
}

double total_time(const verify::VerifyReport& report) {
  double sum = 0;
  for (const double s : report.seconds) sum += s;
  return sum;
}

const char* member_name(const verify::Finding& f) {
  static constexpr const char* names[] = {"cutter", "shank", "holder", "beyond"};
  return names[static_cast<int>(f.member)];
}

py::dict to_dict(const verify::Finding& f) {
  py::dict d;
  d["kind"] = name_of(f.kind), d["row"] = f.row, d["last_row"] = f.last_row, d["line"] = f.line;
  d["last_line"] = f.last_line, d["tool"] = f.tool, d["value"] = f.value, d["unit"] = f.unit();
  d["point"] = py::make_tuple(f.point.x, f.point.y, f.point.z);
  if (f.fixture >= 0)
    d["fixture"] = f.fixture;
  else
    d["fixture"] = py::none();
  d["message"] = f.message;
  return d;
}

py::dict to_dict(const verify::VerifyStats& s) {
  py::dict d;
  d["moves"] = s.moves, d["slabs"] = s.slabs, d["slabs_kept"] = s.slabs_kept;
  d["snapshots_used"] = s.snapshots_used, d["probes"] = s.probes, d["probed_moves"] = s.probed_moves;
  d["bisections"] = s.bisections, d["skipped"] = s.skipped;
  return d;
}

py::dict to_dict(const SharedReport& self) {
  const verify::VerifyReport& r = self.report;
  py::dict d;
  py::list findings;
  for (const verify::Finding& f : r.findings) findings.append(to_dict(f));
  d["passed"] = r.passed(), d["findings"] = findings, d["not_checked"] = r.not_checked;
  d["rows"] = r.removed.size(), d["time"] = total_time(r), d["volume"] = r.volume.volume();
  double sum = 0;
  for (const double taken : r.removed) sum += taken;
  d["removed"] = sum;
  d["stats"] = to_dict(r.stats);
  return d;
}

void bind_finding(py::module_& m) {
  py::class_<verify::Finding>(
      m, "Finding", "One fault, neighbouring rows of a program with the same kind, tool and fixture: see `verify`.")
      .def_property_readonly(
          "kind", [](const verify::Finding& f) { return name_of(f.kind); },
          R"("rapid", "holder", "shank", "fixture", "gouge", "rest", "spindle" (a feed move into material with a spindle
that stands), "machine" (the machine cannot hold the row) or "unknown" (it could not be checked).)")
      .def_readonly("row", &verify::Finding::row, "First row; the move that ends there.")
      .def_readonly("last_row", &verify::Finding::last_row, "Last row.")
      .def_readonly("line", &verify::Finding::line, "Source line of the first row from 1; 0: no source.")
      .def_readonly("last_line", &verify::Finding::last_line, "Source line of the last row.")
      .def_readonly("tool", &verify::Finding::tool, "Tool number.")
      .def_property_readonly("member", &member_name,
                             "Piece of the tool: cutter, shank, holder, or beyond where its description ends.")
      .def_property_readonly(
          "fixture", [](const verify::Finding& f) { return f.fixture < 0 ? std::optional<int>() : f.fixture; },
          "Number of the fixture, from 0, or None.")
      .def_readonly(
          "value", &verify::Finding::value,
          R"(How much, in ``unit``. rapid, spindle: mm³ that all rows took. holder, shank, fixture, unknown: mm³ in
the way of the worst row (where a slab of the stock has been hit 256 times, only one further hit in sixteen is measured).
gouge, rest: mm under or over the part's surface.)")
      .def_property_readonly("unit", &verify::Finding::unit, "Unit of ``value``.")
      .def_property_readonly(
          "point", [](const verify::Finding& f) { return from_vec3(f.point); },
          "(3,) mm: the worst place, part coordinates.")
      .def_readonly("message", &verify::Finding::message, "A sentence with the fault and the remedy.")
      .def(
          "to_dict", [](const verify::Finding& f) { return to_dict(f); },
          R"(For JSON: all attributes.

Returns
-------
dict

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> ball = riffler.Tool.ball(diameter=6, length=30)
>>> program = riffler.Program([(0, 0, 8, 0, 0, 1), (20, 20, 8, 0, 0, 1)], 0, rapid=True, tools={1: ball})
>>> riffler.verify(program, stock).findings[0].to_dict()["kind"]
'rapid'
)")
      .def("__repr__", [](const verify::Finding& f) {
        return "<riffler.Finding " + std::string(name_of(f.kind)) + ", rows " + std::to_string(f.row) + " to " +
               std::to_string(f.last_row) + ": " + f.message + ">";
      });
}

void bind_report(py::module_& m) {
  py::class_<SharedReport, std::shared_ptr<SharedReport>>(m, "VerifyReport",
                                                          "The result of a verification: see `verify`.")
      .def_property_readonly(
          "passed", [](const SharedReport& r) { return r.report.passed(); },
          "True only if every requested check could be made and found nothing.")
      .def_property_readonly(
          "findings", [](const SharedReport& r) { return r.report.findings; }, "The faults, by rows.")
      .def_property_readonly(
          "not_checked", [](const SharedReport& r) { return r.report.not_checked; },
          "Sentences on checks that were not requested and so cannot fail.")
      .def_property_readonly(
          "removed", [](const SharedReport& r) { return take<double>(std::vector<double>(r.report.removed)); },
          "(n,) mm³ that each row's move took; row 0: 0.")
      .def_property_readonly(
          "seconds", [](const SharedReport& r) { return take<double>(std::vector<double>(r.report.seconds)); },
          R"((n,) s: the tip's travel at its feed, rapids at ``rapid_feed``; where the tip stands still, the axis' angle at
3600 deg/min. Acceleration and tool changes are left out.)")
      .def_property_readonly("rate", &rate, "(n,) mm³/min; 0 where a move takes no time.")
      .def_property_readonly(
          "time", [](const SharedReport& r) { return total_time(r.report); }, "s, all rows.")
      .def_property_readonly(
          "volume", [](const SharedReport& r) { return std::make_shared<SharedVolume>(r.report.volume.snapshot()); },
          "The material that is left.")
      .def(
          "stock_deviation", &stock_deviation,
          R"(Mesh of the remaining stock, and its distances from the part. Computed at the first call; later calls return the same.

Returns
-------
tuple of Mesh and ndarray, shape (vertices,), or None
    The remaining stock, and mm from each of its vertices to the part's surface: positive in rest material,
    negative in gouges. None without a part.

Examples
--------
>>> stock = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz")
>>> program = riffler.Program([[10, 10, 20, 0, 0, 1]], feed=600)
>>> report = riffler.verify(program, stock, part_mesh=stock.to_mesh())
>>> mesh, distance = report.stock_deviation()
>>> bool(abs(distance).max() < 1e-6)
True
)")
      .def(
          "part_deviation", &part_deviation,
          R"(Distance of the part's vertices from the remaining stock. Computed at the first call; later calls return the same.

Returns
-------
ndarray, shape (vertices,), or None
    mm from each vertex of the part to the surface of the remaining stock: positive where material covers it, negative where it
    is missing, -inf where nothing is left at all. None without a part.

Examples
--------
>>> stock = riffler.Volume.block((0, 0, 0), (20, 20, 10), pitch=0.5, directions="xyz")
>>> program = riffler.Program([[10, 10, 20, 0, 0, 1]], feed=600)
>>> report = riffler.verify(program, stock, part_mesh=stock.to_mesh())
>>> bool(abs(report.part_deviation()).max() < 1e-6)
True
)")
      .def_property_readonly(
          "stats",
          [](const SharedReport& r) -> VerifyCounters {
            return program_result("VerifyStats", to_dict(r.report.stats));
          },
          "Operation counts.")
      .def(
          "to_dict", [](const SharedReport& r) { return to_dict(r); },
          R"(For JSON: passed, findings, not_checked, rows, time, volume, removed (mm³ in sum), stats.

Returns
-------
dict

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> ball = riffler.Tool.ball(diameter=6, length=30)
>>> program = riffler.Program([(0, 0, 8, 0, 0, 1), (20, 20, 8, 0, 0, 1)], 600, spindle=9000, tools={1: ball})
>>> riffler.verify(program, stock).to_dict()["rows"]
2
)")
      .def("__repr__", [](const SharedReport& r) {
        const std::size_t n = r.report.findings.size();
        return "<riffler.VerifyReport: " + std::to_string(r.report.removed.size()) + " rows, " +
               (n == 0 ? std::string("passed") : std::to_string(n) + (n == 1 ? " finding" : " findings")) + ">";
      });
}

/// The arguments that verify and Verification share.
constexpr const char* kParameters = R"(stock_volume : Volume
    Not changed.
part_mesh : Mesh, optional
    For gouges and rest material.
fixtures : list of Volume or Mesh
    Volumes or meshes that the whole tool must stay clear of; a Mesh becomes a Volume at the stock's pitch.
tools : dict, optional
    Number to Tool; takes the place of the program's own.
tolerance : float
    mm, of cutting, as in ``Volume.carve``; shallower contact does not count.
gouge_tolerance : float
    mm under the part's surface from which removed material is a gouge.
rest_tolerance : float, optional
    mm over the part's surface from which material is a finding; None: rest material is mapped, not judged.
rapid_feed : float
    mm/min, for the time.
machine : str, optional
    A name of ``machines`` on which the program is to run: the first row that its axes or their limits cannot hold is a
    finding "machine".
machine_options : dict, optional
    Options of the machine; those of reading are ignored.
machine_frame : array_like, shape (4, 4), optional
    Transform from the coordinates of stock and program to those of the program on the machine, if they differ.
progress : callable, optional
    Called with the finished share, from 0 for each chunk; returning False cancels.
)";

}  // namespace

std::shared_ptr<SharedReport> share(verify::VerifyReport&& report) {
  return std::make_shared<SharedReport>(std::move(report));
}

void bind_verify(py::module_& m) {
  bind_finding(m);
  bind_report(m);
  define_with_arguments([&](const auto&... arguments) {
    m.def("verify", with_arguments<ProgramLike>(&verify), py::arg("program"), arguments...,
          (std::string(R"(Runs a program on a stock and reports faults. The stock is not changed.

Rapids remove material too, as a crash would. Shank and holder must stay clear of the remaining stock when they come
there, the whole tool of the fixtures. If the description of a tool ends below material or a fixture above
or next to it, collisions of the spindle are unknown: a finding "unknown".

Parameters
----------
program : Program, or an iterable of Programs
    Each of several begins with the row at which the one before ended; only 16 bytes a row of them are kept.
)") + kParameters +
           R"(
Returns
-------
VerifyReport

Raises
------
ValueError
    Naming number, row and line of a tool of unknown shape.

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> ball = riffler.Tool.ball(diameter=6, length=30)
>>> cut = [(5, 10, 8, 0, 0, 1), (15, 10, 8, 0, 0, 1)]
>>> program = riffler.Program.from_cl([cut], [ball], feed=600, spindle=9000)
>>> riffler.verify(program, stock).findings
[]
)")
              .c_str());
  });
  py::class_<SharedVerification, std::shared_ptr<SharedVerification>> verification(
      m, "Verification",
      (std::string(R"(Verifies a program again and again while it is edited.

``run`` of a program that is like the one before repeats only what differs: rows before the first difference come from
snapshots, and parts of the stock that no differing move can touch stay unchanged. The report is that of a fresh run, bit
for bit.

Parameters
----------
)") + kParameters +
       R"(
Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> ball = riffler.Tool.ball(diameter=6, length=30)
>>> verification = riffler.Verification(stock, tools={1: ball})
>>> cut = [(5, 10, 8, 0, 0, 1), (15, 10, 8, 0, 0, 1)]
>>> verification.run(riffler.Program.from_cl([cut], [ball], feed=600, spindle=9000)).findings
[]
)")
          .c_str());
  define_with_arguments([&](const auto&... arguments) {
    verification.def(py::init(with_arguments<>([](const GivenArguments& given, const ProgressLike& progress) {
                       return std::shared_ptr<SharedVerification>(make_of<SharedVerification>(given, progress));
                     })),
                     arguments...);
  });
  verification.def("run", &run, py::arg("program").none(false), py::kw_only(), py::arg("progress") = py::none(),
                   R"(Verifies a program. After an error or Cancelled the object is unchanged.

Parameters
----------
program : Program
    The program.
progress : callable, optional
    Called with the finished share; returning False cancels.

Returns
-------
VerifyReport

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> ball = riffler.Tool.ball(diameter=6, length=30)
>>> program = riffler.Program.from_cl([[(5, 10, 8, 0, 0, 1)]], [ball], feed=600, spindle=9000)
>>> riffler.Verification(stock).run(program).findings
[]
)");
}

}  // namespace riffler::bindings
