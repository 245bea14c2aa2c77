#include "bindings/pen_calls.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pen/arms/pens.hpp"
#include "pen/arms/redundancy.hpp"
#include "pen/arms/wrench_split.hpp"
#include "riffler/pen/arms/motors.hpp"

namespace riffler::bindings {

using namespace py::literals;

namespace {

using Row = std::array<double, 6>;

py::array_t<double> shaped(std::vector<Row>&& rows, const std::vector<py::ssize_t>& each) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows.size())};
  shape.insert(shape.end(), each.begin(), each.end());
  return take<double>(std::move(rows), 6).reshape(shape);
}

Vec3 vector_at(const double* p) {
  return {p[0], p[1], p[2]};
}

Row row_of(const std::array<Vec3, 2>& pair) {
  return {pair[0].x, pair[0].y, pair[0].z, pair[1].x, pair[1].y, pair[1].z};
}

std::vector<pen::EncoderCounts> to_counts(const Doubles& array) {
  std::vector<pen::EncoderCounts> out(check_rows(array, pen::kPenChannels, "counts"));
  const double* p = array.data();
  for (std::size_t row = 0; row < out.size(); ++row)
    for (std::int32_t& count : out[row]) {
      const double value = *p++;
      if (value != std::floor(value) || std::abs(value + 0.5) > 0x1p31)
        throw py::value_error("counts, row " + std::to_string(row) + ": must be whole numbers of 32 bits");
      count = static_cast<std::int32_t>(value);
    }
  return out;
}

std::vector<pen::JointAngles> to_joints(const Doubles& array, const char* name) {
  std::vector<pen::JointAngles> out(check_rows(array, 6, name));
  const double* p = array.data();
  for (pen::JointAngles& row : out) row = {vector_at(p), vector_at(p + 3)}, p += 6;
  return out;
}

std::vector<Wrench> to_wrenches(const Doubles& array) {
  std::vector<Wrench> out(check_rows(array, 6, "wrenches"));
  const double* p = array.data();
  for (Wrench& row : out) row = {vector_at(p), vector_at(p + 3)}, p += 6;
  return out;
}

void check_same(std::size_t rows, std::size_t expected, const char* name) {
  if (rows != expected)
    throw py::value_error(std::string(name) + " must have as many rows as counts: " + std::to_string(expected) +
                          ", not " + std::to_string(rows));
}

/// One row of six numbers for each of `in`; `row` knows nothing of Python.
template <class In, class F>
std::vector<Row> rows_of(const std::vector<In>& in, const F& row) {
  const NoGil release;
  std::vector<Row> out;
  out.reserve(in.size());
  for (const In& one : in) out.push_back(row(one));
  return out;
}

const char* name_of(pen::ReachResult reach) {
  switch (reach) {
    case pen::ReachResult::Reached:
      return "reached";
    case pen::ReachResult::TooFar:
      return "too far";
    case pen::ReachResult::TooNear:
      return "too near";
    case pen::ReachResult::OnAxis:
      return "on axis";
    case pen::ReachResult::Limits:
      return "limits";
    default:
      return "not finite";
  }
}

template <class F>
CommandPair commands(const pen::PenKinematics& pen, const Doubles& torques, const F& command) {
  std::vector<std::array<std::int16_t, pen::kPenChannels>> values;
  std::vector<double> scales;
  for (const pen::JointAngles& row : to_joints(torques, "torques")) {
    const pen::MotorCommands one = command(motor_torques(pen.geometry(), row));
    values.push_back(one.values), scales.push_back(one.scale);
  }
  return py::make_tuple(take<std::int16_t>(std::move(values), pen::kPenChannels), take<double>(std::move(scales)));
}

}  // namespace

py::array_t<double> forward(const pen::PenKinematics& pen, const Doubles& counts) {
  return shaped(rows_of(to_counts(counts),
                        [&](const pen::EncoderCounts& raw) {
                          const Pose pose = pen.posture(raw).pose;
                          return row_of({pose.tip, pose.axis});
                        }),
                {6});
}

py::array_t<double> joints(const pen::PenKinematics& pen, const Doubles& counts) {
  return shaped(rows_of(to_counts(counts), [&](const pen::EncoderCounts& raw) { return row_of(pen.angles(raw)); }),
                {6});
}

