// riffler.pen: plugged-in devices, and an open device.
#include <array>
#include <memory>
#include <optional>

#include "base/real_time.hpp"
#include "bindings/pen_calls.hpp"
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

py::object info_of(const pen::FoundDevice& found) {
  py::dict out;
  out["path"] = found.path;
  out["name"] = found.name.empty() ? "unnamed device" : found.name;
  out["maker"] = found.maker;
  out["id"] = found.id;
  out["serial"] = found.serial;
  out["choice"] = or_none(found.choice);
  out["kind"] = found.family == nullptr ? py::object(py::none()) : py::object(py::str(found.family->kind));
  out["was_opened"] = found.was_opened;
  out["problem"] = found.problem == pen::OpenProblem::None ? py::object(py::none())
                                                           : py::object(py::str(problem_text(found.problem)));
  out["text"] = or_none(found.text);
  out["capability"] = or_none(found.capability);
  out["about"] = or_none(found.about);
  return pen_result("DeviceInfo", out);
}

DeviceList devices() {
  std::vector<pen::FoundDevice> found;
  {
    const NoGil release;
    found = pen::find_devices();
  }
  py::list out;
  for (const pen::FoundDevice& device : found) out.append(info_of(device));
  return out;
}

StringDict unavailable() {
  std::vector<pen::FoundDevice> found;
  {
    const NoGil release;
    found = pen::find_unavailable();
  }
  py::dict out;
  for (const pen::FoundDevice& family : found)
    out[family.family->kind] = std::string(problem_text(family.problem)) + ": " + family.text;
  return out;
}

StringDict families() {
  py::dict out;
  for (const pen::PenFamily* const family : pen::pen_families()) out[family->kind] = family->what;
  out[pen::kSimulatedKind] = pen::kSimulatedWhat;
  return out;
}

SharedPen open_device(const std::string& what, const std::string& geometry, double bubble, double exponent,
                      double speed, double turn_rate, bool hold_orientation, const std::array<int, 6>& signs,
                      std::optional<double> gravity, std::optional<double> friction, std::optional<std::uint64_t> seed,
                      bool real_time) {
  pen::PenOptions options;
  options.geometry = geometry;
  options.rate = {bubble, exponent, speed, turn_rate, hold_orientation, false, signs};
  options.rate.validate();
  options.compensation = {gravity, friction};
  options.compensation.validate();
  options.seed = seed, options.real_time = real_time;
  const NoGil release;
  return open_pen(what, options);
}

SharedPen play(const std::vector<std::pair<Doubles, std::vector<double>>>& strokes, double speed) {
  std::vector<pen::RecordedStroke> recorded;
  for (const auto& [poses, times] : strokes) recorded.push_back({to_poses(poses, "poses"), times});
  return std::make_shared<pen::PlaybackPen>(std::move(recorded), speed);
}

Wrench to_wrench(const ArrayLike& force, const ArrayLike& torque) {
  return {to_vec3(force, "force"), to_vec3(torque, "torque")};
}

HealthResult health(const pen::Pen& pen) {
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
  return pen_result("PenHealth", out);
}

PushResult push(pen::Pen& pen, const ArrayLike& force, const ArrayLike& torque) {
  const pen::PushAnswer answer = pen.push(to_wrench(force, torque));
  py::dict out;
  out["force"] = from_vec3(answer.felt.force);
  out["torque"] = from_vec3(answer.felt.torque);
  out["missing_force"] = from_vec3(answer.missing.force);
  out["missing_torque"] = from_vec3(answer.missing.torque);
  out["reason"] = or_none(not_pushed_text(answer.reason));
  return pen_result("PushResult", out);
}

/// A sample, and its age at the time of the query.
struct State {
  pen::PenSample sample;
  double age;
};

void bind_state(py::module_& m) {
  py::class_<State>(m, "PenState", "State of the hand in one report: see `PenDevice.state`.")
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
          "sequence", [](const State& s) { return s.sample.sequence; }, "Number of the report; 0 before the first.")
      .def_property_readonly(
          "homed", [](const State& s) { return s.sample.homed; }, "Whether the pose is certain.")
      .def_property_readonly(
          "fault", [](const State& s) { return s.sample.fault; }, "The device's own fault code, or 0.")
      .def_property_readonly(
          "stretch", [](const State& s) { return s.sample.stretch; }, "mm between two measurements of one length.")
      .def_property_readonly(
          "powered", [](const State& s) { return s.sample.powered; }, "Whether the device is ready to push.")
      .def_property_readonly(
          "counts",
          [](const State& s) {
            return take<std::int32_t>(std::vector(s.sample.counts.begin(), s.sample.counts.end()));
          },
          "(6,) int32: counters of a pen that has a geometry, in its order, as if homing had preset them.")
      .def_property_readonly(
          "applied",
          [](const State& s) -> ArrayPair {
            return py::make_tuple(from_vec3(s.sample.applied.force), from_vec3(s.sample.applied.torque));
          },
          "(force, torque), N and N·mm: of the motors on the hand, if the device reports it; otherwise zero.");
}

