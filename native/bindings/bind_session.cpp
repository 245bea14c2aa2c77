// riffler.Session
#include <memory>

#include "bindings/bindings.hpp"
#include "bindings/one_caller.hpp"
#include "bindings/session_frame.hpp"
#include "bindings/shared_volume.hpp"
#include "riffler/dexel/file/file.hpp"
#include "riffler/haptics/material.hpp"
#include "riffler/pen/pointer.hpp"
#include "riffler/session/journal_sink.hpp"
#include "riffler/session/session.hpp"

namespace riffler::bindings {

namespace {

using namespace py::literals;
using Obstacles = std::shared_ptr<collide::Collider>;

/// A session with what it uses, which Python may have let go.
struct SharedSession : Guarded {
  std::shared_ptr<SharedVolume> volume;
  std::shared_ptr<pen::Pen> pen;
  Tool tool;
  sweep::MoveCarver::Options carving;
  sweep::CarveMode mode;
  std::optional<Volume> mask{};
  std::shared_ptr<session::JournalSink> sink;
  std::unique_ptr<session::Session> session;
  session::SculptTick last{};

  SharedSession(std::shared_ptr<SharedVolume> v, std::shared_ptr<pen::Pen> p, const Tool& t,
                const session::SessionSettings& settings)
      : volume(std::move(v)), pen(std::move(p)), tool(t), carving(settings.loop.carving), mode(settings.mode) {}
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

sweep::CarveMode to_mode(const std::string& mode) {
  if (mode == "remove") return sweep::CarveMode::Remove;
  if (mode == "add") return sweep::CarveMode::Add;
  throw py::value_error("mode must be \"remove\" or \"add\", not \"" + mode + '"');
}

/// Set by Session where the device decides: 0.4 ms a step for a device with motors, none for others.
constexpr const char* kAutomatic = "auto";

std::optional<double> to_budget(const py::object& budget, const pen::Pen& pen) {
  if (py::isinstance<py::str>(budget) && py::cast<std::string>(budget) == kAutomatic)
    return pen.capability().has_force() ? std::optional(4e-4) : std::nullopt;
  if (budget.is_none()) return std::nullopt;
  try {
    return py::cast<double>(budget);
  } catch (const py::cast_error&) {
    throw py::type_error("budget must be a number in s, None or \"auto\"");
  }
}

std::unique_ptr<SharedSession> make(const std::shared_ptr<SharedVolume>& volume, const Tool& tool,
                                    std::shared_ptr<pen::Pen> pen, const Obstacles& obstacles, SharedVolume* protect,
                                    session::SessionSettings settings, const py::object& budget) {
  if (!pen) pen = std::make_shared<pen::PointerPen>(pen::PointerPen::Kind::Mouse);
  settings.loop.passivity = pen->passivity();
  settings.loop.sculpt.budget = to_budget(budget, *pen);
  settings.loop.wrench_extrapolator.most = settings.loop.limits.wrench;
  settings.validate();
  auto out = std::make_unique<SharedSession>(volume, pen, tool, settings);
  const Volume state = Reading(*volume).volume.snapshot();
  if (protect) out->mask = Reading(*protect).volume.snapshot();
  out->session = std::make_unique<session::Session>(state, tool, std::move(pen), obstacles, settings,
                                                    out->mask ? &*out->mask : nullptr);
  return out;
}

/// Session's constructor, with a default for every setting.
void bind_constructor(py::class_<SharedSession>& c) {
  const session::SessionSettings usual;
  const session::SculptLoopSettings& loop = usual.loop;
  const haptics::CouplingSettings& coupling = loop.sculpt.coupling;
  c.def(py::init([](const std::shared_ptr<SharedVolume>& volume, const Tool& tool, std::shared_ptr<pen::Pen> pen,
                    const Obstacles& obstacles, SharedVolume* protect, const std::string& mode,
                    const std::optional<haptics::Material>& material, const py::object& at, double scale,
                    const py::object& turn, double stiffness, double turn_stiffness, double damping,
                    double turn_damping, double tolerance, std::optional<double> memory, double max_force,
                    double max_torque, double max_power, double ramp, std::uint32_t dead_man_mask,
                    std::uint32_t clutch_mask, const py::object& budget, std::size_t undo) {
          session::SessionSettings settings;
          settings.mode = to_mode(mode), settings.start = to_pose(at), settings.undo = undo;
          session::SculptLoopSettings& made = settings.loop;
          made.sculpt.coupling.stiffness = stiffness, made.sculpt.coupling.turn_stiffness = turn_stiffness;
          made.sculpt.coupling.damping = damping, made.sculpt.coupling.turn_damping = turn_damping;
          made.sculpt.memory = memory, made.carving.tolerance = tolerance, made.safety.ramp = ramp;
          made.limits.wrench = {max_force, max_torque}, made.limits.power = max_power;
          made.workspace = {scale, to_turn(turn), clutch_mask, dead_man_mask};
          if (material) {
            material->validate("the stock");
            made.carving.removal_constant = material->removal_constant, made.sculpt.damping = material->damping;
          }
          return make(volume, tool, std::move(pen), obstacles, protect, std::move(settings), budget);
        }),
        "volume"_a.none(false), "tool"_a, "pen"_a = py::none(), py::kw_only(), "obstacles"_a = py::none(),
        "protect"_a = py::none(), "mode"_a = "remove", "material"_a = py::none(), "at"_a = py::none(),
        "scale"_a = loop.workspace.scale, "turn"_a = py::none(), "stiffness"_a = coupling.stiffness,
        "turn_stiffness"_a = coupling.turn_stiffness, "damping"_a = coupling.damping,
        "turn_damping"_a = coupling.turn_damping, "tolerance"_a = loop.carving.tolerance, "memory"_a = py::none(),
        "max_force"_a = loop.limits.wrench.linear, "max_torque"_a = loop.limits.wrench.angular,
        "max_power"_a = loop.limits.power, "ramp"_a = loop.safety.ramp,
        "dead_man_mask"_a = loop.workspace.dead_man_mask, "clutch_mask"_a = loop.workspace.clutch_mask,
        "budget"_a = kAutomatic, "undo"_a = usual.undo);
}

/// The mode of all its strokes.
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

FrameView with_last(SharedSession& self, session::SessionFrame&& frame) {
  if (!frame.ticks.empty()) self.last = frame.ticks.back();
  return {std::move(frame), self.last};
}

FrameView frame(SharedSession& self) {
  const NoGil release;
  const Using use(self);
  return with_last(self, self.session->frame(use.volume));
}

FrameView stop(SharedSession& self) {
  const NoGil release;
  const Using use(self);
  bool kept = true;
  const auto close = [&] { kept = !self.sink || self.sink->close(); };
  FrameView out;
  try {
    out = with_last(self, self.session->stop(use.volume));
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

}  // namespace

void bind_session(py::module_& m) {
  py::class_<SharedSession> session(
      m, "Session",
      R"(A pen, a tool and a stock: the tool follows the hand and cuts a thousand times a second, and the hand feels it.

The device's own thread cuts. ``volume`` is what is shown: each call of ``frame`` brings it up to date, between steps, and
nothing else may change it while the session runs. The tool cuts while a button of ``dead_man_mask`` is held and every
check of the pen passes. Context manager: starts and stops.

Parameters
----------
volume : Volume
    The stock.
tool : Tool
    The cutter.
pen : PenDevice, optional
    From ``riffler.pen.open``, or a ``riffler.pen.Pointer``; None: a Pointer of kind "mouse", then the session's ``pen``.
obstacles : Collider, optional
    Part and fixtures that the tool stays out of.
protect : Volume, optional
    Region that must not change, with the lower, upper, pitch and directions of ``volume``; air to the tool.
mode : {"remove", "add"}
    "add": the cutter adds what it sweeps, over its whole length and within the volume's box. The hand then feels neither
    that nor the stock, only obstacles.
material : Material, optional
    What the stock is made of.
at : array_like, shape (6,), optional
    Pose of the tool at the start: tip in mm and axis. None: the hand's pose for tablets, mice and recordings, otherwise
    5 mm above the middle of the stock.
scale : float
    mm of the tool per mm of the hand.
turn : array_like, shape (3, 3), optional
    Rotation from the hand's frame to the tool's; None: none.
stiffness, turn_stiffness : float
    Of the coupling between hand and tool, N/mm and N·mm/rad.
damping, turn_damping : float
    Of the coupling, N·s/mm and N·mm·s/rad.
tolerance : float
    mm, of the cuts, as in ``Volume.carve``.
memory : float, optional
    mm of travel over which the resistance is estimated; None: chosen by tool and stock.
max_force, max_torque, max_power : float
    Largest force (N), torque (N·mm) and power (N·mm/s) given to the hand.
ramp : float
    s from no force to full force, at the start and after interruptions.
dead_man_mask, clutch_mask : int
    Buttons, as bits: cut while one is held; move the hand without the tool.
budget : float, "auto" or None
    s for one step; None: as long as it takes, and steps are deterministic; "auto": 0.0004 for a device with motors, None
    for others.
undo : int
    Number of strokes that can be undone.

Raises
------
TypeError, ValueError
    Naming the argument that is wrong.

Examples
--------
>>> stock = riffler.Volume.block(lower=(0, 0, 0), upper=(20, 20, 10), pitch=0.5)
>>> ball = riffler.Tool.ball(diameter=6, length=30)
>>> with riffler.Session(stock, ball, at=(10, 10, 15, 0, 0, 1), max_force=3.0) as session:
...     frame = session.frame()
>>> frame.in_stroke
False
)");
  bind_constructor(session);
  session
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