py::array_t<std::int32_t> counts_of(const pen::PenKinematics& pen, const Doubles& angles) {
  std::vector<pen::EncoderCounts> out;
  for (const pen::JointAngles& row : to_joints(angles, "joints")) out.push_back(pen.counts(row));
  return take<std::int32_t>(std::move(out), pen::kPenChannels);
}

pen::PenKinematics homed(const pen::PenKinematics& pen, const Doubles& counts, std::int32_t probe) {
  const std::vector<pen::EncoderCounts> rows = to_counts(counts);
  if (rows.size() != 1) throw py::value_error("counts must have one row: what the counters read at home");
  pen::PenKinematics out = pen;
  out.home_at(rows[0], probe);
  return out;
}

py::array_t<double> ends(const pen::PenKinematics& pen, const Doubles& counts) {
  return shaped(rows_of(to_counts(counts),
                        [&](const pen::EncoderCounts& raw) {
                          const pen::PenPosture posture = pen.posture(raw);
                          return row_of({posture.arms[0].end, posture.arms[1].end});
                        }),
                {2, 3});
}

py::array_t<double> jacobian(const pen::PenKinematics& pen, const Doubles& counts) {
  const std::vector<pen::EncoderCounts> rows = to_counts(counts);
  py::array_t<double> out({static_cast<py::ssize_t>(rows.size()), py::ssize_t{2}, py::ssize_t{3}, py::ssize_t{3}});
  double* p = out.mutable_data();
  for (const pen::EncoderCounts& raw : rows)
    for (const pen::ArmPosture& arm : pen.posture(raw).arms)
      for (int row = 0; row < 3; ++row)
        for (int joint = 0; joint < 3; ++joint) *p++ = arm.jacobian[joint][row];
  return out;
}

py::array_t<double> stretch(const pen::PenKinematics& pen, const Doubles& counts) {
  std::vector<double> out;
  for (const pen::EncoderCounts& raw : to_counts(counts)) out.push_back(check_grip(pen, pen.posture(raw)).stretch);
  return take<double>(std::move(out));
}

py::array_t<double> noticed(const pen::PenKinematics& pen, const Doubles& counts) {
  return shaped(rows_of(to_counts(counts),
                        [&](const pen::EncoderCounts& raw) {
                          const auto found = noticed_counts(pen, pen.posture(raw));
                          Row row{};
                          for (std::size_t k = 0; k < row.size(); ++k) row[k] = std::max(found[k].few, found[k].many);
                          return row;
                        }),
                {6});
}

InverseResult inverse(const pen::PenKinematics& pen, const Doubles& poses) {
  std::vector<Row> angles;
  py::list reach;
  for (const Pose& pose : to_poses(poses, "poses")) {
    const pen::PenInverse found = pen.inverse(pose);
    angles.push_back(row_of(found.angles));
    reach.append(py::make_tuple(name_of(found.reach[0]), name_of(found.reach[1])));
  }
  return py::make_tuple(shaped(std::move(angles), {6}), reach);
}

ArrayPair split(const pen::PenKinematics&, const Doubles& wrenches, const Doubles& apart) {
  const std::vector<Wrench> rows = to_wrenches(wrenches);
  const std::vector<Vec3> between = to_vec3s(apart, "apart");
  if (between.size() != rows.size())
    throw py::value_error("apart must have as many rows as wrenches: " + std::to_string(rows.size()) + ", not " +
                          std::to_string(between.size()));
  std::vector<Row> forces;
  std::vector<Vec3> missing;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const pen::WrenchSplit one = pen::split_wrench(rows[k], between[k]);
    forces.push_back(row_of(one.forces)), missing.push_back(one.missing);
  }
  return py::make_tuple(shaped(std::move(forces), {2, 3}), from_vec3s(missing));
}

ArrayPair efforts(const pen::PenKinematics& pen, const Doubles& counts, const Doubles& wrenches, const Doubles& at) {
  const std::vector<pen::EncoderCounts> rows = to_counts(counts);
  const std::vector<Wrench> wanted = to_wrenches(wrenches);
  const std::vector<Vec3> points = to_vec3s(at, "at");
  check_same(wanted.size(), rows.size(), "wrenches");
  check_same(points.size(), rows.size(), "at");
  std::vector<Row> torques;
  std::vector<Vec3> missing;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const pen::PenEffort effort = pen_effort(pen, pen.posture(rows[k]), wanted[k], points[k]);
    torques.push_back(row_of(effort.torques)), missing.push_back(effort.missing);
  }
  return py::make_tuple(shaped(std::move(torques), {6}), from_vec3s(missing));
}

