// riffler.pen: what a pen is and how it moves.
#include "bindings/pen_calls.hpp"
#include "pen/arms/pens.hpp"

namespace riffler::bindings {

using namespace py::literals;

void bind_pen(py::module_& m) {
  py::class_<pen::PenKinematics>(m, "PenGeometry",
                                 R"(A pen's lengths, gears, encoders, motors and limits, and its kinematics.

Two arms, R and L, hold the two ends of a grip. Counts are the six counters in the device's own order (``channels``);
joints are θ1 θ2 θ3 of R, then of L, in rad. Poses are the grip's pivot and the unit axis along it, away from the tool's
tip. Arrays have one row per moment.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.forward([pen.home]).shape
(1, 6)
)")
      .def_static(
          "load", [](const std::string& name) { return pen::PenKinematics(pen::load_pen(name)); }, "name"_a,
          R"(Reads the geometry of a pen.

Parameters
----------
name : str
    A name of ``riffler.pen.names()``, or the path of a .toml file.

Returns
-------
PenGeometry

Raises
------
FormatError
    Naming the file's line.
ValueError
    Listing the known pens.

Examples
--------
>>> riffler.pen.PenGeometry.load("riffler").name
'riffler'
)")
      .def_property_readonly(
          "name", [](const pen::PenKinematics& p) { return p.geometry().name; }, "Name of its file.")
      .def_property_readonly(
          "description", [](const pen::PenKinematics& p) { return p.geometry().description; },
          "Description in its file.")
      .def_property_readonly(
          "grip_length", [](const pen::PenKinematics& p) { return p.geometry().grip_length; },
          "mm, between the arms' ends.")
      .def_property_readonly(
          "grip_tolerance", [](const pen::PenKinematics& p) { return p.geometry().grip_tolerance; },
          "mm: a larger |stretch| is a lost count or a bad homing.")
      .def_property_readonly(
          "tip", [](const pen::PenKinematics& p) { return p.geometry().tip == pen::Arm::R ? "R" : "L"; },
          "The arm whose end is at the tool's tip.")
      .def_property_readonly("channels", &channels, "The six motors with their encoders, in the device's order.")
      .def_property_readonly("limits", &limits, "Workspace, elbow, force, torque, speeds.")
      .def_property_readonly(
          "home",
          [](const pen::PenKinematics& p) {
            std::vector<pen::EncoderCounts> one{p.counts(p.home_angles())};
            return take<std::int32_t>(std::move(one)).reshape({static_cast<py::ssize_t>(pen::kPenChannels)});
          },
          "(6,) int32: what the counters read in the home posture.")
      .def("forward", &forward, "counts"_a, R"(Poses of counts: (2.3) and (2.4) of the source.

Parameters
----------
counts : array_like, shape (n, 6)
    Readings of the counters, in the device's order.

Returns
-------
ndarray, shape (n, 6)
    The grip's pivot, mm, and the unit axis along it.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.forward([pen.home]).shape
(1, 6)
)")
      .def("joints", &joints, "counts"_a, R"(Joint angles of counts: (2.9) of the source.

Parameters
----------
counts : array_like, shape (n, 6)
    Readings of the counters, in the device's order.

Returns
-------
ndarray, shape (n, 6)
    θ1 θ2 θ3 of R, then of L, rad.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.joints([pen.home]).shape
(1, 6)
)")
      .def("counts", &counts_of, "joints"_a, R"(The nearest counts of joint angles.

Parameters
----------
joints : array_like, shape (n, 6)
    θ1 θ2 θ3 of R, then of L, rad.

Returns
-------
ndarray of int32, shape (n, 6)

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> bool((pen.counts(pen.joints([pen.home])) == pen.home).all())
True
)")
      .def("homed", &homed, "counts"_a, py::kw_only(), "probe"_a = 0,
           R"(The same pen, homed by its readings instead of presets. Counters may wrap.

Parameters
----------
counts : array_like, shape (1, 6)
    Readings of the counters in the home posture.
probe : int
    Reading of the seventh counter there.

Returns
-------
PenGeometry

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.homed([pen.home + 100]).name
'riffler'
)")
      .def("probe_angle", &pen::PenKinematics::probe_angle, "count"_a,
           R"(The grip's rotation about the pose's axis, turns added up.

Parameters
----------
count : int
    Readings of the seventh counter.

Returns
-------
float
    rad.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.probe_angle(0)
0.0
)")
      .def("ends", &ends, "counts"_a, R"(Ends of the arms in their frame: (2.1) and (2.2) of the source.

Parameters
----------
counts : array_like, shape (n, 6)
    Readings of the counters, in the device's order.

Returns
-------
ndarray, shape (n, 2, 3)
    Of R and of L, mm.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.ends([pen.home]).shape
(1, 2, 3)
)")
      .def("jacobian", &jacobian, "counts"_a,
           R"(Derivative of each arm's end by its joint angles: (2.7) and (2.8) of the source.

Parameters
----------
counts : array_like, shape (n, 6)
    Readings of the counters, in the device's order.

Returns
-------
ndarray, shape (n, 2, 3, 3)
    Of R and of L: x y z by θ1 θ2 θ3, mm/rad.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.jacobian([pen.home]).shape
(1, 2, 3, 3)
)")
      .def("inverse", &inverse, "poses"_a, R"(Joint angles of poses.

Parameters
----------
poses : array_like, shape (n, 6)
    The grip's pivot, mm, and the unit axis along it.

Returns
-------
joints : ndarray, shape (n, 6)
    rad.
reach : list of tuple
    Of R and of L: "reached", "too far", "too near", "on axis" (of θ1, or folded), "limits" (the angles are beyond the
    joints' or the elbow's) or "not finite".

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> joints, reach = pen.inverse(pen.forward([pen.home]))
>>> reach
[('reached', 'reached')]
)")
      .def("split", &split, "wrenches"_a, "apart"_a, R"(Forces of the two arms for a force and a torque on the hand.

Parameters
----------
wrenches : array_like, shape (n, 6)
    Force, N, and torque about the grip's pivot, N·mm.
apart : array_like, shape (n, 3)
    From R's end to L's, mm.

Returns
-------
forces : ndarray, shape (n, 2, 3)
    Of R and of L, N.
missing : ndarray, shape (n, 3)
    The torque that cannot be felt: its part along the grip, N·mm.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> forces, missing = pen.split([(0, 0, 1, 0, 0, 0)], [(0, 0, 50)])
>>> forces.sum(axis=1)
array([[0., 0., 1.]])
)")
      .def("efforts", &efforts, "counts"_a, "wrenches"_a, "at"_a, R"(Joint torques for a force and a torque on the hand.

Parameters
----------
counts : array_like, shape (n, 6)
    Readings of the counters, in the device's order.
wrenches : array_like, shape (n, 6)
    Force, N, and torque, N·mm, in the frame of poses.
at : array_like, shape (n, 3)
    Points about which the torques act, mm.

Returns
-------
torques : ndarray, shape (n, 6)
    Of the joints, N·mm.
missing : ndarray, shape (n, 3)
    The torque that cannot be felt, N·mm.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> torques, missing = pen.efforts([pen.home], [(0, 0, 1, 0, 0, 0)], pen.forward([pen.home])[:, :3])
>>> torques.shape
(1, 6)
)")
      .def("motor_currents", &currents, "torques"_a, R"(Motor currents for joint torques.

Parameters
----------
torques : array_like, shape (n, 6)
    Of the joints, N·mm.

Returns
-------
currents : ndarray of int16, shape (n, 6)
    mA, in the device's order.
scale : ndarray, shape (n,)
    The factor by which all six of a row were scaled, so that none passes its peak.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> currents, scale = pen.motor_currents([(1, 0, 0, 0, 0, 0)])
>>> scale
array([1.])
)")
      .def("converter_steps", &steps, "torques"_a,
           R"(As ``motor_currents``, in the steps of the pen's digital to analogue converter.

Parameters
----------
torques : array_like, shape (n, 6)
    Of the joints, N·mm.

Returns
-------
steps : ndarray of int16, shape (n, 6)
scale : ndarray, shape (n,)

Raises
------
ValueError
    For a pen without a converter.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> steps, scale = pen.converter_steps([(1, 0, 0, 0, 0, 0)])
>>> steps.shape, scale
((1, 6), array([1.]))
)")
      .def("stretch", &stretch, "counts"_a, R"(Error of the grip's length as computed from the counts, mm.

Parameters
----------
counts : array_like, shape (n, 6)
    Readings of the counters, in the device's order.

Returns
-------
ndarray, shape (n,)
    mm.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.stretch([pen.home]).shape
(1,)
)")
      .def(
          "noticed_counts", &noticed, "counts"_a,
          R"(Number of counts by which each channel may be off, in either direction, before the error is detected, if all others are right.

Parameters
----------
counts : array_like, shape (n, 6)
    Readings of the counters, in the device's order.

Returns
-------
ndarray, shape (n, 6)
    Infinite if no error is detected, 0 in rows that do not fit.

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.noticed_counts([pen.home]).shape
(1, 6)
)")
      .def("diagnose", &diagnose, "counts"_a, R"(Which counter is wrong, from counts of different postures.

Parameters
----------
counts : array_like, shape (n, 6)
    Readings of the counters, in the device's order.

Returns
-------
riffler.pen.GripDiagnosis

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.diagnose([pen.home]).fault
'unclear'
)")
      .def("capability", &capability, R"(What each coordinate senses and pushes.

Returns
-------
riffler.pen.PenCapability

Examples
--------
>>> pen = riffler.pen.PenGeometry.load("riffler")
>>> pen.capability().axes["x"].sensing
'position'
)");
  m.def("_pens", &pen_list);
  m.def("_pen_text", &pen::pen_text, "name"_a);
}

}  // namespace riffler::bindings
