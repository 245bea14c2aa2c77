// riffler.pen: what is plugged in, and a device that is open.
#include <array>
#include <memory>
#include <optional>

#include "bindings/bindings.hpp"
#include "pen/simulated/simulated_device.hpp"
#include "riffler/pen/arms/kinematics.hpp"
#include "riffler/pen/hid/open_error.hpp"
#include "riffler/pen/playback.hpp"
#include "riffler/pen/pointer.hpp"
#include "riffler/pen/registry.hpp"

namespace riffler::bindings {
namespace {

using namespace py::literals;

/// A device that was stopped, or whose Python object is gone, does not push.
using SharedPen = std::shared_ptr<pen::Pen>;

py::object or_none(const std::string& text) {
  return text.empty() ? py::object(py::none()) : py::object(py::str(text));
}

py::dict dict_of(const pen::FoundDevice& found) {
  py::dict out;
  out["path"] = found.info.path;
  out["name"] = found.info.name.empty() ? "unnamed device" : found.info.name;
  out["maker"] = found.info.maker;
  out["id"] = found.info.id();
  out["serial"] = found.info.serial;
  out["kind"] = found.family == nullptr ? py::object(py::none()) : py::object(py::str(found.family->kind));
  out["tried"] = found.was_opened;
  out["problem"] = found.problem == pen::OpenProblem::None ? py::object(py::none())
                                                           : py::object(py::str(problem_text(found.problem)));
  out["text"] = or_none(found.text);
  out["capability"] = or_none(found.capability);
  out["about"] = or_none(found.about);
  return out;
}

py::list devices() {
  std::vector<pen::FoundDevice> found;
  {
    const NoGil release;
    found = pen::find_devices();
  }
  py::list out;
  for (const pen::FoundDevice& device : found) out.append(dict_of(device));
  return out;
}

py::dict families() {
  py::dict out;
  for (const pen::PenFamily& family : pen::pen_families()) out[family.kind] = family.what;
  out[pen::kSimulatedKind] = pen::kSimulatedWhat;
  return out;
}

SharedPen open_device(const std::string& what, const std::string& geometry, double bubble, double exponent,
                      double speed, double turn_rate, bool hold_orientation, const std::array<int, 6>& signs,
                      double gravity, double friction) {
  pen::PenOptions options;
  options.geometry = geometry;
  options.rate = {bubble, exponent, speed, turn_rate, hold_orientation, false, signs};
  options.rate.validate();
  options.compensation = {gravity, friction};
  options.compensation.validate();
  const NoGil release;
  return open_pen(what, options);
}

SharedPen play(const std::vector<std::pair<Doubles, std::vector<double>>>& strokes, double speed) {
  std::vector<pen::RecordedStroke> recorded;
  for (const auto& [poses, times] : strokes) recorded.push_back({to_poses(poses, "poses"), times});
  return std::make_shared<pen::PlaybackPen>(std::move(recorded), speed);
}

Wrench to_wrench(const py::object& force, const py::object& torque) {
  return {to_vec3(force, "force"), to_vec3(torque, "torque")};
}

py::dict limits(const pen::Pen& pen) {
  const char* const names = "xyzabc";
  py::dict out;
  for (std::size_t k = 0; k < haptics::kCoordinates; ++k) {
    const pen::CoordinateCapability& c = pen.capability().coordinates[k];
    py::dict one;
    one["senses"] = c.sensing == pen::Sensing::None       ? py::object(py::none())
                    : c.sensing == pen::Sensing::Position ? py::object(py::str("position"))
                                                          : py::object(py::str("rate"));
    one["pushes"] = c.pushes;
    one["low"] = c.low;
    one["high"] = c.high;
    one["resolution"] = c.resolution;
    one["peak"] = c.peak;
    one["continuous"] = c.continuous;
    out[py::str(std::string(1, names[k]))] = one;
  }
  return out;
}

py::dict health(const pen::Pen& pen) {
  const pen::LinkStatus link = pen.status();
  py::dict out;
  out["state"] = link_text(link.state);
  out["problem"] = or_none(pen.problem());
  out["force_state"] = name(pen.force_state());
  out["cause"] =
      pen.cause() == haptics::Cause::None ? py::object(py::none()) : py::object(py::str(sentence(pen.cause())));
  out["fault"] = link.sample.fault;
  out["homed"] = link.sample.homed;
  out["force"] = from_vec3(link.wrench.force);
  out["torque"] = from_vec3(link.wrench.torque);
  const pen::LinkCounts& c = link.counts;
  out["reports"] = c.reports;
  out["superseded"] = c.superseded;
  out["lost"] = c.lost;
  out["malformed"] = c.malformed;
  out["timeouts"] = c.timeouts;
  out["writes"] = c.writes;
  out["read_errors"] = c.read_errors;
  out["write_errors"] = c.write_errors;
  out["silences"] = c.silences;
  out["connections"] = c.connections;
  out["attempts"] = c.attempts;
  return out;
}

py::dict push(pen::Pen& pen, const py::object& force, const py::object& torque) {
  const pen::PushAnswer answer = pen.push(to_wrench(force, torque));
  py::dict out;
  out["force"] = from_vec3(answer.felt.force);
  out["torque"] = from_vec3(answer.felt.torque);
  out["missing_force"] = from_vec3(answer.missing.force);
  out["missing_torque"] = from_vec3(answer.missing.torque);
  out["reason"] = or_none(not_pushed_text(answer.reason));
  return out;
}

/// A sample, and how old it was when it was asked for.
struct State {
  pen::PenSample sample;
  double age;
};

void bind_state(py::module_& m) {
  py::class_<State>(m, "PenState", "Where the hand was, as of one report.")
      .def_property_readonly(
          "pose", [](const State& s) { return from_poses({s.sample.pose}).reshape({6}); },
          "(6,): point and axis of the grip.")
      .def_property_readonly(
          "spin", [](const State& s) { return s.sample.spin; }, "rad, of the grip about its axis.")
      .def_property_readonly(
          "velocity", [](const State& s) { return from_vec3(s.sample.velocity); }, "(3,) mm/s.")
      .def_property_readonly(
          "turning", [](const State& s) { return from_vec3(s.sample.turning); }, "(3,) rad/s.")
      .def_property_readonly(
          "buttons", [](const State& s) { return s.sample.buttons; }, "Bit 0 is button 1.")
      .def_property_readonly(
          "age_s", [](const State& s) { return s.age; }, "s since it was measured; inf before the first report.")
      .def_property_readonly(
          "sequence", [](const State& s) { return s.sample.sequence; }, "Of the report; 0 before the first.")
      .def_property_readonly(
          "homed", [](const State& s) { return s.sample.homed; }, "Whether the pose is sure.")
      .def_property_readonly(
          "fault", [](const State& s) { return s.sample.fault; }, "The device's own code, or 0.")
      .def_property_readonly(
          "stretch", [](const State& s) { return s.sample.stretch; }, "mm between two measurements of one length.")
      .def_property_readonly(
          "powered", [](const State& s) { return s.sample.powered; }, "Whether the device is ready to push.")
      .def_property_readonly(
          "counts",
          [](const State& s) {
            return take<std::int32_t>(std::vector(s.sample.counts.begin(), s.sample.counts.end()));
          },
          R"((6,) int32: the counters of a pen that has a geometry, in its order, as if homing had preset them.)")
      .def_property_readonly(
          "applied",
          [](const State& s) {
            return py::make_tuple(from_vec3(s.sample.applied.force), from_vec3(s.sample.applied.torque));
          },
          "(force, torque), N and N·mm: what the hand felt of the motors, where the device says so; zero elsewhere.");
}

void bind_device(py::module_& m) {
  py::class_<pen::Pen, SharedPen>(m, "PenDevice", R"(A device that is open: a pen, a puck, a recording. Context manager.

Reports are read, and forces written, in a thread of its own; a device that goes away is looked for until it is back.)")
      .def_property_readonly("kind", &pen::Pen::kind)
      .def_property_readonly("about", &pen::Pen::about)
      .def_property_readonly(
          "geometry",
          [](const pen::Pen& p) {
            return p.geometry() == nullptr ? py::object(py::none()) : py::cast(pen::PenKinematics(*p.geometry()));
          },
          "PenGeometry of a pen of two arms, with the currents that the device allows; None of everything else.")
      .def_property_readonly("limits", &limits, R"(dict: "x", "y", "z" and turns "a", "b", "c", each a dict of senses
("position", "rate" or None), pushes, low, high, resolution (mm, rad, or a second of them), peak, continuous (N, N·mm).)")
      .def(
          "state", [](const pen::Pen& p) { return State{p.newest(), p.age()}; }, "PenState: the newest sample.")
      .def("health", &health,
           "dict: state, problem, force_state, cause, what was last pushed with, and counts since the start.")
      .def("push", &push, "force"_a, "torque"_a = py::make_tuple(0, 0, 0), R"(Pushes for 20 ms with a force (N) and a
torque (N·mm) about the grip's point. dict: force, torque that will be felt, missing_force, missing_torque, reason or
None.)")
      .def("home", &pen::Pen::home, "The device stands in its home posture. False where nothing has to be homed.")
      .def("reset", &pen::Pen::reset, "Clears a trip that does not heal by itself: health()['cause'] says what it was.")
      .def("stop", &pen::Pen::stop, py::call_guard<NoGil>(),
           "No force, and closed. False where the device could not be told in time.")
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](pen::Pen& p, const py::args&) {
        const NoGil release;
        p.stop();
      });
}

