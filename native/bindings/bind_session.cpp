// riffler.Session, riffler.Material
#include <memory>

#include "bindings/bindings.hpp"
#include "bindings/one_caller.hpp"
#include "bindings/shared_volume.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/haptics/material.hpp"
#include "riffler/pen/pointer.hpp"
#include "riffler/session/journal_sink.hpp"
#include "riffler/session/session.hpp"

namespace riffler::bindings {

namespace {

using namespace py::literals;
/// Rows of the ticks of a frame, as arrays.
struct FrameView {
  session::SessionFrame frame;
  session::SculptTick last;  // the newest that there was

  template <class Get>
  py::array_t<double> column(const Get& get) const {
    std::vector<double> out;
    out.reserve(frame.ticks.size());
    for (const session::SculptTick& tick : frame.ticks) out.push_back(get(tick));
    return take<double>(std::move(out));
  }
  template <class Get>
  py::array_t<double> poses(const Get& get) const {
    std::vector<Pose> out;
    out.reserve(frame.ticks.size());
    for (const session::SculptTick& tick : frame.ticks) out.push_back(get(tick));
    return take<double>(std::move(out), 6);
  }
  template <class Get>
  py::array_t<double> wrenches(const Get& get) const {
    std::vector<Wrench> out;
    out.reserve(frame.ticks.size());
    for (const session::SculptTick& tick : frame.ticks) out.push_back(get(tick));
    return take<double>(std::move(out), 6);
  }
};

/// A session with what it uses, which Python may have let go.
struct SharedSession : Guarded {
  std::shared_ptr<SharedVolume> volume;
  std::shared_ptr<pen::Pen> pen;
  py::object collider;
  Tool tool;
  sweep::MoveCarver::Options carving;
  sweep::CarveMode mode;
  std::optional<Volume> mask{};
  std::shared_ptr<session::JournalSink> sink;
  std::unique_ptr<session::Session> session;
  session::SculptTick last{};

  SharedSession(std::shared_ptr<SharedVolume> v, std::shared_ptr<pen::Pen> p, py::object c, const Tool& t,
                const session::SessionSettings& settings)
      : volume(std::move(v)),
        pen(std::move(p)),
        collider(std::move(c)),
        tool(t),
        carving(settings.loop.carving),
        mode(settings.mode) {}
  ~SharedSession() {
    const NoGil release;  // the thread of the device may be waiting for it
    session.reset();
    if (sink) sink->close();
  }
};

/// One call at a time, and the volume is the session's meanwhile.
struct Using {
  explicit Using(SharedSession& s) : only(s, "the session"), writing(*s.volume), volume(writing.volume) {}
  OneCaller only;
  Writing writing;
  Volume& volume;
};

Mat3 to_turn(const py::object& turn) {
  if (turn.is_none()) return Mat3(1);
  const auto rows = Doubles::ensure(turn);
  if (!rows || rows.ndim() != 2 || rows.shape(0) != 3 || rows.shape(1) != 3) {
    PyErr_Clear();
    throw py::value_error("turn must have the shape (3, 3)");
  }
  Mat3 out;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[j][i] = rows.at(i, j);
  return out;
}

std::optional<Pose> to_pose(const py::object& at) {
  if (at.is_none()) return std::nullopt;
  const auto row = Doubles::ensure(at);
  if (!row || row.ndim() != 1 || row.size() != 6) {
    PyErr_Clear();
    throw py::value_error("at must be six numbers: tip and axis");
  }
  Pose pose{{row.at(0), row.at(1), row.at(2)}, {row.at(3), row.at(4), row.at(5)}};
  const double length = glm::length(pose.axis);
  if (!(length > 0) || !std::isfinite(length)) throw py::value_error("at: the axis must be finite, not zero");
  pose.axis /= length;
  return pose;
}

struct Options {
  session::SessionSettings settings;

