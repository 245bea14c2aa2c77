// riffler.verify, riffler.Verification and what they report.
#include <memory>

#include "bindings/one_caller.hpp"
#include "bindings/shared_report.hpp"
#include "bindings/task.hpp"
#include "dexel/from_mesh/from_mesh.hpp"
#include "nc/read/reader.hpp"

namespace riffler {

namespace {

struct SharedVerification : Guarded {
  explicit SharedVerification(std::unique_ptr<Verification> v) : verification(std::move(v)) {}
  std::unique_ptr<Verification> verification;
};

std::map<int, Tool> to_tools(const py::object& object) {
  std::map<int, Tool> out;
  if (object.is_none()) return out;
  if (!py::isinstance<py::dict>(object)) throw py::value_error("tools must be a dict: number to Tool");
  for (const auto& [key, value] : py::cast<py::dict>(object)) {
    if (!py::isinstance<py::int_>(key) || !py::isinstance<Tool>(value) || py::cast<long long>(key) < 0 ||
        py::cast<long long>(key) > std::numeric_limits<int>::max())
      throw py::value_error("tools must be a dict: number to Tool");
    out.emplace(py::cast<int>(key), py::cast<const Tool&>(value));
  }
  return out;
}

std::string fixture_name(std::size_t k) {
  return "fixtures, number " + std::to_string(k);
}

using Fixture = std::variant<Volume, std::shared_ptr<const Mesh>>;

std::vector<Fixture> to_fixtures(const py::object& object) {
  std::vector<Fixture> out;
  if (object.is_none()) return out;
  if (py::isinstance<SharedVolume>(object) || py::isinstance<Mesh>(object))
    throw py::value_error("fixtures must be a list of Volume or Mesh, not one of them");
  for (const py::handle& item : py::cast<py::iterable>(object)) {
    if (py::isinstance<SharedVolume>(item))
      out.push_back(Reading(py::cast<SharedVolume&>(item)).volume.snapshot());
    else if (py::isinstance<Mesh>(item))
      out.push_back(py::cast<std::shared_ptr<Mesh>>(item));
    else
      throw py::value_error(fixture_name(out.size()) + ": a Volume or a Mesh expected");
  }
  return out;
}

/// Volumes as they are; meshes at the stock's pitch.
std::vector<Volume> to_volumes(const std::vector<Fixture>& fixtures, double pitch, const Progress& progress) {
  std::vector<Volume> out;
  for (std::size_t k = 0; k < fixtures.size(); ++k) {
    if (const Volume* volume = std::get_if<Volume>(&fixtures[k])) {
      out.push_back(volume->snapshot());
      continue;
    }
    const Mesh& mesh = *std::get<std::shared_ptr<const Mesh>>(fixtures[k]);
    try {
      validate(mesh);
      const auto n = static_cast<double>(fixtures.size()), done = static_cast<double>(k);
      out.push_back(from_mesh(mesh, {bounds(mesh), pitch, "z"}, part(progress, done / n, (done + 1) / n)));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fixture_name(k) + ": " + error.what());
    }
  }
  return out;
}

}  // namespace

VerifyOptions to_verify_options(double tolerance, double gouge_tolerance, const std::optional<double>& rest_tolerance,
                                double rapid_feed, const std::optional<std::string>& machine,
                                const py::object& machine_options, const py::object& machine_frame) {
  VerifyOptions out{tolerance, gouge_tolerance, rest_tolerance, rapid_feed, {}};
  if (machine) out.machine = MachineChoice{*machine, without_reading(to_options(machine_options))};
  if (machine && !machine_frame.is_none())
    std::tie(out.machine->turn, out.machine->shift) = to_affine(machine_frame, "machine_frame");
  if (!machine && !machine_options.is_none()) throw py::value_error("machine_options: there is no machine");
  if (!machine && !machine_frame.is_none()) throw py::value_error("machine_frame: there is no machine");
  return out;
}