void aim(pen::SimulatedDevice& pen, const Doubles& pose, double spin, double grip, std::uint32_t buttons) {
  if (pose.size() != 6) throw std::invalid_argument("pose must be six numbers: a point and an axis");
  const double* const p = pose.data();
  pen.aim({.pose = {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}}, .spin = spin, .grip = grip, .buttons = buttons});
}

void bind_simulated(py::module_& m) {
  py::class_<pen::SimulatedDevice, pen::Pen, std::shared_ptr<pen::SimulatedDevice>>(
      m, "SimulatedPen", "A pen without hardware: arms, motors, firmware and cable are simulated, and a hand moves it.")
      .def("aim", &aim, "pose"_a, py::kw_only(), "spin"_a = 0.0, "grip"_a = 1.0, "buttons"_a = 0U,
           R"(The hand goes to `pose`, (6,) point and axis, at up to 300 mm/s and 5 rad/s, as far as the arms reach;
with `grip` below 1 it holds more loosely, with 0 not at all. `spin` in rad about the axis.)")
      .def("wander", &pen::SimulatedDevice::wander, "The hand goes round on its own curve again.")
      .def("lose", &pen::SimulatedDevice::lose, "channel"_a, "counts"_a,
           "A counter (0 to 5) loses so many counts in all, one by one: a fault to practise with.");
}