  void read(const py::kwargs& given) {
    session::SculptLoopSettings& loop = settings.loop;
    haptics::CouplingSettings& coupling = loop.sculpt.coupling;
    const auto number = [](const char* name, double& to) { return std::pair<const char*, double*>(name, &to); };
    const std::pair<const char*, double*> numbers[] = {
        number("stiffness", coupling.stiffness),
        number("turn_stiffness", coupling.turn_stiffness),
        number("damping", coupling.damping),
        number("turn_damping", coupling.turn_damping),
        number("tolerance", loop.carving.tolerance),
        number("scale", loop.workspace.scale),
        number("max_force", loop.limits.wrench.linear),
        number("max_torque", loop.limits.wrench.angular),
        number("max_power", loop.limits.power),
        number("ramp", loop.safety.ramp),
    };
    for (const auto& [key, value] : given) {
      const auto name = py::cast<std::string>(key);
      const auto* found =
          std::find_if(std::begin(numbers), std::end(numbers), [&](auto& n) { return name == n.first; });
      if (found != std::end(numbers))
        *found->second = as_number(name, value);
      else
        read_other(name, py::reinterpret_borrow<py::object>(value));
    }
    loop.wrench_extrapolator.most = loop.limits.wrench;
    settings.validate();
  }

  static double as_number(const std::string& name, const py::handle& value) {
    try {
      return py::cast<double>(value);
    } catch (const py::cast_error&) {
      throw py::type_error(name + " must be a number");
    }
  }

