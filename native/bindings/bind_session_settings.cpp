// The settings of riffler.Session: its constructor.
#include "bindings/session_class.hpp"
#include "riffler/haptics/material.hpp"
#include "riffler/pen/pointer.hpp"

namespace riffler::bindings {

using namespace py::literals;

Mat3 to_turn(const OptionalArrayLike& turn) {
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

std::optional<double> to_budget(const BudgetLike& budget, const pen::Pen& pen) {
  if (py::isinstance<py::str>(budget) && py::cast<std::string>(budget) == kAutomaticBudget)
    return pen.capability().has_force() ? std::optional(4e-4) : std::nullopt;
  if (budget.is_none()) return std::nullopt;
  try {
    return py::cast<double>(budget);
  } catch (const py::cast_error&) {
    throw py::type_error("budget must be a number in s, None or \"auto\"");
  }
}

namespace {

std::optional<Pose> to_pose(const OptionalArrayLike& at) {
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

std::unique_ptr<SharedSession> make_session(const std::shared_ptr<SharedVolume>& volume, const Tool& tool,
                                            std::shared_ptr<pen::Pen> pen, const Obstacles& obstacles,
                                            SharedVolume* protect, session::SessionSettings settings,
                                            const BudgetLike& budget) {
  tool.require_revolved("a session");
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
                    const std::optional<haptics::Material>& material, const OptionalArrayLike& at, double scale,
                    const OptionalArrayLike& turn, double stiffness, double turn_stiffness, double damping,
                    double turn_damping, double tolerance, std::optional<double> memory, double max_force,
                    double max_torque, double max_power, double ramp, std::uint32_t dead_man_mask,
                    std::uint32_t clutch_mask, double pivot, bool touch, double touch_force, std::uint32_t touch_mask,
                    const BudgetLike& budget, std::size_t undo) {
          session::SessionSettings settings;
          settings.mode = to_carve_mode(mode), settings.start = to_pose(at), settings.undo = undo;
          session::SculptLoopSettings& made = settings.loop;
          made.sculpt.coupling.stiffness = stiffness, made.sculpt.coupling.turn_stiffness = turn_stiffness;
          made.sculpt.coupling.damping = damping, made.sculpt.coupling.turn_damping = turn_damping;
          made.sculpt.memory = memory, made.carving.tolerance = tolerance, made.safety.ramp = ramp;
          made.limits.wrench = {max_force, max_torque}, made.limits.power = max_power;
          made.workspace = {scale, to_turn(turn), clutch_mask, dead_man_mask, pivot};
          made.touch = touch, made.touch_force = touch_force, made.touch_mask = touch_mask;
          if (material) {
            material->validate("the stock");
            made.carving.removal_constant = material->removal_constant, made.sculpt.damping = material->damping;
          }
          return make_session(volume, tool, std::move(pen), obstacles, protect, std::move(settings), budget);
        }),
        "volume"_a.none(false), "tool"_a, "pen"_a = py::none(), py::kw_only(), "obstacles"_a = py::none(),
        "protect"_a = py::none(), "mode"_a = "remove", "material"_a = py::none(), "at"_a = py::none(),
        "scale"_a = loop.workspace.scale, "turn"_a = py::none(), "stiffness"_a = coupling.stiffness,
        "turn_stiffness"_a = coupling.turn_stiffness, "damping"_a = coupling.damping,
        "turn_damping"_a = coupling.turn_damping, "tolerance"_a = loop.carving.tolerance, "memory"_a = py::none(),
        "max_force"_a = loop.limits.wrench.linear, "max_torque"_a = loop.limits.wrench.angular,
        "max_power"_a = loop.limits.power, "ramp"_a = loop.safety.ramp,
        "dead_man_mask"_a = loop.workspace.dead_man_mask, "clutch_mask"_a = loop.workspace.clutch_mask,
        "pivot"_a = loop.workspace.pivot, "touch"_a = loop.touch, "touch_force"_a = loop.touch_force,
        "touch_mask"_a = loop.touch_mask, "budget"_a = kAutomaticBudget, "undo"_a = usual.undo);
}

}  // namespace

py::class_<SharedSession> bind_session_class(py::module_& m) {
  py::class_<SharedSession> session(
      m, "Session",
      R"(A pen, a tool and a stock: the tool follows the hand and cuts a thousand times a second, and the hand feels it.

The device's own thread cuts. ``volume`` is the displayed volume: each call of ``frame`` brings it up to date, between steps, and
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
    Part and fixtures that the tool does not enter.
protect : Volume, optional
    Region that must not change, with the lower, upper, pitch and directions of ``volume``; air to the tool.
mode : {"remove", "add"}
    "add": the cutter adds what it sweeps, over its whole length and within the volume's box. The hand then feels neither
    that nor the stock, only obstacles.
material : Material, optional
    Material of the stock.
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
pivot : float
    mm above the tip, on the tool's axis: the point that the grip leads, about which the hand turns the tool and feels its
    torque. 0: the tip. Without effect for devices in the part's frame.
touch : bool
    Keep the tool out of the stock while no button of ``dead_man_mask`` is held, so that the hand feels what it carves; the
    button then only cuts. Not with the mode "add".
touch_force : float
    Largest force of that on the hand, N; its torque is limited in proportion.
touch_mask : int
    Buttons, as bits, of which one must be held for it; 0: none, so that force acts whenever the checks of the pen pass.
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
  return session;
}

}  // namespace riffler::bindings