pen::PointerFrame to_frame(const py::object& origin, const py::object& right, const py::object& up, double scale,
                           double depth, double most_tilt) {
  return {to_vec3(origin, "origin"), to_vec3(right, "right"), to_vec3(up, "up"), scale, depth, most_tilt};
}

std::shared_ptr<pen::PointerPen> make_pointer(const std::string& kind) {
  if (kind == "tablet") return std::make_shared<pen::PointerPen>(pen::PointerPen::Kind::Tablet);
  if (kind == "mouse") return std::make_shared<pen::PointerPen>(pen::PointerPen::Kind::Mouse);
  throw std::invalid_argument("kind: there is no pointer \"" + kind + "\"; there are tablet, mouse");
}

void bind_pointer(py::module_& m) {
  const pen::PointerFrame frame;
  const py::tuple zero = py::make_tuple(0, 0, 0), along = py::make_tuple(1, 0, 0), across = py::make_tuple(0, 1, 0);
  py::class_<pen::PointerPen, pen::Pen, std::shared_ptr<pen::PointerPen>>(
      m, "Pointer", R"(A tablet or a mouse as a device: whoever gets its events gives them here, and they become poses.

`kind` is "tablet" (senses point and axis) or "mouse" (the point only; its axis stands upright on the plane).)")
      .def(py::init(&make_pointer), "kind"_a = "tablet")
      .def(
          "set_frame",
          [](pen::PointerPen& p, const py::object& origin, const py::object& right, const py::object& up, double scale,
             double depth, double most_tilt) { p.set_frame(to_frame(origin, right, up, scale, depth, most_tilt)); },
          py::kw_only(), "origin"_a = zero, "right"_a = along, "up"_a = across, "scale"_a = frame.scale,
          "depth"_a = frame.depth, "most_tilt"_a = frame.most_tilt,
          R"(Where the pointer's plane lies, from the next event on: `origin`, (3,) mm, of pointer (0, 0); `right` and
`up`, (3,) unit vectors square to each other; `scale`, mm for a unit of the pointer; `depth`, mm into the plane at full
pressure; `most_tilt`, rad from upright, below pi/2. ValueError naming what cannot be; the frame is as before then.)")
      .def(
          "give",
          [](pen::PointerPen& p, double x, double y, double pressure, double tilt_x, double tilt_y,
             std::uint32_t buttons, double time) { return p.give({x, y, pressure, tilt_x, tilt_y, buttons, time}); },
          "x"_a, "y"_a, py::kw_only(), "pressure"_a = 0.0, "tilt_x"_a = 0.0, "tilt_y"_a = 0.0, "buttons"_a = 0U,
          "time"_a,
          R"(An event: right and up in units of the frame, pressure 0 to 1, tilts (rad) by which the pen's end leans to
the right and up, buttons as bits, time in s of any clock. False, and it is left out, where a number is not finite or the
time is before the last event's.)");
}

}  // namespace

void bind_pen_device(py::module_& m) {
  py::register_exception<pen::OpenError>(m, "PenError", PyExc_RuntimeError).attr("__doc__") =
      "A device that does not open: says exactly why, and what to do.";
  bind_state(m);
  bind_device(m);
  bind_simulated(m);
  bind_pointer(m);
  m.def("_pen_devices", &devices);
  m.def("_pen_families", &families);
  const pen::RateSettings rate;
  m.def("_open_pen", &open_device, "what"_a, py::kw_only(), "geometry"_a = "woodenhaptics", "bubble"_a = rate.bubble,
        "exponent"_a = rate.exponent, "speed"_a = rate.speed, "turn_rate"_a = rate.turn_rate,
        "hold_orientation"_a = rate.hold_orientation, "signs"_a = rate.signs, "gravity"_a = 0.0, "friction"_a = 0.0);
  m.def("_play_pen", &play, "strokes"_a, "speed"_a);
}

}  // namespace riffler::bindings