CommandPair currents(const pen::PenKinematics& pen, const Doubles& torques) {
  return commands(pen, torques,
                  [&](const pen::MotorTorques& motors) { return motor_currents(pen.geometry(), motors); });
}

CommandPair steps(const pen::PenKinematics& pen, const Doubles& torques) {
  const std::optional<pen::Converter>& converter = pen.geometry().converter;
  if (!converter) throw py::value_error("pen " + pen.geometry().name + " has no [converter]");
  return commands(pen, torques,
                  [&](const pen::MotorTorques& motors) { return converter_steps(pen.geometry(), *converter, motors); });
}

DiagnosisResult diagnose(const pen::PenKinematics& pen, const Doubles& counts) {
  pen::GripDiagnosis diagnosis(pen);
  for (const pen::EncoderCounts& raw : to_counts(counts)) diagnosis.add(pen.posture(raw));
  const pen::GripVerdict verdict = diagnosis.verdict();
  constexpr const char* kFaults[] = {"none", "channel", "several", "unclear"};
  py::dict out("fault"_a = kFaults[static_cast<std::size_t>(verdict.fault)], "postures"_a = diagnosis.postures());
  if (verdict.fault == pen::GripFault::Channel)
    out["channel"] = verdict.channel, out["counts"] = verdict.counts, out["left"] = verdict.left;
  return pen_result("GripDiagnosis", out);
}

CoordinateDict to_axes(const pen::DeviceCapability& device) {
  constexpr const char* kSensing[] = {"none", "position", "rate"};
  py::dict out;
  for (std::size_t k = 0; k < haptics::kCoordinates; ++k) {
    const pen::CoordinateCapability& c = device.coordinates[k];
    out[py::str(std::string(1, "xyzabc"[k]))] = pen_result(
        "CoordinateCapability",
        py::dict("sensing"_a = kSensing[static_cast<std::size_t>(c.sensing)], "pushes"_a = c.pushes, "low"_a = c.low,
                 "high"_a = c.high, "resolution"_a = c.resolution, "peak"_a = c.peak, "continuous"_a = c.continuous));
  }
  return out;
}

CapabilityResult capability(const pen::PenKinematics& pen) {
  const pen::DeviceCapability device = pen_capability(pen.geometry());
  return pen_result("PenCapability",
                    py::dict("name"_a = device.name, "text"_a = capability_text(device), "axes"_a = to_axes(device)));
}

ChannelList channels(const pen::PenKinematics& pen) {
  py::list out;
  for (const pen::PenChannel& c : pen.geometry().channels)
    out.append(pen_result(
        "PenChannel",
        py::dict("name"_a = std::string(c.arm == pen::Arm::R ? "R" : "L") + std::to_string(c.joint + 1),
                 "steps"_a = c.steps, "ratio"_a = c.ratio, "sign"_a = c.sign, "home"_a = c.home, "low"_a = c.low,
                 "high"_a = c.high, "torque_constant"_a = c.torque_constant, "peak_current"_a = c.peak_current,
                 "continuous_current"_a = c.continuous_current, "coulomb"_a = c.coulomb, "viscous"_a = c.viscous,
                 "gravity"_a = c.gravity, "inertia"_a = c.inertia, "resistance"_a = c.resistance)));
  return out;
}

LimitsResult limits(const pen::PenKinematics& pen) {
  const pen::PenGeometry& g = pen.geometry();
  return pen_result("PenLimits",
                    py::dict("lower"_a = from_vec3(g.workspace.lower), "upper"_a = from_vec3(g.workspace.upper),
                             "elbow"_a = py::make_tuple(g.elbow_low, g.elbow_high), "force"_a = g.force,
                             "torque"_a = g.torque, "speed"_a = g.speed, "turn_rate"_a = g.turn_rate));
}

StringDict pen_list() {
  py::dict out;
  for (const base::DescriptionEntry& entry : pen::pens()) out[py::str(entry.name)] = entry.description;
  return out;
}

}  // namespace riffler::bindings