VerifyArguments to_verify_arguments(SharedVolume& stock, const py::object& part, const py::object& fixtures,
                                    const py::object& tools, const VerifyOptions& options) {
  std::shared_ptr<const Mesh> mesh;
  if (!part.is_none()) {
    if (!py::isinstance<Mesh>(part)) throw py::value_error("part_mesh must be a Mesh or None");
    mesh = py::cast<std::shared_ptr<Mesh>>(part);
  }
  return {Reading(stock).volume.snapshot(), std::move(mesh), to_fixtures(fixtures), to_tools(tools), options};
}

std::unique_ptr<Verification> make_verification(const VerifyArguments& a, const Progress& progress) {
  std::vector<Volume> fixtures = to_volumes(a.fixtures, a.stock.frame().pitch, part(progress, 0, 0.5));
  return std::make_unique<Verification>(a.stock, a.part, std::move(fixtures), a.tools, a.options,
                                        part(progress, 0.5, 1));
}

std::unique_ptr<Verification> make_verification_here(const VerifyArguments& arguments, const Progress& progress) {
  const NoGil release;
  return make_verification(arguments, progress);
}

std::shared_ptr<SharedReport> share(VerifyReport&& report) {
  return std::make_shared<SharedReport>(std::move(report));
}

namespace {

/// Chunk by chunk; of how many there are nothing is known, so progress is that of each.
VerifyReport run_stream(Verification& verification, const py::iterable& chunks, const Progress& progress) {
  VerifyStream stream(verification);
  for (const py::handle& item : chunks) {
    if (!py::isinstance<Program>(item)) throw py::value_error("program must be a Program or an iterable of Programs");
    const Program& chunk = py::cast<const Program&>(item);
    const NoGil release;
    stream.add(chunk, progress);
  }
  const NoGil release;
  return stream.finish(progress);
}

VerifyReport run_whole(Verification& verification, const Program& program, const Progress& progress) {
  VerifyStream stream(verification);
  stream.add(program, part(progress, 0, 0.9));
  return stream.finish(part(progress, 0.9, 1));
}

auto verify(const py::object& program, SharedVolume& stock, const py::object& part_mesh, const py::object& fixtures,
            const py::object& tools, double tolerance, double gouge_tolerance,
            const std::optional<double>& rest_tolerance, double rapid_feed, const std::optional<std::string>& machine,
            const py::object& machine_options, const py::object& machine_frame, const py::object& progress) {
  VerifyArguments arguments =
      to_verify_arguments(stock, part_mesh, fixtures, tools,
                          to_verify_options(tolerance, gouge_tolerance, rest_tolerance, rapid_feed, machine,
                                            machine_options, machine_frame));
  if (py::isinstance<Program>(program)) {
    const auto work = [arguments = std::move(arguments),
                       whole = py::cast<std::shared_ptr<Program>>(program)](const Progress& listener) {
      const auto verification = make_verification(arguments, part(listener, 0, 0.1));
      return run_whole(*verification, *whole, part(listener, 0.1, 1));
    };
    return long_call(progress, work, &share);
  }
  if (!py::isinstance<py::iterable>(program))
    throw py::value_error("program must be a Program or an iterable of Programs");
  if (is_task_request(progress)) throw py::value_error("program must be a Program for a Task, which runs no Python");
  const Progress listener = to_progress(progress);
  const auto verification = make_verification_here(arguments, part(listener, 0, 0.1));
  VerifyReport report =
      run_stream(*verification, py::reinterpret_borrow<py::iterable>(program), part(listener, 0.1, 1));
  return ValueOrTask<std::shared_ptr<SharedReport>>(py::cast(share(std::move(report))));
}

auto run(const std::shared_ptr<SharedVerification>& self, const std::shared_ptr<Program>& program,
         const py::object& progress) {
  const auto work = [self, program](const Progress& listener) {
    const OneCaller only(*self, "the verification");
    return self->verification->run(*program, listener);
  };
  return long_call(progress, work, &share);
}

py::object made_deviation(const VerifyReport& report) {
  const Progress listener = to_progress(py::none());
  std::pair<Mesh, std::vector<double>> found;
  {
    const NoGil release;
    found = deviation_of(report.volume, *report.part, listener);
  }
  return py::make_tuple(std::make_shared<Mesh>(std::move(found.first)), take<double>(std::move(found.second)));
}

py::object deviation(SharedReport& self) {
  if (!self.report.part) return py::none();
  return self.deviation.get([&] { return made_deviation(self.report); });
}

py::object made_part_map(SharedReport& self) {
  const auto left = py::cast<std::shared_ptr<Mesh>>(py::tuple(deviation(self))[0]);
  std::vector<double> found;
  {
    const NoGil release;
    found = part_map_of(*left, *self.report.part);
  }
  return take<double>(std::move(found));
}

py::object part_map(SharedReport& self) {
  if (!self.report.part) return py::none();
  return self.part_map.get([&] { return made_part_map(self); });
}

py::array_t<double> rate(const SharedReport& self) {
  const VerifyReport& r = self.report;
  std::vector<double> out(r.removed.size());
  for (std::size_t row = 0; row < out.size(); ++row)
    out[row] = r.seconds[row] > 0 ? 60 * r.removed[row] / r.seconds[row] : 0;
  return take<double>(std::move(out));
}

double total_time(const VerifyReport& report) {
  double sum = 0;
  for (const double s : report.seconds) sum += s;
  return sum;
}

const char* member_name(const Finding& f) {
  static constexpr const char* names[] = {"cutter", "shank", "holder", "beyond"};
  return names[static_cast<int>(f.member)];
}

py::dict to_dict(const Finding& f) {
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

py::dict to_dict(const VerifyStats& s) {
  py::dict d;
  d["moves"] = s.moves, d["slabs"] = s.slabs, d["slabs_kept"] = s.slabs_kept;
  d["snapshots_used"] = s.snapshots_used, d["probes"] = s.probes, d["probed_moves"] = s.probed_moves;
  d["bisections"] = s.bisections, d["skipped"] = s.skipped;
  return d;
}

py::dict to_dict(const SharedReport& self) {
  const VerifyReport& r = self.report;
  py::dict d;
  py::list findings;
  for (const Finding& f : r.findings) findings.append(to_dict(f));
  d["passed"] = r.passed(), d["findings"] = findings, d["not_checked"] = r.not_checked;
  d["rows"] = r.removed.size(), d["time"] = total_time(r), d["volume"] = r.volume.volume();
  double sum = 0;
  for (const double taken : r.removed) sum += taken;
  d["removed"] = sum;
  d["stats"] = to_dict(r.stats);
  return d;
}

void bind_report(py::module_& m) {
  py::class_<Finding>(m, "Finding", "One fault: neighbouring rows of a program with the same kind, tool and fixture.")
      .def_property_readonly(
          "kind", [](const Finding& f) { return name_of(f.kind); },
          R"("rapid", "holder", "shank", "fixture", "gouge", "rest", "spindle" (a feed move into material with a spindle
that stands), "machine" (the machine cannot hold the row) or "unknown" (it could not be checked).)")
      .def_readonly("row", &Finding::row, "First row; the move that ends there.")
      .def_readonly("last_row", &Finding::last_row)
      .def_readonly("line", &Finding::line, "Source line of the first row from 1; 0: no source.")
      .def_readonly("last_line", &Finding::last_line)
      .def_readonly("tool", &Finding::tool, "Tool number.")
      .def_property_readonly("member", &member_name,
                             "What of the tool it was: cutter, shank, holder, or beyond where its description ends.")
      .def_property_readonly(
          "fixture", [](const Finding& f) { return f.fixture < 0 ? std::optional<int>() : f.fixture; },
          "Which of the fixtures it was, from 0, or None.")
      .def_readonly(
          "value", &Finding::value,
          R"(How much, in ``unit``. rapid, spindle: mm³ that all rows took. holder, shank, fixture, unknown: mm³ in
the way of the worst row (where a slab of the stock has been hit 256 times, only one further hit in sixteen is measured).
gouge, rest: mm under or over the part's surface.)")
      .def_property_readonly("unit", &Finding::unit)
      .def_property_readonly(
          "point", [](const Finding& f) { return from_vec3(f.point); }, "(3,) mm: the worst place, part coordinates.")
      .def_readonly("message", &Finding::message, "One sentence: what happened and what to do.")
      .def("to_dict", [](const Finding& f) { return to_dict(f); })
      .def("__repr__", [](const Finding& f) {
        return "<riffler.Finding " + std::string(name_of(f.kind)) + ", rows " + std::to_string(f.row) + " to " +
               std::to_string(f.last_row) + ": " + f.message + ">";
      });

  py::class_<SharedReport, std::shared_ptr<SharedReport>>(m, "VerifyReport", "What a verification found.")
      .def_property_readonly(
          "passed", [](const SharedReport& r) { return r.report.passed(); },
          "True only where every check that was asked for could be made and found nothing.")
      .def_property_readonly(
          "findings", [](const SharedReport& r) { return r.report.findings; }, "list of Finding, by rows.")
      .def_property_readonly(
          "not_checked", [](const SharedReport& r) { return r.report.not_checked; },
          "list of sentences: what was not asked for, so does not fail.")
      .def_property_readonly(
          "removed", [](const SharedReport& r) { return take<double>(std::vector<double>(r.report.removed)); },
          "(n,) mm³ that each row's move took; row 0: 0.")
      .def_property_readonly(
          "seconds", [](const SharedReport& r) { return take<double>(std::vector<double>(r.report.seconds)); },
          R"((n,) s: the tip's way at its feed, rapids at ``rapid_feed``; where the tip stands still, the axis' angle at
3600 deg/min. Acceleration and tool changes are left out.)")
      .def_property_readonly("rate", &rate, "(n,) mm³/min; 0 where a move takes no time.")
      .def_property_readonly(
          "time", [](const SharedReport& r) { return total_time(r.report); }, "s, all rows.")
      .def_property_readonly(
          "volume", [](const SharedReport& r) { return std::make_shared<SharedVolume>(r.report.volume.snapshot()); },
          "The Volume that is left.")
      .def_property_readonly(
          "deviation", &deviation,
          R"((mesh of what is left, (vertices,) mm) or None without a part; made when first asked for.

Distance of each vertex from the part's surface: positive where rest material stands on it, negative in gouges.)")
      .def_property_readonly("part_map", &part_map,
                             R"((vertices of the part,) mm, or None without a part; made when first asked for.

Distance of each vertex of the part from the surface of what is left: positive where material covers it, negative where
it is missing, -inf where nothing is left at all.)")
      .def_property_readonly(
          "stats", [](const SharedReport& r) { return to_dict(r.report.stats); },
          R"(dict of operation counts: ``moves``, (move, slab) pairs cut; ``slabs`` simulated; ``slabs_kept``, whose results
of the run before were taken; ``snapshots_used``; ``probes``, batches tried with shank and holder or on a fixture, and
``probed_moves`` in them; ``bisections`` of such batches; ``skipped``, (move, slab) pairs told apart by boxes alone.)")
      .def(
          "to_dict", [](const SharedReport& r) { return to_dict(r); },
          "For JSON: passed, findings, not_checked, rows, time, volume, removed (mm³ in sum), stats.")
      .def("__repr__", [](const SharedReport& r) {
        const std::size_t n = r.report.findings.size();
        return "<riffler.VerifyReport: " + std::to_string(r.report.removed.size()) + " rows, " +
               (n == 0 ? std::string("passed") : std::to_string(n) + (n == 1 ? " finding" : " findings")) + ">";
      });
}

}  // namespace

void bind_verify(py::module_& m) {
  bind_report(m);
  m.def("verify", &verify, py::arg("program"), py::arg("stock_volume"), py::arg("part_mesh") = py::none(),
        py::arg("fixtures") = py::tuple(), py::kw_only(), py::arg("tools") = py::none(), py::arg("tolerance") = 0.01,
        py::arg("gouge_tolerance") = 0.05, py::arg("rest_tolerance") = py::none(), py::arg("rapid_feed") = 10000.0,
        py::arg("machine") = py::none(), py::arg("machine_options") = py::none(), py::arg("machine_frame") = py::none(),
        py::arg("progress") = py::none(),
        R"(Runs a program on a stock and reports what goes wrong; the stock is not changed.

``program``: a Program, or an iterable of Programs, each of which begins with the row at which the one before ended;
nothing is kept of them but 16 bytes a row. ``part_mesh``: Mesh, for gouges and rest material. ``fixtures``: list of
Volume or Mesh (which becomes a Volume at the stock's pitch). ``tools``: dict of number to Tool, before the program's own.

``tolerance`` (mm): of cutting, as in Volume.carve; contact that is less deep is none. ``gouge_tolerance`` (mm): what is
taken from the part deeper under its surface is a gouge. ``rest_tolerance`` (mm): what stands higher on the part is a
finding; None: rest material is mapped, not judged. ``rapid_feed``: mm/min, for the time. ``machine``: a name of
machines() on which it is to run, with ``machine_options`` (those of reading are passed over): the first row that its axes or their limits cannot hold is a
finding "machine". ``machine_frame``: (4, 4), from the coordinates of stock and program to those in which the machine has the
program, where they are others.

Rapids are cut too: a crash takes material. Shank and holder must stay clear of what is left of the stock when they come
there, the whole tool of the fixtures. Where the description of a tool ends below material or a fixture that stands above
or beside it, nobody knows what the spindle meets: a finding "unknown". ValueError naming number, row and line of a tool
whose shape is not known. ``progress``: called with the finished share, of each chunk anew; returning False cancels.)");
  py::class_<SharedVerification, std::shared_ptr<SharedVerification>>(
      m, "Verification",
      R"(Verifies a program again and again while it is edited.

Arguments are those of ``verify``. ``run`` of a program that is like the one before does again only what differs: rows
before the first difference come from snapshots, and parts of the stock that no differing move can touch stay as they
are. The report is that of a fresh run, bit for bit.)")
      .def(py::init([](SharedVolume& stock, const py::object& part_mesh, const py::object& fixtures,
                       const py::object& tools, double tolerance, double gouge_tolerance,
                       const std::optional<double>& rest_tolerance, double rapid_feed,
                       const std::optional<std::string>& machine, const py::object& machine_options,
                       const py::object& machine_frame, const py::object& progress) {
             const VerifyArguments arguments =
                 to_verify_arguments(stock, part_mesh, fixtures, tools,
                                     to_verify_options(tolerance, gouge_tolerance, rest_tolerance, rapid_feed, machine,
                                                       machine_options, machine_frame));
             return std::make_shared<SharedVerification>(make_verification_here(arguments, to_progress(progress)));
           }),
           py::arg("stock_volume"), py::arg("part_mesh") = py::none(), py::arg("fixtures") = py::tuple(), py::kw_only(),
           py::arg("tools") = py::none(), py::arg("tolerance") = 0.01, py::arg("gouge_tolerance") = 0.05,
           py::arg("rest_tolerance") = py::none(), py::arg("rapid_feed") = 10000.0, py::arg("machine") = py::none(),
           py::arg("machine_options") = py::none(), py::arg("machine_frame") = py::none(),
           py::arg("progress") = py::none())
      .def("run", &run, py::arg("program").none(false), py::arg("progress") = py::none(),
           "The VerifyReport of a Program. After an error or Cancelled this is as it was before the call.");
}

}  // namespace riffler
