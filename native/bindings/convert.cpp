#include <chrono>
#include <cmath>
#include <memory>

#include "bindings/bindings.hpp"
#include "riffler/base/check.hpp"

namespace riffler::bindings {

std::size_t check_rows(const Doubles& array, std::size_t columns, const char* name) {
  if (array.ndim() != 2 || static_cast<std::size_t>(array.shape(1)) != columns) {
    std::string shape;
    for (py::ssize_t d = 0; d < array.ndim(); ++d) shape.append(d ? ", " : "").append(std::to_string(array.shape(d)));
    throw py::value_error(std::string(name) + " must have the shape (n, " + std::to_string(columns) + "), not (" +
                          shape + (array.ndim() == 1 ? ",)" : ")"));
  }
  const std::size_t n = static_cast<std::size_t>(array.shape(0));
  const double* p = array.data();
  for (std::size_t i = 0; i < n * columns; ++i)
    if (!std::isfinite(p[i]))
      throw py::value_error(std::string(name) + ", row " + std::to_string(i / columns) + ": not finite");
  return n;
}

Vec3 to_vec3(const py::object& object, const char* name) {
  Doubles array;
  try {
    array = py::cast<Doubles>(object);
  } catch (const py::cast_error&) {
    throw py::value_error(std::string(name) + " must be three numbers");
  }
  if (!array || array.ndim() != 1 || array.shape(0) != 3)
    throw py::value_error(std::string(name) + " must be three numbers");
  const Vec3 v{array.at(0), array.at(1), array.at(2)};
  if (!geom::finite(v))
    throw py::value_error(std::string(name) + " must be finite, not (" + base::in_figures(v.x) + ", " +
                          base::in_figures(v.y) + ", " + base::in_figures(v.z) + ")");
  return v;
}

Box3 box_or(const Box3& own, const py::object& lower, const py::object& upper) {
  return {lower.is_none() ? own.lower : to_vec3(lower, "lower"), upper.is_none() ? own.upper : to_vec3(upper, "upper")};
}

std::pair<Mat3, Vec3> to_affine(const py::object& object, const std::string& name) {
  Doubles matrix;
  try {
    matrix = py::cast<Doubles>(object);
  } catch (const py::cast_error&) {
    throw py::value_error(name + " must have the shape (4, 4)");
  }
  if (!matrix || matrix.ndim() != 2 || matrix.shape(0) != 4 || matrix.shape(1) != 4)
    throw py::value_error(name + " must have the shape (4, 4)");
  const auto m = matrix.unchecked<2>();
  if (m(3, 0) != 0 || m(3, 1) != 0 || m(3, 2) != 0 || m(3, 3) != 1)
    throw py::value_error(name + ": its last row must be 0, 0, 0, 1");
  Mat3 turn;
  Vec3 shift;
  for (int row = 0; row < 3; ++row) {
    shift[row] = m(row, 3);
    for (int column = 0; column < 3; ++column) turn[column][row] = m(row, column);
  }
  return {turn, shift};
}

py::array_t<double> from_vec3(const Vec3& v) {
  py::array_t<double> out(3);
  for (int k = 0; k < 3; ++k) out.mutable_at(k) = v[k];
  return out;
}

py::array_t<double> from_vec3s(const std::vector<Vec3>& v) {
  return take<double>(std::vector<Vec3>(v), 3);
}

std::vector<Vec3> to_vec3s(const Doubles& array, const char* name) {
  std::vector<Vec3> out(check_rows(array, 3, name));
  const double* p = array.data();
  for (Vec3& row : out) row = {p[0], p[1], p[2]}, p += 3;
  return out;
}

py::array_t<double> from_poses(const std::vector<Pose>& poses) {
  static_assert(sizeof(Pose) == 6 * sizeof(double));
  return take<double>(std::vector<Pose>(poses), 6);
}

std::vector<Pose> to_poses(const Doubles& array, const char* name) {
  const std::size_t n = check_rows(array, 6, name);
  std::vector<Pose> poses(n);
  const double* p = array.data();
  for (std::size_t i = 0; i < n; ++i, p += 6) poses[i] = {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}};
  return poses;
}

std::vector<RolledPose> to_rolled_poses(const Doubles& array, const char* name) {
  const std::size_t n = check_rows(array, 9, name);
  std::vector<RolledPose> poses(n);
  const double* p = array.data();
  for (std::size_t i = 0; i < n; ++i, p += 9) poses[i] = {{p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]}};
  return poses;
}

PosesOf to_poses_of(const Tool& tool, const Doubles& array, const char* name) {
  const py::ssize_t columns = array.ndim() == 2 ? array.shape(1) : 0;
  if (columns == 6 && !tool.revolved())
    throw py::value_error(std::string(name) + ": the hand tool \"" + tool.name() +
                          "\" needs the shape (n, 9): add its forward direction to tip and axis");
  if (columns == 9 && tool.revolved())
    throw py::value_error(std::string(name) + ": the tool \"" + tool.name() +
                          "\" is a body of revolution and needs the shape (n, 6): leave out the forward direction");
  if (tool.revolved()) return {to_poses(array, name), {}};
  return {{}, to_rolled_poses(array, name)};
}

py::array_t<double> from_poses(const std::vector<RolledPose>& poses) {
  static_assert(sizeof(RolledPose) == 9 * sizeof(double));
  return take<double>(std::vector<RolledPose>(poses), 9);
}

sweep::CarveMode to_carve_mode(const std::string& mode) {
  if (mode == "remove") return sweep::CarveMode::Remove;
  if (mode == "add") return sweep::CarveMode::Add;
  throw py::value_error("mode must be \"remove\" or \"add\", not \"" + mode + "\"");
}

PyObject*& task_request() {
  static PyObject* type = nullptr;
  return type;
}

PyObject*& task_refusal() {
  static PyObject* type = nullptr;
  return type;
}

Progress to_progress(const py::object& callable) {
  if (task_request() && callable.ptr() == task_request()) {
    PyErr_SetString(task_refusal(), "progress: this call cannot be a task");
    throw py::error_already_set();
  }
  // The function object must be released under the GIL, wherever the last copy of the Progress dies.
  std::shared_ptr<py::object> held;
  if (!callable.is_none())
    held = std::shared_ptr<py::object>(new py::object(callable), [](py::object* p) {
      const WithGil gil;
      delete p;
    });
  using Clock = std::chrono::steady_clock;
  return [held, last = Clock::time_point{}](double share) mutable {
    const Clock::time_point now = Clock::now();
    if (share < 1 && now - last < std::chrono::milliseconds(30)) return true;
    last = now;
    const WithGil gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    return !held || !py::object((*held)(share)).is(py::bool_(false));
  };
}

}  // namespace riffler::bindings