  void read_other(const std::string& name, const py::object& value) {
    session::SculptLoopSettings& loop = settings.loop;
    if (name == "material") {
      const haptics::Material& material = py::cast<const haptics::Material&>(value);
      material.validate("the stock");
      loop.carving.removal_constant = material.removal_constant, loop.sculpt.damping = material.damping;
    } else if (name == "at") {
      settings.start = to_pose(value);
    } else if (name == "turn") {
      loop.workspace.turn = to_turn(value);
    } else if (name == "dead_man_mask") {
      loop.workspace.dead_man_mask = py::cast<std::uint32_t>(value);
    } else if (name == "clutch_mask") {
      loop.workspace.clutch_mask = py::cast<std::uint32_t>(value);
    } else if (name == "budget") {
      loop.sculpt.budget = value.is_none() ? std::nullopt : std::optional(as_number(name, value));
    } else if (name == "memory") {
      loop.sculpt.memory = value.is_none() ? std::nullopt : std::optional(as_number(name, value));
    } else if (name == "undo") {
      settings.undo = py::cast<std::size_t>(value);
    } else {
      throw py::type_error("Session has no option \"" + name + "\"");
    }
  }
};

sweep::CarveMode to_mode(const std::string& mode) {
  if (mode == "remove") return sweep::CarveMode::Remove;
  if (mode == "add") return sweep::CarveMode::Add;
  throw py::value_error("mode must be \"remove\" or \"add\", not \"" + mode + '"');
}

std::unique_ptr<SharedSession> make(const std::shared_ptr<SharedVolume>& volume, const Tool& tool,
                                    std::shared_ptr<pen::Pen> pen, const py::object& obstacles, SharedVolume* protect,
                                    const std::string& mode, const py::kwargs& given) {
  if (!volume) throw py::type_error("volume: None");
  if (!pen) pen = std::make_shared<pen::PointerPen>(pen::PointerPen::Kind::Mouse);
  Options options;
  options.settings.loop.passivity = pen->passivity();
  if (pen->capability().has_force()) options.settings.loop.sculpt.budget = 4e-4;
  options.read(given);
  options.settings.mode = to_mode(mode);
  // Python's collider is immutable, and kept by the object.
  const collide::Collider* collider = obstacles.is_none() ? nullptr : py::cast<const collide::Collider*>(obstacles);
  auto out = std::make_unique<SharedSession>(volume, pen, obstacles, tool, options.settings);
  const Volume state = Reading(*volume).volume.snapshot();
  if (protect) out->mask = Reading(*protect).volume.snapshot();
  out->session = std::make_unique<session::Session>(
      state, tool, std::move(pen), std::shared_ptr<const collide::Collider>(std::shared_ptr<void>(), collider),
      options.settings, out->mask ? &*out->mask : nullptr);
  return out;
}

/// Of all its strokes.
session::StrokeMode stroke_mode(const SharedSession& self) {
  if (self.mode == sweep::CarveMode::Add) return session::StrokeMode::Build;
  return self.mask ? session::StrokeMode::Beside : session::StrokeMode::Remove;
}

/// Stock and tool stand at the journal's beginning; every stroke follows as it is made.
void record(SharedSession& self, const std::filesystem::path& path, const py::dict& notes) {
  const Using use(self);
  if (self.sink) throw std::runtime_error("the session has a journal already");
  const auto beside = [&](const char* end) {
    std::filesystem::path p = path;
    return p.replace_extension().concat(end);
  };
  const std::filesystem::path snapshot = beside("-stock.rvol"), mask = beside("-mask.rvol");
  for (const std::filesystem::path& p : {path, snapshot, mask})
    if (std::filesystem::exists(p))
      throw py::value_error(p.filename().string() + " is there already: take another name, or move it away");
  save(use.volume, snapshot);
  if (self.mask) save(*self.mask, mask);
  auto writer = std::make_unique<session::JournalWriter>(path, session::JournalWriter::Keep::Rules);
  const dexel::Frame& frame = use.volume.frame();
  for (const auto& [key, value] : notes) writer->add_note(py::cast<std::string>(key), py::cast<std::string>(value));
  writer->set_stock({frame.box, frame.pitch, frame.directions, snapshot.filename().string(),
                     self.mask ? mask.filename().string() : ""});
  writer->add_tool(1, tool_json(py::cast(self.tool)));
  writer->sync();
  session::JournalStreamOptions options;
  options.mode = stroke_mode(self);
  auto sink = std::make_shared<session::JournalSink>(std::move(writer), 1, self.carving.tolerance, options);
  self.session->record(sink);
  self.sink = std::move(sink);
}

FrameView view(SharedSession& self, session::SessionFrame&& frame) {
  if (!frame.ticks.empty()) self.last = frame.ticks.back();
  return {std::move(frame), self.last};
}

FrameView frame(SharedSession& self) {
  const NoGil release;
  const Using use(self);
  return view(self, self.session->frame(use.volume));
}

FrameView stop(SharedSession& self) {
  const NoGil release;
  const Using use(self);
  bool kept = true;
  const auto close = [&] { kept = !self.sink || self.sink->close(); };
  FrameView out;
  try {
    out = view(self, self.session->stop(use.volume));
  } catch (...) {
    if (!self.session->running()) close();
    throw;
  }
  close();
  if (!kept) throw std::runtime_error("the journal is not complete on the disk: " + self.sink->problem());
  return out;
}

template <std::size_t (session::Session::*Go)(Volume&)>
std::size_t go(SharedSession& self) {
  const NoGil release;
  const Using use(self);
  return (self.session.get()->*Go)(use.volume);
}

session::SculptLoop& running(SharedSession& self) {
  if (!self.session->running()) throw std::runtime_error("the session does not run");
  return *self.session->loop();
}

void bind_frame(py::module_& m) {
  using F = FrameView;
  using T = session::SculptTick;
  py::class_<F>(m, "SessionFrame", R"(What happened between two calls of Session.frame: one row for each step.

Forces and torques act on the hand, about the grip's point, in the device's frame; those on the tool act on it, about its
tip, in the part's.)")
      .def_property_readonly(
          "tiles",
          [](const F& f) {
            std::vector<std::int32_t> out;
            for (const auto& p : f.frame.tiles)
              out.insert(out.end(), {static_cast<std::int32_t>(p.grid), static_cast<std::int32_t>(p.tile)});
            return take<std::int32_t>(std::move(out), 2);
          },
          "(k, 2): number of the grid and of the tile in it, for each tile that changed.")
      .def_property_readonly(
          "times", [](const F& f) { return f.column([](const T& t) { return t.time; }); }, "(n,) s since the start.")
      .def_property_readonly(
          "poses", [](const F& f) { return f.poses([](const T& t) { return t.tool; }); },
          "(n, 6) of the tool, at each step's end.")
      .def_property_readonly(
          "starts", [](const F& f) { return f.poses([](const T& t) { return t.from; }); },
          "(n, 6) of the tool, at each step's begin: not where the last one left it where it was placed anew.")
      .def_property_readonly(
          "grips", [](const F& f) { return f.poses([](const T& t) { return t.grip; }); },
          "(n, 6) of the grip, in the device's frame.")
      .def_property_readonly(
          "forces", [](const F& f) { return f.wrenches([](const T& t) { return t.wrench; }); },
          "(n, 6): force (N) and torque (N·mm) that the device was told.")
      .def_property_readonly(
          "applied", [](const F& f) { return f.wrenches([](const T& t) { return t.applied; }); },
          "(n, 6): what it had, where it says so; otherwise what it was told a step before.")
      .def_property_readonly(
          "tool_forces", [](const F& f) { return f.wrenches([](const T& t) { return t.on_tool; }); },
          "(n, 6): force (N) and torque (N·mm) of the material on the tool, whatever the hand is given of them.")
      .def_property_readonly(
          "removed", [](const F& f) { return f.column([](const T& t) { return t.removed; }); },
          "(n,) mm³; with mode \"add\" what was put on.")
      .def_property_readonly(
          "energy", [](const F& f) { return f.column([](const T& t) { return t.energy; }); },
          "(n,) N·mm that may go to the hand: the account of passivity.")
      .def_property_readonly(
          "depth", [](const F& f) { return f.column([](const T& t) { return t.depth; }); },
          "(n,) mm that the tool is at most in what it must not enter.")
      .def_property_readonly(
          "step_seconds", [](const F& f) { return f.column([](const T& t) { return t.seconds; }); },
          "(n,) s of processor time.")
      .def_property_readonly(
          "dt", [](const F& f) { return f.column([](const T& t) { return t.dt; }); }, "(n,) s from step to step.")
      .def_property_readonly(
          "cutting", [](const F& f) { return f.column([](const T& t) { return t.cutting ? 1.0 : 0.0; }); },
          "(n,) 1 in strokes, otherwise 0.")
      .def_property_readonly(
          "missed", [](const F& f) { return f.column([](const T& t) { return t.missed ? 1.0 : 0.0; }); },
          "(n,) 1 where no step could be made and the force was held over.")
      .def_property_readonly(
          "tool", [](const F& f) { return from_poses({f.last.tool}).reshape({6}); }, "(6,) now.")
      .def_property_readonly(
          "grip", [](const F& f) { return from_poses({f.last.grip}).reshape({6}); }, "(6,) now.")
      .def_property_readonly(
          "force", [](const F& f) { return from_vec3(f.last.wrench.force); }, "(3,) N, now.")
      .def_property_readonly(
          "torque", [](const F& f) { return from_vec3(f.last.wrench.torque); }, "(3,) N·mm, now.")
      .def_property_readonly(
          "state", [](const F& f) { return name(f.last.state); },
          "Of the force, now: off, homing, ready, ramp, active, degraded or tripped.")
      .def_property_readonly(
          "cause",
          [](const F& f) {
            return f.last.cause == haptics::Cause::None ? py::object(py::none())
                                                        : py::object(py::str(sentence(f.last.cause)));
          },
          "Why the force was taken away and what to do, or None.")
      .def_property_readonly(
          "problem",
          [](const F& f) { return f.last.problem ? py::object(py::str(f.last.problem)) : py::object(py::none()); },
          "Why nothing is cut though the hand wants to, or None.")
      .def_property_readonly(
          "strokes", [](const F& f) { return f.frame.strokes; }, "That were begun since the start.")
      .def_property_readonly("in_stroke", [](const F& f) { return f.frame.in_stroke; })
      .def_property_readonly(
          "untold", [](const F& f) { return f.frame.dropped_ticks; },
          "Steps since the start that are in no frame: they were asked for too seldom (4096 are kept).")
      .def("__len__", [](const F& f) { return f.frame.ticks.size(); });
}

void bind_material(py::module_& m) {
  const haptics::Material usual;
  py::class_<haptics::Material>(m, "Material", "What a stock or a fixture is made of, as far as a hand can feel it.")
      .def(py::init([](double stiffness, double removal_constant, double damping, double density) {
             const haptics::Material material{stiffness, removal_constant, damping, density};
             material.validate("the material");
             return material;
           }),
           py::kw_only(), "stiffness"_a = usual.stiffness, "removal_constant"_a = usual.removal_constant,
           "damping"_a = usual.damping, "density"_a = usual.density)
      .def_readonly("stiffness", &haptics::Material::stiffness,
                    "Of its surface, N per mm of depth and mm²; of a fixture N per mm³ in the tool.")
      .def_readonly("removal_constant", &haptics::Material::removal_constant,
                    "N·s/mm³: force for volume removed per second.")
      .def_readonly("damping", &haptics::Material::damping, "N·s/mm on a cutter in the cut.")
      .def_readonly("density", &haptics::Material::density, "g/cm³.")
      .def("mass", &haptics::Material::mass, "volume"_a, "g of so many mm³.");
}

}  // namespace

void bind_session(py::module_& m) {
  bind_material(m);
  bind_frame(m);
  py::class_<SharedSession>(m, "Session", R"(A pen, a tool and a stock: the tool follows the hand and cuts, a thousand
times a second, in a thread of its own, and the hand feels it. Context manager: starts and stops.

The volume is the one that is shown: it follows with each call of ``frame``, between steps, and nobody else changes it
while the session runs. The tool cuts while a button of ``dead_man_mask`` is held, and every check of the pen passes.

pen: of ``riffler.pen.open``; None: a ``riffler.pen.Pointer`` of kind "mouse", see ``pen``. obstacles: a Collider to stay
out of. protect: a volume of the same lower, upper, pitch and directions, or None; what lies in it stays as it is, and is
as air to the tool. mode: "remove", or "add": the cutter puts on what it sweeps, all its length, within the volume's box;
then it feels neither that nor the stock, only obstacles. Options: ``material`` (of the stock), ``at`` ((6,) where the tool
stands at the start; for tablets, mice and recordings their own pose, otherwise 5 mm above the stock), ``scale`` and
``turn`` ((3, 3); from the hand's motion to the tool's), ``stiffness`` (N/mm), ``turn_stiffness`` (N·mm/rad), ``damping``,
``turn_damping`` (of the coupling between hand and tool), ``tolerance`` (mm, of cuts), ``memory`` (mm of way over which
resistance is learnt; None: by tool and stock), ``max_force`` (N), ``max_torque`` (N·mm), ``max_power`` (N·mm/s), ``ramp``
(s), ``dead_man_mask``, ``clutch_mask`` (of buttons), ``budget`` (s for a step; None: as long as it takes), ``undo`` (strokes
that can be taken back).)")
      .def(py::init(&make), "volume"_a, "tool"_a, "pen"_a = py::none(), py::kw_only(), "obstacles"_a = py::none(),
           "protect"_a = py::none(), "mode"_a = "remove")
      .def(
          "start",
          [](SharedSession& s) {
            const NoGil release;
            const Using use(s);
            s.session->start();
          },
          "The pen's thread sculpts from now on. Once.")
      .def("stop", &stop, R"(No force any more, and everything that was cut is in the volume and, where there is one, in
the journal on the disk. SessionFrame: what was not shown yet.)")
      .def("frame", &frame, R"(Brings the volume up to date, and tells what happened since the last call: SessionFrame.
Waits for the next step, 3 ms at most.)")
      .def("journal", &record, "path"_a, "notes"_a = py::dict(), R"(Records every stroke: poses, times, forces, what was
cut. Before ``start``; a new file, with the stock beside it (``NAME-stock.rvol``), and what is protected
(``NAME-mask.rvol``). What is in it survives a crash but for the last second at most, and is replayed by
``Session.replay``.)")
      .def("undo", &go<&session::Session::undo>,
           R"(The last stroke did not happen, or the last few if they ended between two
frames. How many that were; 0: there is none. RuntimeError in the middle of a stroke.)")
      .def("redo", &go<&session::Session::redo>, "And happened, unless another was begun since.")
      .def(
          "reset", [](SharedSession& s) { running(s).reset(); },
          "Clears a trip that does not heal by itself: the frame's ``cause`` says what it was.")
      .def(
          "set_workspace",
          [](SharedSession& s, double scale, const py::object& turn, std::uint32_t dead_man, std::uint32_t clutch) {
            const haptics::WorkspaceSettings settings{scale, to_turn(turn), clutch, dead_man};
            session::SculptLoop& loop = running(s);
            const NoGil release;
            loop.set_workspace(settings);
          },
          py::kw_only(), "scale"_a = 1.0, "turn"_a = py::none(),
          "dead_man_mask"_a = haptics::WorkspaceSettings().dead_man_mask,
          "clutch_mask"_a = haptics::WorkspaceSettings().clutch_mask,
          "Another scale, view or buttons from the next step on. The tool does not jump.")
      .def_static(
          "replay",
          [](const std::filesystem::path& path, const py::object& progress) {
            const py::object journal = py::type::of<session::Journal>().attr("read")(path);
            return journal.attr("replay")(path.parent_path(), progress);
          },
          "path"_a, "progress"_a = py::none(),
          "What the session left of its stock: a Volume, the same to the bit. Its stock lies beside the journal.")
      .def_property_readonly("running", [](const SharedSession& s) { return s.session->running(); })
      .def_property_readonly(
          "volume", [](const SharedSession& s) { return s.volume; }, "The one that is shown.")
      .def_property_readonly(
          "pen", [](const SharedSession& s) { return s.pen; }, "The device.")
      .def_property_readonly(
          "trips",
          [](SharedSession& s) {
            py::list out;
            if (!s.session->loop()) return out;
            std::array<haptics::Trip, haptics::TripLog::kCapacity> trips{};
            std::uint64_t from = 0;
            const std::size_t n = s.session->loop()->trips().read(from, trips);
            for (std::size_t k = 0; k < n; ++k)
              out.append(py::make_tuple(trips[k].time, name(trips[k].state), sentence(trips[k].cause), trips[k].value));
            return out;
          },
          "list of (time s, state, sentence, value): when the force was taken away, and why.")
      .def_property_readonly(
          "journal_problem",
          [](const SharedSession& s) -> py::object {
            const std::string text = s.sink ? s.sink->problem() : "";
            return text.empty() ? py::object(py::none()) : py::object(py::str(text));
          },
          "Why strokes wait for the disk, or None.")
      .def(
          "journal_written",
          [](const SharedSession& s, double seconds) {
            const NoGil release;
            return !s.sink || s.sink->written(seconds);
          },
          "seconds"_a = 2.0,
          "Waits until all rows that were made so far are in the journal's file, which is some 50 ms behind. False: "
          "not within so many seconds.")
      .def("__enter__",
           [](const py::object& self) {
             self.attr("start")();
             return self;
           })
      .def("__exit__", [](const py::object& self, const py::args&) { self.attr("stop")(); });
}

}  // namespace riffler::bindings
