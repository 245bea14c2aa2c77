// riffler.OrientSession and riffler.OrientFrame
#include "bindings/one_caller.hpp"
#include "bindings/program_types.hpp"
#include "bindings/session_class.hpp"
#include "bindings/session_frame.hpp"
#include "riffler/session/orient_session.hpp"

namespace riffler::bindings {

namespace {

using namespace py::literals;

using Path = std::shared_ptr<plan::PencilPath>;

/// A session with what it uses, which Python may have let go.
struct SharedOrientSession : Guarded {
  std::shared_ptr<pen::Pen> pen;
  std::unique_ptr<session::OrientSession> session;
  session::OrientTick last{};

  ~SharedOrientSession() {
    const NoGil release;  // the thread of the device may be waiting for it
    session.reset();
  }
};

std::unique_ptr<SharedOrientSession> make_orient_session(const Path& path, const Tool& tool, const Obstacles& part,
                                                         std::shared_ptr<pen::Pen> pen,
                                                         session::OrientSessionSettings settings,
                                                         const BudgetLike& budget) {
  tool.require_revolved("a session");
  settings.loop.passivity = pen->passivity();
  settings.loop.step.budget = to_budget(budget, *pen);
  settings.loop.wrench_extrapolator.most = settings.loop.limits.wrench;
  auto out = std::make_unique<SharedOrientSession>();
  out->pen = pen;
  out->session = std::make_unique<session::OrientSession>(*path, tool, std::move(pen), part, settings);
  return out;
}

OrientView view(SharedOrientSession& self, session::OrientFrame (session::OrientSession::*call)()) {
  const NoGil release;
  const OneCaller only(self, "the session");
  session::OrientFrame frame = (self.session.get()->*call)();
  if (!frame.ticks.empty()) self.last = frame.ticks.back();
  return {std::move(frame), self.last};
}

KeyChanges changes(const OrientView& f) {
  const py::object change = py::module_::import("riffler.program_results").attr("KeyChange");
  py::tuple out(f.frame.changes.size());
  for (std::size_t k = 0; k < f.frame.changes.size(); ++k) {
    const session::KeyChange& c = f.frame.changes[k];
    const py::object refused = c.refused.empty() ? py::object(py::none()) : py::object(py::str(c.refused));
    out[k] = change(c.time, c.point, from_vec3(c.axis), c.deleted, refused);
  }
  return out;
}

void bind_frame(py::module_& m) {
  using F = OrientView;
  using T = session::OrientTick;
  py::class_<F> c(m, "OrientFrame",
                  R"(The steps between two calls of ``OrientSession.frame``, one row for each.

Forces and torques act on the hand, about the grip's point, in the device's frame; those on the tool act on it, about its
tip, in the part's.

Examples
--------
>>> ball = riffler.Tool.ball(diameter=4, length=20)
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> path = riffler.plan.pencil(part, ball)[0]
>>> pen = riffler.pen.Pointer("tablet")
>>> with riffler.OrientSession(path, ball, riffler.Collider(part), pen) as session:
...     frame = session.frame()
>>> frame.touching is None
True
)");
  c.def_property_readonly("changes", &changes, "Changes of keys by presses of buttons, in order: KeyChange.")
      .def_property_readonly(
          "stations", [](const F& f) { return rows(f, [](const T& t) { return t.station; }); },
          "(n,) places on the path: point indices with fractions.")
      .def_property_readonly(
          "held", [](const F& f) { return rows(f, [](const T& t) { return t.held ? 1.0 : 0.0; }); },
          "(n,) 1 where the tool waited because its depth was not found in time.")
      .def_property_readonly(
          "station", [](const F& f) { return f.last.station; },
          "Present place on the path: a point index with a fraction.")
      .def_property_readonly(
          "touching",
          [](const F& f) -> std::optional<std::string> {
            if (!f.last.touch) return {};
            return name_of(*f.last.touch);
          },
          "The part of the tool that is deepest in contact now (cutter, shank, holder), fixture (for any part of the "
          "tool), or None.");
  bind_ticks(c, {"(n, 6): force (N) and torque (N·mm) of part and fixtures on the tool, before limits.",
                 "(n,) mm: largest depth of the tool in part and fixtures.",
                 "Why the tool does not follow the hand, or None."});
}

constexpr const char* kOrientSession =
    R"(A pen turns a tool on a path, and its buttons set key orientations there: planning by feel.

The cutter stays on the path, its axis follows the hand, and stops where cutter, shank or holder touch part or fixtures:
the hand feels a torque away from what is hit, and a weak pull towards the path. Devices without torque get the force of
the contact instead; those without motors move the tool alone. Context manager: starts and stops.

Parameters
----------
path : PencilPath
    Path to be oriented. Its keys are the first ones.
tool : Tool
    Cutter, with shank and holder.
part : Collider
    Part and fixtures.
pen : PenDevice
    From ``riffler.pen.open``, or a ``riffler.pen.Pointer``.
point : int
    Index of the path's point at which the tool starts.
axis : array_like, shape (3,), optional
    Axis of the tool at the start; None: the path's there, or, if it has none, halfway between the walls that it touches.
slide : bool
    Whether the tool follows the hand along the path; otherwise it rests at its point.
interpolation : {"smooth", "slerp", "linear"}
    How axes between keys are found, as in ``PencilPath.orient``.
limit : (axis, angle), optional
    Cone in which the machine allows keys, rad; a key beyond it is refused.
reach : float
    mm along the path within which the second button finds a key to delete.
scale : float
    mm of the tool per mm of the hand.
turn : array_like, shape (3, 3), optional
    Rotation from the hand's frame to the tool's; None: none.
stiffness, turn_stiffness : float
    Of the coupling between hand and tool, N/mm and N·mm/rad.
max_force, max_torque, max_power : float
    Largest force (N), torque (N·mm) and power (N·mm/s) given to the hand.
ramp : float
    s from no force to full force, at the start and after interruptions.
set_mask, delete_mask : int
    Buttons, as bits: set a key where the tool is, replacing one at the same point; delete the nearest key.
dead_man_mask, clutch_mask : int
    Buttons, as bits: force only while one is held (0: always); move the hand without the tool.
pivot : float
    mm above the tip, on the tool's axis: the point that the grip leads, about which the hand turns the tool and feels its
    torque. 0: the tip. Without effect for devices in the part's frame.
budget : float, "auto" or None
    s for one step; None: as long as it takes; "auto": 0.0004 for a device with motors, None for others.

Raises
------
TypeError, ValueError
    Naming the argument that is wrong.

Examples
--------
>>> ball = riffler.Tool.ball(diameter=4, length=20)
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> path = riffler.plan.pencil(part, ball)[0]
>>> pen = riffler.pen.open("simulated")
>>> with riffler.OrientSession(path, ball, riffler.Collider(part), pen) as session:
...     frame = session.frame()
>>> session.keys
{}
)";

void bind_constructor(py::class_<SharedOrientSession>& c) {
  const session::OrientSessionSettings usual;
  const session::OrientSettings& loop = usual.loop;
  const haptics::CouplingSettings& coupling = loop.step.coupling;
  c.def(py::init([](const Path& path, const Tool& tool, const Obstacles& part, const std::shared_ptr<pen::Pen>& pen,
                    std::size_t point, const OptionalArrayLike& axis, bool slide, const std::string& interpolation,
                    const ConeLike& limit, double reach, double scale, const OptionalArrayLike& turn, double stiffness,
                    double turn_stiffness, double max_force, double max_torque, double max_power, double ramp,
                    std::uint32_t set_mask, std::uint32_t delete_mask, std::uint32_t dead_man_mask,
                    std::uint32_t clutch_mask, double pivot, const BudgetLike& budget) {
          session::OrientSessionSettings settings;
          settings.point = point, settings.reach = reach;
          if (!axis.is_none()) settings.axis = to_vec3(axis, "axis");
          settings.interpolation = plan::interpolation_named(interpolation);
          settings.limit = to_axis_limit(limit);
          session::OrientSettings& made = settings.loop;
          made.slides = slide, made.set_mask = set_mask, made.delete_mask = delete_mask;
          made.step.coupling.stiffness = stiffness, made.step.coupling.turn_stiffness = turn_stiffness;
          made.limits.wrench = {max_force, max_torque}, made.limits.power = max_power, made.safety.ramp = ramp;
          made.workspace = {scale, to_turn(turn), clutch_mask, dead_man_mask, pivot};
          return make_orient_session(path, tool, part, pen, std::move(settings), budget);
        }),
        "path"_a.none(false), "tool"_a, "part"_a.none(false), "pen"_a.none(false), py::kw_only(),
        "point"_a = usual.point, "axis"_a = py::none(), "slide"_a = loop.slides, "interpolation"_a = "smooth",
        "limit"_a = py::none(), "reach"_a = usual.reach, "scale"_a = loop.workspace.scale, "turn"_a = py::none(),
        "stiffness"_a = coupling.stiffness, "turn_stiffness"_a = coupling.turn_stiffness,
        "max_force"_a = loop.limits.wrench.linear, "max_torque"_a = loop.limits.wrench.angular,
        "max_power"_a = loop.limits.power, "ramp"_a = loop.safety.ramp, "set_mask"_a = loop.set_mask,
        "delete_mask"_a = loop.delete_mask, "dead_man_mask"_a = loop.workspace.dead_man_mask,
        "clutch_mask"_a = loop.workspace.clutch_mask, "pivot"_a = loop.workspace.pivot, "budget"_a = kAutomaticBudget);
}

}  // namespace