void bind_device(py::module_& m) {
  py::class_<pen::Pen, SharedPen>(m, "PenDevice", R"(An open device: a pen, a puck, a recording. Context manager.

Its own thread reads reports and writes forces, and reconnects to a device that was unplugged.

Examples
--------
>>> with riffler.pen.open("simulated") as pen:
...     pen.kind
'simulated'
)")
      .def_property_readonly("kind", &pen::Pen::kind, "Its kind in ``riffler.pen.kinds``.")
      .def_property_readonly("about", &pen::Pen::about, "The device's own description.")
      .def_property_readonly(
          "geometry",
          [](const pen::Pen& p) -> OptionalGeometry {
            return p.geometry() == nullptr ? py::object(py::none()) : py::cast(pen::PenKinematics(*p.geometry()));
          },
          "Geometry of a pen of two arms, with the currents that the device allows; None for other devices.")
      .def_property_readonly(
          "limits", [](const pen::Pen& p) { return to_axes(p.capability()); },
          R"(What the device senses and pushes along "x", "y", "z" and about the axes "a", "b", "c".)")
      .def_property_readonly(
          "priority", [](const pen::Pen& p) { return to_priority(p.priority()); },
          "How the system runs the device's thread: ThreadPriority.")
      .def(
          "state", [](const pen::Pen& p) { return State{p.newest(), p.age()}; }, R"(The newest sample.

Returns
-------
PenState

Examples
--------
>>> with riffler.pen.open("simulated") as pen:
...     pen.state().pose.shape
(6,)
)")
      .def("health", &health, R"(The connection, the force, and counts since the start.

Returns
-------
PenHealth

Examples
--------
>>> with riffler.pen.open("simulated") as pen:
...     pen.health().malformed
0
)")
      .def("push", &push, "force"_a, "torque"_a = py::make_tuple(0, 0, 0), R"(Pushes for 20 ms.

Parameters
----------
force : array_like, shape (3,)
    N.
torque : array_like, shape (3,)
    N·mm about the grip's point.

Returns
-------
PushResult

Examples
--------
>>> pointer = riffler.pen.Pointer("mouse")
>>> pointer.push((0, 0, 1)).reason
'the device has no motors for all of it'
)")
      .def("home", &pen::Pen::home, R"(Declares that the device is in its home posture.

Returns
-------
bool
    False for a device that needs no homing.

Examples
--------
>>> riffler.pen.Pointer("mouse").home()
False
)")
      .def("reset", &pen::Pen::reset,
           R"(Clears a trip that does not clear itself: the cause is in ``health()``.

Examples
--------
>>> with riffler.pen.open("simulated") as pen:
...     pen.reset()
)")
      .def("stop", &pen::Pen::stop, py::call_guard<NoGil>(), R"(Ends the force and closes the device.

Returns
-------
bool
    False if the device could not be reached in time.

Examples
--------
>>> pen = riffler.pen.open("simulated")
>>> pen.stop()
True
)")
      .def("__enter__", [](const py::object& self) -> Self { return self; })
      .def("__exit__", [](pen::Pen& p, const py::args&) {
        const NoGil release;
        p.stop();
      });
}

}  // namespace

void bind_pen_device(py::module_& m) {
  py::register_exception<pen::OpenError>(m, "PenError", PyExc_RuntimeError).attr("__doc__") =
      "A device does not open. The message gives the reason and the remedy.";
  bind_state(m);
  bind_device(m);
  bind_pointers(m);
  bind_pose_follower(m);
  m.def("_pen_devices", &devices);
  m.def("_pen_families", &families);
  m.def("_pen_unavailable", &unavailable);
  m.def("_pen_real_time", [] {
    base::ThreadPriority found;
    {
      const NoGil release;  // rtkit may take a second
      found = base::probe_real_time();
    }
    return to_priority(found);
  });
  const pen::RateSettings rate;
  m.def("_open_pen", &open_device, "what"_a, py::kw_only(), "geometry"_a = "woodenhaptics", "bubble"_a = rate.bubble,
        "exponent"_a = rate.exponent, "speed"_a = rate.speed, "turn_rate"_a = rate.turn_rate,
        "hold_orientation"_a = rate.hold_orientation, "signs"_a = rate.signs, "gravity"_a = std::optional<double>(),
        "friction"_a = std::optional<double>(), "seed"_a = std::optional<std::uint64_t>(), "real_time"_a = true);
  m.def("_play_pen", &play, "strokes"_a, "speed"_a);
}

}  // namespace riffler::bindings
