#include "bindings/journal_arguments.hpp"

#include <iterator>

namespace riffler::bindings {

namespace {

/// (n,), or empty for None.
std::vector<double> to_column(const OptionalArrayLike& column, const char* name, std::size_t rows) {
  if (column.is_none()) return {};
  const auto array = Doubles::ensure(column);
  if (!array || array.ndim() != 1) {
    PyErr_Clear();
    throw py::value_error(std::string(name) + " must have the shape (n,)");
  }
  // An empty column would mean that there is none.
  if (static_cast<std::size_t>(array.size()) != rows)
    throw py::value_error(std::string(name) + " must be as many as poses");
  return {array.data(), array.data() + array.size()};
}

/// (n, 6), or empty for None.
std::vector<Wrench> to_forces(const OptionalArrayLike& forces, std::size_t rows) {
  if (forces.is_none()) return {};
  const Doubles array = py::cast<Doubles>(forces);
  if (check_rows(array, 6, "forces") != rows) throw py::value_error("forces must be as many as poses");
  std::vector<Wrench> out(rows);
  const double* p = array.data();
  for (Wrench& wrench : out)
    for (int k = 0; k < haptics::kCoordinates; ++k) wrench[k] = *p++;
  return out;
}

constexpr const char* kModes[] = {"remove", "add", "mask", "unmask", "soften", "beside", "build"};
static_assert(std::size(kModes) == session::kFirstBrush);

}  // namespace

session::JournalStroke to_rows(const Doubles& poses, const OptionalArrayLike& times, const OptionalArrayLike& forces,
                               const OptionalArrayLike& removed) {
  session::JournalStroke out;
  if (poses.ndim() == 2 && poses.shape(1) == 9) {
    for (const RolledPose& pose : to_rolled_poses(poses, "poses"))
      out.poses.push_back({pose.tip, pose.axis}), out.forward.push_back(pose.forward);
  } else {
    out.poses = to_poses(poses, "poses");
  }
  const std::size_t rows = out.poses.size();
  out.times = to_column(times, "times", rows);
  out.forces = to_forces(forces, rows);
  out.removed = to_column(removed, "removed", rows);
  return out;
}

session::JournalStock to_stock(const ArrayLike& lower, const ArrayLike& upper, double pitch,
                               const std::string& directions, const std::string& snapshot, const std::string& mask) {
  return {{to_vec3(lower, "lower"), to_vec3(upper, "upper")}, pitch, directions, snapshot, mask};
}

session::StrokeMode to_stroke_mode(const std::string& name) {
  std::string all;
  for (std::uint32_t k = 0; k < session::kStrokeModes; ++k) {
    const auto mode = static_cast<session::StrokeMode>(k);
    if (name == stroke_mode_name(mode)) return mode;
    all += (k == 0                          ? "\""
            : k + 1 < session::kStrokeModes ? "\", \""
                                            : "\" or \"") +
           std::string(stroke_mode_name(mode));
  }
  throw py::value_error("mode must be " + all + "\"");
}

const char* stroke_mode_name(session::StrokeMode mode) {
  return session::is_brush(mode) ? brush_name(session::brush_of(mode)) : kModes[static_cast<std::uint32_t>(mode)];
}

py::object json() {
  return py::module_::import("json");
}

std::string tool_json(const py::object& tool) {
  py::object dict = tool;
  if (py::isinstance<Tool>(tool)) dict = tool.attr("to_dict")();
  if (py::isinstance<py::str>(tool)) dict = json().attr("loads")(tool);
  if (!py::isinstance<py::dict>(dict)) throw py::value_error("tool must be a Tool, its dict or JSON text of it");
  return py::cast<std::string>(json().attr("dumps")(dict));
}

void check_roll(const session::JournalRules& rules, const session::JournalStroke& stroke) {
  const auto text = rules.tools().find(stroke.tool);
  if (text == rules.tools().end()) return;  // the journal refuses it
  const py::object dict = json().attr("loads")(text->second);
  const py::object kind =
      py::isinstance<py::dict>(dict) ? py::object(dict.attr("get")("kind")) : py::object(py::none());
  const bool hand = py::isinstance<py::str>(kind) && is_hand_tool(py::cast<std::string>(kind));
  if (hand != stroke.forward.empty()) return;
  const std::string which = "poses: tool " + std::to_string(stroke.tool);
  if (hand)
    throw py::value_error(which +
                          " is a hand tool and needs the shape (n, 9): add its forward direction to tip and axis");
  throw py::value_error(which + " is a body of revolution and needs the shape (n, 6): leave out the forward direction");
}

}  // namespace riffler::bindings