void bind_orient(py::module_& m) {
  bind_frame(m);
  py::class_<SharedOrientSession> c(m, "OrientSession", kOrientSession);
  bind_constructor(c);
  c.def(
       "start",
       [](SharedOrientSession& s) {
         const NoGil release;
         const OneCaller only(s, "the session");
         s.session->start();
       },
       R"(Starts, in the pen's own thread. Call it once.

Examples
--------
>>> ball = riffler.Tool.ball(diameter=4, length=20)
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> path = riffler.plan.pencil(part, ball)[0]
>>> pen = riffler.pen.Pointer("tablet")
>>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
>>> session.start()
>>> frame = session.stop()
)")
      .def(
          "stop", [](SharedOrientSession& s) { return view(s, &session::OrientSession::stop); },
          R"(Ends the force.

Returns
-------
OrientFrame
    The steps since the last frame.

Examples
--------
>>> ball = riffler.Tool.ball(diameter=4, length=20)
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> path = riffler.plan.pencil(part, ball)[0]
>>> pen = riffler.pen.Pointer("tablet")
>>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
>>> session.start()
>>> session.stop().changes
()
)")
      .def(
          "frame", [](SharedOrientSession& s) { return view(s, &session::OrientSession::frame); },
          R"(Applies the presses since the last call to the keys, and returns what happened.

Returns
-------
OrientFrame

Raises
------
RuntimeError
    If the session does not run.

Examples
--------
>>> ball = riffler.Tool.ball(diameter=4, length=20)
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> path = riffler.plan.pencil(part, ball)[0]
>>> pen = riffler.pen.Pointer("tablet")
>>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
>>> with session:
...     frame = session.frame()
>>> frame.changes
()
)")
      .def(
          "set_keys",
          [](SharedOrientSession& s, const KeysLike& keys) {
            const plan::OrientationKeys wanted = to_keys(keys);
            const OneCaller only(s, "the session");
            s.session->set_keys(wanted);
          },
          "keys"_a,
          R"(Replaces all keys, also while the session runs.

Parameters
----------
keys : mapping of int to array_like, shape (3,)
    Point index to axis, as in ``PencilPath.orient``; empty: none.

Raises
------
ValueError
    Naming the point; nothing is changed then.

Examples
--------
>>> ball = riffler.Tool.ball(diameter=4, length=20)
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> path = riffler.plan.pencil(part, ball)[0]
>>> pen = riffler.pen.Pointer("tablet")
>>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
>>> session.set_keys({0: (0, 0.6, 0.8)})
>>> session.path.axes[1]
array([0. , 0.6, 0.8])
)")
      .def(
          "go_to",
          [](SharedOrientSession& s, std::size_t point) {
            const NoGil release;
            s.session->loop().go_to(point);
          },
          "point"_a,
          R"(Moves the tool to a point of the path, with the axis that it has; the hand does not feel a jump.

Parameters
----------
point : int
    From 0.

Examples
--------
>>> ball = riffler.Tool.ball(diameter=4, length=20)
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> path = riffler.plan.pencil(part, ball)[0]
>>> pen = riffler.pen.Pointer("tablet")
>>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
>>> session.go_to(1)
)")
      .def(
          "set_slide", [](SharedOrientSession& s, bool slide) { s.session->loop().set_slides(slide); }, "slide"_a,
          R"(Lets the tool follow the hand along the path, or rest at its place.

Parameters
----------
slide : bool

Examples
--------
>>> ball = riffler.Tool.ball(diameter=4, length=20)
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> path = riffler.plan.pencil(part, ball)[0]
>>> pen = riffler.pen.Pointer("tablet")
>>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
>>> session.set_slide(False)
)")
      .def(
          "set_workspace",
          [](SharedOrientSession& s, double scale, const OptionalArrayLike& turn, std::uint32_t clutch, double pivot) {
            const haptics::WorkspaceSettings settings{scale, to_turn(turn), clutch, 0, pivot};
            const NoGil release;
            s.session->loop().set_workspace(settings);
          },
          py::kw_only(), "scale"_a = 1.0, "turn"_a = py::none(),
          "clutch_mask"_a = session::OrientSettings().workspace.clutch_mask, "pivot"_a = 0.0,
          R"(Changes scale, view or clutch from the next step on. The tool does not jump.

Parameters
----------
scale : float
    mm of the tool per mm of the hand.
turn : array_like, shape (3, 3), optional
    Rotation from the hand's frame to the tool's; None: none.
clutch_mask : int
    Buttons, as bits: move the hand without the tool.
pivot : float
    mm above the tip, on the tool's axis: the point that the grip leads, about which the hand turns the tool and feels its
    torque. 0: the tip. Without effect for devices in the part's frame.

Examples
--------
>>> ball = riffler.Tool.ball(diameter=4, length=20)
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> path = riffler.plan.pencil(part, ball)[0]
>>> pen = riffler.pen.Pointer("tablet")
>>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
>>> session.set_workspace(scale=0.5)
)")
      .def(
          "reset", [](SharedOrientSession& s) { s.session->loop().reset(); },
          R"(Clears a trip that does not clear itself: ``OrientFrame.cause`` gives its reason.

Examples
--------
>>> ball = riffler.Tool.ball(diameter=4, length=20)
>>> part = riffler.shape.relief([[1, 1], [0, 0], [1, 1]], size=(30, 20), depth=10, sink=5)
>>> path = riffler.plan.pencil(part, ball)[0]
>>> pen = riffler.pen.Pointer("tablet")
>>> session = riffler.OrientSession(path, ball, riffler.Collider(part), pen)
>>> session.reset()
)")
      .def_property_readonly(
          "keys", [](const SharedOrientSession& s) { return from_keys(s.session->keys()); },
          "Point index to axis (3,): the keys after the last frame.")
      .def_property_readonly(
          "path", [](const SharedOrientSession& s) { return std::make_shared<plan::PencilPath>(s.session->path()); },
          "PencilPath with axes between the keys; without keys, as given.")
      .def_property_readonly(
          "running", [](const SharedOrientSession& s) { return s.session->running(); },
          "Whether the session was started and not stopped.")
      .def_property_readonly(
          "priority", [](const SharedOrientSession& s) { return to_priority(s.session->priority()); },
          "How the system runs the thread of the steps: ThreadPriority.")
      .def_property_readonly(
          "pen", [](const SharedOrientSession& s) { return s.pen; }, "The device.")
      .def("__enter__",
           [](const py::object& self) -> Self {
             self.attr("start")();
             return self;
           })
      .def("__exit__", [](const py::object& self, const py::args&) { self.attr("stop")(); });
}

}  // namespace riffler::bindings
