// riffler.pen.SimulatedPen and riffler.pen.Pointer: devices without hardware.
#include <memory>

#include "bindings/pen_calls.hpp"
#include "pen/simulated/simulated_device.hpp"
#include "riffler/pen/arms/kinematics.hpp"
#include "riffler/pen/pointer.hpp"

namespace riffler::bindings {

namespace {

using namespace py::literals;

void aim(pen::SimulatedDevice& pen, const Doubles& pose, double spin, double grip, std::uint32_t buttons) {
  if (pose.size() != 6) throw std::invalid_argument("pose must be six numbers: a point and an axis");
  const double* const p = pose.data();
  pen.aim({.pose = {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}}, .spin = spin, .grip = grip, .buttons = buttons});
}

void bind_simulated(py::module_& m) {
  py::class_<pen::SimulatedDevice, pen::Pen, std::shared_ptr<pen::SimulatedDevice>>(
      m, "SimulatedPen", R"(A pen without hardware: arms, motors, firmware and cable are simulated, and a hand moves it.

Examples
--------
>>> with riffler.pen.open("simulated") as pen:
...     isinstance(pen, riffler.pen.SimulatedPen)
True
)")
      .def("aim", &aim, "pose"_a, py::kw_only(), "spin"_a = 0.0, "grip"_a = 1.0, "buttons"_a = 0U,
           R"(Moves the hand to a pose, at up to 300 mm/s and 5 rad/s, as far as the arms reach.

Parameters
----------
pose : array_like, shape (6,)
    Point, mm, and axis.
spin : float
    rad about the axis.
grip : float
    1: the hand holds firmly; less: more loosely; 0: not at all.
buttons : int
    As bits; bit 0 is button 1.

Examples
--------
>>> with riffler.pen.open("simulated") as pen:
...     pen.aim((0, 0, 0, 0, 0, 1), buttons=1)
)")
      .def("wander", &pen::SimulatedDevice::wander, R"(Moves the hand along its own closed curve again.

Examples
--------
>>> with riffler.pen.open("simulated") as pen:
...     pen.wander()
)")
      .def("lose", &pen::SimulatedDevice::lose, "channel"_a, "counts"_a,
           R"(Makes a counter lose counts, one by one: a fault to practise with.

Parameters
----------
channel : int
    0 to 5.
counts : int
    Total number of lost counts.

Examples
--------
>>> with riffler.pen.open("simulated") as pen:
...     pen.lose(0, 20)
)")
      .def("hang", &pen::SimulatedDevice::hang, "mass"_a, "hook"_a = 15.0,
           R"(Hangs a weight on the grip by a thread.

Parameters
----------
mass : float
    kg; 0 takes it off.
hook : float
    mm from the grip's point towards the tool's tip, along the grip.

Examples
--------
>>> with riffler.pen.open("simulated") as pen:
...     pen.hang(0.2)
)")
      .def("unplug", &pen::SimulatedDevice::unplug, R"(Pulls the cable out: a fault to practise with.

Examples
--------
>>> with riffler.pen.open("simulated") as pen:
...     pen.unplug()
)")
      .def("plug", &pen::SimulatedDevice::plug, R"(Puts the cable in again; the pen then connects by itself.

Examples
--------
>>> with riffler.pen.open("simulated") as pen:
...     pen.unplug()
...     pen.plug()
)")
      .def_property_readonly(
          "truth", [](const pen::SimulatedDevice& p) { return pen::PenKinematics(p.truth()); },
          "PenGeometry of the simulated arms and motors; ``geometry`` has the values that the host assumes.");
}

pen::PointerFrame to_frame(const ArrayLike& origin, const ArrayLike& right, const ArrayLike& up, double scale,
                           double depth, double max_tilt) {
  return {to_vec3(origin, "origin"), to_vec3(right, "right"), to_vec3(up, "up"), scale, depth, max_tilt};
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
      m, "Pointer", R"(A tablet or a mouse as a device: `give` passes its events, which become poses.

Parameters
----------
kind : {"tablet", "mouse"}
    A tablet senses point and axis, a mouse the point only; its axis stands upright on the plane.

Examples
--------
>>> pointer = riffler.pen.Pointer("tablet")
>>> pointer.give(3, 4, pressure=0.5, time=0.0)
True
)")
      .def(py::init(&make_pointer), "kind"_a = "tablet")
      .def(
          "set_frame",
          [](pen::PointerPen& p, const ArrayLike& origin, const ArrayLike& right, const ArrayLike& up, double scale,
             double depth, double max_tilt) { p.set_frame(to_frame(origin, right, up, scale, depth, max_tilt)); },
          py::kw_only(), "origin"_a = zero, "right"_a = along, "up"_a = across, "scale"_a = frame.scale,
          "depth"_a = frame.depth, "max_tilt"_a = frame.max_tilt,
          R"(Sets the position of the pointer's plane, from the next event on.

Parameters
----------
origin : array_like, shape (3,)
    mm, of pointer (0, 0).
right, up : array_like, shape (3,)
    Unit vectors, perpendicular to each other.
scale : float
    mm for a unit of the pointer.
depth : float
    mm into the plane at full pressure.
max_tilt : float
    rad from upright, below pi/2.

Raises
------
ValueError
    Naming the impossible value; the frame is then unchanged.

Examples
--------
>>> pointer = riffler.pen.Pointer("mouse")
>>> pointer.set_frame(origin=(0, 0, 10), scale=0.5)
)")
      .def(
          "give",
          [](pen::PointerPen& p, double x, double y, double pressure, double tilt_x, double tilt_y,
             std::uint32_t buttons, double time) { return p.give({x, y, pressure, tilt_x, tilt_y, buttons, time}); },
          "x"_a, "y"_a, py::kw_only(), "pressure"_a = 0.0, "tilt_x"_a = 0.0, "tilt_y"_a = 0.0, "buttons"_a = 0U,
          "time"_a, R"(Gives an event.

Parameters
----------
x, y : float
    Right and up, in units of the frame.
pressure : float
    0 to 1.
tilt_x, tilt_y : float
    rad by which the pen's end leans to the right and up.
buttons : int
    As bits; bit 0 is button 1.
time : float
    s of any clock.

Returns
-------
bool
    False if the event is ignored: a number is not finite, or the time is before the last event's.

Examples
--------
>>> riffler.pen.Pointer("mouse").give(3, 4, time=0.0)
True
)");
}

}  // namespace

void bind_pointers(py::module_& m) {
  bind_simulated(m);
  bind_pointer(m);
}

}  // namespace riffler::bindings
